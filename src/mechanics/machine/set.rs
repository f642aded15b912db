//! Reads and changes settings of a machine by the keys of files, edits and `--set`.

use toml::{Table, Value};

use super::keys::{FieldAccess, KEYS, KeyRow, MACHINE_KEYS};
use super::words::{MachineWords, with_names};
use super::{KeyPath, Machine, MachineError, MachineSpec, Part, PlaceOnLink};
use stillbase_settings::change::{self, DEFAULT_WORD};
use stillbase_settings::key::{self, Key};
use stillbase_settings::key_path::AsKeyStep;
use stillbase_settings::mending::Vocabulary as _;

/// The tables and keys of a scenario that set its machine.
pub const MACHINE_TABLES: [&str; 10] =
    ["link", "material", "part", "lump", "counterweight", "length", "payload", "gravity", "limits", "drive"];

/// Returns whether a setting, such as `link.5.com`, belongs to the machine.
pub fn is_of_machine(path: &str) -> bool {
    MACHINE_TABLES.contains(&path.split('.').next().unwrap_or_default())
}

impl Machine {
    /// Returns the machine without its counterweights, except fixed ones.
    ///
    /// # Errors
    /// If the machine is not valid without them.
    pub fn without_counterweights(&self) -> Result<Self, MachineError> {
        let mut spec = self.spec().clone();
        spec.counterweights.retain(|weight| weight.fixed);
        Self::new(spec)
    }

    /// Returns the machine with one setting changed. `value` is a number, two numbers separated by a comma, `true` or
    /// `false`, or the word `default` or `none`.
    ///
    /// # Errors
    /// If there is no such key, the value cannot be read, or the machine would no longer be valid.
    pub fn set(&self, key: &str, value: &str) -> Result<Self, MachineError> {
        self.set_all([(key, value)])
    }

    /// Returns the machine with several settings changed together, checked once at the end.
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

    /// Returns the machine with the settings of nested tables changed: `{ link = { 5 = { com = -0.02 } } }`.
    ///
    /// # Errors
    /// As [`set`](Self::set).
    pub fn with_settings(&self, change: &Table) -> Result<Self, MachineError> {
        let mut spec = self.spec().clone();
        for (key, value) in change::leaves(change) {
            assign(&mut spec, &key, value)?;
        }
        Self::new(spec)
    }

    /// Returns whether a setting has an effect on this machine; `pushed` says whether a force acts on the end effector.
    pub fn uses(&self, key: &str, pushed: bool) -> bool {
        KeyRow::of(key).and_then(|row| row.uses).is_none_or(|uses| uses(self.spec(), pushed))
    }

    /// Returns the keys of settings that differ from their defaults but have no effect; `pushed` as in
    /// [`uses`](Self::uses).
    pub fn ineffective_keys(&self, pushed: bool) -> impl Iterator<Item = &'static str> {
        let is_given = |row: &KeyRow| !change::same_value(&row.value(self, 0), &change::value(row.key.default));
        let idle = move |row: &&KeyRow| row.uses.is_some_and(|uses| !uses(self.spec(), pushed)) && is_given(row);
        MACHINE_KEYS.iter().filter(idle).map(|row| row.key.path)
    }

    /// Returns the settings whose present values undo a change of others. A change of a bar that is cut anew makes it a
    /// part of its own, so all parts are put back as they are.
    pub fn settings_to_undo(&self, change: &Table) -> Vec<String> {
        let is_cut = |path: &str| {
            let number = path.strip_prefix("part.").and_then(|rest| rest.split('.').next()?.parse::<usize>().ok());
            number.and_then(|n| self.spec().parts.get(n.checked_sub(1)?)).is_some_and(Part::is_cut)
        };
        let mut paths: Vec<String> = change::leaves(change).into_iter().map(|(path, _)| path).collect();
        if paths.iter().any(|path| is_cut(path)) {
            paths.retain(|path| !path.starts_with("part."));
            paths.push("part".into());
        }
        paths
    }

    /// Returns the value of a setting; the word `default` if it is not given, `None` if there is no such key.
    pub fn value(&self, key: &str) -> Option<Value> {
        if let Some(list) = BodyList::of(key) {
            return list.value(self.spec());
        }
        let row = KeyRow::of(key)?;
        Some(row.value(self, body_of(self.spec(), key).ok()?))
    }
}

/// A list of bodies that a single key sets as a whole, as in a file.
struct BodyList {
    key: &'static str,
    want: &'static str,
    get: fn(&MachineSpec) -> Result<Vec<Value>, toml::ser::Error>,
    set: fn(&mut MachineSpec, Value) -> Result<(), toml::de::Error>,
}

macro_rules! body_list {
    ($key:literal, $field:ident, $want:literal) => {
        BodyList {
            key: $key,
            want: $want,
            get: |spec| spec.$field.iter().map(Value::try_from).collect(),
            set: |spec, list| list.try_into().map(|list| spec.$field = list),
        }
    };
}

const BODY_LISTS: [BodyList; 4] = [
    body_list!(
        "counterweight",
        counterweights,
        "a list of { link, mass, at, across, radius, fixed }, or the word default for none"
    ),
    body_list!("material", materials, "a list of { name, density }, or the word default for none"),
    body_list!("part", parts, "a list of parts, each { link, shape, … } as in a file, or the word default for none"),
    body_list!("lump", lumps, "a list of { link, name, mass, at, across, inertia }, or the word default for none"),
];

impl BodyList {
    fn of(key: &str) -> Option<&'static Self> {
        BODY_LISTS.iter().find(|list| list.key == key)
    }

    /// Returns the list; the word `default` if it is empty.
    fn value(&self, spec: &MachineSpec) -> Option<Value> {
        let all = (self.get)(spec).ok()?;
        Some(if all.is_empty() { DEFAULT_WORD.into() } else { Value::Array(all) })
    }

    fn assign(&self, spec: &mut MachineSpec, value: &Value) -> Result<(), MachineError> {
        let all = if is_default(value) { Value::Array(Vec::new()) } else { value.clone() };
        (self.set)(spec, all).map_err(|_| bad(self.key, value, self.want))
    }
}

fn assign(spec: &mut MachineSpec, key: &str, value: &Value) -> Result<(), MachineError> {
    if let Some(list) = BodyList::of(key) {
        return list.assign(spec, value);
    }
    let unknown =
        || MachineError::UnknownKey { key: key.into(), known: key::in_words(KEYS.map(|key| key.path)).join(", ") };
    if !MACHINE_KEYS.iter().any(|row| shares_head(row.key.path, key)) {
        return Err(unknown());
    }
    // Fails for a body that does not exist.
    let i = body_of(spec, key)?;
    let row = KeyRow::of(key).ok_or_else(unknown)?;
    // A required key has no default value.
    let default =
        Some(row.key.default).filter(|default| is_default(value) && *default != Key::REQUIRED).map(change::value);
    let (given, value) = (value, default.as_ref().unwrap_or(value));
    let part = if key.starts_with("part.") { spec.parts.get(i).cloned() } else { None };
    match row.at {
        FieldAccess::Number(_, of) => *of(spec, i) = number(key, value)?,
        FieldAccess::LinkNumber(of) => {
            // Its default is what the parts of the link give.
            let typed = if is_none(given) { None } else { Some(number(key, given)?) };
            spec.links[i].type_number(of, typed);
        }
        FieldAccess::Place(_, of) => *of(spec, i) = place(key, value)?,
        FieldAccess::Limit(_, of) => *of(spec, i) = if is_none(value) { None } else { Some(number(key, value)?) },
        FieldAccess::Pair(_, of) => *of(spec, i) = pair(key, value)?,
        FieldAccess::Switch(_, of) => *of(spec, i) = switch(key, value)?,
        FieldAccess::Bounds(_, of) => {
            let bounds = if is_none(value) { [None; 2] } else { pair(key, value)?.map(Some) };
            of(spec, i).into_iter().zip(bounds).for_each(|(end, to)| *end = to);
        }
        FieldAccess::Metres(_, set) => set(spec, i, number(key, value)?)?,
    }
    if part.is_some_and(|before| before != spec.parts[i]) {
        spec.parts[i] = spec.parts[i].clone().changed_by_hand();
    }
    Ok(())
}

/// Returns whether a key matches a pattern in all parts except the last, which may differ.
fn shares_head(pattern: &str, key: &str) -> bool {
    let (of, head) = (pattern.rsplit_once('.'), key.rsplit_once('.'));
    of.zip(head).map_or(pattern == key, |((pattern, _), (head, _))| key::names(pattern, head))
}

/// Returns the index of the body that a key belongs to, among those of its kind; 0 for kinds with a single body.
fn body_of(spec: &MachineSpec, key: &str) -> Result<usize, MachineError> {
    let mut parts = key.split('.');
    let (part, name) = (parts.next().unwrap_or_default(), parts.next().unwrap_or_default());
    let numbers: Vec<String>;
    let count = |count: usize| (1..=count).map(|number| number.to_string()).collect();
    let (what, names): (_, Vec<&str>) = match part {
        "link" => ("link", spec.links.iter().map(|link| link.name.as_str()).collect()),
        "counterweight" => {
            numbers = count(spec.counterweights.len());
            ("counterweight", numbers.iter().map(String::as_str).collect())
        }
        "part" => {
            numbers = count(spec.parts.len());
            ("part", numbers.iter().map(String::as_str).collect())
        }
        "lump" => {
            numbers = count(spec.lumps.len());
            ("lump", numbers.iter().map(String::as_str).collect())
        }
        "material" => ("material", spec.materials.iter().map(|material| material.name.as_str()).collect()),
        "length" => ("length", spec.lengths.keys().map(String::as_str).collect()),
        "limits" => ("angle", spec.angles.iter().map(|angle| angle.name.as_str()).collect()),
        "drive" => ("drive", spec.drives.iter().map(|drive| drive.name.as_str()).collect()),
        _ => return Ok(0),
    };
    names.iter().position(|known| *known == name).ok_or_else(|| MachineError::Unknown {
        place: KeyPath::new(&[&key]),
        what,
        name: name.into(),
        more: if names.is_empty() { first_of(spec, what, name).into() } else { "".into() },
        known: names.into_iter().map(Into::into).collect(),
    })
}

/// Says how a machine that has no angle, part … yet gets one of this name.
fn first_of(spec: &MachineSpec, what: &str, name: &str) -> String {
    let list = if what == "length" { "lengths" } else { what };
    let example = |path: &[&dyn AsKeyStep]| MachineWords.example(&KeyPath::new(path)).unwrap_or_default();
    // A length is named by its key, others by one in their table.
    let own = format!("name = {}", example(&[&list, &0, &"name"]));
    let named = example(&[&list]).replace("l1 =", &format!("{name} =")).replace(&own, &format!("name = {name:?}"));
    let links: Vec<&str> = spec.links.iter().map(|link| link.name.as_str()).collect();
    let drives: Vec<&str> = spec.drives.iter().map(|drive| drive.name.as_str()).collect();
    format!(
        "one that exists; there is none yet, so state it in the machine file first: {list} = {}",
        with_names(named, &links, &drives)
    )
}

fn is_default(value: &Value) -> bool {
    value.as_str() == Some(DEFAULT_WORD)
}

/// Returns whether a value removes an optional setting: the word `default` or [`Key::NONE`].
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

fn place(key: &str, value: &Value) -> Result<PlaceOnLink, MachineError> {
    let named = value.as_str().filter(|_| !is_default(value)).map(|name| PlaceOnLink::Named(name.into()));
    let place = || named.or_else(|| change::number(value).map(PlaceOnLink::Metres));
    place().ok_or_else(|| bad(key, value, "a place along the link: root, tip, a number in m, or a named length"))
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
