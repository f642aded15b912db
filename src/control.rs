//! Computed-torque control: τ = Ĥ (q̈_r + K_d ė + K_p e) + V̂ − γ̂ᵀ g, with the constants of the *model*.
//!
//! With equal gains on all drives the errors of an exact model obey Σ D_k e_k = const · decay, so they stay on the
//! plane and transmit nothing.

use serde::{Deserialize, Serialize};

use crate::dynamics::{Surroundings, inverse};
use crate::machine::Inertia;
use crate::plan::Reference;
use crate::planar::{DriveAngles, PerDrive, Units};

/// Feedback gains, equal on all drives.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Gains {
    /// K_p, s⁻².
    pub kp: f64,
    /// K_d, s⁻¹.
    pub kd: f64,
}

impl Default for Gains {
    fn default() -> Self {
        Self { kp: 400.0, kd: 40.0 }
    }
}

/// Motor torques, N m, that would make the model follow the reference.
#[inline]
pub fn computed_torque(
    model: &Inertia,
    gains: Gains,
    reference: &Reference,
    q: &DriveAngles,
    e: &Units,
    qd: &PerDrive,
    around: &Surroundings,
) -> PerDrive {
    let (rate_error, error) = (reference.qd.minus(qd), reference.q.0.minus(&q.0));
    let commanded = reference.qdd.plus(gains.kd, &rate_error).plus(gains.kp, &error);
    inverse(model, e, qd, &commanded, around)
}
