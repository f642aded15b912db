//! Machines and scenarios by name or by file.

use std::io::ErrorKind;
use std::path::Path;

use super::text::read;
use crate::mechanics::machine::{self, FileError, Machine};
use crate::session::scenario::{Scenario, ScenarioError};
use crate::settings::range::shortened;

/// A machine by built-in name or by file; a relative file is looked up beside `folder` if there is one.
///
/// # Errors
/// If it is neither, or the file is not a machine.
pub fn machine(name: &str, folder: Option<&Path>) -> Result<Machine, FileError> {
    if let Some(machine) = machine::builtin(name) {
        return Ok(machine.clone());
    }
    let file = folder.map_or_else(|| name.into(), |folder| folder.join(name));
    match read(&file) {
        Ok(text) => machine::parse(&text, &file.display().to_string()),
        Err(source) if source.kind() == ErrorKind::NotFound && !name.ends_with(".toml") => Err(machine::unknown(name)),
        Err(source) => Err(FileError::Unreadable { file, source }),
    }
}

/// A scenario by built-in name or by file; a machine file that it names is looked up beside it.
///
/// # Errors
/// If it is neither, or the file is not a scenario.
pub fn scenario(name: &str) -> Result<Scenario, ScenarioError> {
    if let Some(scenario) = Scenario::builtin(name) {
        return Ok(scenario);
    }
    let file = Path::new(name);
    let text = read(file).map_err(|source| match source.kind() {
        ErrorKind::NotFound if !name.ends_with(".toml") => ScenarioError::Syntax {
            file: shortened(name, 300),
            line: None,
            message: format!(
                "no such scenario: want {}, or a TOML file",
                Scenario::builtin_names().collect::<Vec<_>>().join(", ")
            ),
        },
        _ => ScenarioError::Unreadable { file: shortened(name, 300), source },
    })?;
    Scenario::parse(&text, name, Some(&|name| machine(name, file.parent())))
}
