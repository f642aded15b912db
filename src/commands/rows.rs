//! Rows of numbers, as CSV on standard output, or in a new file as CSV or Parquet.

use std::io::{self, StdoutLock};
use std::path::{Path, PathBuf};

use stillbase_files::row_file::RowFile;
use stillbase_settings::text::{plain, sheet_cell};

use super::exit::print_message;
use super::failure::Failure;
use super::output::is_standard;

/// Rows that are being written.
pub struct Rows {
    sink: Sink,
    row: Vec<Option<f64>>,
}

enum Sink {
    File(RowFile, PathBuf),
    Standard(Box<csv::Writer<StdoutLock<'static>>>),
}

impl Rows {
    /// Begins a file with the names of its columns, CSV or Parquet by its ending; without a file, writes CSV to standard
    /// output.
    ///
    /// # Errors
    /// If the file or standard output cannot be written.
    pub fn begin(file: Option<&Path>, force: bool, head: &[String]) -> Result<Self, Failure> {
        Self::begin_with(file, force, ("instant", &[]), head)
    }

    /// Begins as [`begin`](Self::begin) does; `of` says what a row is, and `texts` names columns of text, which come
    /// first.
    ///
    /// # Errors
    /// As [`begin`](Self::begin).
    pub fn begin_with(
        file: Option<&Path>,
        force: bool,
        (of, texts): (&str, &[&str]),
        head: &[String],
    ) -> Result<Self, Failure> {
        let sink = match file.filter(|file| !is_standard(file)) {
            Some(file) => Sink::File(RowFile::with_texts(file, force, of, (texts, head))?, file.into()),
            None => {
                let mut writer = csv::Writer::from_writer(io::stdout().lock());
                let names = texts.iter().copied().chain(head.iter().map(String::as_str));
                writer.write_record(names.map(|name| plain(name).into_owned())).map_err(failure)?;
                Sink::Standard(Box::new(writer))
            }
        };
        Ok(Self { sink, row: Vec::new() })
    }

    /// Writes a row. Zero has no sign, and `None` gives an empty cell.
    ///
    /// # Errors
    /// If the file or standard output cannot be written.
    pub fn row<T: Into<Option<f64>>>(&mut self, values: impl IntoIterator<Item = T>) -> Result<(), Failure> {
        self.named_row(&[], values)
    }

    /// Writes a row as [`row`](Self::row) does, with a cell for each column of text.
    ///
    /// # Errors
    /// If the file or standard output cannot be written.
    pub fn named_row<T: Into<Option<f64>>>(
        &mut self,
        texts: &[&str],
        values: impl IntoIterator<Item = T>,
    ) -> Result<(), Failure> {
        self.row.clear();
        self.row.extend(values.into_iter().map(|x| x.into().map(|x| x + 0.0)));
        match &mut self.sink {
            Sink::File(file, _) => Ok(file.named_row(texts, &self.row)?),
            Sink::Standard(writer) => {
                let texts: Vec<_> = texts.iter().map(|text| sheet_cell(text)).collect();
                writer.serialize((texts, &self.row)).map_err(failure)
            }
        }
    }

    /// Completes the file and prints its name.
    ///
    /// # Errors
    /// If the file or standard output cannot be written.
    pub fn finish(self) -> Result<(), Failure> {
        match self.sink {
            Sink::File(file, name) => {
                file.finish()?;
                print_message(format!("wrote {}", name.display()));
                Ok(())
            }
            Sink::Standard(mut writer) => writer.flush().map_err(|e| Failure::standard_output(&e)),
        }
    }
}

/// Returns the failure to write standard output.
fn failure(error: csv::Error) -> Failure {
    match error.into_kind() {
        csv::ErrorKind::Io(error) => Failure::standard_output(&error),
        other => Failure::WrongInput(format!("CSV: {other:?}")),
    }
}
