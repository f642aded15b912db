//! [`BalanceConstants`]: the constants in the balance conditions of a machine.

use schemars::JsonSchema;
use serde::Serialize;

use stillbase_mechanics::machine::Inertia;

/// Constants of the balance conditions. Complex coefficients are represented by their real parts; pairs have the order
/// (1,2), (1,3), (2,3) …
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct BalanceConstants {
    /// Coefficients g_k of the first moment, kg m.
    pub gamma_coefficients: Vec<f64>,
    /// Coupling coefficients C_kl, kg m².
    pub coupling_coefficients: Vec<f64>,
    /// Diagonal of the mass matrix, H_kk, kg m².
    pub h: Vec<f64>,
    /// D_k if all C_kl vanish, kg m²; equal to H_kk unless the machine has gears.
    pub d: Vec<f64>,
    /// Coefficients λ_k of the pose constant.
    pub lambda: Vec<f64>,
}

impl BalanceConstants {
    /// Returns the constants of a machine.
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
