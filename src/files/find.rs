//! Finds machines and scenarios by name or by file.

use std::io::ErrorKind;
use std::path::Path;

use super::text::read;
use stillbase_exchange::import::{ImportedMachine, import};
use stillbase_mechanics::machine::{self, FileError, Machine, MachineError};
use stillbase_session::gentle_motion;
use stillbase_session::scenario::{FileContent, Scenario, ScenarioError, TaskKind, content};
use stillbase_settings::number::ShortNumber;
use stillbase_settings::range::shortened;
use stillbase_settings::spelling::UnknownName;

const IS_SCENARIO: &str = "this is a scenario, not a machine: want the machine that it names; simulate, headless, \
                           compare, joints, export, tolerance, spectrum and plan take a SCENARIO";

/// Returns a machine by built-in name or by file; a relative path is resolved in `folder`, if given.
///
/// # Errors
/// If there is no such machine or file, or if the file is not a machine.
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
                Some(FileContent::Scenario) => other(file),
                _ => why,
            })
        }
        Err(source) if source.kind() == ErrorKind::NotFound && !name.ends_with(".toml") => {
            Err(if Scenario::builtin(name).is_some() { other(name.into()) } else { machine::unknown(name) })
        }
        Err(source) => Err(FileError::Unreadable { file, source }),
    }
}

/// A scenario, with a note on its origin.
#[derive(Clone, Debug)]
pub struct FoundScenario {
    /// The scenario.
    pub scenario: Scenario,
    /// Note that the scenario was made for a machine, with the notes of its import; `None` otherwise.
    pub note: Option<String>,
}

/// Returns a scenario by built-in name or by file. A machine file that the scenario names is resolved in the folder of
/// the scenario. For the name or file of a machine, makes a scenario with a task.
///
/// # Errors
/// If there is no such scenario, machine or file, the file is neither, or no task can be stated for the machine.
pub fn scenario(name: &str) -> Result<FoundScenario, ScenarioError> {
    if let Some(scenario) = Scenario::builtin(name) {
        return Ok(FoundScenario { scenario, note: None });
    }
    let file = Path::new(name);
    let said = |message: String| ScenarioError::Syntax { file: shortened(name, 300), line: None, message };
    let text = match read(file) {
        Ok(text) => text,
        Err(source) if source.kind() == ErrorKind::NotFound && !name.ends_with(".toml") => {
            return match machine::builtin(name) {
                Some(machine) => scenario_for(name, machine),
                None => {
                    let machines: Vec<&str> = machine::builtins().iter().map(Machine::name).collect();
                    Err(UnknownName::new(name, "scenario", Scenario::builtin_names().collect(), &machines).into())
                }
            };
        }
        Err(source) => return Err(ScenarioError::Unreadable { file: shortened(name, 300), source }),
    };
    // This is a model of another program, because TOML cannot begin with this character.
    if text.trim_start().starts_with('<') {
        let ImportedMachine { machine, notes, .. } = import(&text).map_err(|why| said(why.to_string()))?;
        let FoundScenario { scenario, note } = scenario_for(name, &machine)?;
        let made = note.into_iter().chain(notes).collect::<Vec<_>>().join("; ");
        return Ok(FoundScenario { scenario, note: Some(made) });
    }
    if content(&text) == Some(FileContent::Machine) {
        return scenario_for(name, &machine::parse(&text, &shortened(name, 300))?);
    }
    let scenario = Scenario::parse(&text, name, Some(&|name| machine(name, file.parent())))?;
    Ok(FoundScenario { scenario, note: None })
}

/// Makes a scenario for a machine, whose name or file is `name`.
fn scenario_for(name: &str, machine: &Machine) -> Result<FoundScenario, ScenarioError> {
    let scenario = gentle_motion(machine)?;
    let task = &scenario.task;
    let made = format!(
        "{} is a machine, so a task was made for it: {} from {:.3}, {:.3} to {:.3}, {:.3} m in {} s",
        shortened(name, 300),
        if task.kind == TaskKind::Reactionless { "reactionless" } else { "a straight line" },
        task.from[0],
        task.from[1],
        task.to[0],
        task.to[1],
        ShortNumber(task.time)
    );
    Ok(FoundScenario { scenario, note: Some(made) })
}
