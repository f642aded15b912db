//! Measures of how a pose transmits motion and force, from its Jacobians in closed form.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | j_k | ∂p/∂q_k = i c_k e^{i q_k}: the columns of the 2×3 Jacobian J in absolute drive angles | m |
//! | σ_1 ≥ σ_2 | singular values of J | m |

use super::plane::PlaneMap;
use stillbase_mechanics::planar::{UnitVectors, Vector, cross};

/// Three measures of a pose, independent of b.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Dexterity {
    /// |det ∂(x, y)/∂(a_1, a_2)| at constant b: the ratio of areas in the workspace and in (a_1, a_2), 0 on a fold, m².
    pub det: f64,
    /// √det(J Jᵀ) = σ_1 σ_2 = √(Σ_{k<l} (j_k × j_l)²), with b free: 0 if all arms are in line, m².
    pub manipulability: f64,
    /// σ_1 = √(½ (Σ|j_k|² + |Σ j_k²|)), j_k as complex numbers: the greatest |τ| = |Jᵀ F| over all unit forces F at the
    /// end effector, N m/N.
    pub worst_torque_per_force: f64,
}

impl PlaneMap {
    /// Returns the dexterity of a pose.
    pub fn dexterity(&self, a: [f64; 2]) -> Dexterity {
        self.dexterity_of(self.arms(a))
    }

    /// Returns the dexterity from the unit vectors e(q_k) of the drives: a common turn has no effect.
    pub fn dexterity_at(&self, e: &UnitVectors) -> Dexterity {
        self.dexterity_of([0, 1, 2].map(|k| self.c()[k] * e[k]))
    }

    fn dexterity_of(&self, arms: [Vector; 3]) -> Dexterity {
        let [first, second] = self.columns(&arms);
        // Computed with arms, not j_k: a common quarter turn changes none of these measures.
        let pair = |k: usize, l: usize| cross(arms[k], arms[l]).powi(2);
        let squares: Vector = arms.iter().map(|j| j * j).sum();
        let lengths: f64 = arms.iter().map(|j| j.norm_sqr()).sum();
        Dexterity {
            det: cross(first, second).abs(),
            manipulability: (pair(0, 1) + pair(1, 2) + pair(0, 2)).sqrt(),
            worst_torque_per_force: (0.5 * (lengths + squares.norm())).sqrt(),
        }
    }
}
