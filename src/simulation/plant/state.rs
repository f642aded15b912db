//! [`State`]: positions and momenta of everything that moves, and its [`Slope`]: how it changes.

use super::WheelState;
use crate::mechanics::dynamics::BaseWrench;
use crate::mechanics::planar::{DriveAngles, PerDrive, Pose2, Units, Vector};

/// Positions and momenta of everything that moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// Absolute angles of the drives and, last, of a base that moves, rad.
    pub q: PerDrive,
    /// π_k; for a base that moves, last, L.
    pub momenta: PerDrive,
    /// R, m.
    pub place: Vector,
    /// P, kg m/s.
    pub momentum: Vector,
    /// Ω of a wheel, rad/s.
    pub wheel: f64,
    /// Work done by motors and by the force at the end effector, J.
    pub work: f64,
    /// Energy lost in friction and dampers, J.
    pub lost: f64,
    /// ∫ dynamic f_B dt, N s, and the moment of it all about the origin, N m s.
    pub impulse: (Vector, f64),
}

/// How a state changes, with the torques and forces that make it change.
#[derive(Clone, Copy, Debug)]
pub struct Slope {
    /// e(q_k), of a base that moves last.
    pub e: Units,
    /// q̇, rad/s.
    pub qd: PerDrive,
    /// q̈, rad/s².
    pub qdd: PerDrive,
    /// Motor torques, N m.
    pub torque: PerDrive,
    /// Friction of the bearings against them, N m.
    pub friction: PerDrive,
    /// Of the wheel.
    pub spin: WheelState,
    /// p_B and θ.
    pub base: Pose2,
    /// ṗ_B, m/s.
    pub base_velocity: Vector,
    /// p̈_B, m/s².
    pub base_acceleration: Vector,
    /// What the manipulator transmits.
    pub wrench: BaseWrench,
    /// Kinetic energy of all that moves, J.
    pub kinetic: f64,
    /// Work done a second, W.
    pub power: f64,
    /// Energy lost a second, W.
    pub loss: f64,
    pub(super) momenta_rate: PerDrive,
    pub(super) place_rate: Vector,
    pub(super) momentum_rate: Vector,
    pub(super) wheel_rate: f64,
}

impl State {
    /// This state with the wheel rate, the work, the losses and the impulse of another.
    #[must_use]
    pub fn with_sums_of(self, other: &Self) -> Self {
        let Self { wheel, work, lost, impulse, .. } = *other;
        Self { wheel, work, lost, impulse, ..self }
    }

    /// The drives' angles without the base, rad.
    #[inline]
    pub fn drives(&self, n: usize) -> DriveAngles {
        DriveAngles(self.q.first(n))
    }
}
