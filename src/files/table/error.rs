//! [`TableError`]: why text is not the table that is wanted.

use std::fmt::{self, Display};

use crate::study::advice::{Advice, Remedy};

/// Why text is not the table that is wanted: where, and what was expected.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TableError {
    /// What the text is called.
    pub file: String,
    /// Line, counted from 1; none if the whole text is wrong.
    pub line: Option<u64>,
    /// What is wrong, by column where it is one, and what was expected.
    pub why: Advice,
}

impl TableError {
    /// Of a line, counted from 1.
    pub(super) fn at(file: &str, line: u64, why: impl Display) -> Self {
        Self { line: Some(line), ..Self::whole(file, why) }
    }

    /// Of the whole text.
    pub(super) fn whole(file: &str, why: impl Display) -> Self {
        Self { file: file.to_owned(), line: None, why: why.to_string().into() }
    }

    /// The same with other names for the ways out.
    #[must_use]
    pub fn worded(self, name: impl Fn(Remedy) -> &'static str) -> Self {
        Self { why: self.why.worded(name), ..self }
    }
}

/// Where, and why.
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
