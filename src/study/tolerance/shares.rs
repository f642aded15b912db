//! Sensitivity to each tolerance: exact derivatives of the wrench, and each parameter's share of the variance.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | σ_p | standard deviation of parameter p | unit of p |
//! | ∂n_B/∂p | at the nominal machine, exact | N m per unit of p |
//! | s_p | ∫(∂n_B/∂p σ_p)² dt / Σ_r ∫(∂n_B/∂r σ_r)² dt; for f_B with \|∂f_B/∂p\| | 1 |

use schemars::JsonSchema;
use serde::Serialize;

use super::ensemble::Ensemble;

/// First-order contribution of one parameter.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct Share {
    /// Key of the setting.
    pub key: String,
    /// Unit of the parameter.
    pub unit: &'static str,
    /// Standard deviation σ_p.
    pub deviation: f64,
    /// max_t |∂n_B/∂p|, N m per unit of the parameter.
    pub moment_slope: f64,
    /// max_t |∂f_B/∂p|, N per unit of the parameter.
    pub force_slope: f64,
    /// Fraction of the variance of n_B over the motion, 0 to 1.
    pub moment_share: f64,
    /// Fraction of the variance of f_B over the motion, 0 to 1.
    pub force_share: f64,
}

/// First-order contributions of all parameters.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct Shares {
    /// Contributions, in the order of the parameters.
    pub parameters: Vec<Share>,
    /// Ratio of first-order to exact variance of n_B over the motion: 1 if the wrench is linear in the parameters.
    pub moment_first_order: f64,
    /// Ratio of first-order to exact variance of f_B over the motion.
    pub force_first_order: f64,
}

impl Shares {
    /// Computes the contributions in an ensemble.
    pub fn of(ensemble: &Ensemble) -> Self {
        let parameters = ensemble.parameters();
        let (mut slopes, mut sums) = (vec![[0.0_f64; 2]; parameters.len()], vec![[0.0; 2]; parameters.len()]);
        let mut exact = [0.0; 2];
        for s in 0..ensemble.time().len() {
            let weight = f64::from(u8::from(ensemble.between().contains(&s)));
            let [n, x, y] = ensemble.slopes_at(s);
            for p in 0..parameters.len() {
                let [n, f] = [n[p] * n[p], x[p] * x[p] + y[p] * y[p]];
                slopes[p] = [slopes[p][0].max(n), slopes[p][1].max(f)];
                let variance = weight * parameters[p].deviation.powi(2);
                sums[p] = [sums[p][0] + n * variance, sums[p][1] + f * variance];
            }
            let [n, x, y] = ensemble.variance_at(s);
            exact = [exact[0] + weight * n, exact[1] + weight * (x + y)];
        }
        let total = [0, 1].map(|i| sums.iter().map(|sum| sum[i]).sum::<f64>());
        let part = |x: f64, of: f64| if of > 0.0 { x / of } else { 0.0 };
        let share = |(p, parameter): (usize, &super::UncertainParameter)| Share {
            key: parameter.key.clone(),
            unit: parameter.unit,
            deviation: parameter.deviation,
            moment_slope: slopes[p][0].sqrt(),
            force_slope: slopes[p][1].sqrt(),
            moment_share: part(sums[p][0], total[0]),
            force_share: part(sums[p][1], total[1]),
        };
        Self {
            parameters: parameters.iter().enumerate().map(share).collect(),
            moment_first_order: part(total[0], exact[0]),
            force_first_order: part(total[1], exact[1]),
        }
    }
}
