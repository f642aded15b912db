//! [`Measures`]: what balance has cost and what it has brought, as the literature compares designs.

use serde::Serialize;

use crate::mechanics::dynamics::{Surroundings, inverse_with_wrench};
use crate::mechanics::machine::{Inertia, Machine};
use crate::mechanics::planar::{PerDrive, Vector};
use crate::planning::Motion;

/// A machine beside the one that it was made from, which is called bare here.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Measures {
    /// M − M_bare, kg.
    pub added_mass: f64,
    /// Σ D_k − Σ D_k of the bare machine, kg m²; of both as if all C_kl vanished, so that no pose is preferred.
    pub added_inertia: f64,
    /// M/M_bare + Σ D_k/Σ D_k of the bare machine: 2 where nothing has been added. Both weigh the same. None where the
    /// bare machine has no Σ D_k above 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mass_inertia_factor: Option<f64>,
    /// What is left of what shakes and drives, if a motion is given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub beta: Option<Beta>,
}

/// What is left of what the bare machine does in the same motion of its drives: the ratio of root mean squares over its
/// time, 0 for nothing and 1 for as much. None where the bare machine has nothing.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Beta {
    /// Of the dynamic |f_B|.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub force: Option<f64>,
    /// Of n_B on a fixed base, weight included.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub moment: Option<f64>,
    /// Of the torques of all motors, weight included.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub torque: Option<f64>,
}

/// Instants at which a motion is looked at.
const INSTANTS: usize = 2000;

/// Rounding's part of a root mean square.
const NOTHING: f64 = 1e-12;

impl Measures {
    /// Of a machine beside the bare one; a motion is one of as many drives.
    pub fn of(bare: &Machine, machine: &Machine, motion: Option<&Motion>) -> Self {
        let (before, after) = (Inertia::of(bare), Inertia::of(machine));
        let [was, is] = [&before, &after].map(|inertia| inertia.total_momentum());
        let (light, heavy) = (before.mass(), after.mass());
        Self {
            added_mass: heavy - light,
            added_inertia: is - was,
            mass_inertia_factor: (was > 0.0).then(|| heavy / light + is / was),
            beta: motion.map(|motion| beta(bare.gravity(), [&before, &after], motion)),
        }
    }
}

fn beta(gravity: Vector, [bare, machine]: [&Inertia; 2], motion: &Motion) -> Beta {
    let around = Surroundings { gravity, force: Vector::default() };
    let squares = |inertia: &Inertia| {
        let mut sum = [0.0; 3];
        for r in instants(motion) {
            let (torque, wrench) = inverse_with_wrench(inertia, &r.q.units(), &r.qd, &r.qdd, &around);
            let torque = inertia.motors().torques(&torque);
            sum[0] += wrench.dynamic.force.norm_sqr();
            sum[1] += wrench.total().moment.powi(2);
            sum[2] += torque.iter().map(|x| x * x).sum::<f64>();
        }
        sum.map(|sum| (sum / INSTANTS as f64).sqrt())
    };
    let (was, is) = (squares(bare), squares(machine));
    let [force, moment, torque] = [0, 1, 2].map(|i| (was[i] > NOTHING).then(|| is[i] / was[i]));
    Beta { force, moment, torque }
}

/// Between the instants, so that no step of the acceleration is looked at from the wrong side.
pub(super) fn instants(motion: &Motion) -> impl Iterator<Item = crate::planning::Reference> {
    let dt = motion.duration() / INSTANTS as f64;
    (0..INSTANTS).map(move |i| motion.at((i as f64 + 0.5) * dt))
}

/// Greatest |q̈_k| of a motion, rad/s².
pub fn greatest_accelerations(motion: &Motion) -> PerDrive {
    let mut most = PerDrive::zeros(motion.at(0.0).q.len());
    for r in instants(motion) {
        most.iter_mut().zip(r.qdd.iter()).for_each(|(most, x)| *most = most.max(x.abs()));
    }
    most
}
