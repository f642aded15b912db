//! Settings of a machine by key, as files, edits and `--set` name them.

use toml::{Table, Value};

use super::error::quoted;
use super::{Length, Machine, MachineError, MachineSpec, Place, Rotor};
use crate::settings::change::{self, DEFAULT};
use crate::settings::key::Key;
use crate::settings::range::{clipped, shortened};

/// The tables and keys of a scenario that set its machine.
pub const PARTS: [&str; 7] = ["link", "counterweight", "length", "payload", "gravity", "limits", "drive"];

/// Whether a setting, such as `link.5.com`, is of the machine.
pub fn is_of_machine(path: &str) -> bool {
    PARTS.contains(&path.split('.').next().unwrap_or_default())
}

const KEYS: &str = "link.NAME.(com|com_normal|mass|inertia|length|axial), counterweight.NUMBER.(mass|at|radius|fixed), \
                    length.NAME, \
                    payload.(mass|inertia|offset|axial), gravity, limits.ANGLE, \
                    drive.NAME.(torque|speed|acceleration|jerk)_limit, drive.NAME.rotor.(inertia|ratio)";

impl Machine {
    /// The same without its counterweights, but for those that are fixed.
    ///
    /// # Errors
    /// If only they make it a machine.
    pub fn without_counterweights(&self) -> Result<Self, MachineError> {
        let mut spec = self.spec().clone();
        spec.counterweights.retain(|weight| weight.fixed);
        Self::new(spec)
    }

    /// A machine with one setting changed; `value` is one number, two parted by a comma, or the word `default`.
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
            assign(&mut spec, key, &change::value(value))?;
        }
        Self::new(spec)
    }

    /// The same with the settings as tables: `{ link = { 5 = { com = -0.02 } } }`.
    ///
    /// # Errors
    /// As [`set`](Self::set).
    pub fn with(&self, change: &Table) -> Result<Self, MachineError> {
        let mut spec = self.spec().clone();
        for (key, value) in change::leaves(change) {
            assign(&mut spec, &key, value)?;
        }
        Self::new(spec)
    }

    /// Whether a setting has an effect as things are; `pushed` if a force is held at the end effector.
    pub fn uses(&self, key: &str, pushed: bool) -> bool {
        match key {
            "payload.offset" => self.spec().payload.mass > 0.0,
            "payload.axial" => self.spec().payload.mass > 0.0 || pushed,
            _ => true,
        }
    }

    /// The settings that are given and have no effect.
    pub fn idle_keys(&self, pushed: bool) -> impl Iterator<Item = &'static str> {
        let payload = &self.spec().payload;
        let given = [("payload.offset", payload.offset != [0.0; 2]), ("payload.axial", payload.axial != 0.0)];
        given.into_iter().filter(move |(key, given)| *given && !self.uses(key, pushed)).map(|(key, _)| key)
    }

    /// What a setting holds; the word `default` for one that is not there, `None` if there is no such key.
    pub fn value(&self, key: &str) -> Option<Value> {
        let spec = self.spec();
        let named = |name: &str| spec.links.iter().position(|l| l.name == name);
        let two = |pair: [f64; 2]| Value::from(pair.to_vec());
        let some = |x: Option<f64>| x.map_or_else(|| DEFAULT.into(), Value::from);
        Some(match *key.split('.').collect::<Vec<_>>() {
            ["link", name, field] => {
                let (link, part) = (&spec.links[named(name)?], &self.resolved_links()[named(name)?]);
                Value::from(match field {
                    "com" => link.com,
                    "com_normal" => link.com_normal,
                    "mass" => link.mass,
                    "inertia" => link.inertia,
                    "axial" => link.axial,
                    "length" => part.length,
                    _ => return None,
                })
            }
            ["counterweight"] if spec.counterweights.is_empty() => DEFAULT.into(),
            ["counterweight"] => {
                Value::Array(spec.counterweights.iter().map(Value::try_from).collect::<Result<_, _>>().ok()?)
            }
            ["counterweight", number, field] => {
                let weight = spec.counterweights.get(place_of(number)?)?;
                match field {
                    "mass" => weight.mass.into(),
                    "at" => weight.at.into(),
                    "radius" => weight.radius.into(),
                    "fixed" => weight.fixed.into(),
                    _ => return None,
                }
            }
            ["length", name] => (*spec.lengths.get(name)?).into(),
            ["payload", "mass"] => spec.payload.mass.into(),
            ["payload", "inertia"] => spec.payload.inertia.into(),
            ["payload", "offset"] => two(spec.payload.offset),
            ["payload", "axial"] => spec.payload.axial.into(),
            ["gravity"] => two(spec.gravity),
            ["limits", name] => {
                let angle = spec.angles.iter().find(|a| a.name == name)?;
                angle.min.zip(angle.max).map_or_else(|| DEFAULT.into(), |(min, max)| two([min, max]))
            }
            ["drive", name, "rotor", field] => {
                let rotor = spec.drives.iter().find(|d| d.name == name)?.rotor.unwrap_or_default();
                Value::from(match field {
                    "inertia" => rotor.inertia,
                    "ratio" => rotor.ratio,
                    _ => return None,
                })
            }
            ["drive", name, field] => {
                let drive = spec.drives.iter().find(|d| d.name == name)?;
                match field {
                    "torque_limit" => some(drive.torque_limit),
                    "speed_limit" => some(drive.speed_limit),
                    "acceleration_limit" => some(drive.acceleration_limit),
                    "jerk_limit" => some(drive.jerk_limit),
                    _ => return None,
                }
            }
            _ => return None,
        })
    }
}

fn assign(spec: &mut MachineSpec, key: &str, value: &Value) -> Result<(), MachineError> {
    let one = || number(key, value);
    let two = || pair(key, value);
    let two_or_zero = || if is_default(value) { Ok([0.0; 2]) } else { two() };
    let one_or_zero = || if is_default(value) { Ok(0.0) } else { one() };
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
            match field {
                "com" => link.com = one()?,
                "com_normal" => link.com_normal = one_or_zero()?,
                "mass" => link.mass = one()?,
                "inertia" => link.inertia = one()?,
                "axial" => link.axial = one_or_zero()?,
                _ => return Err(unknown()),
            }
        }
        // All of them, as a file lists them.
        ["counterweight"] if is_default(value) => spec.counterweights.clear(),
        ["counterweight"] => {
            let want = "a list of { link, mass, at, radius, fixed }, or the word default for none";
            spec.counterweights = value.clone().try_into().map_err(|_| bad(key, value, want))?;
        }
        ["counterweight", number, field] => {
            let known: Vec<String> = (1..=spec.counterweights.len()).map(|i| i.to_string()).collect();
            let missing = nobody("counterweight", number, known.iter().map(String::as_str).collect());
            let place = place_of(number).filter(|i| *i < spec.counterweights.len()).ok_or(missing)?;
            let weight = &mut spec.counterweights[place];
            match field {
                "mass" => weight.mass = one()?,
                "at" => weight.at = one()?,
                "radius" => weight.radius = one_or_zero()?,
                "fixed" => weight.fixed = !is_default(value) && switch(key, value)?,
                _ => return Err(unknown()),
            }
        }
        ["length", name] => {
            let known = spec.lengths.keys().map(String::as_str).collect();
            let missing = nobody("length", name, known);
            *spec.lengths.get_mut(name).ok_or(missing)? = one()?;
        }
        ["payload", "mass"] => spec.payload.mass = one_or_zero()?,
        ["payload", "inertia"] => spec.payload.inertia = one_or_zero()?,
        ["payload", "offset"] => spec.payload.offset = two_or_zero()?,
        ["payload", "axial"] => spec.payload.axial = one_or_zero()?,
        ["gravity"] => spec.gravity = two_or_zero()?,
        ["limits", name] => {
            let known = spec.angles.iter().map(|a| a.name.as_str()).collect();
            let missing = nobody("angle", name, known);
            let angle = spec.angles.iter_mut().find(|a| a.name == name).ok_or(missing)?;
            [angle.min, angle.max] = if is_none(value) { [None; 2] } else { two()?.map(Some) };
        }
        ["drive", name, "rotor", field] => {
            let known = spec.drives.iter().map(|d| d.name.as_str()).collect();
            let missing = nobody("drive", name, known);
            let drive = spec.drives.iter_mut().find(|d| d.name == name).ok_or(missing)?;
            let rotor = drive.rotor.get_or_insert(Rotor::default());
            match field {
                "inertia" => rotor.inertia = one_or_zero()?,
                "ratio" => rotor.ratio = if is_default(value) { Rotor::default().ratio } else { one()? },
                _ => return Err(unknown()),
            }
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
            } = if is_none(value) { None } else { Some(one()?) };
        }
        _ => return Err(unknown()),
    }
    Ok(())
}

/// Of a number that counts from 1, written as such.
fn place_of(number: &str) -> Option<usize> {
    number.parse::<usize>().ok().filter(|i| i.to_string() == number)?.checked_sub(1)
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

fn is_default(value: &Value) -> bool {
    value.as_str() == Some(DEFAULT)
}

/// Whether a value takes out what stands by default for nothing.
fn is_none(value: &Value) -> bool {
    is_default(value) || value.as_str() == Some(Key::NONE)
}

fn bad(key: &str, value: &Value, want: &'static str) -> MachineError {
    let value = value.as_str().map_or_else(|| value.to_string(), Into::into);
    MachineError::BadValue { key: key.into(), value, want }
}

fn number(key: &str, value: &Value) -> Result<f64, MachineError> {
    let want = if is_default(value) { "one number: there is no default" } else { "one number" };
    change::number(value).ok_or_else(|| bad(key, value, want))
}

fn switch(key: &str, value: &Value) -> Result<bool, MachineError> {
    value.as_bool().ok_or_else(|| bad(key, value, "true or false"))
}

fn pair(key: &str, value: &Value) -> Result<[f64; 2], MachineError> {
    let both = value.as_array().and_then(|list| match &list[..] {
        [a, b] => Some([change::number(a)?, change::number(b)?]),
        _ => None,
    });
    both.ok_or_else(|| bad(key, value, "two numbers, A,B"))
}
