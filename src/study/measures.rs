//! [`Measures`]: cost and benefit of balancing, by the measures of the literature.

use schemars::JsonSchema;
use serde::Serialize;

use stillbase_mechanics::dynamics::{ExternalLoads, inverse_with_wrench};
use stillbase_mechanics::machine::{Inertia, Machine};
use stillbase_mechanics::planar::{PerDrive, Vector};
use stillbase_planning::Motion;

/// Comparison of a machine with the bare machine, from which it was made.
#[derive(Clone, Copy, Debug, PartialEq, JsonSchema, Serialize)]
pub struct Measures {
    /// M − M_bare, kg.
    pub added_mass: f64,
    /// Σ D_k less Σ D_k of the bare machine, kg m². Both are for zero C_kl, so the value does not depend on the pose.
    pub added_inertia: f64,
    /// M/M_bare + Σ D_k/Σ D_k of the bare machine; 2 if nothing was added. `None` if Σ D_k of the bare machine is not
    /// above 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mass_inertia_factor: Option<f64>,
    /// Ratios of base reactions and torques, if a motion is given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub beta: Option<Beta>,
}

/// Ratios of root mean squares over time to those of the bare machine, in the same motion of the drives. 0 if nothing
/// remains, 1 if nothing changes; `None` if the bare machine's value is zero.
#[derive(Clone, Copy, Debug, PartialEq, JsonSchema, Serialize)]
pub struct Beta {
    /// Ratio of the dynamic |f_B|.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub force: Option<f64>,
    /// Ratio of n_B on a fixed base, weight included.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub moment: Option<f64>,
    /// Ratio of the torques of all motors, weight included.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub torque: Option<f64>,
}

/// Number of instants at which a motion is sampled.
const SAMPLES: usize = 2000;

/// Root mean squares up to this, in N or N m, are treated as zero.
const ZERO_BELOW: f64 = 1e-12;

impl Measures {
    /// Compares a machine with the bare one. The motion must have as many drives as both.
    pub fn of(bare: &Machine, machine: &Machine, motion: Option<&Motion>) -> Self {
        let (before, after) = (Inertia::of(bare), Inertia::of(machine));
        Self {
            beta: motion.map(|motion| beta(bare.gravity(), [&before, &after], motion)),
            ..Self::between([&before, &after].map(|inertia| [inertia.mass(), inertia.total_momentum()]))
        }
    }

    /// Compares mass, kg, and Σ D_k, kg m², before and after.
    pub fn between([[light, was], [heavy, is]]: [[f64; 2]; 2]) -> Self {
        Self {
            added_mass: heavy - light,
            added_inertia: is - was,
            mass_inertia_factor: (was > 0.0).then(|| heavy / light + is / was),
            beta: None,
        }
    }
}

fn beta(gravity: Vector, [bare, machine]: [&Inertia; 2], motion: &Motion) -> Beta {
    let around = ExternalLoads { gravity, force: Vector::default() };
    let squares = |inertia: &Inertia| {
        let mut sum = [0.0; 3];
        for r in instants(motion) {
            let (torque, wrench) = inverse_with_wrench(inertia, &r.q.units(), &r.qd, &r.qdd, &around);
            let torque = inertia.motors().motor_torques(&torque);
            sum[0] += wrench.dynamic.force.norm_sqr();
            sum[1] += wrench.total().moment.powi(2);
            sum[2] += torque.iter().map(|x| x * x).sum::<f64>();
        }
        sum.map(|sum| (sum / SAMPLES as f64).sqrt())
    };
    let (was, is) = (squares(bare), squares(machine));
    let [force, moment, torque] = [0, 1, 2].map(|i| (was[i] > ZERO_BELOW).then(|| is[i] / was[i]));
    Beta { force, moment, torque }
}

/// Samples a motion at the middle of equal time intervals, to avoid sampling exactly at jumps of the acceleration.
pub(super) fn instants(motion: &Motion) -> impl Iterator<Item = stillbase_planning::Reference> {
    let dt = motion.duration() / SAMPLES as f64;
    (0..SAMPLES).map(move |i| motion.at((i as f64 + 0.5) * dt))
}

/// Returns the largest |q̈_k| of a motion, rad/s².
pub fn greatest_accelerations(motion: &Motion) -> PerDrive {
    let mut most = PerDrive::zeros(motion.at(0.0).q.len());
    for r in instants(motion) {
        most.iter_mut().zip(r.qdd.iter()).for_each(|(most, x)| *most = most.max(x.abs()));
    }
    most
}
