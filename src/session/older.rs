//! Reads settings in sessions of earlier versions, which have a separate kind of edit for each part of a scenario.

use toml::{Table, Value};

use stillbase_settings::change;

/// Extracts the settings from the entry of an edit of an earlier version; returns `None` for any other edit.
pub fn settings(table: &mut Table) -> Result<Option<Table>, String> {
    let Some(word) = table.get("do").and_then(Value::as_str).map(str::to_owned) else { return Ok(None) };
    let mut take = |key: &str| table.remove(key);
    let text = |value: Option<Value>, key: &str| match value {
        Some(Value::String(text)) => Ok(text),
        Some(_) => Err(format!("{key}: want a text")),
        None => Err(format!("missing field `{key}`")),
    };
    let found = match word.as_str() {
        "set-plant" | "set-base" | "set-control" | "set-tolerance" | "set-task" => {
            let inner = take("change").ok_or("missing field `change`")?;
            let part = word.trim_start_matches("set-").to_owned();
            match inner {
                Value::Table(inner) => Table::from_iter([(part, Value::Table(inner))]),
                _ => return Err("change: want a table of keys".into()),
            }
        }
        "set-machine" => {
            let (key, value) = (text(take("key"), "key")?, text(take("value"), "value")?);
            change::single_change(&key, change::value(&value))
        }
        "set-time" => change::single_change("task.time", take("time").ok_or("missing field `time`")?),
        "compare-b" => change::single_change("compare_b", take("b").unwrap_or_else(|| change::DEFAULT_WORD.into())),
        _ => return Ok(None),
    };
    take("do");
    match table.keys().next() {
        Some(key) => Err(format!("unknown field `{key}`")),
        None => Ok(Some(found)),
    }
}
