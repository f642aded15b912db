//! Rows of numbers as CSV or Parquet, on standard output or in a new file.

use std::path::{Path, PathBuf};

use stillbase_files::row_file::{ROW_ENDINGS, RowFile, RowForm};

use super::failure::Failure;
use super::file_form::FileForm;
use super::output::{Format, say_written};

/// Where rows go.
#[derive(Clone)]
pub struct RowTarget {
    file: PathBuf,
    form: RowForm,
    force: bool,
}

impl RowTarget {
    /// Returns where rows go: to a file, CSV or Parquet by its ending, or else to standard output, CSV by default.
    ///
    /// # Errors
    /// As [`FileForm::check`].
    pub fn of(format: &Format, form: &FileForm, file: Option<&Path>, force: bool) -> Result<Self, Failure> {
        let ending = form.check(format, file, force, &ROW_ENDINGS)?;
        Ok(Self::with_ending(file, force, ending))
    }

    /// Returns where rows go, if a file is asked for.
    ///
    /// # Errors
    /// As [`FileForm::check_wanted`].
    pub fn wanted(format: &Format, form: &FileForm, file: Option<&Path>, force: bool) -> Result<Option<Self>, Failure> {
        let ending = form.check_wanted(format, file, force, &ROW_ENDINGS)?;
        Ok(ending.map(|ending| Self::with_ending(file, force, ending)))
    }

    /// Returns the same for an ending that is checked already.
    pub fn with_ending(file: Option<&Path>, force: bool, ending: &str) -> Self {
        let form = RowForm::of_ending(ending).unwrap_or(RowForm::Csv);
        Self { file: file.unwrap_or(Path::new("-")).into(), form, force }
    }
}

/// Rows that are being written.
pub struct Rows {
    out: RowFile,
    file: PathBuf,
    row: Vec<Option<f64>>,
}

impl Rows {
    /// Begins with the names of the columns.
    ///
    /// # Errors
    /// If the file or standard output cannot be written.
    pub fn begin(to: &RowTarget, head: &[String]) -> Result<Self, Failure> {
        Self::begin_with(to, ("instant", &[]), head)
    }

    /// Begins as [`begin`](Self::begin) does; `of` says what a row is, and `texts` names columns of text, which come
    /// first.
    ///
    /// # Errors
    /// As [`begin`](Self::begin).
    pub fn begin_with(to: &RowTarget, (of, texts): (&str, &[&str]), head: &[String]) -> Result<Self, Failure> {
        let RowTarget { file, form, force } = to;
        let out = RowFile::with_texts((file, *form), *force, of, (texts, head))?;
        Ok(Self { out, file: file.clone(), row: Vec::new() })
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
        self.row.extend(values.into_iter().map(Into::into));
        Ok(self.out.named_row(texts, &self.row)?)
    }

    /// Completes the file and prints its name.
    ///
    /// # Errors
    /// If the file or standard output cannot be written.
    pub fn finish(self) -> Result<(), Failure> {
        self.out.finish()?;
        say_written(&self.file);
        Ok(())
    }
}
