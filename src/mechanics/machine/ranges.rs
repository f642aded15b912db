//! Where the numbers of a machine may lie.

use super::error::{MachineError, Place};
use crate::settings::range::{Range, Want};

/// The largest number of a machine, in SI units: beyond it, products of them would not be finite.
const MAX_NUMBER: f64 = 1e6;
/// The smallest number of those that have to be above zero: below it, quotients would not be finite.
pub(super) const MIN_POSITIVE: f64 = 1e-9;

pub(super) const GRAVITY: Range = Range::either_way(MAX_NUMBER, "m/s²");
pub(crate) const LENGTH: Range = Range::new(1e-6, MAX_NUMBER, "m");
pub(crate) const PLACE: Range = Range::either_way(MAX_NUMBER, "m");
/// Links may be all but without mass.
pub(crate) const MASS: Range = Range::new(1e-15, MAX_NUMBER, "kg");
pub(crate) const LOAD: Range = Range::new(0.0, MAX_NUMBER, "kg");
pub(super) const RADIUS: Range = Range::new(0.0, MAX_NUMBER, "m");
pub(crate) const INERTIA: Range = Range::new(0.0, MAX_NUMBER, "kg m²");
pub(super) const TORQUE_LIMIT: Range = Range::new(MIN_POSITIVE, MAX_NUMBER, "N m");
/// A gear is no lever of any length, and none of none.
pub(crate) const RATIO: Range = Range::either_way(1e4, "");
pub(super) const SPEED_LIMIT: Range = Range::new(MIN_POSITIVE, MAX_NUMBER, "rad/s");
pub(super) const ACCELERATION_LIMIT: Range = Range::new(MIN_POSITIVE, MAX_NUMBER, "rad/s²");
pub(super) const JERK_LIMIT: Range = Range::new(MIN_POSITIVE, 1e9, "rad/s³");

/// The largest joint limit either way, rad: each further turn is one more winding of the same workspace.
pub const MAX_ANGLE: f64 = 25.2;
/// Where a relative angle and its limits may lie.
pub const ANGLE: Range = Range::either_way(MAX_ANGLE, "rad, four turns");

/// Refuses a number that is none, or out of the range of its key.
pub(super) fn within(range: Range, value: f64, place: impl Fn() -> Place) -> Result<(), MachineError> {
    match value.is_finite() {
        true if range.contains(value) => Ok(()),
        true => Err(MachineError::OutOfRange { place: place(), value, want: Want::Within(range) }),
        false => Err(MachineError::NotFinite { place: place(), value, unit: range.unit() }),
    }
}
