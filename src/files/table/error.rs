//! [`TableError`]: the reason why text is not the expected table.

use std::fmt::{self, Display};

use stillbase_study::advice::{Advice, Remedy};

/// The reason why text is not the expected table, with its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TableError {
    /// Name of the file or text.
    pub file: String,
    /// Line, counted from 1; `None` if the whole text is wrong.
    pub line: Option<u64>,
    /// The reason, with the column if there is one, and with the expected content.
    pub why: Advice,
}

impl TableError {
    /// Makes an error of a line, counted from 1.
    pub(super) fn at(file: &str, line: u64, why: impl Display) -> Self {
        Self { line: Some(line), ..Self::of_file(file, why) }
    }

    /// Makes an error of the whole text.
    pub(super) fn of_file(file: &str, why: impl Display) -> Self {
        Self { file: file.to_owned(), line: None, why: why.to_string().into() }
    }

    /// Returns the same error with other names for the remedies.
    #[must_use]
    pub fn worded(self, name: impl Fn(Remedy) -> &'static str) -> Self {
        Self { why: self.why.worded(name), ..self }
    }
}

/// Puts file and line before the reason.
impl From<TableError> for Advice {
    fn from(TableError { file, line, why }: TableError) -> Self {
        why.after(match line {
            Some(line) => format!("{file}:{line}: "),
            None => format!("{file}: "),
        })
    }
}

impl Display for TableError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.line {
            Some(line) => write!(f, "{}:{line}: {}", self.file, self.why),
            None => write!(f, "{}: {}", self.file, self.why),
        }
    }
}

impl std::error::Error for TableError {}
