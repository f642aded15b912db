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

use serde::{Deserialize, Serialize};

use crate::range::{Check, Range};

const INERTIA: Range = Range::new(1e-9, 1e6, "kg m²");
const TORQUE_LIMIT: Range = Range::new(1e-9, 1e6, "N m");
const SPEED_LIMIT: Range = Range::new(1e-9, 1e6, "rad/s");

/// A reaction wheel.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Wheel {
    /// Of its rotor about its axis, kg m².
    #[serde(default = "rotor")]
    pub inertia: f64,
    /// The greatest |τ_w|, N m; none: unlimited.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub torque_limit: Option<f64>,
    /// The greatest |Ω|, rad/s; none: unlimited.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed_limit: Option<f64>,
}

fn rotor() -> f64 {
    0.02
}

impl Default for Wheel {
    fn default() -> Self {
        Self { inertia: rotor(), torque_limit: None, speed_limit: None }
    }
}

/// What a wheel does at an instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spin {
    /// Ω, rad/s.
    pub rate: f64,
    /// τ_w, N m.
    pub torque: f64,
    /// Whether it could not give what was wanted.
    pub saturated: bool,
}

impl Wheel {
    /// Which way it turns as fast as it can, ±1, or 0: asked once a step, so that within one nothing jumps.
    pub fn at_limit(&self, rate: f64) -> f64 {
        let top = self.speed_limit.unwrap_or(f64::INFINITY);
        if rate.abs() >= top { rate.signum() } else { 0.0 }
    }

    /// What it gives of a wanted torque, N m, at a rate, rad/s.
    #[inline]
    pub fn give(&self, wanted: f64, rate: f64, at_limit: f64) -> Spin {
        let limit = self.torque_limit.unwrap_or(f64::INFINITY);
        let within = wanted.clamp(-limit, limit);
        let torque = if within * at_limit > 0.0 { 0.0 } else { within };
        Spin { rate, torque, saturated: torque != wanted }
    }

    pub(crate) fn checks(&self) -> impl Iterator<Item = Check> {
        let inertia = INERTIA.check("base.wheel.inertia", self.inertia);
        let torque = TORQUE_LIMIT.check_some("base.wheel.torque_limit", self.torque_limit);
        let speed = SPEED_LIMIT.check_some("base.wheel.speed_limit", self.speed_limit);
        std::iter::once(inertia).chain(torque).chain(speed)
    }
}
