//! A [`Frame`]: all quantities of a run at one instant. Plots, scene and recording only read it and compute nothing.

use serde::{Deserialize, Serialize};

use super::audit::AuditFigure;
use crate::plant::WheelState;
use nalgebra::Vector3;
use stillbase_mechanics::assembly::{Attitude, SpatialLoads};
use stillbase_mechanics::dynamics::BaseWrench;
use stillbase_mechanics::joint_forces::InternalLoads;
use stillbase_mechanics::machine::Payload;
use stillbase_mechanics::planar::{DriveAngles, PerDrive, Pose2, Vector};

pub use crate::audit::Audit;
pub use crate::peaks::{Peaks, REACTIONLESS_SHARE};
pub use crate::totals::Totals;
pub use stillbase_planning::following::follow::Target;
pub use stillbase_planning::pose_space::Reach;
pub use stillbase_planning::reactionless::Dexterity;

/// One instant of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Number of steps since the start.
    pub step: u64,
    /// Time since the start, s.
    pub time: f64,
    /// Drive angles q, absolute, rad.
    pub q: DriveAngles,
    /// Drive rates q̇, absolute, rad/s.
    pub qd: PerDrive,
    /// Drive accelerations q̈, absolute, rad/s².
    pub qdd: PerDrive,
    /// Motor torques τ, N m.
    pub torque: PerDrive,
    /// Friction torques in the bearings, N m, positive if they oppose a positive rate: n_B = −Σ (τ_k − friction_k).
    pub friction: PerDrive,
    /// Reference of the drive angles relative to the base, rad.
    pub q_reference: DriveAngles,
    /// Pose constant b = Σ λ_k (q_k − θ) of the model, rad, (13).
    pub b: f64,
    /// Reference of b, rad.
    pub b_reference: f64,
    /// Relative joint angles a_1, a_2 …, rad, in the machine's order.
    pub a: PerDrive,
    /// Pose of the base: position p_B of B, m, and angle θ, rad. A fixed base stays at the origin.
    pub base: Pose2,
    /// Whether the base floats and turns whenever b changes: it is free, and has no wheel.
    pub floats: bool,
    /// Velocity ṗ_B of B, m/s.
    pub base_velocity: Vector,
    /// Rate θ̇ of the base, rad/s.
    pub base_rate: f64,
    /// Angular acceleration θ̈ of the base, rad/s².
    pub base_angular_acceleration: f64,
    /// Wrench of the manipulator on its base.
    pub wrench: BaseWrench,
    /// Moment that turns the base, N m, positive counter-clockwise: n_B less the torque of a reaction wheel. On a free base
    /// it is about the base's own centre of mass, so that the force at the pin counts too.
    pub felt_moment: f64,
    /// State of a reaction wheel in the base.
    pub wheel: WheelState,
    /// Linear momentum of all moving parts, including a moving base, kg m/s.
    pub momentum: Vector,
    /// Angular momentum of all moving parts except the wheel, kg m²/s, about the origin, which is the position of B at
    /// the start.
    pub angular_momentum: f64,
    /// Centre of mass of manipulator and payload, m.
    pub com: Vector,
    /// Position of the end effector, m.
    pub end_effector: Vector,
    /// Target of the end effector. That of a plan is in the axes of the base at the start, which stand still.
    pub target: Target,
    /// Whether the target moves with the base: a hand leads the machine, and its base [floats](Self::floats).
    pub target_rides: bool,
    /// Whether the plan accounts for the motion of the base, so that its places are those in space.
    pub base_is_planned: bool,
    /// Whether the payload that the model lacks is held.
    pub loaded: bool,
    /// Kinetic energy, J.
    pub kinetic: f64,
    /// Dexterity of the end effector on the plane; zero on machines without planes.
    pub dexterity: Dexterity,
    /// min |sin(q_k − q_l)|: 0 at a change point, where pin forces grow without bound.
    pub transmission: f64,
    /// Pin forces and tilting moment of the base.
    pub inside: InternalLoads,
    /// Phase of the run.
    pub phase: Phase,
    /// Peaks so far.
    pub peaks: Peaks,
    /// Time integrals and extremes so far.
    pub totals: Totals,
    /// Figures that should be zero.
    pub audit: Audit,
    /// The base that the machine shares with others, if it is a block of an assembly.
    pub shared: Option<SharedBase>,
}

/// The base that several machines share, in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SharedBase {
    /// What all machines put on their base, about its origin and in its axes, as it moves.
    pub loads: SpatialLoads,
    /// Attitude of the base; level if it is fixed.
    pub attitude: Attitude,
    /// Origin of the base in space, m.
    pub origin: Vector3<f64>,
    /// Rate of the base in its axes, rad/s.
    pub rate: Vector3<f64>,
    /// Whether the base can move.
    pub moves: bool,
    /// Peaks so far of the parts of force, N, and moment, N m, from motion.
    pub peaks: [f64; 6],
    /// Peak so far of Σ|τ|, N m, and of Σ m |a|, N, of all machines.
    pub scale: [f64; 2],
    /// Largest turn of the base so far, and its turn now, rad.
    pub turn: [f64; 2],
    /// Largest distance so far of the base from where it was, m.
    pub shift: f64,
    /// End effector of the machine in space, m.
    pub tip: Vector3<f64>,
    /// What it holds.
    pub held: Payload,
}

impl SharedBase {
    /// Returns for each component of force and moment whether its peak so far counts as zero.
    pub fn silent(&self) -> [bool; 6] {
        silent(&self.peaks, &self.scale)
    }

    /// Returns whether all six components are zero now.
    pub fn is_unloaded(&self) -> bool {
        let now = self.loads.motion.components();
        now.iter().enumerate().all(|(i, x)| x.abs() <= no_load(&self.scale, i).max(1e-15))
    }
}

/// Returns for each component of force, N, and moment, N m, whether its peak counts as zero beside the peaks of Σ|τ|, N m,
/// and Σ m |a|, N.
pub fn silent(peaks: &[f64; 6], scale: &[f64; 2]) -> [bool; 6] {
    std::array::from_fn(|i| peaks[i] <= no_load(scale, i))
}

/// Returns the largest component that counts as zero, N or N m.
fn no_load(scale: &[f64; 2], component: usize) -> f64 {
    REACTIONLESS_SHARE * scale[usize::from(component < 3)]
}

/// Phase of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Phase {
    /// On its planned motion.
    Motion,
    /// Following the pointer or the slider.
    Follow,
    /// At rest.
    Rest,
}

impl Phase {
    /// Returns the name in one word.
    pub fn name(self) -> &'static str {
        match self {
            Self::Motion => "motion",
            Self::Follow => "follow",
            Self::Rest => "rest",
        }
    }
}

impl Frame {
    /// Returns the first figure of the audit that exceeds its tolerance.
    pub fn first_violation(&self) -> Option<AuditFigure> {
        self.audit.figures(&self.peaks, &self.totals).into_iter().find(|figure| !figure.is_within_tolerance())
    }

    /// Returns whether angles, rates and torques are finite, which fails when a run diverges.
    pub fn is_finite(&self) -> bool {
        self.q.iter().chain(self.qd.iter()).chain(self.torque.iter()).all(|x| x.is_finite())
    }

    /// Returns n_B, N m, positive counter-clockwise.
    pub fn base_moment(&self) -> f64 {
        self.wrench.total().moment
    }

    /// Converts a point to the axes of the base, m.
    pub fn in_base(&self, point: Vector) -> Vector {
        self.base.seen(point)
    }

    /// Converts a point in the axes of the base, m, to one in space.
    pub fn in_space(&self, point: Vector) -> Vector {
        self.base.place(point)
    }

    /// Returns the target in the axes in which the machine is planned and led, m.
    pub fn target_in_base(&self) -> Vector {
        if self.target_rides { self.in_base(self.target.at) } else { self.target.at }
    }

    /// Returns the angle of a drive relative to the base, q_k − θ, rad.
    pub fn relative(&self, k: usize) -> f64 {
        self.q[k] - self.base.angle
    }

    /// Returns whether the base has felt nothing so far: of the machine or, in an assembly, of all blocks together.
    pub fn was_reactionless(&self) -> bool {
        self.shared.map_or(self.peaks.is_reactionless(), |shared| shared.silent() == [true; 6])
    }

    /// Returns whether the moment that the base feels is zero now, relative to the run's peaks.
    pub fn turns_no_base(&self) -> bool {
        self.felt_moment.abs() <= self.peaks.no_moment().max(1e-15)
    }

    /// Returns whether the moment and force that the base feels are zero now, relative to the run's peaks.
    pub fn is_base_unloaded(&self) -> bool {
        match &self.shared {
            Some(shared) => shared.is_unloaded(),
            None => self.turns_no_base() && self.wrench.dynamic.force.norm() <= self.peaks.no_force().max(1e-15),
        }
    }
}
