//! Settings by key: part of a TOML table laid over a value, as files, edits and the command line name it.

use serde::Serialize;
use serde::de::DeserializeOwned;
use toml::{Table, Value};

use crate::settings::range::shortened;

/// The word that takes a key out, so that its default returns.
const DEFAULT: &str = "default";

/// A value with some of its keys changed; tables inside it are changed key by key, and the word `default` takes a key
/// out.
///
/// # Errors
/// What key or value is wrong, and what would be right.
pub fn with<T: Serialize + DeserializeOwned>(value: &T, change: &Table) -> Result<T, String> {
    if let Some(key) = not_finite(change) {
        return Err(format!("{key} is not a finite number: want one"));
    }
    let mut table = Table::try_from(value).map_err(|e| e.to_string())?;
    lay(&mut table, change);
    table.try_into().map_err(|e: toml::de::Error| shortened(e.message(), 300))
}

/// What the keys of a change hold now, so that [`with`] brings it back.
pub fn only<T: Serialize>(value: &T, change: &Table) -> Table {
    pick(&Table::try_from(value).unwrap_or_default(), change)
}

/// Whether a change sets every key that another sets.
pub fn covers(later: &Table, earlier: &Table) -> bool {
    earlier.iter().all(|(key, value)| match (value, later.get(key)) {
        (Value::Table(earlier), Some(Value::Table(later))) => covers(later, earlier),
        (_, found) => found.is_some(),
    })
}

/// The change that takes out every key of a value, whatever keys it has: [`with`] makes all of it default.
pub fn to_defaults<T: Serialize>(value: &T) -> Table {
    let table = Table::try_from(value).unwrap_or_default();
    table.into_iter().map(|(key, _)| (key, DEFAULT.into())).collect()
}

/// A change of one key, its parts joined by dots.
pub fn one(key: &str, value: impl Into<Value>) -> Table {
    match key.split_once('.') {
        Some((head, rest)) => Table::from_iter([(head.to_owned(), Value::Table(one(rest, value)))]),
        None => Table::from_iter([(key.to_owned(), value.into())]),
    }
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

/// Every key of a change with its value, as `a.b = 1`.
pub fn listed(change: &Table) -> Vec<(String, String)> {
    let mut list = Vec::new();
    for (key, value) in change {
        match value {
            Value::Table(inner) => {
                list.extend(listed(inner).into_iter().map(|(rest, value)| (format!("{key}.{rest}"), value)));
            }
            value => list.push((key.clone(), value.as_str().map_or_else(|| value.to_string(), Into::into))),
        }
    }
    list
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
            (Value::Table(change), None) => Value::Table(pick(&Table::new(), change)),
            (_, now) => now.cloned().unwrap_or_else(|| DEFAULT.into()),
        };
        (key.clone(), now)
    };
    change.iter().map(picked).collect()
}
