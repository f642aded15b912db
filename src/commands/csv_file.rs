//! Rows of numbers as CSV, on standard output or in a new file.

use std::io::{self, StdoutLock, Write};
use std::path::Path;

use stillbase_files::{NewFile, WriteError};
use stillbase_settings::text::plain;

use super::exit::print_message;
use super::failure::Failure;

/// A CSV file that is being written.
pub struct Csv {
    writer: csv::Writer<Sink>,
    row: Vec<Option<f64>>,
}

impl Csv {
    /// Begins a file with the heading row `head`; without a file, writes to standard output.
    ///
    /// # Errors
    /// If the file or standard output cannot be written.
    pub fn begin(file: Option<&Path>, force: bool, head: impl IntoIterator<Item = String>) -> Result<Self, Failure> {
        let sink = match file {
            Some(file) => Sink::File(NewFile::create(file, force)?),
            None => Sink::Standard(io::stdout().lock()),
        };
        let shown = |name: String| if file.is_some() { name } else { plain(&name).into_owned() };
        let mut csv = Self { writer: csv::Writer::from_writer(sink), row: Vec::new() };
        let done = csv.writer.write_record(head.into_iter().map(shown));
        csv.checked(done)?;
        Ok(csv)
    }

    /// Writes a row. Zero has no sign, and `None` gives an empty cell.
    ///
    /// # Errors
    /// If the file or standard output cannot be written.
    pub fn row<T: Into<Option<f64>>>(&mut self, values: impl IntoIterator<Item = T>) -> Result<(), Failure> {
        self.row.clear();
        self.row.extend(values.into_iter().map(|x| x.into().map(|x| x + 0.0)));
        let done = self.writer.serialize(&self.row);
        self.checked(done)
    }

    /// Completes the file and prints its name.
    ///
    /// # Errors
    /// If the file or standard output cannot be written.
    pub fn finish(mut self) -> Result<(), Failure> {
        let done = self.writer.flush();
        done.map_err(|e| self.writer.get_ref().failure(e))?;
        match self.writer.into_inner() {
            Ok(Sink::File(file)) => {
                let name = file.path().display().to_string();
                file.finish()?;
                print_message(format!("wrote {name}"));
            }
            Ok(Sink::Standard(_)) => {}
            Err(e) => return Err(Failure::standard_output(e.error())),
        }
        Ok(())
    }

    fn checked(&self, done: Result<(), csv::Error>) -> Result<(), Failure> {
        done.map_err(|e| match e.into_kind() {
            csv::ErrorKind::Io(e) => self.writer.get_ref().failure(e),
            other => Failure::WrongInput(format!("CSV: {other:?}")),
        })
    }
}

enum Sink {
    File(NewFile),
    Standard(StdoutLock<'static>),
}

impl Sink {
    fn failure(&self, error: io::Error) -> Failure {
        match self {
            Self::File(file) => WriteError::Failed { file: file.path().into(), source: error }.into(),
            Self::Standard(_) => Failure::standard_output(&error),
        }
    }
}

impl Write for Sink {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Self::File(file) => file.write(bytes),
            Self::Standard(out) => out.write(bytes),
        }
    }
    fn flush(&mut self) -> io::Result<()> {
        match self {
            Self::File(file) => file.flush(),
            Self::Standard(out) => out.flush(),
        }
    }
}
