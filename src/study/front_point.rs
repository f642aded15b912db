//! [`FrontPoint`]: what a machine of the front comes to beside its mass and inertia.

use serde::Serialize;

use crate::mechanics::counterweights::{Placed, Tolerance, off_by};
use crate::mechanics::dynamics::{Surroundings, inverse_with_wrench};
use crate::mechanics::machine::{Inertia, Machine};
use crate::mechanics::planar::Vector;
use crate::planning::Motion;
use crate::planning::pose_space::plane_area;

use super::measures::instants;

/// A machine of the front, in numbers.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FrontPoint {
    /// kg.
    pub added_mass: f64,
    /// Σ D_k, kg m².
    pub inertia: f64,
    /// The greatest |torque| of a motor in a motion, weight included, N m; none without a motion.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub torque: Option<f64>,
    /// Area of the reactionless workspace, m²; none without a b that three drives hold.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub workspace: Option<f64>,
    /// The greatest |g_k| if every counterweight is as far off as is usual ([`Tolerance::USUAL`]), kg m.
    pub off_by: f64,
}

/// What the machines of a front may be told apart by beside mass and inertia.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrontMeasure {
    /// The greatest torque of the motion.
    Torque,
    /// The area of the reactionless workspace.
    Workspace,
    /// The greatest |g_k| with counterweights that are a little off.
    OffBy,
}

impl FrontMeasure {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Torque, Self::Workspace, Self::OffBy];

    /// In words, and its unit.
    pub const fn words(self) -> [&'static str; 2] {
        match self {
            Self::Torque => ["greatest torque", "N m"],
            Self::Workspace => ["workspace", "m²"],
            Self::OffBy => ["left if 1 % and 0.5 mm off", "kg m"],
        }
    }

    /// Of each machine of a front; none where a machine has none. A motion is one of as many drives.
    pub fn of(self, placed: &Placed, motion: Option<&Motion>) -> Option<f64> {
        let point = FrontPoint::of(placed, motion.filter(|_| self == Self::Torque), self == Self::Workspace);
        match self {
            Self::Torque => point.torque,
            Self::Workspace => point.workspace,
            Self::OffBy => Some(point.off_by),
        }
    }
}

impl FrontPoint {
    /// Added mass, kg, and Σ D_k, kg m².
    pub fn measures(&self) -> [f64; 2] {
        [self.added_mass, self.inertia]
    }

    /// Of a machine of the front; a motion is one of as many drives. The workspace is found if it is asked for: it takes
    /// longer than all else.
    pub fn of(placed: &Placed, motion: Option<&Motion>, workspace: bool) -> Self {
        let machine = &placed.machine;
        Self {
            added_mass: placed.added_mass,
            inertia: Inertia::of(machine).total_momentum(),
            torque: motion.map(|motion| greatest_torque(machine, motion)),
            workspace: workspace.then(|| plane_area(machine)).flatten(),
            off_by: off_by(machine, &Tolerance::USUAL).force,
        }
    }
}

/// Of all motors, N m.
fn greatest_torque(machine: &Machine, motion: &Motion) -> f64 {
    let inertia = Inertia::of(machine);
    let around = Surroundings { gravity: machine.gravity(), force: Vector::default() };
    let at = |r: crate::planning::Reference| {
        let (torque, _) = inverse_with_wrench(&inertia, &r.q.units(), &r.qd, &r.qdd, &around);
        inertia.motors().torques(&torque).iter().fold(0.0_f64, |most, x| most.max(x.abs()))
    };
    instants(motion).map(at).fold(0.0, f64::max)
}
