//! [`RowFile`]: rows of numbers in a new file, CSV or Parquet by its ending.

use std::io;
use std::path::{Path, PathBuf};

use parquet::errors::ParquetError;

use super::parquet_rows::{ParquetHead, ParquetRows};
use super::{NewFile, WriteError};
use stillbase_settings::text::sheet_cell;

/// File name extensions of rows of numbers.
pub const ROW_ENDINGS: [&str; 2] = ["csv", "parquet"];

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

/// A file of rows that is being written. It takes its name when it is finished; dropped before, it leaves nothing.
pub struct RowFile {
    file: PathBuf,
    out: Out,
}

enum Out {
    Csv(Box<csv::Writer<NewFile>>),
    Parquet(Box<ParquetRows<NewFile>>),
}

impl RowFile {
    /// Begins a file with the names of its columns; `of` says what a row is.
    ///
    /// # Errors
    /// If its ending is neither `.csv` nor `.parquet`, or if it cannot be created.
    pub fn create(file: &Path, force: bool, of: &str, columns: &[String]) -> Result<Self, RowError> {
        Self::with_texts(file, force, of, (&[], columns))
    }

    /// Begins a file as [`create`](Self::create) does, with columns of text before those of numbers.
    ///
    /// # Errors
    /// As [`create`](Self::create).
    pub fn with_texts(
        file: &Path,
        force: bool,
        of: &str,
        (texts, columns): (&[&str], &[String]),
    ) -> Result<Self, RowError> {
        let own = file.extension().unwrap_or_default();
        let kind = ROW_ENDINGS.iter().position(|ending| own.eq_ignore_ascii_case(ending));
        let out = match kind {
            Some(0) => {
                let mut writer = csv::Writer::from_writer(NewFile::create(file, force)?);
                let head = texts.iter().copied().chain(columns.iter().map(String::as_str));
                writer.write_record(head).map_err(|e| csv_error(file, e))?;
                Out::Csv(Box::new(writer))
            }
            Some(_) => {
                let head = ParquetHead { row: of, count: None, texts, columns, note: None };
                let begun = ParquetRows::begin(NewFile::create(file, force)?, &head);
                Out::Parquet(Box::new(begun.map_err(|e| parquet_error(file, e))?))
            }
            None => return Err(RowError::Ending(file.into())),
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
                let done = rows.named_row(0, texts, values.iter().map(|x| x.unwrap_or(f64::NAN) + 0.0));
                done.map_err(|e| parquet_error(&self.file, e))
            }
        }
    }

    /// Gives the file its final name.
    ///
    /// # Errors
    /// If not everything could be written.
    pub fn finish(self) -> Result<(), RowError> {
        let Self { file, out } = self;
        let whole = match out {
            Out::Csv(writer) => writer.into_inner().map_err(|e| failed(&file, e.into_error()))?,
            Out::Parquet(rows) => rows.finish().map_err(|e| parquet_error(&file, e))?,
        };
        Ok(whole.finish()?)
    }
}

fn failed(file: &Path, source: io::Error) -> RowError {
    WriteError::Failed { file: file.into(), source }.into()
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
