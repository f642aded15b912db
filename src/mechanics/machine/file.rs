//! Reading and writing of machine files in TOML; errors name file and line.

use std::path::{Path, PathBuf};

use thiserror::Error;
use toml::de::{DeTable, DeValue};

use super::{KeyPath, KeyStep, Machine, MachineError, MachineSpec};
use stillbase_settings::range::shortened;
use stillbase_settings::spelling::UnknownName;
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
    #[error("{file}{}: {error}", line.map(|l| format!(":{l}")).unwrap_or_default())]
    Wrong {
        /// The file.
        file: String,
        /// Line of the error, counted from 1, if known.
        line: Option<usize>,
        /// The error.
        #[source]
        error: MachineError,
    },
    /// No built-in machine has the name, and there is no such file.
    #[error(transparent)]
    UnknownName(#[from] UnknownName),
}

/// Returns the path of a file for messages, shortened because a path may be arbitrarily long.
fn named(file: &Path) -> String {
    shortened(&file.display().to_string(), 300)
}

/// Reads a machine from text; `file` is the name used in errors.
///
/// # Errors
/// If the text does not describe a machine.
pub fn parse(text: &str, file: &str) -> Result<Machine, FileError> {
    let wrong = |line, error| FileError::Wrong { file: file.into(), line, error };
    let spec: MachineSpec = toml::from_str(text).map_err(|e| {
        let line = e.span().map(|span| line_of(text, span.start));
        if let Some(DeValue::Array(several)) =
            DeTable::parse(text).ok().as_ref().and_then(|table| Some(table.get_ref().get("end_effector")?.get_ref()))
        {
            return wrong(line, MachineError::SeveralEndEffectors { count: several.len() });
        }
        wrong(line, MachineError::Syntax(shortened(e.message(), 300)))
    })?;
    Machine::new(spec).map_err(|e| wrong(e.place().and_then(|p| line_of_place(text, p)), e))
}

/// Writes a machine as TOML, from which [`parse`] returns an equal machine.
///
/// # Panics
/// Never: every machine can be written.
pub fn to_toml(machine: &Machine) -> String {
    toml::to_string(machine.spec()).expect("a machine is plain data")
}

/// Returns the line of a byte offset, counted from 1.
pub fn line_of(text: &str, byte: usize) -> usize {
    text.as_bytes()[..byte.min(text.len())].iter().filter(|b| **b == b'\n').count() + 1
}

/// Returns the line of the innermost step of a place that exists in the text.
pub fn line_of_place(text: &str, place: &KeyPath) -> Option<usize> {
    let table = DeTable::parse(text).ok()?;
    let mut span = None;
    let mut at: Option<&DeValue> = None;
    for step in &place.0 {
        let next = match (step, at) {
            (KeyStep::Key(k), None) => table.get_ref().get(k.as_str()),
            (KeyStep::Key(k), Some(DeValue::Table(t))) => t.get(k.as_str()),
            (KeyStep::At(i) | KeyStep::Named(i, _), Some(DeValue::Array(a))) => a.get(*i),
            _ => None,
        };
        let Some(next) = next else { break };
        span = Some(next.span());
        at = Some(next.get_ref());
    }
    span.map(|s| line_of(text, s.start))
}
