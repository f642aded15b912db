//! [`Table`]: a table of another program, before its columns are understood.

use std::io;
use std::path::{Path, PathBuf};

use super::columns::ColumnTable;
use super::error::TableError;
#[cfg(feature = "rows")]
use super::parquet_table::parquet_columns;
use super::reader::TableReader;
#[cfg(feature = "rows")]
use super::signals::MAX_BYTES;
#[cfg(feature = "rows")]
use crate::row_file::RowForm;
#[cfg(feature = "rows")]
use crate::text::open;
use crate::text::read;
use stillbase_settings::text::MAX_TEXT_BYTES;

/// A table of another program, CSV or Parquet, before its columns are understood.
#[derive(Debug, PartialEq)]
pub struct Table {
    /// Its name in errors.
    pub(super) name: String,
    pub(super) content: TableContent,
}

#[derive(Debug, PartialEq)]
pub(super) enum TableContent {
    Csv(String),
    #[cfg_attr(not(feature = "rows"), expect(dead_code, reason = "Parquet is not read"))]
    Columns(ColumnTable),
}

/// File name extensions of tables.
#[cfg(feature = "rows")]
pub const TABLE_ENDINGS: &[&str] = &crate::row_file::ROW_ENDINGS;
/// File name extensions of tables.
#[cfg(not(feature = "rows"))]
pub const TABLE_ENDINGS: &[&str] = &["csv"];

/// Returns whether a file is a table by its name.
pub fn is_table(file: &Path) -> bool {
    let own = file.extension().unwrap_or_default();
    TABLE_ENDINGS.iter().any(|ending| own.eq_ignore_ascii_case(ending))
}

/// Why a table was not opened.
#[derive(Debug, thiserror::Error)]
pub enum NoTable {
    /// The file cannot be read.
    #[error("{}: {source}: want a plain file that can be read, of at most {MAX_TEXT_BYTES} bytes", file.display())]
    Unread {
        /// The file.
        file: PathBuf,
        /// The reason.
        source: io::Error,
    },
    /// The file is no Parquet.
    #[error(transparent)]
    Wrong(#[from] TableError),
}

impl Table {
    /// Makes a table of CSV; `name` is used in errors.
    pub fn of_csv(text: impl Into<String>, name: impl Into<String>) -> Self {
        Self { name: name.into(), content: TableContent::Csv(text.into()) }
    }

    /// Opens a file: Parquet if its name ends so, otherwise CSV of at most [`MAX_TEXT_BYTES`], or CSV from standard input
    /// as `-`.
    ///
    /// # Errors
    /// If it cannot be read, or is no Parquet.
    pub fn open(file: &Path) -> Result<Self, NoTable> {
        Self::open_with(file, read)
    }

    /// Opens a file as [`open`](Self::open) does; `text` reads CSV.
    ///
    /// # Errors
    /// As [`open`](Self::open).
    pub(super) fn open_with(file: &Path, text: impl Fn(&Path) -> io::Result<String>) -> Result<Self, NoTable> {
        let name = file.display().to_string();
        let unread = |source| NoTable::Unread { file: file.into(), source };
        #[cfg(feature = "rows")]
        if matches!(RowForm::of(file), Ok(RowForm::Parquet)) {
            let opened = open(file, MAX_BYTES).map_err(unread)?;
            return Ok(Self { content: TableContent::Columns(parquet_columns(opened, &name)?), name });
        }
        Ok(Self::of_csv(text(file).map_err(unread)?, name))
    }

    /// Begins to read the table; `want` describes the expected head in errors.
    ///
    /// # Errors
    /// If it has no head.
    pub(super) fn reader(&self, want: &str) -> Result<TableReader<'_>, TableError> {
        match &self.content {
            TableContent::Csv(text) => TableReader::new(text, &self.name, want),
            TableContent::Columns(columns) => TableReader::of_columns(columns, &self.name, want),
        }
    }
}
