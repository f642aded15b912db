//! [`Peaks`]: peak values of a run, and tests of whether they count as zero.

use stillbase_mechanics::planar::PerDrive;

/// Peak values over a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peaks {
    /// |τ_k|, N m.
    pub torque: PerDrive,
    /// Σ_k |τ_k|, N m.
    pub torque_sum: f64,
    /// Dynamic |f_B|, N.
    pub force: f64,
    /// |n_B|, the moment that the arm transmits, N m.
    pub arm_moment: f64,
    /// Moment that turns the base, N m: |n_B − τ_w|, and |n_B| without a wheel; on a free base about its own centre of
    /// mass.
    pub moment: f64,
    /// Σ_j m_j |a_cj|, N: the force that the links would transmit without cancellation.
    pub inertial_pull: f64,
    /// Static force of weight and of the force at the end effector, N: the scale of rounding errors.
    pub weight: f64,
    /// Rates of the motors, seen from what carries them, rad/s: |q̇_k − θ̇| for motors on the base.
    pub rate: PerDrive,
    /// Their accelerations, rad/s².
    pub acceleration: PerDrive,
    /// Moment that tilts the base, due to heights along the axis, N m.
    pub tilt: f64,
    /// Maximum distance of a relative joint angle beyond a limit, rad, and index of the angle in the machine's order.
    pub past_limit: (f64, usize),
}

impl Peaks {
    /// Returns zero peaks for a number of drives.
    pub fn zero(drives: usize) -> Self {
        Self {
            torque: PerDrive::zeros(drives),
            torque_sum: 0.0,
            force: 0.0,
            arm_moment: 0.0,
            moment: 0.0,
            inertial_pull: 0.0,
            weight: 0.0,
            rate: PerDrive::zeros(drives),
            acceleration: PerDrive::zeros(drives),
            tilt: 0.0,
            past_limit: (0.0, 0),
        }
    }

    /// Includes the values of one more instant, of which torques, rates and accelerations may be negative.
    pub(crate) fn include(&mut self, now: &Self) {
        for (peaks, now) in
            [(&mut self.torque, &now.torque), (&mut self.rate, &now.rate), (&mut self.acceleration, &now.acceleration)]
        {
            peaks.iter_mut().zip(now.iter()).for_each(|(peak, x)| *peak = worse(*peak, x.abs()));
        }
        self.torque_sum = worse(self.torque_sum, now.torque_sum);
        self.force = worse(self.force, now.force);
        self.arm_moment = worse(self.arm_moment, now.arm_moment);
        self.moment = worse(self.moment, now.moment);
        self.inertial_pull = worse(self.inertial_pull, now.inertial_pull);
        self.weight = worse(self.weight, now.weight);
        self.tilt = worse(self.tilt, now.tilt);
        if now.past_limit.0 > self.past_limit.0 {
            self.past_limit = now.past_limit;
        }
    }

    /// Returns the tolerance up to which a moment counts as zero, N m: a fraction of the torques plus rounding of
    /// weight.
    pub(super) fn no_moment(&self) -> f64 {
        REACTIONLESS_SHARE * self.torque_sum + ROUNDING * self.weight
    }

    /// Returns the tolerance up to which a force counts as zero, N.
    pub(super) fn no_force(&self) -> f64 {
        REACTIONLESS_SHARE * self.inertial_pull + ROUNDING * self.weight
    }

    /// Returns whether a dynamic force of this size, N, counts as nonzero.
    pub fn counts_as_force(&self, force: f64) -> bool {
        force > self.no_force().max(SMALLEST_REACTION)
    }

    /// Returns whether a moment of this size, N m, counts as nonzero.
    pub fn counts_as_moment(&self, moment: f64) -> bool {
        moment > self.no_moment().max(SMALLEST_REACTION)
    }

    /// Returns whether the arm transmits no reaction. The peak |n_B| must be at most 1e-6 of the peak Σ|τ_k|. The peak
    /// dynamic |f_B| must be at most 1e-6 of the peak Σ m_j |a_cj|. Both tolerances include rounding of weight.
    pub fn is_reactionless(&self) -> bool {
        self.arm_moment <= self.no_moment() && self.force <= self.no_force()
    }

    /// Returns whether n_B counts as nonzero.
    pub fn transmits_moment(&self) -> bool {
        self.arm_moment > self.no_moment()
    }

    /// Returns whether the dynamic f_B counts as nonzero.
    pub fn transmits_force(&self) -> bool {
        self.force > self.no_force()
    }

    /// Returns whether the moment that the base feels and the dynamic force on it count as zero.
    pub fn is_base_unloaded(&self) -> bool {
        self.turns_no_base() && self.force <= self.no_force()
    }

    /// Returns whether the moment that the base feels counts as zero: on a free base about its own centre of mass.
    pub fn turns_no_base(&self) -> bool {
        self.moment <= self.no_moment()
    }
}

/// Returns the larger of two numbers, or NaN if either is NaN, so that a diverged run never counts as reactionless.
#[inline]
fn worse(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}

/// Peaks below this fraction of torques or inertial forces count as zero.
pub const REACTIONLESS_SHARE: f64 = 1e-6;

/// Smallest force or moment that counts as nonzero before anything has moved, N or N m.
const SMALLEST_REACTION: f64 = 1e-15;

/// Rounding error relative to the weight: in free fall, weight cancels in the dynamic force only up to this error. For
/// moments, a lever of 1 m is assumed.
const ROUNDING: f64 = 1e-12;
