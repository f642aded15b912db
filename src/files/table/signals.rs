//! Signals over time from a table.

use std::path::Path;

use super::column::unit_in_brackets;
use super::error::TableError;
use super::reader::TableReader;
use crate::text::read_at_most;
use stillbase_settings::range::quote_clipped;
use stillbase_simulation::signal_table::{SignalColumn, SignalTable};
use stillbase_simulation::signals::name_and_unit as simulation_head;

/// Largest table that is read, bytes.
const MAX_BYTES: u64 = 1 << 30;

const WANT: &str = "a head such as time s,torque/1 N m: the time, then a signal with its unit in each column";

/// Reads signals over time from a CSV file with a head: the time first, then a signal in each column. The unit follows
/// the name after a space, or in brackets. An empty cell is no number.
///
/// # Errors
/// If the file cannot be read or is no such table, or if its time does not increase.
pub fn signals(file: &Path) -> Result<SignalTable, TableError> {
    let name = file.display().to_string();
    let text = read_at_most(file, MAX_BYTES)
        .map_err(|e| TableError::of_file(&name, format!("{e}: want a plain file that can be read")))?;
    signals_of(&text, &name)
}

fn signals_of(text: &str, file: &str) -> Result<SignalTable, TableError> {
    let mut reader = TableReader::new(text, file, WANT)?;
    let heads: Vec<(String, String)> = reader.head().iter().map(name_and_unit).collect();
    let is_time = heads.first().is_some_and(|(name, unit)| {
        ["t", "time"].contains(&name.to_lowercase().as_str()) && ["", "s"].contains(&unit.as_str())
    });
    if !is_time || heads.len() < 2 {
        return Err(reader.head_error(format!("want {WANT}")));
    }
    if let Some(i) = (1..heads.len()).find(|i| heads[..*i].iter().any(|(name, _)| *name == heads[*i].0)) {
        let why = format!("two columns {:?}: want different names", quote_clipped(&heads[i].0));
        return Err(reader.head_error(why));
    }
    let column = |(path, unit)| SignalColumn { path, unit, values: Vec::new() };
    let mut table = SignalTable { time: Vec::new(), columns: heads.into_iter().skip(1).map(column).collect() };
    while let Some(row) = reader.row()? {
        let number = |place: usize, name: &str| match row.cell(place) {
            Some("") => Ok(f64::NAN),
            Some(cell) => cell.parse::<f64>().map_err(|_| {
                row.error(format!("column {name}: {:?}: want a number, such as 0.25", quote_clipped(cell)))
            }),
            None => Err(row.error(format!("column {name}: nothing there: want a number"))),
        };
        let time = number(0, "time")?;
        if !time.is_finite() || table.time.last().is_some_and(|last| time <= *last) {
            return Err(row.error("column time: want finite numbers that increase from row to row"));
        }
        table.time.push(time);
        for (i, column) in table.columns.iter_mut().enumerate() {
            column.values.push(number(i + 1, &column.path)?);
        }
    }
    match table.time.is_empty() {
        true => Err(reader.head_error("no row below the head: want at least one")),
        false => Ok(table),
    }
}

/// Splits the head of a column into the name and the unit of a signal.
fn name_and_unit(head: &str) -> (String, String) {
    let head = head.trim();
    if let Some((name, unit)) = unit_in_brackets(head) {
        return (name, unit.unwrap_or_default());
    }
    let (name, unit) = simulation_head(head);
    (name.into(), unit.into())
}
