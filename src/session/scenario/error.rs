//! Errors of a scenario, with file, line and key.

use thiserror::Error;

use super::bounds::ordinal;
use super::names::with_name;
use stillbase_mechanics::machine::{FileError, MachineError};
use stillbase_settings::fault::Faults;
use stillbase_settings::range::{Requirement, range_error};
use stillbase_settings::spelling::UnknownName;
use stillbase_settings::text::MAX_TEXT_BYTES;

/// Reason why a file is not a valid scenario.
#[derive(Debug, Error)]
pub enum ScenarioError {
    /// The file cannot be read.
    #[error("{file}: {source}: want a plain file that can be read, of at most {MAX_TEXT_BYTES} bytes")]
    Unreadable {
        /// The file.
        file: String,
        /// The system's reason.
        source: std::io::Error,
    },
    /// The text is not TOML, or not a scenario.
    #[error("{file}{}: {message}", at(*line))]
    Syntax {
        /// The file.
        file: String,
        /// Line, counted from 1.
        line: Option<usize>,
        /// Description of the error.
        message: String,
    },
    /// A number out of range.
    #[error("{file}{}: {}", at(*line), range_error(&with_name(key), *value, want))]
    OutOfRange {
        /// The file.
        file: String,
        /// Line, counted from 1, where it is known.
        line: Option<usize>,
        /// The key of the number.
        key: String,
        /// The value.
        value: f64,
        /// Allowed values.
        want: Requirement,
    },
    /// The machine of the scenario is not valid.
    #[error("{file}{}: machine: {error}", at(*line))]
    Machine {
        /// The file.
        file: String,
        /// Line, counted from 1, where it is known.
        line: Option<usize>,
        /// Description of the error.
        #[source]
        error: MachineError,
    },
    /// An edit is not valid.
    #[error("{file}{}: the {} [[edit]]: {message}", at(*line), ordinal(*entry))]
    Edit {
        /// The file.
        file: String,
        /// Line, counted from 1, where it is known.
        line: Option<usize>,
        /// Number of the edit, counted from 1.
        entry: usize,
        /// Description of the error.
        message: String,
    },
    /// No built-in scenario has the name, and there is no such file.
    #[error(transparent)]
    UnknownName(#[from] UnknownName),
    /// The text of a file is wrong in one place or several.
    #[error("{first}{}", and_more(faults))]
    Faulty {
        /// The file.
        file: String,
        /// The first error.
        #[source]
        first: Box<ScenarioError>,
        /// All faults.
        faults: Box<Faults>,
    },
    /// The file of the scenario's machine is wrong.
    #[error(transparent)]
    MachineFile(#[from] FileError),
}

/// Says how many faults a file has, if it has several.
fn and_more(faults: &Faults) -> String {
    if faults.count() > 1 { format!(" (one of {})", faults.counted()) } else { String::new() }
}

impl ScenarioError {
    /// Returns the file that is faulty, and its faults; `None` if no file was read.
    pub fn faults(&self) -> Option<(&str, &Faults)> {
        match self {
            Self::Faulty { file, faults, .. } => Some((file, faults)),
            Self::MachineFile(why) => why.file().zip(why.faults()),
            _ => None,
        }
    }
}

impl ScenarioError {
    /// Returns the error of a text that is not that of a file, whose lines and examples say nothing; `label` names what is
    /// wrong.
    #[must_use]
    pub fn without_lines(self, label: &str) -> Self {
        let file = label.to_owned();
        match self {
            Self::Faulty { first, mut faults, .. } => {
                for fault in &mut faults.list {
                    (fault.line, fault.column, fault.example) = (None, None, String::new());
                }
                Self::Faulty { file, first: Box::new(first.without_lines(label)), faults }
            }
            Self::Syntax { message, .. } => Self::Syntax { file, line: None, message },
            other => other,
        }
    }
}

/// Formats a line number as it follows the name of a file.
fn at(line: Option<usize>) -> String {
    line.map(|line| format!(":{line}")).unwrap_or_default()
}
