//! Where the numbers of a machine may lie.

use super::error::{MachineError, Place};
use super::keys::check_body;
use super::spec::MachineSpec;
use crate::settings::range::{Range, Want};

/// The largest number of a machine, in SI units: beyond it, products of them would not be finite.
const MAX_NUMBER: f64 = 1e6;
/// The smallest number of those that have to be above zero: below it, quotients would not be finite.
const MIN_POSITIVE: f64 = 1e-9;

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

pub(super) fn check_numbers(spec: &MachineSpec) -> Result<(), MachineError> {
    check_body("gravity", spec, 0)?;
    for (name, &value) in &spec.lengths {
        within(LENGTH, value, || Place::new(&[&"lengths", name]))?;
    }
    check_body("payload", spec, 0)?;
    for (i, drive) in spec.drives.iter().enumerate() {
        check_body("drive", spec, i)?;
        if let Some(rotor) = drive.rotor.filter(|rotor| rotor.ratio.abs() < MIN_POSITIVE) {
            let place = Place::new(&[&"drive", &i, &"rotor", &"ratio"]);
            let want = Want::Words("a gear ratio other than 0: 1 for a direct drive, below 0 to turn the other way");
            return Err(MachineError::OutOfRange { place, value: rotor.ratio, want });
        }
    }
    for (i, link) in spec.links.iter().enumerate() {
        check_body("link", spec, i)?;
        if !matches!(link.direction, -1 | 1) {
            let place = Place::new(&[&"link", &i, &"direction"]);
            return Err(MachineError::OutOfRange { place, value: link.direction.into(), want: Want::Words("1 or -1") });
        }
    }
    (0..spec.counterweights.len()).try_for_each(|i| check_body("counterweight", spec, i))?;
    for (i, angle) in spec.angles.iter().enumerate() {
        for (key, value) in [("offset", Some(angle.offset)), ("min", angle.min), ("max", angle.max)] {
            value.map_or(Ok(()), |value| within(ANGLE, value, || Place::new(&[&"angle", &i, &key])))?;
        }
        match (angle.min, angle.max) {
            (Some(min), Some(max)) if min > max => {
                let place = Place::new(&[&"angle", &i, &"max"]);
                let want = Want::Words("a limit not below min");
                return Err(MachineError::OutOfRange { place, value: max, want });
            }
            (Some(_), None) | (None, Some(_)) => {
                return Err(MachineError::HalfLimited { angle: angle.name.clone() });
            }
            _ => {}
        }
    }
    Ok(())
}

/// Refuses a number that is none, or out of the range of its key.
pub(super) fn within(range: Range, value: f64, place: impl Fn() -> Place) -> Result<(), MachineError> {
    match value.is_finite() {
        true if range.contains(value) => Ok(()),
        true => Err(MachineError::OutOfRange { place: place(), value, want: Want::Within(range) }),
        false => Err(MachineError::NotFinite { place: place(), value, unit: range.unit() }),
    }
}
