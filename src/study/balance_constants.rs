//! [`BalanceConstants`]: the constants of balance of a machine.

use serde::Serialize;

use crate::mechanics::machine::Inertia;

/// The constants of balance. Coefficients are real parts; pairs in the order (1,2), (1,3), (2,3) …
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BalanceConstants {
    /// g_k, kg m.
    pub gamma_coefficients: Vec<f64>,
    /// C_kl, kg m².
    pub coupling_coefficients: Vec<f64>,
    /// H_kk, kg m².
    pub h: Vec<f64>,
    /// D_k where all C_kl vanish, kg m²; gears make it another than H_kk.
    pub d: Vec<f64>,
    /// λ_k.
    pub lambda: Vec<f64>,
}

impl BalanceConstants {
    /// Of a machine.
    pub fn of(inertia: &Inertia) -> Self {
        let n = inertia.drives();
        Self {
            gamma_coefficients: (0..n).map(|k| inertia.first_moment(k).re).collect(),
            coupling_coefficients: Inertia::pairs(n).map(|(k, l)| inertia.coupling(k, l).re).collect(),
            h: inertia.diagonals().to_vec(),
            d: inertia.momenta().to_vec(),
            lambda: inertia.lambda().to_vec(),
        }
    }
}
