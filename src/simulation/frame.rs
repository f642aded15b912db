//! A [`Frame`]: everything that is true at one instant. Plots, scene and recording read it and compute nothing.

use serde::{Deserialize, Serialize};

use crate::mechanics::dynamics::BaseWrench;
use crate::mechanics::joint_forces::Inside;
use crate::mechanics::planar::{DriveAngles, PerDrive, Pose2, Vector, unit};
use crate::simulation::plant::Spin;

pub use crate::planning::following::follow::Target;
pub use crate::planning::pose_constant::Reach;
pub use crate::planning::reactionless::Dexterity;
pub use crate::simulation::audit::Audit;
pub use crate::simulation::tally::Tally;

/// Peaks below this part of what moves count as zero.
pub const REACTIONLESS: f64 = 1e-6;

/// What rounding leaves of weight that is not carried, as in free fall; of moments, for each metre.
const ROUNDING: f64 = 1e-12;

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
    pub wheel: Spin,
    /// Linear momentum of all that moves, the base too if it does, kg m/s.
    pub momentum: Vector,
    /// Its angular momentum about the origin, where B is at the start, kg m²/s; without the wheel.
    pub angular_momentum: f64,
    /// Centre of mass of manipulator and payload, m.
    pub com: Vector,
    /// End effector, m.
    pub tip: Vector,
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
    pub tally: Tally,
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
    /// One word.
    pub fn name(self) -> &'static str {
        match self {
            Self::Motion => "motion",
            Self::Follow => "follow",
            Self::Rest => "rest",
        }
    }
}

/// Largest values over a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peaks {
    /// |τ_k|, N m.
    pub torque: PerDrive,
    /// Σ_k |τ_k|, N m.
    pub torque_sum: f64,
    /// Dynamic |f_B|, N.
    pub force: f64,
    /// |n_B|, what the arm transmits, N m.
    pub arm_moment: f64,
    /// The moment on the base past a reaction wheel, |n_B − τ_w|, N m; without one, |n_B|.
    pub moment: f64,
    /// Σ_j m_j |a_cj|, N: the force that the links would transmit if nothing cancelled.
    pub inertial_pull: f64,
    /// Force of weight and of what is held against the end effector, N: rounding is a part of it.
    pub weight: f64,
    /// |q̇_k − θ̇| of any drive, rad/s.
    pub rate: f64,
    /// The moment that tilts the base, from heights along the axis, N m.
    pub tilt: f64,
    /// By how much a relative joint angle has passed a limit, rad, and which, in the machine's order.
    pub past_limit: (f64, usize),
}

impl Peaks {
    /// Nothing yet.
    pub fn zero(drives: usize) -> Self {
        Self {
            torque: PerDrive::zeros(drives),
            torque_sum: 0.0,
            force: 0.0,
            arm_moment: 0.0,
            moment: 0.0,
            inertial_pull: 0.0,
            weight: 0.0,
            rate: 0.0,
            tilt: 0.0,
            past_limit: (0.0, 0),
        }
    }

    /// Takes in one more instant, given as peaks of its own.
    pub(crate) fn include(&mut self, now: &Self) {
        for (peak, t) in self.torque.iter_mut().zip(now.torque.iter()) {
            *peak = worse(*peak, t.abs());
        }
        self.torque_sum = worse(self.torque_sum, now.torque_sum);
        self.force = worse(self.force, now.force);
        self.arm_moment = worse(self.arm_moment, now.arm_moment);
        self.moment = worse(self.moment, now.moment);
        self.inertial_pull = worse(self.inertial_pull, now.inertial_pull);
        self.weight = worse(self.weight, now.weight);
        self.rate = worse(self.rate, now.rate);
        self.tilt = worse(self.tilt, now.tilt);
        if now.past_limit.0 > self.past_limit.0 {
            self.past_limit = now.past_limit;
        }
    }

    /// A moment up to this counts as zero, N m: a part of the torques, or rounding of what weight does.
    fn no_moment(&self) -> f64 {
        REACTIONLESS * self.torque_sum + ROUNDING * self.weight
    }

    /// A force up to this counts as zero, N.
    fn no_force(&self) -> f64 {
        REACTIONLESS * self.inertial_pull + ROUNDING * self.weight
    }

    /// What the arm does: peak |n_B| at most 1e-6 of peak Σ|τ_k|, and peak dynamic |f_B| at most 1e-6 of peak Σ m_j |a_cj|.
    pub fn is_reactionless(&self) -> bool {
        self.arm_moment <= self.no_moment() && self.force <= self.no_force()
    }

    /// What the base feels, past a reaction wheel if it has one, by the same measure.
    pub fn is_quiet(&self) -> bool {
        self.moment <= self.no_moment() && self.force <= self.no_force()
    }
}

/// The larger of two, and not a number if either is not: a run that has blown up is never called reactionless.
#[inline]
fn worse(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}

impl Frame {
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
    pub fn is_quiet(&self) -> bool {
        self.felt_moment().abs() <= self.peaks.no_moment().max(1e-15)
            && self.wrench.dynamic.force.norm() <= self.peaks.no_force().max(1e-15)
    }
}
