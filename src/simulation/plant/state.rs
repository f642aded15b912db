//! [`State`]: positions and momenta of all moving parts, and its time derivative [`Slope`].

use super::WheelState;
use stillbase_mechanics::dynamics::BaseWrench;
use stillbase_mechanics::planar::{DriveAngles, PerDrive, Pose2, UnitVectors, Vector};

/// Positions and momenta of all moving parts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// Absolute angles of the drives and, last, of a moving base, rad.
    pub q: PerDrive,
    /// Momenta π_k, kg m²/s; on a moving base the last entry is the angular momentum L about R.
    pub momenta: PerDrive,
    /// Centre of mass R of all moving parts, m.
    pub position: Vector,
    /// Momentum P of all moving parts, kg m/s.
    pub momentum: Vector,
    /// Rate Ω of the wheel, rad/s.
    pub wheel: f64,
    /// Work done by motors and by the force at the end effector, J.
    pub work: f64,
    /// Energy lost in friction and dampers, J.
    pub lost: f64,
    /// ∫ dynamic f_B dt, N s, and the time integral of the dynamic moment about the origin, N m s.
    pub impulse: (Vector, f64),
}

/// Time derivative of a state, with its torques and forces.
#[derive(Clone, Copy, Debug)]
pub struct Slope {
    /// Unit vectors e(q_k); that of a moving base is last.
    pub e: UnitVectors,
    /// q̇, rad/s.
    pub qd: PerDrive,
    /// q̈, rad/s².
    pub qdd: PerDrive,
    /// Motor torques, N m.
    pub torque: PerDrive,
    /// Friction torques in the bearings, N m; positive if they oppose a positive sliding rate.
    pub friction: PerDrive,
    /// State of the wheel.
    pub spin: WheelState,
    /// Position p_B of B, m, and angle θ of the base, rad.
    pub base: Pose2,
    /// Velocity ṗ_B of B, m/s.
    pub base_velocity: Vector,
    /// Acceleration p̈_B of B, m/s².
    pub base_acceleration: Vector,
    /// Wrench of the manipulator on its base.
    pub wrench: BaseWrench,
    /// Kinetic energy of all moving parts, J.
    pub kinetic: f64,
    /// Power of motors, wheel and outer force, W.
    pub power: f64,
    /// Power lost in friction and dampers, W.
    pub loss: f64,
    pub(super) momenta_rate: PerDrive,
    pub(super) place_rate: Vector,
    pub(super) momentum_rate: Vector,
    pub(super) wheel_rate: f64,
}

impl State {
    /// Returns this state with the wheel rate, the work, the losses and the impulse of another.
    #[must_use]
    pub fn with_sums_of(self, other: &Self) -> Self {
        let Self { wheel, work, lost, impulse, .. } = *other;
        Self { wheel, work, lost, impulse, ..self }
    }

    /// Returns the drive angles without the base, rad.
    #[inline]
    pub fn drives(&self, n: usize) -> DriveAngles {
        DriveAngles(self.q.first(n))
    }
}
