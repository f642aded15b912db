//! Signals over time from a table.

use std::path::Path;

use super::error::TableError;
use super::heads::{SignalHeads, WANT, wrong_time};
use super::opened::{NoTable, Table, TableContent};
use super::reader::TableReader;
use crate::text::read_at_most;
use stillbase_settings::range::quote_clipped;
use stillbase_simulation::signal_table::SignalTable;

/// Largest table that is read, bytes.
pub(super) const MAX_BYTES: u64 = 1 << 30;

/// Reads signals over time from a CSV or Parquet file. A column with the name `t` or `time` is the time, each other one a
/// signal. The unit follows the name after a space, or in brackets. An empty cell is no number.
///
/// # Errors
/// If the file cannot be read or is no such table, or if its time does not increase.
pub fn signals(file: &Path) -> Result<SignalTable, TableError> {
    let opened = Table::open_with(file, |file| read_at_most(file, MAX_BYTES)).map_err(|why| match why {
        NoTable::Wrong(why) => why,
        NoTable::Unread { file, source } => {
            TableError::of_file(&file.display().to_string(), format!("{source}: want a plain file that can be read"))
        }
    });
    opened?.signals()
}

impl Table {
    /// Reads the table as signals over time, as [`signals`] does.
    ///
    /// # Errors
    /// If it is no such table, or if its time does not increase.
    pub fn signals(&self) -> Result<SignalTable, TableError> {
        match &self.content {
            TableContent::Csv(text) => signals_of(text, &self.name),
            TableContent::Columns(columns) => columns.signals(&self.name),
        }
    }
}

/// Returns whether a text is CSV with a head of signals over time, rather than something else.
pub fn has_signal_head(text: &str) -> bool {
    TableReader::new(text, "", WANT).is_ok_and(|reader| SignalHeads::of(reader.head()).is_ok())
}

/// Reads signals over time from CSV, as [`signals`] does; `file` is the name used in errors.
///
/// # Errors
/// As [`signals`].
pub fn signals_of(text: &str, file: &str) -> Result<SignalTable, TableError> {
    let mut reader = TableReader::new(text, file, WANT)?;
    let heads = SignalHeads::of(reader.head()).map_err(|why| reader.head_error(why))?;
    let (mut time, mut values) = (Vec::new(), vec![Vec::new(); heads.signals().count()]);
    while let Some(row) = reader.row()? {
        let number = |place: usize, name: &str| match row.cell(place) {
            Some(cell) if cell.is_empty() => Ok(f64::NAN),
            Some(cell) => cell.parse::<f64>().map_err(|_| {
                row.error(format!("column {name}: {:?}: want a number, such as 0.25", quote_clipped(&cell)))
            }),
            None => Err(row.error(format!("column {name}: nothing there: want a number"))),
        };
        let now = number(heads.time, "time")?;
        if let Some(why) = wrong_time(now, time.last().copied()) {
            return Err(row.error(why));
        }
        time.push(now);
        for ((place, name), column) in heads.signals().zip(&mut values) {
            column.push(number(place, name)?);
        }
    }
    match time.is_empty() {
        true => Err(reader.head_error("no row below the head: want at least one")),
        false => Ok(heads.table(time, values)),
    }
}
