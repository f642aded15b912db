//! [`ColumnTable`]: a table that is given by columns, as Parquet has it.

use super::error::TableError;
use super::heads::{SignalHeads, wrong_time};
use stillbase_settings::range::quote_clipped;
use stillbase_simulation::signal_table::SignalTable;

/// A table given by columns.
#[derive(Debug, PartialEq)]
pub(crate) struct ColumnTable {
    /// Names of the columns.
    pub heads: Vec<String>,
    /// Number of rows.
    pub rows: usize,
    /// The values of each column.
    pub columns: Vec<ColumnValues>,
}

/// Values of a column.
#[cfg_attr(not(feature = "rows"), expect(dead_code, reason = "Parquet is not read"))]
#[derive(Debug, PartialEq)]
pub(crate) enum ColumnValues {
    /// Numbers, NaN for nulls.
    Numbers(Vec<f64>),
    /// Texts, empty for nulls.
    Texts(Vec<String>),
    /// Neither; says what it holds.
    Other(&'static str),
}

impl ColumnTable {
    /// Returns the table as signals over time; `file` is the name used in errors.
    ///
    /// # Errors
    /// If it has no such columns, or if its time does not increase.
    pub fn signals(&self, file: &str) -> Result<SignalTable, TableError> {
        let refused = |why: String| TableError::of_file(file, why);
        let heads = SignalHeads::of(self.heads.iter().map(String::as_str)).map_err(refused)?;
        if self.rows == 0 {
            return Err(refused("no row: want at least one".into()));
        }
        let values = |place: usize| {
            let what = match &self.columns[place] {
                ColumnValues::Numbers(values) => return Ok(values.clone()),
                ColumnValues::Texts(_) => "text",
                ColumnValues::Other(what) => *what,
            };
            Err(refused(format!("column {}: {what}: want numbers", quote_clipped(&self.heads[place]))))
        };
        let time = values(heads.time)?;
        let before = [None].into_iter().chain(time.iter().copied().map(Some));
        if let Some((row, why)) =
            (1..).zip(time.iter().zip(before)).find_map(|(row, (time, before))| Some((row, wrong_time(*time, before)?)))
        {
            return Err(refused(format!("row {row}: {why}")));
        }
        let columns = heads.signals().map(|(place, _)| values(place)).collect::<Result<_, _>>()?;
        Ok(heads.table(time, columns))
    }
}
