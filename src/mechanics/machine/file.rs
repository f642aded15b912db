//! Reading and writing of machine files in TOML; errors name file and line.

use std::path::{Path, PathBuf};

use thiserror::Error;

use super::faults::{self, FirstProblem};
use super::words::MachineWords;
use super::{Machine, MachineError};
use stillbase_settings::fault::Faults;
use stillbase_settings::mending::{Vocabulary, faults_of};
use stillbase_settings::range::shortened;
use stillbase_settings::spelling::UnknownName;
use stillbase_settings::stated::StatedFile;
use stillbase_settings::text::MAX_TEXT_BYTES;

/// Error of a machine file, with its place.
#[derive(Debug, Error)]
pub enum FileError {
    /// The file cannot be read.
    #[error("{}: {source}: want a plain file that can be read, of at most {MAX_TEXT_BYTES} bytes", named(file))]
    Unreadable {
        /// The file.
        file: PathBuf,
        /// Reason: that of the operating system, or that it is no plain file or too long.
        source: std::io::Error,
    },
    /// The file does not describe a machine.
    #[error("{file}{}: {error}{}", line.map(|l| format!(":{l}")).unwrap_or_default(), and_more(faults))]
    Wrong {
        /// The file.
        file: String,
        /// Line of the error, counted from 1, if known.
        line: Option<usize>,
        /// The first error.
        #[source]
        error: MachineError,
        /// All faults of the file.
        faults: Box<Faults>,
    },
    /// No built-in machine has the name, and there is no such file.
    #[error(transparent)]
    UnknownName(#[from] UnknownName),
}

/// Says how many faults a file has, if it has several.
fn and_more(faults: &Faults) -> String {
    if faults.count() > 1 { format!(" (one of {})", faults.counted()) } else { String::new() }
}

impl FileError {
    /// Returns the faults of the file; `None` if it was not even read.
    pub fn faults(&self) -> Option<&Faults> {
        match self {
            Self::Wrong { faults, .. } => Some(faults),
            Self::Unreadable { .. } | Self::UnknownName(_) => None,
        }
    }

    /// Returns the file, for the places of its faults.
    pub fn file(&self) -> Option<&str> {
        match self {
            Self::Wrong { file, .. } => Some(file),
            Self::Unreadable { .. } | Self::UnknownName(_) => None,
        }
    }
}

/// Returns the path of a file for messages, shortened because a path may be arbitrarily long.
fn named(file: &Path) -> String {
    shortened(&file.display().to_string(), 300)
}

/// Reads a machine from text; `file` is the name used in errors.
///
/// # Errors
/// If the text does not describe a machine; the error has all faults of the text.
pub fn parse(text: &str, file: &str) -> Result<Machine, FileError> {
    parse_with(text, file, &MachineWords, &faults::read)
}

/// Reads from text a machine with what else its file holds: `read` reads both, `words` names the keys of both.
///
/// # Errors
/// As [`parse`].
pub fn parse_with<T>(
    text: &str,
    file: &str,
    words: &dyn Vocabulary,
    read: &dyn Fn(&StatedFile) -> Result<T, FirstProblem>,
) -> Result<T, FileError> {
    let first = match StatedFile::parse(text) {
        Ok(stated) => match read(&stated) {
            Ok(found) => return Ok(found),
            Err(first) => Some((stated.place(&first.0.path), first.1)),
        },
        Err(_) => None,
    };
    let faults = faults_of(text, words, &|stated| read(stated).map(|_| ()).map_err(|first| first.0));
    let (line, error) = match (first, faults.list.first()) {
        (Some((place, error)), _) => (place.map(|place| place.line), error),
        (None, Some(fault)) => (fault.line, MachineError::Syntax(fault.text.clone())),
        (None, None) => (None, MachineError::Syntax("this is not TOML".into())),
    };
    Err(FileError::Wrong { file: file.into(), line, error, faults: Box::new(faults) })
}

/// Writes a machine as TOML, from which [`parse`] returns an equal machine.
///
/// # Panics
/// Never: every machine can be written.
pub fn to_toml(machine: &Machine) -> String {
    toml::to_string(machine.spec()).expect("a machine is plain data")
}
