//! [`check_numbers`] checks that every number of a specification is finite and within its range.

use super::counterweight::Counterweight;
use super::error::{KeyPath, MachineError};
use super::keys::rows_of;
use super::ranges::{ANGLE, LENGTH, MIN_POSITIVE, within};
use super::spec::MachineSpec;
use super::transverse;
use stillbase_settings::range::Requirement;

/// Checks every number of a specification. It fails if one is out of range or not finite, or an angle has one limit.
pub(super) fn check_numbers(spec: &MachineSpec) -> Result<(), MachineError> {
    let check = |part: &str, bodies: usize| {
        let rows = rows_of(part);
        (0..bodies).try_for_each(|i| rows.iter().try_for_each(|row| row.check(spec, i)))
    };
    check("gravity", 1)?;
    if let Some(pose) = &spec.pose {
        for (k, angle) in pose.iter().enumerate() {
            within(ANGLE, *angle, || KeyPath::new(&[&"pose", &k]))?;
        }
        if pose.len() != spec.drives.len() {
            let want = format!("one for each drive, {}", spec.drives.len());
            return Err(MachineError::Count { what: "angles in the pose of the drawing", count: pose.len(), want });
        }
    }
    for (name, &value) in &spec.lengths {
        within(LENGTH, value, || KeyPath::new(&[&"lengths", name]))?;
    }
    check("payload", 1)?;
    let rows = rows_of("drive");
    for (i, drive) in spec.drives.iter().enumerate() {
        rows.iter().try_for_each(|row| row.check(spec, i))?;
        if let Some(rotor) = drive.rotor.filter(|rotor| rotor.ratio.abs() < MIN_POSITIVE) {
            let place = KeyPath::new(&[&"drive", &i, &"rotor", &"ratio"]);
            let want =
                Requirement::Words("a gear ratio other than 0: 1 for a direct drive, below 0 to turn the other way");
            return Err(MachineError::OutOfRange { place, value: rotor.ratio, want });
        }
    }
    let rows = rows_of("link");
    for (i, link) in spec.links.iter().enumerate() {
        rows.iter().try_for_each(|row| row.check(spec, i))?;
        if !matches!(link.direction, -1 | 1) {
            let place = KeyPath::new(&[&"link", &i, &"direction"]);
            return Err(MachineError::OutOfRange {
                place,
                value: link.direction.into(),
                want: Requirement::Words("1 or -1"),
            });
        }
    }
    transverse::check(spec)?;
    check("counterweight", spec.counterweights.len())?;
    check_shapes(spec)?;
    for (i, angle) in spec.angles.iter().enumerate() {
        for (key, value) in [("offset", Some(angle.offset)), ("min", angle.min), ("max", angle.max)] {
            value.map_or(Ok(()), |value| within(ANGLE, value, || KeyPath::new(&[&"angle", &i, &key])))?;
        }
        match (angle.min, angle.max) {
            (Some(min), Some(max)) if min > max => {
                let place = KeyPath::new(&[&"angle", &i, &"max"]);
                let want = Requirement::Words("a limit not below min");
                return Err(MachineError::OutOfRange { place, value: max, want });
            }
            (Some(_), None) | (None, Some(_)) => {
                return Err(MachineError::HalfLimited {
                    place: KeyPath::new(&[&"angle", &i]),
                    angle: angle.name.clone(),
                });
            }
            _ => {}
        }
    }
    Ok(())
}

/// Checks that the sizes of each counterweight give one shape.
fn check_shapes(spec: &MachineSpec) -> Result<(), MachineError> {
    for (i, weight) in spec.counterweights.iter().enumerate() {
        let Counterweight { radius, inner_radius, half, length, width, .. } = *weight;
        let want = |key: &str, value, want| {
            let place = KeyPath::new(&[&"counterweight", &i, &key]);
            Err(MachineError::OutOfRange { place, value, want: Requirement::Words(want) })
        };
        if inner_radius > 0.0 && inner_radius >= radius {
            return want("inner_radius", inner_radius, "less than the radius");
        }
        if half && radius == 0.0 {
            return want("radius", radius, "a radius above 0, of which it is half");
        }
        if radius > 0.0 && (length > 0.0 || width > 0.0) {
            return want("radius", radius, "a radius, or a length and a width, not both");
        }
        if (length > 0.0) != (width > 0.0) {
            return match length > 0.0 {
                true => want("width", width, "a width above 0 beside its length"),
                false => want("length", length, "a length above 0 beside its width"),
            };
        }
    }
    Ok(())
}
