//! Settings by key: part of a TOML table laid over a value, as files, edits and the command line name it.

use serde::Serialize;
use serde::de::DeserializeOwned;
use toml::{Table, Value};

use crate::settings::range::{clipped, shortened};

/// The word that takes a key out, so that its default returns.
pub const DEFAULT: &str = "default";

/// A value with some of its keys changed; tables inside it are changed key by key, and the word `default` takes a key
/// out.
///
/// # Errors
/// What key or value is wrong, and what would be right.
pub fn with<T: Serialize + DeserializeOwned>(value: &T, change: &Table) -> Result<T, String> {
    read(&laid(value, change)?)
}

/// The keys of a value with some of them changed, not yet read as a value.
///
/// # Errors
/// Which number is not finite.
pub fn laid<T: Serialize>(value: &T, change: &Table) -> Result<Table, String> {
    if let Some(key) = not_finite(change) {
        return Err(format!("{} is not a finite number: want one", clipped(&key)));
    }
    let mut table = Table::try_from(value).map_err(|e| e.to_string())?;
    lay(&mut table, change);
    Ok(table)
}

/// A value by its keys.
///
/// # Errors
/// What key or value is wrong, and what would be right.
pub fn read<T: DeserializeOwned>(table: &Table) -> Result<T, String> {
    table.clone().try_into().map_err(|e: toml::de::Error| shortened(e.message(), 300))
}

/// What the keys of a change hold now, so that [`with`] brings it back.
pub fn only<T: Serialize>(value: &T, change: &Table) -> Table {
    pick(&Table::try_from(value).unwrap_or_default(), change)
}

/// Whether a change sets every key that another sets.
pub fn covers(later: &Table, earlier: &Table) -> bool {
    earlier.iter().all(|(key, value)| match (value, later.get(key)) {
        (Value::Table(earlier), Some(Value::Table(later))) => covers(later, earlier),
        // Keys of what a whole value has brought do not stand for it.
        (_, found) => found.is_some_and(|found| !found.is_table()),
    })
}

/// A change of one key, its parts joined by dots.
pub fn one(key: &str, value: impl Into<Value>) -> Table {
    at(&key.split('.').collect::<Vec<_>>(), value)
}

/// A change of one key, by its parts.
pub fn at(path: &[&str], value: impl Into<Value>) -> Table {
    let Some((last, outer)) = path.split_last() else { return Table::new() };
    let innermost = Table::from_iter([((*last).to_owned(), value.into())]);
    outer.iter().rev().fold(innermost, |inner, key| Table::from_iter([((*key).to_owned(), Value::Table(inner))]))
}

/// A value as it would stand in a file: text where TOML knows no other reading, and a list of several numbers parted by
/// commas.
pub fn value(text: &str) -> Value {
    let read = |text: &str| {
        let table: Option<Table> = format!("x = {text}").parse().ok();
        // More than one line would be more than one value.
        table.filter(|table| table.len() == 1).and_then(|mut table| table.remove("x"))
    };
    // Such as `.5` and `5.`, which TOML does not take.
    let number = |text: &str| text.trim().parse::<f64>().ok().map(Value::Float);
    let text = text.trim();
    let list = || {
        let several = text.contains(',').then(|| read(&format!("[{text}]"))).flatten();
        several.or_else(|| {
            text.contains(',')
                .then(|| text.split(',').map(number).collect::<Option<Vec<_>>>())
                .flatten()
                .map(Value::Array)
        })
    };
    read(text).or_else(|| number(text)).or_else(list).unwrap_or_else(|| Value::String(text.into()))
}

/// Two changes as one; the second has the last word.
pub fn join(mut first: Table, second: &Table) -> Table {
    for (key, value) in second {
        let value = match (first.remove(key), value) {
            (Some(Value::Table(first)), Value::Table(second)) => Value::Table(join(first, second)),
            (_, value) => value.clone(),
        };
        first.insert(key.clone(), value);
    }
    first
}

/// The first key whose value is a number, or a list with one, that is not finite.
pub fn not_finite(table: &Table) -> Option<String> {
    fn within(value: &Value) -> bool {
        match value {
            Value::Float(x) => !x.is_finite(),
            Value::Array(list) => list.iter().any(within),
            _ => false,
        }
    }
    table.iter().find_map(|(key, value)| match value {
        Value::Table(inner) => not_finite(inner).map(|rest| format!("{key}.{rest}")),
        value => within(value).then(|| key.clone()),
    })
}

/// Every value of a table with its path, its keys joined by dots.
pub fn leaves(table: &Table) -> Vec<(String, &Value)> {
    let mut list = Vec::new();
    for (key, value) in table {
        match value {
            Value::Table(inner) => {
                list.extend(leaves(inner).into_iter().map(|(rest, value)| (format!("{key}.{rest}"), value)));
            }
            value => list.push((key.clone(), value)),
        }
    }
    list
}

/// A number, whole or not.
pub fn number(value: &Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|x| x as f64))
}

/// Whether two values say the same: 2 is 2.0.
pub fn same(a: &Value, b: &Value) -> bool {
    match (a, b) {
        (Value::Array(a), Value::Array(b)) => a.len() == b.len() && a.iter().zip(b).all(|(a, b)| same(a, b)),
        _ => number(a).zip(number(b)).map_or(a == b, |(a, b)| a == b),
    }
}

/// A value as it would be typed.
pub fn typed(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Array(items) if items.iter().all(|item| !item.is_array() && !item.is_table()) => {
            items.iter().map(typed).collect::<Vec<_>>().join(",")
        }
        value => value.to_string(),
    }
}

fn lay(table: &mut Table, change: &Table) {
    for (key, value) in change {
        match (value, table.get_mut(key)) {
            (Value::String(word), _) if word == DEFAULT => {
                table.remove(key);
            }
            (Value::Table(change), Some(Value::Table(inner))) => {
                lay(inner, change);
                if inner.is_empty() {
                    table.remove(key);
                }
            }
            (Value::Table(change), _) => {
                let mut inner = Table::new();
                lay(&mut inner, change);
                if !inner.is_empty() {
                    table.insert(key.clone(), Value::Table(inner));
                }
            }
            (value, _) => {
                table.insert(key.clone(), value.clone());
            }
        }
    }
}

fn pick(table: &Table, change: &Table) -> Table {
    let picked = |(key, value): (&String, &Value)| {
        let now = match (value, table.get(key)) {
            (Value::Table(change), Some(Value::Table(inner))) => Value::Table(pick(inner, change)),
            (_, now) => now.cloned().unwrap_or_else(|| DEFAULT.into()),
        };
        (key.clone(), now)
    };
    change.iter().map(picked).collect()
}
