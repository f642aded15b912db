//! Ranges of the numbers of a machine.

use super::error::{KeyPath, MachineError};
use stillbase_settings::range::{Range, Requirement};

/// Largest magnitude of most numbers of a machine, in SI units: products of larger numbers could overflow.
const MAX_NUMBER: f64 = 1e6;
/// Smallest limit of a drive and smallest |gear ratio|, in SI units: quotients of smaller numbers could overflow.
pub(super) const MIN_POSITIVE: f64 = 1e-9;

pub(super) const GRAVITY: Range = Range::either_way(MAX_NUMBER, "m/s²");
/// Range of a length that must be positive.
pub const LENGTH: Range = Range::new(1e-6, MAX_NUMBER, "m");
/// Range of a coordinate.
pub const PLACE: Range = Range::either_way(MAX_NUMBER, "m");
/// Range of a mass that must be positive; it may be nearly zero.
pub const MASS: Range = Range::new(1e-15, MAX_NUMBER, "kg");
/// Range of a mass that may be zero.
pub const LOAD: Range = Range::new(0.0, MAX_NUMBER, "kg");
pub(super) const RADIUS: Range = Range::new(0.0, MAX_NUMBER, "m");
/// Range of a moment of inertia.
pub const INERTIA: Range = Range::new(0.0, MAX_NUMBER, "kg m²");
/// Range of the density of a material.
pub const DENSITY: Range = Range::new(1.0, 1e5, "kg/m³");
pub(super) const TORQUE_LIMIT: Range = Range::new(MIN_POSITIVE, MAX_NUMBER, "N m");
/// Range of a gear ratio; a separate check rejects a ratio of 0.
pub const RATIO: Range = Range::either_way(1e4, "");
pub(super) const SPEED_LIMIT: Range = Range::new(MIN_POSITIVE, MAX_NUMBER, "rad/s");
pub(super) const ACCELERATION_LIMIT: Range = Range::new(MIN_POSITIVE, MAX_NUMBER, "rad/s²");
pub(super) const JERK_LIMIT: Range = Range::new(MIN_POSITIVE, 1e9, "rad/s³");

/// Largest magnitude of a joint limit, rad: each further turn only repeats the same workspace.
pub const MAX_ANGLE: f64 = 25.2;
/// Range of a relative angle's offset and limits.
pub const ANGLE: Range = Range::either_way(MAX_ANGLE, "rad, four turns");

/// Checks that a number is finite and within a range; returns an error with its place otherwise.
pub(super) fn within(range: Range, value: f64, place: impl Fn() -> KeyPath) -> Result<(), MachineError> {
    match value.is_finite() {
        true if range.contains(value) => Ok(()),
        true => Err(MachineError::OutOfRange { place: place(), value, want: Requirement::Within(range) }),
        false => Err(MachineError::NotFinite { place: place(), value, unit: range.unit() }),
    }
}
