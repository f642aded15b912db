//! [`RowFile`]: rows of numbers and words in a new file or on standard output, as CSV or Parquet.

use std::io::{self, Stdout, Write};
use std::path::{Path, PathBuf};

use parquet::errors::ParquetError;

use super::new_file::is_standard;
use super::parquet_rows::{ColumnKind, ParquetCell, ParquetHead, ParquetRows};
use super::{NewFile, WriteError};
use stillbase_settings::cell_table::{Cell, CellTable};
use stillbase_settings::text::{plain, sheet_cell};

/// Format of rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RowForm {
    /// Text, for a spreadsheet.
    Csv,
    /// Columns of numbers, for a program.
    Parquet,
}

/// File name extensions of rows.
pub const ROW_ENDINGS: [&str; 2] = [RowForm::Csv.ending(), RowForm::Parquet.ending()];

impl RowForm {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Csv, Self::Parquet];

    /// Returns the file name extension.
    pub const fn ending(self) -> &'static str {
        match self {
            Self::Csv => "csv",
            Self::Parquet => "parquet",
        }
    }

    /// Returns the name.
    pub fn words(self) -> &'static str {
        match self {
            Self::Csv => "CSV",
            Self::Parquet => "Parquet",
        }
    }

    /// Returns the format of an extension, in upper or lower case; `None` if no rows have it.
    pub fn of_ending(ending: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|form| form.ending().eq_ignore_ascii_case(ending))
    }

    /// Returns the format of a file by its extension.
    ///
    /// # Errors
    /// If no rows have it.
    pub fn of(file: &Path) -> Result<Self, RowError> {
        let own = file.extension().and_then(|ending| ending.to_str());
        own.and_then(Self::of_ending).ok_or_else(|| RowError::Ending(file.into()))
    }
}

/// Why rows were not written.
#[derive(Debug, thiserror::Error)]
pub enum RowError {
    /// The file cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// The name has another ending.
    #[error("{}: want a name that ends in .csv or .parquet", .0.display())]
    Ending(PathBuf),
    /// The format cannot hold the rows.
    #[error("{}: {why}: want fewer columns, or another name", file.display())]
    Format {
        /// The file.
        file: PathBuf,
        /// Reason given by the format's library.
        why: String,
    },
}

/// Rows that are being written. A file takes its name when it is finished; dropped before, it leaves nothing. On standard
/// output, rows appear as they come.
pub struct RowFile {
    file: PathBuf,
    out: Out,
}

/// Where rows go.
enum Sink {
    File(NewFile),
    Standard(Stdout),
    Memory(Vec<u8>),
}

impl Write for Sink {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Self::File(file) => file.write(bytes),
            Self::Standard(out) => out.write(bytes),
            Self::Memory(out) => out.write(bytes),
        }
    }
    fn flush(&mut self) -> io::Result<()> {
        match self {
            Self::File(file) => file.flush(),
            Self::Standard(out) => out.flush(),
            Self::Memory(out) => out.flush(),
        }
    }
}

enum Out {
    Csv(Box<csv::Writer<Sink>>),
    Parquet(Box<ParquetRows<Sink>>),
}

impl RowFile {
    /// Begins a file with the names of its columns; `of` says what a row is.
    ///
    /// # Errors
    /// If its ending is neither `.csv` nor `.parquet`, or if it cannot be created.
    pub fn create(file: &Path, force: bool, of: &str, columns: &[String]) -> Result<Self, RowError> {
        Self::with_texts((file, RowForm::of(file)?), force, of, (&[], columns))
    }

    /// Begins a file of a format as [`create`](Self::create) does, or standard output (`-`), with columns of text before
    /// those of numbers.
    ///
    /// # Errors
    /// If it cannot be created.
    pub fn with_texts(
        (file, form): (&Path, RowForm),
        force: bool,
        of: &str,
        (texts, columns): (&[&str], &[String]),
    ) -> Result<Self, RowError> {
        let sink = match is_standard(file) {
            true => Sink::Standard(io::stdout()),
            false => Sink::File(NewFile::create(file, force)?),
        };
        Self::begin(sink, (file, form), of, (texts, columns))
    }

    /// Begins rows as CSV in memory, which [`into_text`](Self::into_text) returns.
    ///
    /// # Errors
    /// If the names of the columns cannot be written.
    pub fn in_memory(columns: &[String]) -> Result<Self, RowError> {
        Self::begin(Sink::Memory(Vec::new()), (Path::new("values.csv"), RowForm::Csv), "instant", (&[], columns))
    }

    fn begin(
        sink: Sink,
        (file, form): (&Path, RowForm),
        of: &str,
        (texts, columns): (&[&str], &[String]),
    ) -> Result<Self, RowError> {
        let is_shown = matches!(sink, Sink::Standard(_));
        let out = match form {
            RowForm::Csv => {
                let mut writer = csv::Writer::from_writer(sink);
                let head = texts.iter().copied().chain(columns.iter().map(String::as_str));
                // Standard output may be a terminal.
                let done = match is_shown {
                    true => writer.write_record(head.map(|name| plain(name).into_owned())),
                    false => writer.write_record(head),
                };
                done.map_err(|e| csv_error(file, e))?;
                Out::Csv(Box::new(writer))
            }
            RowForm::Parquet => {
                let texts = texts.iter().map(|name| (ColumnKind::Text, *name));
                let numbers = columns.iter().map(|name| (ColumnKind::Number, name.as_str()));
                let head =
                    ParquetHead { row: of, columns: texts.chain(numbers).collect(), note: None, is_compressed: false };
                Out::Parquet(Box::new(ParquetRows::begin(sink, &head).map_err(|e| parquet_error(file, e))?))
            }
        };
        Ok(Self { file: file.into(), out })
    }

    /// Writes a row. Zero has no sign; `None` gives an empty cell in CSV, and no number (NaN) in Parquet.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn row(&mut self, values: &[Option<f64>]) -> Result<(), RowError> {
        self.named_row(&[], values)
    }

    /// Writes a row as [`row`](Self::row) does, with a cell for each column of text.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn named_row(&mut self, texts: &[&str], values: &[Option<f64>]) -> Result<(), RowError> {
        match &mut self.out {
            Out::Csv(writer) => {
                let row = values.iter().map(|x| x.map(|x| x + 0.0));
                let texts: Vec<_> = texts.iter().map(|text| sheet_cell(text)).collect();
                let done = writer.serialize((texts, row.collect::<Vec<_>>()));
                done.map_err(|e| csv_error(&self.file, e))
            }
            Out::Parquet(rows) => {
                let texts = texts.iter().map(|text| ParquetCell::Text(text));
                let numbers = values.iter().map(|x| ParquetCell::Number(x.unwrap_or(f64::NAN) + 0.0));
                rows.row(texts.chain(numbers)).map_err(|e| parquet_error(&self.file, e))
            }
        }
    }

    /// Gives the file its final name.
    ///
    /// # Errors
    /// If not everything could be written.
    pub fn finish(self) -> Result<(), RowError> {
        let file = self.file.clone();
        match self.end()? {
            Sink::File(whole) => Ok(whole.finish()?),
            Sink::Standard(mut out) => out.flush().map_err(|e| failed(&file, e)),
            Sink::Memory(_) => Ok(()),
        }
    }

    /// Returns the rows that were written in memory.
    ///
    /// # Errors
    /// If not everything could be written.
    pub fn into_text(self) -> Result<String, RowError> {
        match self.end()? {
            Sink::Memory(bytes) => Ok(String::from_utf8_lossy(&bytes).into_owned()),
            Sink::File(_) | Sink::Standard(_) => Ok(String::new()),
        }
    }

    /// Writes what is left, and gives back what it was written to.
    fn end(self) -> Result<Sink, RowError> {
        let Self { file, out } = self;
        match out {
            Out::Csv(writer) => writer.into_inner().map_err(|e| failed(&file, e.into_error())),
            Out::Parquet(rows) => rows.finish().map_err(|e| parquet_error(&file, e)),
        }
    }
}

/// Key of the lines about a table in the metadata of a Parquet file.
const ABOUT_KEY: &str = "stillbase.about";

/// Returns a table as the content of a file; `file` is the name used in errors.
///
/// # Errors
/// If the format cannot hold the table.
pub fn table_bytes(table: &CellTable, form: RowForm, file: &Path) -> Result<Vec<u8>, RowError> {
    match form {
        RowForm::Csv => Ok(table.csv().into_bytes()),
        RowForm::Parquet => parquet_bytes(table).map_err(|e| parquet_error(file, e)),
    }
}

fn parquet_bytes(table: &CellTable) -> Result<Vec<u8>, ParquetError> {
    let kind = |column| if table.has_words(column) { ColumnKind::Text } else { ColumnKind::Number };
    let kinds: Vec<ColumnKind> = (0..table.head.len()).map(kind).collect();
    let about = table.about.join("\n");
    let note = Some([ABOUT_KEY, &*about]).filter(|_| !table.about.is_empty());
    let columns = kinds.iter().copied().zip(table.head.iter().map(String::as_str)).collect();
    let mut rows =
        ParquetRows::begin(Vec::new(), &ParquetHead { row: table.row, columns, note, is_compressed: false })?;
    for row in &table.rows {
        // A column of words may hold numbers, too.
        let texts: Vec<String> = row.iter().map(text_of).collect();
        let cell = |(i, cell): (usize, &Cell)| match (kinds.get(i), cell) {
            (Some(ColumnKind::Number), Cell::Number(x)) => ParquetCell::Number(x + 0.0),
            (Some(ColumnKind::Number), _) => ParquetCell::Number(f64::NAN),
            _ => ParquetCell::Text(&texts[i]),
        };
        rows.row(row.iter().enumerate().map(cell))?;
    }
    rows.finish()
}

fn text_of(cell: &Cell) -> String {
    match cell {
        Cell::Words(text) => text.clone(),
        Cell::Number(x) => (x + 0.0).to_string(),
        Cell::Empty => String::new(),
    }
}

fn failed(file: &Path, source: io::Error) -> RowError {
    match is_standard(file) {
        true => WriteError::Standard(source).into(),
        false => WriteError::Failed { file: file.into(), source }.into(),
    }
}

fn csv_error(file: &Path, error: csv::Error) -> RowError {
    match error.into_kind() {
        csv::ErrorKind::Io(source) => failed(file, source),
        other => RowError::Format { file: file.into(), why: format!("CSV: {other:?}") },
    }
}

fn parquet_error(file: &Path, error: ParquetError) -> RowError {
    match error {
        ParquetError::External(source) => match source.downcast::<io::Error>() {
            Ok(source) => failed(file, *source),
            Err(other) => RowError::Format { file: file.into(), why: other.to_string() },
        },
        other => RowError::Format { file: file.into(), why: other.to_string() },
    }
}
