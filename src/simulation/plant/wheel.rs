//! [`Wheel`]: a reaction wheel in the base that takes up the moment of the manipulator while it can.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | τ_w | torque of the wheel's motor on the wheel; −τ_w on the base | N m |
//! | Ω | rate of the wheel, absolute | rad/s |
//!
//! The wheel is told the sum of the motors' torques, which the base feels as −Σ τ_k, and turns τ_w = −Σ τ_k. It
//! saturates where τ_w or Ω would pass their limits; then the base feels the rest.
//!
//! # At the top rate
//! Ω never passes its limit, not even within a step: in each step of h seconds the wheel gives no more than
//! J (Ω_top − Ω)/h either way, which brings it to the limit by the step's end and leaves it there. So the step in which
//! the limit is reached has the right impulse, spread evenly over what is left of it, and the next ones give nothing
//! outwards.

use crate::settings::key::Key;
use crate::settings::keyed::keyed;
use crate::settings::range::Range;

keyed! {
    /// A reaction wheel.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Wheel at "base.wheel" {
        /// Inertia of a reaction wheel's rotor about its axis; a wheel is there if one of its keys is given.
        inertia: f64 = Key::NONE, range: Range::new(1e-9, 1e6, "kg m²"),
            instead: "0.02 if another key of the wheel is given, or else there is no wheel", usual: 0.02, saved: always;
        /// The greatest torque of the wheel's motor, either way.
        torque_limit: Option<f64> = Key::NONE, range: Range::new(1e-9, 1e6, "N m"), instead: "no limit";
        /// The greatest rate of the wheel, either way.
        speed_limit: Option<f64> = Key::NONE, range: Range::new(1e-9, 1e6, "rad/s"), instead: "no limit";
    }
}

/// What a wheel does at an instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WheelState {
    /// Ω, rad/s.
    pub rate: f64,
    /// τ_w, N m.
    pub torque: f64,
    /// Whether it could not give what was wanted.
    pub saturated: bool,
}

impl Wheel {
    /// The least and the greatest torque, N m, that it can give through a step of a length, s, which begins at a rate,
    /// rad/s: asked once a step, so that within one nothing jumps.
    pub fn room(&self, rate: f64, step: f64) -> [f64; 2] {
        let most = self.torque_limit.unwrap_or(f64::INFINITY);
        let top = self.speed_limit.unwrap_or(f64::INFINITY);
        let to = |end: f64| self.inertia * (end - rate) / step;
        [to(-top).clamp(-most, 0.0), to(top).clamp(0.0, most)]
    }

    /// What it gives of a wanted torque, N m, at a rate, rad/s, with what room there is in this step.
    #[inline]
    pub fn give(&self, wanted: f64, rate: f64, room: [f64; 2]) -> WheelState {
        // In a run that diverges the torque becomes NaN, so that the run counts as failed.
        let torque = if rate.is_finite() { wanted.max(room[0]).min(room[1]) } else { f64::NAN };
        WheelState { rate, torque, saturated: torque != wanted }
    }
}
