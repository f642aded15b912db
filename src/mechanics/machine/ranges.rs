//! Where the numbers of a machine may lie.

use super::error::{MachineError, Place};
use super::spec::{MachineSpec, Payload};
use crate::settings::key::{Holds, Key};
use crate::settings::range::{Range, Want};

/// The largest number of a machine, in SI units: beyond it, products of them would not be finite.
const MAX_NUMBER: f64 = 1e6;
/// The smallest number of those that have to be above zero: below it, quotients would not be finite.
const MIN_POSITIVE: f64 = 1e-9;

const GRAVITY: Range = Range::either_way(MAX_NUMBER, "m/s²");
pub(crate) const LENGTH: Range = Range::new(1e-6, MAX_NUMBER, "m");
pub(crate) const PLACE: Range = Range::either_way(MAX_NUMBER, "m");
/// Links may be all but without mass.
pub(crate) const MASS: Range = Range::new(1e-15, MAX_NUMBER, "kg");
pub(crate) const LOAD: Range = Range::new(0.0, MAX_NUMBER, "kg");
const RADIUS: Range = Range::new(0.0, MAX_NUMBER, "m");
pub(crate) const INERTIA: Range = Range::new(0.0, MAX_NUMBER, "kg m²");
const TORQUE_LIMIT: Range = Range::new(MIN_POSITIVE, MAX_NUMBER, "N m");
/// A gear is no lever of any length, and none of none.
pub(crate) const RATIO: Range = Range::either_way(1e4, "");
const SPEED_LIMIT: Range = Range::new(MIN_POSITIVE, MAX_NUMBER, "rad/s");
const ACCELERATION_LIMIT: Range = Range::new(MIN_POSITIVE, MAX_NUMBER, "rad/s²");
const JERK_LIMIT: Range = Range::new(MIN_POSITIVE, 1e9, "rad/s³");

/// The largest joint limit either way, rad: each further turn is one more winding of the same workspace.
pub const MAX_ANGLE: f64 = 25.2;
/// Where a relative angle and its limits may lie.
pub const ANGLE: Range = Range::either_way(MAX_ANGLE, "rad, four turns");

const UNLIMITED: &str = "no limit";

/// Every key of a machine that can be set by itself; its links, drives and angles go by their names, its
/// counterweights by their numbers, from 1.
pub const KEYS: [Key; 23] = [
    Key::number(
        "link.*.com",
        PLACE,
        Key::REQUIRED,
        "Place l_c of a link's centre of mass along the link, from its root.",
    ),
    Key::number(
        "link.*.com_normal",
        PLACE,
        "0",
        "Place of a link's centre of mass off the link's axis, to the left of the direction root to tip.",
    ),
    Key::number("link.*.mass", MASS, Key::REQUIRED, "Mass of a link."),
    Key::number("link.*.inertia", INERTIA, Key::REQUIRED, "Inertia of a link about its own centre of mass."),
    Key::number("link.*.length", LENGTH, Key::REQUIRED, "Length of a link that shares it with no other."),
    Key::number(
        "link.*.axial",
        PLACE,
        "0",
        "Height of a link's centre of mass along the drives' axis; it decides which moments tilt the base.",
    ),
    Key::number(
        "counterweight.*.mass",
        MASS,
        Key::REQUIRED,
        "Mass of a counterweight: 1 is the first that the machine has.",
    ),
    Key::number(
        "counterweight.*.at",
        PLACE,
        Key::REQUIRED,
        "Place of a counterweight along the link that carries it, from that link's root.",
    ),
    Key::number("counterweight.*.radius", RADIUS, "0", "Radius of a counterweight, a disc; 0 for a point."),
    Key::new(
        "counterweight.*.fixed",
        Holds::Switch,
        "false",
        "Whether a counterweight stays where it is, as a motor does, when others are sought or taken off.",
    ),
    Key::number("length.*", LENGTH, Key::REQUIRED, "A named length, of all bars that share it."),
    Key::number("payload.mass", LOAD, "0", "Mass held at the end effector, known to control."),
    Key::number("payload.inertia", INERTIA, "0", "Inertia of the payload about its own centre of mass."),
    Key::new(
        "payload.offset",
        Holds::List(2, PLACE),
        "0,0",
        "Centre of mass of the payload, seen from the end effector: along the link that holds it, and to its left.",
    )
    .when("payload.mass above 0"),
    Key::number(
        "payload.axial",
        PLACE,
        "0",
        "Height of the payload's centre of mass, and of a force on the end effector, along the drives' axis.",
    )
    .when("payload.mass above 0, or a force on the end effector"),
    Key::new("gravity", Holds::List(2, GRAVITY), "0,0", "Acceleration of gravity along the axes of the base."),
    Key::new(
        "limits.*",
        Holds::List(2, ANGLE),
        Key::NONE,
        "Least and greatest value of a relative joint angle; without them it turns freely.",
    )
    .instead(UNLIMITED),
    Key::number(
        "drive.*.rotor.inertia",
        INERTIA,
        "0",
        "Inertia of what turns in a drive's motor, about its own axis, before the gear.",
    ),
    Key::number(
        "drive.*.rotor.ratio",
        RATIO,
        "1",
        "Turns of the rotor for one turn of the drive, seen from the motor's stator; below 0 it turns the other way.",
    ),
    Key::number("drive.*.torque_limit", TORQUE_LIMIT, Key::NONE, "The greatest torque of a drive, either way.")
        .instead(UNLIMITED),
    Key::number("drive.*.speed_limit", SPEED_LIMIT, Key::NONE, "The greatest rate of a drive, either way.")
        .instead(UNLIMITED),
    Key::number(
        "drive.*.acceleration_limit",
        ACCELERATION_LIMIT,
        Key::NONE,
        "The greatest acceleration that is asked of a drive, either way.",
    )
    .instead(UNLIMITED),
    Key::number(
        "drive.*.jerk_limit",
        JERK_LIMIT,
        Key::NONE,
        "The greatest jerk that is asked of a drive, either way, by time laws that keep jerk in bounds.",
    )
    .instead(UNLIMITED),
];

pub(super) fn check_numbers(spec: &MachineSpec) -> Result<(), MachineError> {
    for (i, &value) in spec.gravity.iter().enumerate() {
        within(GRAVITY, value, || Place::new(&[&"gravity", &i]))?;
    }
    for (name, &value) in &spec.lengths {
        within(LENGTH, value, || Place::new(&[&"lengths", name]))?;
    }
    let Payload { mass, inertia, offset, axial } = spec.payload;
    within(LOAD, mass, || Place::new(&[&"payload", &"mass"]))?;
    within(INERTIA, inertia, || Place::new(&[&"payload", &"inertia"]))?;
    within(PLACE, axial, || Place::new(&[&"payload", &"axial"]))?;
    for (i, &value) in offset.iter().enumerate() {
        within(PLACE, value, || Place::new(&[&"payload", &"offset", &i]))?;
    }
    for (i, drive) in spec.drives.iter().enumerate() {
        for (key, value, range) in [
            ("torque_limit", drive.torque_limit, TORQUE_LIMIT),
            ("speed_limit", drive.speed_limit, SPEED_LIMIT),
            ("acceleration_limit", drive.acceleration_limit, ACCELERATION_LIMIT),
            ("jerk_limit", drive.jerk_limit, JERK_LIMIT),
        ] {
            value.map_or(Ok(()), |value| within(range, value, || Place::new(&[&"drive", &i, &key])))?;
        }
        if let Some(rotor) = drive.rotor {
            let place = |key: &'static str| Place::new(&[&"drive", &i, &"rotor", &key]);
            within(INERTIA, rotor.inertia, || place("inertia"))?;
            within(RATIO, rotor.ratio, || place("ratio"))?;
            if rotor.ratio.abs() < MIN_POSITIVE {
                let want =
                    Want::Words("a gear ratio other than 0: 1 for a direct drive, below 0 to turn the other way");
                return Err(MachineError::OutOfRange { place: place("ratio"), value: rotor.ratio, want });
            }
        }
    }
    for (i, link) in spec.links.iter().enumerate() {
        for (key, value, range) in [
            ("mass", link.mass, MASS),
            ("inertia", link.inertia, INERTIA),
            ("com", link.com, PLACE),
            ("com_normal", link.com_normal, PLACE),
            ("axial", link.axial, PLACE),
        ] {
            within(range, value, || Place::new(&[&"link", &i, &key]))?;
        }
        if !matches!(link.direction, -1 | 1) {
            let place = Place::new(&[&"link", &i, &"direction"]);
            return Err(MachineError::OutOfRange { place, value: link.direction.into(), want: Want::Words("1 or -1") });
        }
    }
    for (i, weight) in spec.counterweights.iter().enumerate() {
        for (key, value, range) in
            [("mass", weight.mass, MASS), ("at", weight.at, PLACE), ("radius", weight.radius, RADIUS)]
        {
            within(range, value, || Place::new(&[&"counterweight", &i, &key]))?;
        }
    }
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
