//! [`taken`]: which numbers of balance are taken as measured, and which as the machine's file has them.

use nalgebra::{DMatrix, DVector};

use super::fit::Fit;
use crate::mechanics::planar::Vector;

/// What the machine is taken to be.
#[derive(Clone, Debug, PartialEq)]
pub struct Taken {
    /// Every unknown.
    pub values: DVector<f64>,
    /// Of them, given that the others are as the file has them.
    pub covariance: DMatrix<f64>,
    /// Half the interval of 95 % of each, given that; nothing of those that are as the file has them.
    pub half_widths: Vec<f64>,
    /// Whether each number of (7) and (8) is as measured.
    pub measured: Vec<bool>,
    /// Whether each number is shown to differ from the file. Of (7) and (8) those are taken as measured, and no others.
    pub off: Vec<bool>,
    /// D_k of each drive where it is told, kg m².
    pub momenta: Vec<Option<f64>>,
}

impl Taken {
    /// What is left of each line of (7) and (8).
    pub fn left(&self) -> Vec<Vector> {
        let parts = &self.values.as_slice()[..self.measured.len()];
        parts.chunks_exact(2).map(|part| Vector::new(part[0], part[1])).collect()
    }
}

/// A number that differs from the file by less than this part of the largest differs by rounding.
const ROUNDING: f64 = 1e-10;

/// Numbers of (7) and (8) that the data do not show to be other than in the machine's file are taken from there, the
/// least certain first, and the rest is found again given that; until every other one differs by more than its interval.
/// So noise is not balanced out, and what is known of a sum is not lost because its parts are not.
pub fn taken(fit: &Fit) -> Taken {
    let count = fit.unknowns.of_balance();
    let (values, covariance, inverse) = (fit.measured.clone(), fit.covariance.clone(), fit.inverse.clone());
    let mut known = Known { values, covariance, inverse };
    let mut measured: Vec<bool> = fit.told[..count].to_vec();
    let rounding = (ROUNDING * fit.measured.amax()).max(f64::MIN_POSITIVE);
    let half_width = |covariance: &DMatrix<f64>, i: usize| fit.critical * covariance[(i, i)].max(0.0).sqrt();
    loop {
        let Known { values, covariance, .. } = &known;
        let certainty = |i: usize| (values[i] - fit.nominal[i]).abs() / half_width(covariance, i).max(rounding);
        let others = (0..count).filter(|i| measured[*i]);
        let Some(least) = others.min_by(|a, b| certainty(*a).total_cmp(&certainty(*b))) else { break };
        if certainty(least) > 1.0 {
            break;
        }
        known.hold(least, fit.nominal[least]);
        measured[least] = false;
    }
    let Known { mut values, mut covariance, .. } = known;
    // What is not told says nothing of the others, and these nothing of it.
    for i in (0..count).filter(|i| !fit.told[*i]) {
        values[i] = fit.nominal[i];
        covariance.row_mut(i).fill(0.0);
        covariance.column_mut(i).fill(0.0);
    }
    let momentum = |i: usize| fit.told[i].then(|| values[i]);
    let momenta = (count..fit.unknowns.count()).map(momentum).collect();
    let half_widths: Vec<f64> = (0..values.len()).map(|i| half_width(&covariance, i)).collect();
    let differs = |i: usize| fit.told[i] && (values[i] - fit.nominal[i]).abs() > half_widths[i].max(rounding);
    let off = (0..values.len()).map(|i| measured.get(i).copied().unwrap_or_else(|| differs(i))).collect();
    Taken { values, covariance, half_widths, measured, off, momenta }
}

/// What least squares say while more and more is held.
struct Known {
    values: DVector<f64>,
    covariance: DMatrix<f64>,
    /// (XᵀX)⁻¹.
    inverse: DMatrix<f64>,
}

impl Known {
    /// The same least squares with one number given.
    fn hold(&mut self, i: usize, value: f64) {
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
