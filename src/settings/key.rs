//! [`Key`]: one setting of a scenario and its description. Each key is defined once, in the table of its part. Files,
//! `--set`, edits, the window's rows with their ranges and tips, and the reference of all keys use this definition.

use std::fmt;

use toml::{Table, Value};

use super::change::{self, DEFAULT_WORD};
use super::range::{Range, RangeCheck};

/// One setting.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Key {
    /// Parts of the key joined by dots; `*` is the name of a link, length, drive, angle or material, or the
    /// number of a counterweight, part or lump.
    pub path: &'static str,
    /// Type and range of the value.
    pub value_type: KeyType,
    /// Default if a file omits the key, written as in a file. [`NONE`](Self::NONE) if a missing key has no value,
    /// [`REQUIRED`](Self::REQUIRED) if the key must be given.
    pub default: &'static str,
    /// Meaning, in one sentence.
    pub meaning: &'static str,
    /// Condition under which the key has an effect; empty for always.
    pub when: &'static str,
    /// Description of what applies if the key has no value.
    pub instead: &'static str,
    /// Part of a run that a change of the key affects.
    pub effect: Effect,
}

/// Part of a run that a change of a key affects, from the least to the most.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Effect {
    /// No frame of the run, but only studies, designs or recordings. Such a key applies to the whole run.
    NoFrame,
    /// No frame of the run, but only the display from the present step on.
    Picture,
    /// Frames from the present step on.
    Motion,
    /// The plan of the motion: such a key can change only before the first step.
    Plan,
}

/// Type and range of the value of a key.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum KeyType {
    /// A number.
    Number(Range),
    /// A whole number.
    Whole(Range),
    /// One number for all drives, or a list with one for each.
    PerDrive(Range),
    /// This many numbers, separated by commas.
    List(usize, Range),
    /// One of two numbers of numbers.
    EitherList([usize; 2], Range),
    /// Points, each of this many coordinates.
    Points(usize, Range),
    /// This many names.
    Names(usize),
    /// One of these words.
    Choice(&'static [&'static str]),
    /// `true` or `false`.
    Switch,
    /// Bounds on a number in an optimisation: the word `fixed` or `free`, or its lower and upper bound.
    Bounds(Range),
    /// Distribution of a value: `normal:` or `uniform:` and an amount, in its unit or in percent.
    Spread(&'static str),
    /// Rows of numbers, from a file.
    Rows,
}

impl Key {
    /// Default of a key that may be absent; as a value, it removes such a key.
    pub const NONE: &'static str = "none";
    /// Default of a key that must be given.
    pub const REQUIRED: &'static str = "";

    /// Returns a key that always has an effect.
    pub const fn new(path: &'static str, value_type: KeyType, default: &'static str, meaning: &'static str) -> Self {
        Self { path, value_type, default, meaning, when: "", instead: "", effect: Effect::Motion }
    }

    /// Returns a key that holds a number.
    pub const fn number(path: &'static str, range: Range, default: &'static str, words: &'static str) -> Self {
        Self::new(path, KeyType::Number(range), default, words)
    }

    /// Returns the key with the condition under which it has an effect.
    #[must_use]
    pub const fn when(self, when: &'static str) -> Self {
        Self { when, ..self }
    }

    /// Returns the key with a description of what applies if it is absent.
    #[must_use]
    pub const fn instead(self, instead: &'static str) -> Self {
        Self { instead, ..self }
    }

    /// Returns the key with another effect than [`Effect::Motion`].
    #[must_use]
    pub const fn reaching(self, effect: Effect) -> Self {
        Self { effect, ..self }
    }

    /// Returns the keys, all with the same effect.
    #[must_use]
    pub const fn all_reaching<const N: usize>(effect: Effect, keys: &[Self]) -> [Self; N] {
        let mut all = [keys[0]; N];
        let mut i = 0;
        while i < N {
            all[i] = keys[i].reaching(effect);
            i += 1;
        }
        all
    }

    /// Returns the part of a scenario that the key belongs to: the first word of its path.
    pub fn part(&self) -> &'static str {
        self.path.split('.').next().unwrap_or_default()
    }

    /// Returns the default in words: that the key must be given, the value, or what applies instead.
    pub fn default_in_words(&self) -> String {
        match (self.default, self.instead) {
            (Self::REQUIRED, "") => "has to be given".into(),
            (Self::REQUIRED, instead) => format!("has to be given; without it {instead}"),
            (default, "") => format!("`{default}`"),
            (default, instead) => format!("`{default}`: {instead}"),
        }
    }

    /// Returns whether a path names this key.
    pub fn matches(&self, path: &str) -> bool {
        names(self.path, path)
    }

    /// Returns the range of the key's numbers, if its value contains any.
    pub const fn range(&self) -> Option<Range> {
        match self.value_type {
            KeyType::Number(range)
            | KeyType::Whole(range)
            | KeyType::PerDrive(range)
            | KeyType::List(_, range)
            | KeyType::EitherList(_, range)
            | KeyType::Bounds(range)
            | KeyType::Points(_, range) => Some(range),
            KeyType::Names(_) | KeyType::Choice(_) | KeyType::Switch | KeyType::Spread(_) | KeyType::Rows => None,
        }
    }

    /// Returns the unit of the key's numbers.
    pub const fn unit(&self) -> &'static str {
        match self.value_type {
            KeyType::Spread(unit) => unit,
            _ => match self.range() {
                Some(range) => range.unit(),
                None => "",
            },
        }
    }

    /// Returns the unit of each of the key's numbers; empty if they have none, or different ones.
    pub fn unit_of_each(&self) -> &'static str {
        match self.unit() {
            // Angles of several turns have a unit that says so.
            unit if unit.starts_with("rad, ") => "rad",
            unit if unit.contains(", ") || unit.contains(" or ") => "",
            unit => unit,
        }
    }
}

/// Words that may replace the bounds on a number.
pub const HOLD_WORDS: [&str; 2] = ["fixed", "free"];

impl KeyType {
    /// Returns this type with its numbers limited to a range, if it contains any.
    #[must_use]
    pub const fn within(self, range: Range) -> Self {
        match self {
            Self::Number(_) => Self::Number(range),
            Self::Whole(_) => Self::Whole(range),
            Self::PerDrive(_) => Self::PerDrive(range),
            Self::List(count, _) => Self::List(count, range),
            Self::EitherList(counts, _) => Self::EitherList(counts, range),
            Self::Points(count, _) => Self::Points(count, range),
            Self::Bounds(_) => Self::Bounds(range),
            Self::Names(_) | Self::Choice(_) | Self::Switch | Self::Spread(_) | Self::Rows => self,
        }
    }

    /// Returns whether a value has this type; the word `default` always does.
    pub fn accepts(&self, value: &Value) -> bool {
        let number = |value: &Value| change::number(value).is_some();
        let list = |value: &Value, count: Option<usize>| {
            let fits = |list: &Vec<Value>| count.is_none_or(|n| list.len() == n) && list.iter().all(number);
            value.as_array().is_some_and(fits)
        };
        if value.as_str() == Some(DEFAULT_WORD) {
            return true;
        }
        match self {
            Self::Number(_) => number(value),
            Self::Whole(range) => {
                value.as_integer().is_some_and(|whole| u32::try_from(whole).is_ok() || range.contains(whole as f64))
            }
            Self::PerDrive(_) => number(value) || list(value, None),
            Self::List(count, _) => list(value, Some(*count)),
            Self::EitherList(counts, _) => counts.iter().any(|count| list(value, Some(*count))),
            Self::Points(count, _) => {
                value.as_array().is_some_and(|points| points.iter().all(|p| list(p, Some(*count))))
            }
            Self::Names(1) => value.is_str(),
            Self::Names(count) => {
                value.as_array().is_some_and(|names| names.len() == *count && names.iter().all(Value::is_str))
            }
            Self::Choice(words) => value.as_str().is_some_and(|word| words.contains(&word)),
            Self::Switch => value.is_bool(),
            Self::Bounds(_) => value.as_str().is_some_and(|word| HOLD_WORDS.contains(&word)) || list(value, Some(2)),
            Self::Spread(_) => value.is_table(),
            Self::Rows => true,
        }
    }
}

impl fmt::Display for KeyType {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(range) => range.fmt(f),
            Self::Whole(range) => write!(f, "a whole number, {range}"),
            Self::PerDrive(range) => write!(f, "{range}, for all drives or a list with one for each"),
            Self::List(count, range) => write!(f, "{count} numbers, each {range}"),
            Self::EitherList([one, other], range) => write!(f, "{one} or {other} numbers, each {range}"),
            Self::Points(2, range) => write!(f, "points [[x, y], …], each {range}"),
            Self::Points(_, range) => write!(f, "points [[x, y, z], …], each {range}"),
            Self::Names(1) => f.write_str("a name"),
            Self::Names(count) => write!(f, "{count} names"),
            Self::Choice(words) => f.write_str(&words.join(", ")),
            Self::Switch => f.write_str("true or false"),
            Self::Bounds(range) => write!(f, "{}, or the least and the greatest, each {range}", HOLD_WORDS.join(", ")),
            Self::Spread(unit) => write!(f, "normal:σ or uniform:half-width, 0 or more, in {unit} or %"),
            Self::Rows => f.write_str("rows of numbers"),
        }
    }
}

/// Returns whether a path matches a pattern, in which `*` matches any name.
pub fn names(pattern: &str, path: &str) -> bool {
    let (mut pattern, mut path) = (pattern.split('.'), path.split('.'));
    loop {
        match (pattern.next(), path.next()) {
            (None, None) => return true,
            (Some(p), Some(k)) if p == k || p == "*" => {}
            _ => return false,
        }
    }
}

/// Returns a check of every number of a table against the range of its key.
pub fn checks(key_of: impl Fn(&str) -> Option<&'static Key>, table: &Table) -> Vec<RangeCheck> {
    let mut list = Vec::new();
    for (path, value) in change::leaves(table) {
        if let Some(range) = key_of(&path).and_then(Key::range) {
            numbers(&path, value, range, &mut list);
        }
    }
    list
}

fn numbers(path: &str, value: &Value, range: Range, list: &mut Vec<RangeCheck>) {
    match value {
        // Each point of a list is named by its index, counted from 1.
        Value::Array(items) if items.iter().any(Value::is_array) => {
            items.iter().enumerate().for_each(|(i, item)| numbers(&format!("{path}[{}]", i + 1), item, range, list));
        }
        Value::Array(items) => items.iter().for_each(|item| numbers(path, item, range, list)),
        value => list.extend(change::number(value).map(|x| range.check(path.to_owned(), x))),
    }
}

/// Returns keys in words, grouped by the table they belong to: `link.NAME.(com|mass)`, `gravity`.
pub fn in_words(paths: impl IntoIterator<Item = &'static str>) -> Vec<String> {
    // Each path without its last part, with all last parts that follow it.
    let mut groups: Vec<(&str, Vec<&str>)> = Vec::new();
    for path in paths {
        let named = path.rsplit_once('.').filter(|(_, field)| *field != "*");
        let (head, field) = named.unwrap_or((path, ""));
        match groups.iter_mut().find(|(known, _)| *known == head) {
            Some((_, fields)) => fields.push(field),
            None => groups.push((head, vec![field])),
        }
    }
    // The keys of a table itself come before those of its subtables.
    let part = |head: &'static str| head.split('.').next();
    let parts: Vec<_> = groups.iter().map(|(head, _)| part(head)).collect();
    groups.sort_by_key(|(head, _)| (parts.iter().position(|known| *known == part(head)), head.matches('.').count()));
    groups.iter().map(|(head, fields)| group(head, fields)).collect()
}

fn group(head: &str, fields: &[&str]) -> String {
    let name = match head.split('.').next() {
        Some("counterweight" | "part" | "lump") => "NUMBER",
        Some("limits") => "ANGLE",
        _ => "NAME",
    };
    let head = head.replace('*', name);
    // An ending that all fields share, such as `_limit`, is written once.
    let ending = fields.first().and_then(|field| Some(&field[field.rfind('_')?..])).unwrap_or_default();
    let stems: Option<Vec<&str>> = fields.iter().map(|field| field.strip_suffix(ending)).collect();
    match (fields, stems) {
        ([""], _) => head,
        ([only], _) => format!("{head}.{only}"),
        (_, Some(stems)) => format!("{head}.({}){ending}", stems.join("|")),
        (_, None) => format!("{head}.({})", fields.join("|")),
    }
}
