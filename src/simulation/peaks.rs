//! [`Peaks`]: the largest values of a run, and whether they count as none.

use crate::mechanics::planar::PerDrive;

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
    /// |q̇_k − θ̇|, rad/s.
    pub rate: PerDrive,
    /// The moment that tilts the base, from heights along the axis, N m.
    pub tilt: f64,
    /// By how much a relative joint angle has passed a limit, rad, and which, in the machine's order.
    pub past_limit: (f64, usize),
}

impl Peaks {
    /// The peaks of a run that has not begun.
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
        for (peak, rate) in self.rate.iter_mut().zip(now.rate.iter()) {
            *peak = worse(*peak, rate.abs());
        }
        self.tilt = worse(self.tilt, now.tilt);
        if now.past_limit.0 > self.past_limit.0 {
            self.past_limit = now.past_limit;
        }
    }

    /// A moment up to this counts as zero, N m: a part of the torques, or rounding of what weight does.
    pub(super) fn no_moment(&self) -> f64 {
        REACTIONLESS * self.torque_sum + ROUNDING * self.weight
    }

    /// A force up to this counts as zero, N.
    pub(super) fn no_force(&self) -> f64 {
        REACTIONLESS * self.inertial_pull + ROUNDING * self.weight
    }

    /// What the arm does: peak |n_B| at most 1e-6 of peak Σ|τ_k|, and peak dynamic |f_B| at most 1e-6 of peak Σ m_j
    /// |a_cj|.
    pub fn is_reactionless(&self) -> bool {
        self.arm_moment <= self.no_moment() && self.force <= self.no_force()
    }

    /// Whether n_B is more than rounding.
    pub fn transmits_moment(&self) -> bool {
        self.arm_moment > self.no_moment()
    }

    /// Whether the dynamic f_B is more than rounding.
    pub fn transmits_force(&self) -> bool {
        self.force > self.no_force()
    }

    /// What the base feels, past a reaction wheel if it has one, by the same measure.
    pub fn base_feels_nothing(&self) -> bool {
        self.moment <= self.no_moment() && self.force <= self.no_force()
    }
}

/// The larger of two, and not a number if either is not: a run that has blown up is never called reactionless.
#[inline]
fn worse(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}

/// Peaks below this part of what moves count as zero.
pub const REACTIONLESS: f64 = 1e-6;

/// What rounding leaves of weight that is not carried, as in free fall; of moments, for each metre.
const ROUNDING: f64 = 1e-12;
