//! Machines and scenarios by name or by file.

use std::io::ErrorKind;
use std::path::Path;

use super::text::read;
use crate::mechanics::machine::{self, FileError, Machine, MachineError};
use crate::session::scenario::{Content, Scenario, ScenarioError, content};
use crate::settings::range::shortened;

const IS_MACHINE: &str = "this is a machine, not a scenario: want a file that names it, as machine = \"…\", beside a \
                          [task]; check, design, dynamics, reach, pose, workspace and plan take a MACHINE";
const IS_SCENARIO: &str = "this is a scenario, not a machine: want the machine that it names; simulate, headless, \
                           compare, joints, export, tolerance, spectrum and plan take a SCENARIO";

/// A machine by built-in name or by file; a relative file is looked up beside `folder` if there is one.
///
/// # Errors
/// If it is neither, or the file is not a machine.
pub fn machine(name: &str, folder: Option<&Path>) -> Result<Machine, FileError> {
    if let Some(machine) = machine::builtin(name) {
        return Ok(machine.clone());
    }
    let file = folder.map_or_else(|| name.into(), |folder| folder.join(name));
    let other = |file: String| {
        let error = MachineError::Syntax(IS_SCENARIO.into());
        FileError::Wrong { file: shortened(&file, 300), line: None, error }
    };
    match read(&file) {
        Ok(text) => {
            let file = file.display().to_string();
            machine::parse(&text, &file).map_err(|why| match content(&text) {
                Some(Content::Scenario) => other(file),
                _ => why,
            })
        }
        Err(source) if source.kind() == ErrorKind::NotFound && !name.ends_with(".toml") => {
            Err(if Scenario::builtin(name).is_some() { other(name.into()) } else { machine::unknown(name) })
        }
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
    let said = |message: String| ScenarioError::Syntax { file: shortened(name, 300), line: None, message };
    let text = read(file).map_err(|source| match source.kind() {
        ErrorKind::NotFound if machine::builtin(name).is_some() => said(IS_MACHINE.into()),
        ErrorKind::NotFound if !name.ends_with(".toml") => {
            let known = Scenario::builtin_names().collect::<Vec<_>>().join(", ");
            said(format!("no such scenario: want {known}, or a TOML file"))
        }
        _ => ScenarioError::Unreadable { file: shortened(name, 300), source },
    })?;
    Scenario::parse(&text, name, Some(&|name| machine(name, file.parent()))).map_err(|why| match content(&text) {
        Some(Content::Machine) => said(IS_MACHINE.into()),
        _ => why,
    })
}
