//! [`correction_benefit`]: effect of a change on the identified imbalance, with a test of its significance.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | x, V | measured first moments and couplings, and their covariance | |
//! | Δ | effect of the change on x | |
//! | W | mean of ℓ² X_fᵀ X_f + X_nᵀ X_n over the regressor's rows X: J = xᵀ W x is the mean of ℓ² f² + n² | |
//! | ℓ | radius of gyration of the machine, the weight of force against moment | m |
//!
//! The gain J(x) − J(x + Δ) = −2 Δᵀ W x − Δᵀ W Δ is linear in x, so its variance is 4 Δᵀ W V W Δ for every x. Δ was
//! computed from this x, with the unknowns adopted from the measurement. Their number is the number of degrees of
//! freedom of χ². By
//! Scheffé (1953), an interval valid for any such choice uses the root of the 95 % quantile of χ² instead of 1.96.

use nalgebra::{DMatrix, DVector};
use schemars::JsonSchema;
use serde::Serialize;

use super::adopted_parameters::AdoptedParameters;
use super::fit::Fit;
use super::machine_correction::MachineCorrection;
use super::rows::Regressor;
use stillbase_mechanics::machine::{Inertia, Machine};
use stillbase_settings::number::fixed_or_scientific;

/// Effect of a change over the measured motions.
#[derive(Clone, Copy, Debug, PartialEq, JsonSchema, Serialize)]
pub struct CorrectionBenefit {
    /// Root mean square force of imbalance before and after the change, N.
    pub force: [f64; 2],
    /// Root mean square moment of imbalance before and after the change, N m.
    pub moment: [f64; 2],
    /// Relative decrease of J; negative if J grows.
    pub gain: f64,
    /// Half width of the 95 % interval of the gain.
    pub half_width: f64,
}

impl CorrectionBenefit {
    /// Describes the effect in words.
    pub fn words(&self) -> String {
        let pair = |[from, to]: [f64; 2], unit: &str| {
            format!("from {} to {} {unit}", fixed_or_scientific(from, 4), fixed_or_scientific(to, 4))
        };
        let share = |x: f64| fixed_or_scientific(100.0 * x, 1);
        format!(
            "force {} rms and moment {}, the mean square of both by {} ± {} %",
            pair(self.force, "N"),
            pair(self.moment, "N m"),
            share(self.gain),
            share(self.half_width)
        )
    }

    /// Returns whether the interval of the gain lies above 0.
    pub fn helps(&self) -> bool {
        self.gain > self.half_width
    }
}

/// Computes the effect of a change.
pub fn correction_benefit(
    machine: &Machine,
    rows: &Regressor,
    fit: &Fit,
    taken: &AdoptedParameters,
    mended: &MachineCorrection,
) -> CorrectionBenefit {
    let count = fit.numbers.unknowns.of_balance();
    let inertia = Inertia::of(machine);
    let radius_squared = inertia.diagonals().iter().sum::<f64>() / inertia.mass();
    let mean = |of: usize| {
        let x = rows.channels[of].x.columns(0, count);
        x.tr_mul(&x) / rows.count() as f64
    };
    let (force, moment): (DMatrix<f64>, DMatrix<f64>) = (mean(0) + mean(1), mean(2));
    let by = DVector::from_iterator(count, mended.effects.iter().flat_map(|by| [by.re, by.im]));
    let now = fit.numbers.measured.rows(0, count).clone_owned();
    let then = &now + &by;
    let rms = |of: &DMatrix<f64>, x: &DVector<f64>| x.dot(&(of * x)).max(0.0).sqrt();
    let weight = &force * radius_squared + &moment;
    let all = now.dot(&(&weight * &now)).max(f64::MIN_POSITIVE);
    let pull = &weight * &by;
    let gain = -2.0 * pull.dot(&now) - pull.dot(&by);
    let covariance = fit.numbers.covariance.view((0, 0), (count, count));
    let deviation = 2.0 * pull.dot(&(covariance * &pull)).max(0.0).sqrt();
    let chosen = taken.measured.iter().filter(|measured| **measured).count().max(1) as f64;
    // Wilson and Hilferty (1931): the cube root of χ² is approximately normal.
    let part = 2.0 / (9.0 * chosen);
    let scheffe = (chosen * (1.0 - part + 1.645 * part.sqrt()).powi(3)).sqrt();
    CorrectionBenefit {
        force: [rms(&force, &now), rms(&force, &then)],
        moment: [rms(&moment, &now), rms(&moment, &then)],
        gain: gain / all,
        half_width: scheffe / 1.96 * fit.numbers.critical * deviation / all,
    }
}
