//! [`adopt_parameters`]: decides which unknowns of balance come from the measurement, and which from the machine's
//! file.

use nalgebra::{DMatrix, DVector};

use super::fit::Fit;
use stillbase_mechanics::planar::Vector;

/// The machine as identified.
#[derive(Clone, Debug, PartialEq)]
pub struct AdoptedParameters {
    /// Values of all unknowns.
    pub values: DVector<f64>,
    /// Covariance of the values, conditional on the values from the file.
    pub covariance: DMatrix<f64>,
    /// Half width of the 95 % interval of each value, by that covariance; zero for values from the file.
    pub half_widths: Vec<f64>,
    /// Whether each unknown of (7) and (8) is taken from the measurement.
    pub measured: Vec<bool>,
    /// Whether each unknown differs significantly from the file. Of the unknowns of (7) and (8), exactly these are
    /// taken from the measurement.
    pub differs: Vec<bool>,
    /// D_k of each drive if it is identifiable, kg m².
    pub momenta: Vec<Option<f64>>,
}

impl AdoptedParameters {
    /// Returns the residual of each line of (7) and (8).
    pub fn residuals(&self) -> Vec<Vector> {
        let parts = &self.values.as_slice()[..self.measured.len()];
        parts.chunks_exact(2).map(|part| Vector::new(part[0], part[1])).collect()
    }
}

/// Differences from the file below this fraction of the largest value are rounding errors.
const ROUNDING_TOLERANCE: f64 = 1e-10;

/// Selects the unknowns of (7) and (8) to take from the measurement by backward elimination. The least significant
/// difference from the file is set to zero and the others are estimated again. This ends when every remaining
/// difference exceeds the half width of its interval. So noise is not mistaken for imbalance, and a well-determined sum
/// is kept even if its parts are not well determined.
pub fn adopt_parameters(fit: &Fit) -> AdoptedParameters {
    let count = fit.numbers.unknowns.of_balance();
    let (values, covariance, inverse) =
        (fit.numbers.measured.clone(), fit.numbers.covariance.clone(), fit.inverse.clone());
    let mut known = Known { values, covariance, inverse };
    let mut measured: Vec<bool> = fit.numbers.identifiable[..count].to_vec();
    let rounding = (ROUNDING_TOLERANCE * fit.numbers.measured.amax()).max(f64::MIN_POSITIVE);
    let half_width = |covariance: &DMatrix<f64>, i: usize| fit.numbers.critical * covariance[(i, i)].max(0.0).sqrt();
    loop {
        let Known { values, covariance, .. } = &known;
        let certainty = |i: usize| (values[i] - fit.numbers.nominal[i]).abs() / half_width(covariance, i).max(rounding);
        let others = (0..count).filter(|i| measured[*i]);
        let Some(least) = others.min_by(|a, b| certainty(*a).total_cmp(&certainty(*b))) else { break };
        if certainty(least) > 1.0 {
            break;
        }
        known.fix(least, fit.numbers.nominal[least]);
        measured[least] = false;
    }
    let Known { mut values, mut covariance, .. } = known;
    // Unknowns that are not identifiable have the values of the file, without uncertainty.
    for i in (0..count).filter(|i| !fit.numbers.identifiable[*i]) {
        values[i] = fit.numbers.nominal[i];
        covariance.row_mut(i).fill(0.0);
        covariance.column_mut(i).fill(0.0);
    }
    let momentum = |i: usize| fit.numbers.identifiable[i].then(|| values[i]);
    let momenta = (count..fit.numbers.unknowns.count()).map(momentum).collect();
    let half_widths: Vec<f64> = (0..values.len()).map(|i| half_width(&covariance, i)).collect();
    let differs = |i: usize| {
        fit.numbers.identifiable[i] && (values[i] - fit.numbers.nominal[i]).abs() > half_widths[i].max(rounding)
    };
    let off = (0..values.len()).map(|i| measured.get(i).copied().unwrap_or_else(|| differs(i))).collect();
    AdoptedParameters { values, covariance, half_widths, measured, differs: off, momenta }
}

/// Least-squares estimate with some unknowns fixed.
struct Known {
    values: DVector<f64>,
    covariance: DMatrix<f64>,
    /// (XᵀX)⁻¹.
    inverse: DMatrix<f64>,
}

impl Known {
    /// Fixes one unknown at a value and updates the estimate.
    fn fix(&mut self, i: usize, value: f64) {
        let own = self.inverse[(i, i)];
        if own > f64::MIN_POSITIVE {
            let gain = self.inverse.column(i) / own;
            self.values.axpy(value - self.values[i], &gain, 1.0);
            let row = self.covariance.row(i).clone_owned();
            self.covariance -= &gain * row;
            let column = self.covariance.column(i).clone_owned();
            self.covariance -= column * gain.transpose();
            let column = self.inverse.column(i).clone_owned();
            self.inverse -= &column * column.transpose() / own;
        }
        self.values[i] = value;
        for of in [&mut self.covariance, &mut self.inverse] {
            of.row_mut(i).fill(0.0);
            of.column_mut(i).fill(0.0);
        }
    }
}
