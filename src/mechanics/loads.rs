//! [`Loads`]: loads on drives and base in a state of motion.

use schemars::JsonSchema;
use serde::Serialize;

use super::dynamics::{ExternalLoads, angular_momentum, centre_of_mass, inverse_with_wrench, mass_matrix};
use super::machine::Inertia;
use super::planar::{DriveAngles, PerDrive};

/// Loads on drives and base in a state of motion, Eqs (1) to (6).
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct Loads {
    /// Mass matrix H_kl, kg m².
    pub mass_matrix: Vec<Vec<f64>>,
    /// Torque of each motor, N m.
    pub torque: Vec<f64>,
    /// Force f_B that the manipulator exerts on its base, weight included, N.
    pub base_force: [f64; 2],
    /// Moment n_B about B that the manipulator exerts on its base, weight included, counter-clockwise, N m.
    pub base_moment: f64,
    /// Centre of mass relative to B, m.
    pub com: [f64; 2],
    /// Angular momentum about B, kg m²/s.
    pub angular_momentum_about_base: f64,
}

impl Loads {
    /// Computes the loads of a machine with drive angles q, rad, rates q̇, rad/s, and accelerations q̈, rad/s².
    pub fn of(inertia: &Inertia, around: &ExternalLoads, q: &PerDrive, qd: &PerDrive, qdd: &PerDrive) -> Self {
        let e = DriveAngles(*q).units();
        let (h, _) = mass_matrix(inertia, &e, qd);
        let (torque, wrench) = inverse_with_wrench(inertia, &e, qd, qdd, around);
        let (total, com) = (wrench.total(), centre_of_mass(inertia, &e));
        let n = inertia.drives();
        Self {
            mass_matrix: (0..n).map(|k| (0..n).map(|l| h.get(k, l)).collect()).collect(),
            torque: inertia.motors().motor_torques(&torque).to_vec(),
            base_force: [total.force.re, total.force.im],
            base_moment: total.moment,
            com: [com.re, com.im],
            angular_momentum_about_base: angular_momentum(inertia, &e, qd),
        }
    }
}
