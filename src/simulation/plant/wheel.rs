//! [`Wheel`]: a reaction wheel in the base that compensates the moment of the manipulator within its limits, and keeps
//! the attitude of a free base.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | τ_w | torque of the wheel's motor on the wheel; −τ_w on the base | N m |
//! | Ω | rate of the wheel, absolute | rad/s |
//! | θ, α | angle of a free base, and its acceleration that the attitude control wants | rad, rad/s² |
//!
//! # On a base that is held
//! With motors on the base and no gears, their moment on the base is −Σ τ_k. The wheel's controller commands τ_w = −Σ
//! τ_k. The wheel saturates where τ_w or Ω would exceed their limits; the remaining moment acts on the base.
//!
//! # On a free base
//! The base turns about its own centre of mass, so forces of the arm at the pin turn it too. From its model, control
//! computes the moment of all this for the wanted motion. The wheel takes it up and adds α = −K_p θ − K_d θ̇, less the
//! dead band: α = 0 while |K_p θ + K_d θ̇| ≤ K_p times the dead band. Control that knows no model, or no free base,
//! commands τ_w = −Σ τ_k − I_b α; feedback then acts on the rest.
//!
//! # At the maximum rate
//! Ω never exceeds its limit Ω_top, not even within a step. In a step of h seconds, the torque is at most J (Ω_top −
//! Ω)/h, J the rotor's inertia. With it, the wheel reaches its limit at the step's end. The other direction has the
//! corresponding limit. So the impulse is exact even in the step in which Ω reaches its limit. In later steps no
//! torque drives Ω beyond the limit.

use stillbase_settings::key::Key;
use stillbase_settings::keyed::keyed;
use stillbase_settings::number::ShortNumber;
use stillbase_settings::range::Range;

keyed! {
    /// Settings of a reaction wheel.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Wheel at "base.wheel" {
        /// Inertia of a reaction wheel's rotor about its axis; a wheel is there if one of its keys is given.
        inertia: f64 = Key::NONE, range: Range::new(1e-9, 1e6, "kg m²"),
            instead: "0.02 if another key of the wheel is given, or else there is no wheel", usual: 0.02, saved: always;
        /// The greatest torque of the wheel's motor, either way.
        torque_limit: Option<f64> = Key::NONE, range: Range::new(1e-9, 1e6, "N m"), instead: "no limit";
        /// The greatest rate of the wheel, either way.
        speed_limit: Option<f64> = Key::NONE, range: Range::new(1e-9, 1e6, "rad/s"), instead: "no limit";
        /// Gain K_p of the attitude of a free base.
        kp: f64 = "1", range: Range::new(0.0, 1e6, "s⁻²"), when: WHEN_FREE;
        /// Gain K_d of the rate of a free base.
        kd: f64 = "2", range: Range::new(0.0, 1e4, "s⁻¹"), when: WHEN_FREE;
        /// Dead band: feedback acts on what θ + (K_d/K_p) θ̇ exceeds this angle by, so a base at rest within it is left alone.
        dead_band: f64 = "0", range: Range::new(0.0, 3.0, "rad"), when: WHEN_FREE;
        /// Rate at which the torque for a free base is computed, a whole number of steps apart; it stays constant in
        /// between, and 0 means as often as those of the motors.
        rate: f64 = "0", range: Range::new(0.0, 1e5, "Hz"), when: WHEN_FREE;
    }
}

const WHEN_FREE: &str = "base.kind = free: another base is held";

/// Least damping ratio K_d/(2 √K_p) of gains that are well chosen.
const MIN_DAMPING: f64 = 0.3;
/// Above this K_d times the time between two torques, they leave a rate of the opposite sign: sampled control diverges at 2.
const MAX_SAMPLED_DAMPING: f64 = 1.0;

/// State of a wheel at an instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WheelState {
    /// Ω, rad/s.
    pub rate: f64,
    /// τ_w, N m.
    pub torque: f64,
    /// True if a limit makes the torque smaller than the controller wants.
    pub saturated: bool,
}

fn short(x: f64) -> ShortNumber {
    ShortNumber((1e3 * x).round() / 1e3)
}

impl Wheel {
    /// Returns the minimum and maximum torque, N m, for a step of given length, s, that begins at a rate, rad/s. Call
    /// this once per step, so that the bounds do not jump within the step.
    pub fn torque_range(&self, rate: f64, step: f64) -> [f64; 2] {
        let limit = self.torque_limit.unwrap_or(f64::INFINITY);
        let top = self.speed_limit.unwrap_or(f64::INFINITY);
        let torque_to = |end_rate: f64| self.inertia * (end_rate - rate) / step;
        [torque_to(-top).clamp(-limit, 0.0), torque_to(top).clamp(0.0, limit)]
    }

    /// Returns the angular acceleration α that feedback wants of a free base, rad/s², for its angle, rad, and rate,
    /// rad/s.
    #[inline]
    pub fn attitude_feedback(&self, angle: f64, rate: f64) -> f64 {
        let error = self.kp * angle + self.kd * rate;
        let band = self.kp * self.dead_band;
        error.clamp(-band, band) - error
    }

    /// Returns in words what is wrong with gains that let a free base swing for long, or that sampling cannot hold; `None` if
    /// they are well chosen.
    pub fn poor_gains(&self) -> Option<String> {
        let damping = self.kd / (2.0 * self.kp.sqrt());
        if self.rate > 0.0 && self.kd / self.rate > MAX_SAMPLED_DAMPING {
            let [most, least] = [MAX_SAMPLED_DAMPING * self.rate, self.kd / MAX_SAMPLED_DAMPING].map(short);
            return Some(format!(
                "base.wheel.kd = {} s⁻¹ is too much for torques at {} Hz: want kd up to {most} s⁻¹, or {least} Hz and more",
                short(self.kd),
                short(self.rate)
            ));
        }
        (self.kp > 0.0 && damping < MIN_DAMPING).then(|| {
            format!(
                "with base.wheel.kp = {} s⁻² and kd = {} s⁻¹ the base swings with a damping ratio of {} only: want kd of about \
                 {} s⁻¹",
                short(self.kp),
                short(self.kd),
                short(damping),
                short(2.0 * self.kp.sqrt())
            )
        })
    }

    /// Returns the number of steps of `step` s between two torques for a free base; 0 without a rate of its own.
    pub fn period(&self, step: f64) -> u64 {
        if self.rate > 0.0 { ((1.0 / (self.rate * step)).round() as u64).max(1) } else { 0 }
    }

    /// Returns the state of the wheel for a requested torque, N m, at a rate, rad/s. The torque is limited to the
    /// interval `room`, N m.
    #[inline]
    pub fn command(&self, wanted: f64, rate: f64, room: [f64; 2]) -> WheelState {
        // In a run that diverges, the torque becomes NaN, so that the run is recognised as failed.
        let torque = if rate.is_finite() { wanted.max(room[0]).min(room[1]) } else { f64::NAN };
        WheelState { rate, torque, saturated: torque != wanted }
    }
}
