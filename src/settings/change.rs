//! Settings by key: a partial TOML table is merged into a value, with the keys that files, edits and the command line
//! use.

use serde::Serialize;
use serde::de::DeserializeOwned;
use toml::{Table, Value};

use crate::number::nine_digits;
use crate::range::{MAX_SAID, quote_clipped, shortened};

/// Word that removes a key, so that its default applies.
pub const DEFAULT_WORD: &str = "default";

/// Returns a value with some of its keys changed. Nested tables are changed key by key; the word `default` removes a
/// key.
///
/// # Errors
/// Says which key or value is wrong, and what is accepted.
pub fn with_changes<T: Serialize + DeserializeOwned>(value: &T, change: &Table) -> Result<T, String> {
    read(&merged_keys(value, change)?)
}

/// Returns the keys of a value with some of them changed, not yet converted to a value.
///
/// # Errors
/// Says which number is not finite.
pub fn merged_keys<T: Serialize>(value: &T, change: &Table) -> Result<Table, String> {
    if let Some(key) = not_finite(change) {
        return Err(format!("{} is not a finite number: want one", quote_clipped(&key)));
    }
    let mut table = Table::try_from(value).map_err(|e| e.to_string())?;
    apply_change(&mut table, change);
    Ok(table)
}

/// Converts a table of keys to a value.
///
/// # Errors
/// Says which key or value is wrong, and what is accepted.
pub fn read<T: DeserializeOwned>(table: &Table) -> Result<T, String> {
    table.clone().try_into().map_err(|e: toml::de::Error| shortened(e.message(), MAX_SAID))
}

/// Returns the current values of the keys of a change, so that [`with_changes`] restores them.
pub fn present_values<T: Serialize>(value: &T, change: &Table) -> Table {
    pick(&Table::try_from(value).unwrap_or_default(), change)
}

/// Returns whether the later change sets every key that the earlier one sets.
pub fn covers(later: &Table, earlier: &Table) -> bool {
    earlier.iter().all(|(key, value)| match (value, later.get(key)) {
        (Value::Table(earlier), Some(Value::Table(later))) => covers(later, earlier),
        // A nested table sets only some keys, so it does not cover a key that was set as a whole.
        (_, found) => found.is_some_and(|found| !found.is_table()),
    })
}

/// Returns a change of one key, given as its parts joined by dots.
pub fn single_change(key: &str, value: impl Into<Value>) -> Table {
    at(&key.split('.').collect::<Vec<_>>(), value)
}

/// Returns a change of one key, given by its parts.
pub fn at(path: &[&str], value: impl Into<Value>) -> Table {
    let Some((last, outer)) = path.split_last() else { return Table::new() };
    let innermost = Table::from_iter([((*last).to_owned(), value.into())]);
    outer.iter().rev().fold(innermost, |inner, key| Table::from_iter([((*key).to_owned(), Value::Table(inner))]))
}

/// Reads a value as a file would state it. Several numbers separated by commas become a list; anything else that TOML
/// cannot read becomes a string.
pub fn value(text: &str) -> Value {
    let read = |text: &str| {
        let table: Option<Table> = format!("x = {text}").parse().ok();
        // More than one line would set more than one key.
        table.filter(|table| table.len() == 1).and_then(|mut table| table.remove("x"))
    };
    // For forms such as `.5` and `5.`, which TOML does not accept.
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

/// Merges two changes; the second takes precedence.
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

/// Returns the first key whose value is a number, or a list with a number, that is not finite.
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

/// Returns every value of a table with its path: its keys joined by dots.
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

/// Returns the number in a value, integer or not.
pub fn number(value: &Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|x| x as f64))
}

/// Returns whether two values are equal, where 2 equals 2.0.
pub fn same_value(a: &Value, b: &Value) -> bool {
    match (a, b) {
        (Value::Array(a), Value::Array(b)) => a.len() == b.len() && a.iter().zip(b).all(|(a, b)| same_value(a, b)),
        _ => number(a).zip(number(b)).map_or(a == b, |(a, b)| a == b),
    }
}

/// Returns a value as a person would type it.
pub fn typed(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Array(items) if items.iter().all(|item| !item.is_array() && !item.is_table()) => {
            items.iter().map(typed).collect::<Vec<_>>().join(",")
        }
        value => value.to_string(),
    }
}

/// Whether a value consists of numbers only.
pub fn is_of_numbers(value: &Value) -> bool {
    match value {
        Value::Integer(_) | Value::Float(_) => true,
        Value::Array(items) => items.iter().all(is_of_numbers),
        _ => false,
    }
}

/// Returns a value as typed, for reading: its numbers have at most nine digits, and are multiplied by a factor if there
/// is one.
pub fn typed_short(value: &Value, factor: Option<f64>) -> String {
    typed(&rounded(value, factor))
}

fn rounded(value: &Value, factor: Option<f64>) -> Value {
    let round = |x: f64| {
        let x: f64 = nine_digits(x).parse().unwrap_or(x);
        // A whole number is written without decimals.
        if x.fract() == 0.0 && x.abs() < 1e9 { Value::Integer(x as i64) } else { Value::Float(x) }
    };
    match (value, factor) {
        (Value::Float(x), _) if x.is_finite() => round(x * factor.unwrap_or(1.0)),
        (Value::Integer(x), Some(factor)) => round(*x as f64 * factor),
        (Value::Array(items), _) => Value::Array(items.iter().map(|item| rounded(item, factor)).collect()),
        (Value::Table(table), _) => {
            Value::Table(table.iter().map(|(key, item)| (key.clone(), rounded(item, factor))).collect())
        }
        (value, _) => value.clone(),
    }
}

fn apply_change(table: &mut Table, change: &Table) {
    for (key, value) in change {
        match (value, table.get_mut(key)) {
            (Value::String(word), _) if word == DEFAULT_WORD => {
                table.remove(key);
            }
            (Value::Table(change), Some(Value::Table(inner))) => {
                apply_change(inner, change);
                if inner.is_empty() {
                    table.remove(key);
                }
            }
            (Value::Table(change), _) => {
                let mut inner = Table::new();
                apply_change(&mut inner, change);
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
            (_, now) => now.cloned().unwrap_or_else(|| DEFAULT_WORD.into()),
        };
        (key.clone(), now)
    };
    change.iter().map(picked).collect()
}
