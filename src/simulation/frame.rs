//! A [`Frame`]: everything that is true at one instant. Plots, scene and recording read it and compute nothing.

use serde::{Deserialize, Serialize};

use super::audit::AuditFigure;
use crate::mechanics::dynamics::BaseWrench;
use crate::mechanics::joint_forces::Inside;
use crate::mechanics::planar::{DriveAngles, PerDrive, Pose2, Vector, unit};
use crate::simulation::plant::WheelState;

pub use crate::planning::following::follow::Target;
pub use crate::planning::pose_space::Reach;
pub use crate::planning::reactionless::Dexterity;
pub use crate::simulation::audit::Audit;
pub use crate::simulation::peaks::{Peaks, REACTIONLESS};
pub use crate::simulation::totals::Totals;

/// One instant of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Steps since the start.
    pub step: u64,
    /// Time since the start, s.
    pub time: f64,
    /// Drive angles q, absolute, rad.
    pub q: DriveAngles,
    /// q̇, rad/s.
    pub qd: PerDrive,
    /// q̈, rad/s².
    pub qdd: PerDrive,
    /// Motor torques τ, N m.
    pub torque: PerDrive,
    /// Friction of the bearings against them, N m: n_B = −Σ (τ_k − friction_k).
    pub friction: PerDrive,
    /// Drive angles relative to the base that control aims at, rad.
    pub q_reference: DriveAngles,
    /// Pose constant b = Σ λ_k (q_k − θ) of the model, rad, (13).
    pub b: f64,
    /// b that control aims at, rad.
    pub b_reference: f64,
    /// Relative joint angles a_1, a_2 …, rad, in the machine's order.
    pub a: PerDrive,
    /// Pose of the base, p_B and θ; a fixed base stays at the origin.
    pub base: Pose2,
    /// ṗ_B, m/s.
    pub base_velocity: Vector,
    /// θ̇, rad/s.
    pub base_rate: f64,
    /// What the manipulator transmits to its base.
    pub wrench: BaseWrench,
    /// What a reaction wheel in the base does.
    pub wheel: WheelState,
    /// Linear momentum of all that moves, the base too if it does, kg m/s.
    pub momentum: Vector,
    /// Its angular momentum about the origin, where B is at the start, kg m²/s; without the wheel.
    pub angular_momentum: f64,
    /// Centre of mass of manipulator and payload, m.
    pub com: Vector,
    /// End effector, m.
    pub end_effector: Vector,
    /// What the end effector is sent to, in the axes of the base at the start.
    pub target: Target,
    /// Whether the payload that the model lacks is held.
    pub loaded: bool,
    /// Kinetic energy, J.
    pub kinetic: f64,
    /// How well the end effector moves on the plane; zero on machines that have none.
    pub dexterity: Dexterity,
    /// min |sin(q_k − q_l)|: 0 at a change point, where pin forces grow without bound.
    pub transmission: f64,
    /// What the pins carry, and what tilts the base.
    pub inside: Inside,
    /// What the run is doing.
    pub phase: Phase,
    /// The largest values so far.
    pub peaks: Peaks,
    /// Sums so far.
    pub totals: Totals,
    /// What should be zero.
    pub audit: Audit,
}

/// What the run is doing.
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
    /// Its name in one word.
    pub fn name(self) -> &'static str {
        match self {
            Self::Motion => "motion",
            Self::Follow => "follow",
            Self::Rest => "rest",
        }
    }
}

impl Frame {
    /// The first figure of the audit that is not where it should be.
    pub fn fault(&self) -> Option<AuditFigure> {
        self.audit.figures(&self.peaks, &self.totals).into_iter().find(|figure| !figure.is_good())
    }

    /// Whether the machine is anywhere at all: a run that has blown up is not.
    pub fn is_finite(&self) -> bool {
        self.q.iter().chain(self.qd.iter()).chain(self.torque.iter()).all(|x| x.is_finite())
    }

    /// n_B, N m, positive counter-clockwise.
    pub fn base_moment(&self) -> f64 {
        self.wrench.total().moment
    }

    /// n_B less what a reaction wheel takes up, N m: what the base feels.
    pub fn felt_moment(&self) -> f64 {
        self.base_moment() - self.wheel.torque
    }

    /// A point as seen from the base, m: where it would be, had the base not moved.
    pub fn in_base(&self, point: Vector) -> Vector {
        (point - self.base.at) * unit(-self.base.angle)
    }

    /// Angle of a drive relative to the base, q_k − θ, rad.
    pub fn relative(&self, k: usize) -> f64 {
        self.q[k] - self.base.angle
    }

    /// Whether the base feels nothing at this instant, by the measure of the run's peaks.
    pub fn base_feels_nothing(&self) -> bool {
        self.felt_moment().abs() <= self.peaks.no_moment().max(1e-15)
            && self.wrench.dynamic.force.norm() <= self.peaks.no_force().max(1e-15)
    }
}
