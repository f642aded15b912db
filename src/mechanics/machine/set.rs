//! One setting of a machine by key, as `--set` and edits name it.

use super::error::quoted;
use super::{Length, Machine, MachineError, MachineSpec, Place};
use crate::settings::range::{clipped, shortened};

const KEYS: &str = "link.NAME.(com|com_normal|mass|inertia|length|axial), length.NAME, \
                    payload.(mass|inertia|offset|axial), gravity, limits.ANGLE, \
                    drive.NAME.(torque|speed|acceleration|jerk)_limit";

impl Machine {
    /// A machine with one setting changed; `value` is one number, or two parted by a comma.
    ///
    /// # Errors
    /// If there is no such key, the value cannot be read, or the machine would no longer be valid.
    pub fn set(&self, key: &str, value: &str) -> Result<Self, MachineError> {
        self.set_all([(key, value)])
    }

    /// A machine with several settings changed together, checked once at the end.
    ///
    /// # Errors
    /// As [`set`](Self::set).
    pub fn set_all<'a>(&self, pairs: impl IntoIterator<Item = (&'a str, &'a str)>) -> Result<Self, MachineError> {
        let mut spec = self.spec().clone();
        for (key, value) in pairs {
            assign(&mut spec, key, value)?;
        }
        Self::new(spec)
    }

    /// The value of a setting, as [`set`](Self::set) would take it; `None` if there is no such key.
    pub fn get(&self, key: &str) -> Option<String> {
        let spec = self.spec();
        let named = |name: &str| spec.links.iter().position(|l| l.name == name);
        let two = |[a, b]: [f64; 2]| format!("{a},{b}");
        match *key.split('.').collect::<Vec<_>>() {
            ["link", name, field] => {
                let (link, part) = (&spec.links[named(name)?], &self.resolved_links()[named(name)?]);
                Some(match field {
                    "com" => link.com,
                    "com_normal" => link.com_normal,
                    "mass" => link.mass,
                    "inertia" => link.inertia,
                    "axial" => link.axial,
                    "length" => part.length,
                    _ => return None,
                })
                .map(|x| x.to_string())
            }
            ["length", name] => spec.lengths.get(name).map(f64::to_string),
            ["payload", "mass"] => Some(spec.payload.mass.to_string()),
            ["payload", "inertia"] => Some(spec.payload.inertia.to_string()),
            ["payload", "offset"] => Some(two(spec.payload.offset)),
            ["payload", "axial"] => Some(spec.payload.axial.to_string()),
            ["gravity"] => Some(two(spec.gravity)),
            ["limits", name] => spec.angles.iter().find(|a| a.name == name).map(|a| two([a.min, a.max])),
            ["drive", name, field] => {
                let drive = spec.drives.iter().find(|d| d.name == name)?;
                match field {
                    "torque_limit" => drive.torque_limit,
                    "speed_limit" => drive.speed_limit,
                    "acceleration_limit" => drive.acceleration_limit,
                    "jerk_limit" => drive.jerk_limit,
                    _ => None,
                }
                .map(|x| x.to_string())
            }
            _ => None,
        }
    }
}

fn assign(spec: &mut MachineSpec, key: &str, value: &str) -> Result<(), MachineError> {
    let one = || number(key, value);
    let two = || pair(key, value);
    let unknown = || MachineError::UnknownKey { key: key.into(), known: KEYS.into() };
    let nobody = |what: &'static str, name: &str, known: Vec<&str>| MachineError::Unknown {
        place: Place::new(&[&key]),
        what,
        name: name.into(),
        known: quoted(known.into_iter()),
    };
    match *key.split('.').collect::<Vec<_>>() {
        ["link", name, field] => {
            let Some(j) = spec.links.iter().position(|l| l.name == name) else {
                return Err(nobody("link", name, spec.links.iter().map(|l| l.name.as_str()).collect()));
            };
            if field == "length" {
                return set_link_length(spec, j, one()?);
            }
            let link = &mut spec.links[j];
            *match field {
                "com" => &mut link.com,
                "com_normal" => &mut link.com_normal,
                "mass" => &mut link.mass,
                "inertia" => &mut link.inertia,
                "axial" => &mut link.axial,
                _ => return Err(unknown()),
            } = one()?;
        }
        ["length", name] => {
            let known = spec.lengths.keys().map(String::as_str).collect();
            let missing = nobody("length", name, known);
            *spec.lengths.get_mut(name).ok_or(missing)? = one()?;
        }
        ["payload", "mass"] => spec.payload.mass = one()?,
        ["payload", "inertia"] => spec.payload.inertia = one()?,
        ["payload", "offset"] => spec.payload.offset = two()?,
        ["payload", "axial"] => spec.payload.axial = one()?,
        ["gravity"] => spec.gravity = two()?,
        ["limits", name] => {
            let known = spec.angles.iter().map(|a| a.name.as_str()).collect();
            let missing = nobody("angle", name, known);
            let angle = spec.angles.iter_mut().find(|a| a.name == name).ok_or(missing)?;
            [angle.min, angle.max] = two()?;
        }
        ["drive", name, field] => {
            let known = spec.drives.iter().map(|d| d.name.as_str()).collect();
            let missing = nobody("drive", name, known);
            let drive = spec.drives.iter_mut().find(|d| d.name == name).ok_or(missing)?;
            *match field {
                "torque_limit" => &mut drive.torque_limit,
                "speed_limit" => &mut drive.speed_limit,
                "acceleration_limit" => &mut drive.acceleration_limit,
                "jerk_limit" => &mut drive.jerk_limit,
                _ => return Err(unknown()),
            } = Some(one()?);
        }
        _ => return Err(unknown()),
    }
    Ok(())
}

/// A length may be set through its only bar; one that others share, or that a point is named by, may not.
fn set_link_length(spec: &mut MachineSpec, j: usize, metres: f64) -> Result<(), MachineError> {
    let name = match &mut spec.links[j].length {
        Length::Metres(l) => {
            *l = metres;
            return Ok(());
        }
        Length::Named(name) => name.clone(),
    };
    let others: Vec<&str> = spec
        .links
        .iter()
        .enumerate()
        .filter(|(i, l)| *i != j && l.length == Length::Named(name.clone()))
        .map(|(_, l)| l.name.as_str())
        .collect();
    if !others.is_empty() {
        let plural = if others.len() > 1 { "links" } else { "link" };
        return Err(MachineError::SharedLength {
            link: clipped(&spec.links[j].name),
            length: clipped(&name),
            sharers: format!("{plural} {}", shortened(&others.join(", "), 200)),
        });
    }
    spec.lengths.insert(name, metres);
    Ok(())
}

fn number(key: &str, value: &str) -> Result<f64, MachineError> {
    value.trim().parse().map_err(|_| MachineError::BadValue {
        key: key.into(),
        value: value.into(),
        want: "one number",
    })
}

fn pair(key: &str, value: &str) -> Result<[f64; 2], MachineError> {
    let bad = || MachineError::BadValue { key: key.into(), value: value.into(), want: "two numbers, A,B" };
    let (a, b) = value.split_once(',').ok_or_else(bad)?;
    Ok([a.trim().parse().map_err(|_| bad())?, b.trim().parse().map_err(|_| bad())?])
}
