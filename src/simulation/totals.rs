//! [`Totals`]: time integrals and extremes of a run so far: root mean squares, impulses, energy, motion of the base.

use crate::plant::Slope;
use stillbase_mechanics::planar::length;

/// Time integrals and extremes over a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Totals {
    /// Time covered, s.
    pub time: f64,
    /// ∫ |f_B|² dt of the dynamic part, N² s.
    pub force_squared: f64,
    /// ∫ n_B² dt of the moment that the arm transmits, N² m² s.
    pub arm_moment_squared: f64,
    /// ∫ n² dt of the moment that the base feels, past a reaction wheel, N² m² s.
    pub moment_squared: f64,
    /// ∫ |f_B| dt of the dynamic part, N s.
    pub force_impulse: f64,
    /// ∫ |n| dt of the moment that the base feels, N m s.
    pub moment_impulse: f64,
    /// ∫ Σ |τ_k (q̇_k − θ̇)| dt including the wheel: the energy of motors without recuperation, J.
    pub energy: f64,
    /// Maximum |p_B|, m.
    pub shift: f64,
    /// Maximum |θ|, rad.
    pub base_angle: f64,
    /// Maximum |Ω| of a reaction wheel, rad/s.
    pub wheel_rate: f64,
    /// Maximum |τ_w| of a reaction wheel, N m.
    pub wheel_torque: f64,
    /// ∫ Ω dt of a reaction wheel, rad.
    pub wheel_turn: f64,
    /// Time at which a reaction wheel first saturated, s; `None` if never.
    pub saturated: Option<f64>,
    /// Integrands at the last instant.
    last: Integrands,
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Integrands {
    force: f64,
    arm_moment: f64,
    moment: f64,
    power: f64,
    wheel: f64,
}

impl Totals {
    /// Adds one more instant by the trapezoidal rule: n_B and the moment that the base feels, N m, the dynamic |f_B|, N,
    /// and the time, s.
    pub(crate) fn include(&mut self, x: &Slope, [arm_moment, felt]: [f64; 2], force: f64, time: f64) {
        let turning = x.qd.get(x.torque.len()).copied().unwrap_or(0.0);
        let powers = x.torque.iter().zip(x.qd.iter()).map(|(t, qd)| (t * (qd - turning)).abs());
        let wheel = (x.spin.torque * (x.spin.rate - turning)).abs();
        let now = Integrands {
            force,
            arm_moment: arm_moment.abs(),
            moment: felt.abs(),
            power: powers.sum::<f64>() + wheel,
            wheel: x.spin.rate,
        };
        let (h, was) = (0.5 * (time - self.time), self.last);
        self.force_squared += h * (now.force.powi(2) + was.force.powi(2));
        self.arm_moment_squared += h * (now.arm_moment.powi(2) + was.arm_moment.powi(2));
        self.moment_squared += h * (now.moment.powi(2) + was.moment.powi(2));
        self.force_impulse += h * (now.force + was.force);
        self.moment_impulse += h * (now.moment + was.moment);
        self.energy += h * (now.power + was.power);
        self.wheel_turn += h * (now.wheel + was.wheel);
        self.shift = self.shift.max(length(x.base.at));
        self.base_angle = self.base_angle.max(x.base.angle.abs());
        self.wheel_rate = self.wheel_rate.max(x.spin.rate.abs());
        self.wheel_torque = self.wheel_torque.max(x.spin.torque.abs());
        if x.spin.saturated && self.saturated.is_none() {
            self.saturated = Some(time);
        }
        (self.last, self.time) = (now, time);
    }

    /// Returns the root mean square of the dynamic |f_B|, N.
    pub fn force_rms(&self) -> f64 {
        rms(self.force_squared, self.time)
    }

    /// Returns the root mean square of n_B, the moment that the arm transmits, N m.
    pub fn arm_moment_rms(&self) -> f64 {
        rms(self.arm_moment_squared, self.time)
    }

    /// Returns the root mean square of the moment that the base feels, past a reaction wheel, N m.
    pub fn moment_rms(&self) -> f64 {
        rms(self.moment_squared, self.time)
    }
}

fn rms(sum: f64, time: f64) -> f64 {
    if time > 0.0 { (sum / time).sqrt() } else { 0.0 }
}
