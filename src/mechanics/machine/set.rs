//! Settings of a machine by key, as files, edits and `--set` name them.

use toml::{Table, Value};

use super::error::quoted;
use super::keys::{At, KEYS, ROWS, Row};
use super::{Machine, MachineError, MachineSpec, Place};
use crate::settings::change::{self, DEFAULT};
use crate::settings::key::{self, Key};

/// The tables and keys of a scenario that set its machine.
pub const PARTS: [&str; 7] = ["link", "counterweight", "length", "payload", "gravity", "limits", "drive"];

/// Whether a setting, such as `link.5.com`, is of the machine.
pub fn is_of_machine(path: &str) -> bool {
    PARTS.contains(&path.split('.').next().unwrap_or_default())
}

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
        Row::of(key).and_then(|row| row.uses).is_none_or(|uses| uses(self.spec(), pushed))
    }

    /// The settings that are given and have no effect.
    pub fn idle_keys(&self, pushed: bool) -> impl Iterator<Item = &'static str> {
        let is_given = |row: &Row| !change::same(&row.value(self, 0), &change::value(row.key.default));
        let idle = move |row: &&Row| row.uses.is_some_and(|uses| !uses(self.spec(), pushed)) && is_given(row);
        ROWS.iter().filter(idle).map(|row| row.key.path)
    }

    /// What a setting holds; the word `default` for one that is not there, `None` if there is no such key.
    pub fn value(&self, key: &str) -> Option<Value> {
        let weights = &self.spec().counterweights;
        match key {
            "counterweight" if weights.is_empty() => Some(DEFAULT.into()),
            "counterweight" => Some(Value::Array(weights.iter().map(Value::try_from).collect::<Result<_, _>>().ok()?)),
            _ => {
                let row = Row::of(key)?;
                Some(row.value(self, body_of(self.spec(), key).ok()?))
            }
        }
    }
}

fn assign(spec: &mut MachineSpec, key: &str, value: &Value) -> Result<(), MachineError> {
    // All of them, as a file lists them.
    if key == "counterweight" {
        let want = "a list of { link, mass, at, radius, fixed }, or the word default for none";
        let all = || value.clone().try_into().map_err(|_| bad(key, value, want));
        spec.counterweights = if is_default(value) { Vec::new() } else { all()? };
        return Ok(());
    }
    let unknown =
        || MachineError::UnknownKey { key: key.into(), known: key::in_words(KEYS.map(|key| key.path)).join(", ") };
    if !ROWS.iter().any(|row| is_beside(row.key.path, key)) {
        return Err(unknown());
    }
    // Who is not there has no keys.
    let i = body_of(spec, key)?;
    let row = Row::of(key).ok_or_else(unknown)?;
    // The default of a key that has to be given is no value.
    let usual = Some(row.key.default).filter(|usual| is_default(value) && *usual != Key::REQUIRED).map(change::value);
    let value = usual.as_ref().unwrap_or(value);
    match row.at {
        At::Number(_, of) => *of(spec, i) = number(key, value)?,
        At::Limit(_, of) => *of(spec, i) = if is_none(value) { None } else { Some(number(key, value)?) },
        At::Pair(_, of) => *of(spec, i) = pair(key, value)?,
        At::Switch(_, of) => *of(spec, i) = switch(key, value)?,
        At::Ends(_, of) => {
            let ends = if is_none(value) { [None; 2] } else { pair(key, value)?.map(Some) };
            of(spec, i).into_iter().zip(ends).for_each(|(end, to)| *end = to);
        }
        At::Metres(_, set) => set(spec, i, number(key, value)?)?,
    }
    Ok(())
}

/// Whether a key is one of those that differ from a pattern in their last part only.
fn is_beside(pattern: &str, key: &str) -> bool {
    let (of, head) = (pattern.rsplit_once('.'), key.rsplit_once('.'));
    of.zip(head).map_or(pattern == key, |((pattern, _), (head, _))| key::names(pattern, head))
}

/// The place of the body that a key is of among those of its kind; the first of what there is one of.
fn body_of(spec: &MachineSpec, key: &str) -> Result<usize, MachineError> {
    let mut parts = key.split('.');
    let (part, name) = (parts.next().unwrap_or_default(), parts.next().unwrap_or_default());
    let numbers: Vec<String>;
    let (what, names): (_, Vec<&str>) = match part {
        "link" => ("link", spec.links.iter().map(|link| link.name.as_str()).collect()),
        "counterweight" => {
            numbers = (1..=spec.counterweights.len()).map(|number| number.to_string()).collect();
            ("counterweight", numbers.iter().map(String::as_str).collect())
        }
        "length" => ("length", spec.lengths.keys().map(String::as_str).collect()),
        "limits" => ("angle", spec.angles.iter().map(|angle| angle.name.as_str()).collect()),
        "drive" => ("drive", spec.drives.iter().map(|drive| drive.name.as_str()).collect()),
        _ => return Ok(0),
    };
    names.iter().position(|known| *known == name).ok_or_else(|| MachineError::Unknown {
        place: Place::new(&[&key]),
        what,
        name: name.into(),
        known: quoted(names.into_iter()),
    })
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
