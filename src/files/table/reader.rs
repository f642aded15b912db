//! [`TableReader`]: reads a header, and rows of numbers with their lines.

use std::borrow::Cow;
use std::fmt::{self, Display};

use super::column::TableColumn;
use super::columns::{ColumnTable, ColumnValues};
use super::error::TableError;
use stillbase_settings::range::quote_clipped;
use stillbase_study::advice::Advice;

/// Largest magnitude of a number, in SI units.
const MAX_NUMBER: f64 = 1e11;
/// Maximum number of columns of a table.
pub(super) const MAX_COLUMNS: usize = 1000;

/// Reads the rows of a table, one after the other.
pub(super) struct TableReader<'a> {
    /// Name used in errors.
    file: &'a str,
    head: csv::StringRecord,
    rows: Rows<'a>,
}

/// Rows that are left.
enum Rows<'a> {
    Csv(csv::StringRecordsIntoIter<&'a [u8]>),
    /// Those of columns from an index on.
    Columns(&'a ColumnTable, usize),
}

/// A row of a table.
pub(super) struct TableRow<'a> {
    file: &'a str,
    pub place: RowPlace,
    cells: Cells<'a>,
}

/// Place of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum RowPlace {
    /// The line of a text, counted from 1.
    Line(u64),
    /// The row below the head, counted from 1.
    Row(u64),
}

impl RowPlace {
    /// Makes an error of this place.
    pub fn error(self, file: &str, why: impl Display) -> TableError {
        self.advise(file, why.to_string().into())
    }

    /// Makes an error of this place that names remedies.
    pub fn advise(self, file: &str, why: Advice) -> TableError {
        let (line, why) = match self {
            Self::Line(line) => (Some(line), why),
            Self::Row(_) => (None, why.after(format!("{self}: "))),
        };
        TableError { file: file.to_owned(), line, why }
    }
}

impl Display for RowPlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(line) => write!(f, "line {line}"),
            Self::Row(row) => write!(f, "row {row}"),
        }
    }
}

enum Cells<'a> {
    Csv(csv::StringRecord),
    /// Those of a row of columns, by its index.
    Columns(&'a ColumnTable, usize),
}

impl<'a> TableReader<'a> {
    /// Reads the header; `want` describes the expected header in errors. The delimiter is the semicolon or the tab if
    /// the first line that is not a comment has one, otherwise the comma.
    ///
    /// # Errors
    /// If there is no header, a row has too many columns, or it is not CSV. Columns are counted before allocation.
    pub fn new(text: &'a str, file: &'a str, want: &str) -> Result<Self, TableError> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let first = text.lines().find(|line| !line.trim().is_empty() && !line.starts_with('#')).unwrap_or_default();
        let delimiter = [b';', b'\t'].into_iter().find(|d| first.bytes().any(|b| b == *d)).unwrap_or(b',');
        if let Some(line) = too_wide(text, delimiter) {
            let why = format!("more than {MAX_COLUMNS} columns: want at most {MAX_COLUMNS}");
            return Err(TableError::at(file, line, why));
        }
        let records = csv::ReaderBuilder::new()
            .has_headers(false)
            .flexible(true)
            .trim(csv::Trim::All)
            .comment(Some(b'#'))
            .delimiter(delimiter)
            .from_reader(text.as_bytes())
            .into_records();
        let mut reader = Self { file, head: csv::StringRecord::new(), rows: Rows::Csv(records) };
        let Some(head) = reader.next_record()? else {
            return Err(TableError::at(file, 1, format!("nothing here: want {want}")));
        };
        if head.iter().all(|cell| cell.parse::<f64>().is_ok()) {
            return Err(TableError::at(file, line_of(&head), format!("no header: want {want}")));
        }
        reader.head = head;
        Ok(reader)
    }

    /// Reads the rows of columns.
    ///
    /// # Errors
    /// If it has no columns.
    pub fn of_columns(columns: &'a ColumnTable, file: &'a str, want: &str) -> Result<Self, TableError> {
        if columns.heads.is_empty() {
            return Err(TableError::of_file(file, format!("no columns: want {want}")));
        }
        // Spaces around a name do not count, as in CSV.
        let head = columns.heads.iter().map(|name| name.trim()).collect();
        Ok(Self { file, head, rows: Rows::Columns(columns, 0) })
    }

    /// Returns the cells of the header.
    pub fn head(&self) -> &csv::StringRecord {
        &self.head
    }

    /// Makes an error of the header.
    pub fn head_error(&self, why: impl Display) -> TableError {
        match &self.rows {
            Rows::Csv(_) => TableError::at(self.file, line_of(&self.head), why),
            Rows::Columns(..) => TableError::of_file(self.file, why),
        }
    }

    /// Returns the next row; `None` after the last.
    ///
    /// # Errors
    /// If the text is not CSV.
    pub fn row(&mut self) -> Result<Option<TableRow<'a>>, TableError> {
        if let Rows::Columns(columns, next) = &mut self.rows {
            let row = *next;
            *next += 1;
            let (place, cells) = (RowPlace::Row(*next as u64), Cells::Columns(columns, row));
            return Ok((row < columns.rows).then_some(TableRow { file: self.file, place, cells }));
        }
        let record = self.next_record()?;
        Ok(record.map(|cells| {
            let place = RowPlace::Line(line_of(&cells));
            TableRow { file: self.file, place, cells: Cells::Csv(cells) }
        }))
    }

    /// Returns the next record of CSV.
    fn next_record(&mut self) -> Result<Option<csv::StringRecord>, TableError> {
        let Rows::Csv(records) = &mut self.rows else { return Ok(None) };
        let read = records.next().transpose();
        read.map_err(|e| TableError::of_file(self.file, format!("{e}: want a CSV file")))
    }
}

impl TableRow<'_> {
    /// Returns the text in a column; `None` if the row is too short.
    pub fn cell(&self, place: usize) -> Option<Cow<'_, str>> {
        match &self.cells {
            Cells::Csv(cells) => cells.get(place).map(Cow::Borrowed),
            Cells::Columns(columns, row) => match columns.columns.get(place)? {
                ColumnValues::Numbers(values) => {
                    let value = values.get(*row)?;
                    Some(if value.is_nan() { Cow::Borrowed("") } else { value.to_string().into() })
                }
                ColumnValues::Texts(values) => values.get(*row).map(|text| Cow::Borrowed(text.trim())),
                ColumnValues::Other(_) => None,
            },
        }
    }

    /// Returns the numbers of columns, in SI units.
    ///
    /// # Errors
    /// If one is missing, or is not a number within ±1e11.
    pub fn numbers<'c>(&self, columns: impl IntoIterator<Item = &'c TableColumn>) -> Result<Vec<f64>, TableError> {
        columns.into_iter().map(|column| self.number(column)).collect()
    }

    fn number(&self, column: &TableColumn) -> Result<f64, TableError> {
        let name = &column.name;
        if let Cells::Columns(columns, row) = &self.cells {
            match columns.columns.get(column.place) {
                // A number that is there needs no way through text.
                Some(ColumnValues::Numbers(values)) => {
                    if let Some(x) = values.get(*row).map(|x| x * column.scale).filter(|x| x.abs() <= MAX_NUMBER) {
                        return Ok(x);
                    }
                }
                Some(ColumnValues::Other(what)) => {
                    return Err(TableError::of_file(self.file, format!("column {name}: {what}: want numbers")));
                }
                _ => {}
            }
        }
        let Some(cell) = self.cell(column.place).filter(|cell| !cell.is_empty()) else {
            return Err(self.error(format!("column {name}: nothing there: want a number")));
        };
        cell.parse().ok().map(|x: f64| x * column.scale).filter(|x| x.abs() <= MAX_NUMBER).ok_or_else(|| {
            let cell = quote_clipped(&cell);
            self.error(format!("column {name}: {cell:?}: want a finite number, such as 0.25, of at most 1e11"))
        })
    }

    /// Makes an error of this row.
    pub fn error(&self, why: impl Display) -> TableError {
        self.place.error(self.file, why)
    }
}

fn line_of(record: &csv::StringRecord) -> u64 {
    record.position().map_or(0, csv::Position::line)
}

/// State of the scanner within a cell.
#[derive(Clone, Copy, PartialEq)]
enum Cell {
    /// Before its first byte; `of_row` says whether the cell begins a row.
    Fresh {
        of_row: bool,
    },
    Bare,
    Quoted,
    /// After a quote within quotes: a second one is an escaped quote, anything else ends the quotes.
    Closed,
    Comment,
}

/// Returns the line of the first row with too many columns, by the rules of the CSV reader.
fn too_wide(text: &str, delimiter: u8) -> Option<u64> {
    let (mut cell, mut columns, mut line) = (Cell::Fresh { of_row: true }, 1, 1);
    for byte in text.bytes() {
        line += u64::from(byte == b'\n');
        cell = match (cell, byte) {
            (Cell::Quoted, b'"') => Cell::Closed,
            (Cell::Quoted, _) | (Cell::Closed, b'"') => Cell::Quoted,
            (_, b'\n' | b'\r') => {
                columns = 1;
                Cell::Fresh { of_row: true }
            }
            (Cell::Comment, _) | (Cell::Fresh { of_row: true }, b'#') => Cell::Comment,
            (Cell::Fresh { .. }, b'"') => Cell::Quoted,
            (_, byte) if byte == delimiter => {
                columns += 1;
                if columns > MAX_COLUMNS {
                    return Some(line);
                }
                Cell::Fresh { of_row: false }
            }
            _ => Cell::Bare,
        };
    }
    None
}
