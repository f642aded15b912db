//! Finds machines and scenarios by name or by file.

use std::io::ErrorKind;
use std::path::Path;

use super::text::read;
use stillbase_exchange::import::{ImportedMachine, faults, import};
use stillbase_mechanics::machine::{self, FileError, Machine, MachineError};
use stillbase_session::gentle_motion;
use stillbase_session::scenario::{FileContent, Scenario, ScenarioError, TaskKind, content};
use stillbase_settings::fault::{Fault, Faults};
use stillbase_settings::number::ShortNumber;
use stillbase_settings::range::shortened;
use stillbase_settings::spelling::UnknownName;

const IS_SCENARIO: &str = "this is a scenario, not a machine: want the machine that it names; simulate, headless, \
                           compare, joints, export, tolerance, spectrum and plan take a SCENARIO";

/// A machine, with notes on its origin.
#[derive(Clone, Debug)]
pub struct FoundMachine {
    /// The machine.
    pub machine: Machine,
    /// What was left out of the model of another program; empty for a machine of this one.
    pub left_out: Vec<String>,
}

/// Returns a machine by built-in name or by file; a relative path is resolved in `folder`, if given.
///
/// # Errors
/// If there is no such machine or file, or if the file is not a machine.
pub fn machine(name: &str, folder: Option<&Path>) -> Result<Machine, FileError> {
    found_machine(name, folder).map(|found| found.machine)
}

/// Returns a machine as [`machine()`] does, with what was left out of it. The file may be a model of another program.
///
/// # Errors
/// As [`machine()`].
pub fn found_machine(name: &str, folder: Option<&Path>) -> Result<FoundMachine, FileError> {
    let own = |machine| FoundMachine { machine, left_out: Vec::new() };
    if let Some(machine) = machine::builtin(name) {
        return Ok(own(machine.clone()));
    }
    let file = folder.map_or_else(|| name.into(), |folder| folder.join(name));
    let other = |file: String| wrong_file(&file, Faults::one(whole_file(IS_SCENARIO)));
    match read(&file) {
        Ok(text) => {
            let file = file.display().to_string();
            if is_model(&text) {
                let ImportedMachine { machine, notes, .. } = model(&text, &file)?;
                return Ok(FoundMachine { machine, left_out: notes });
            }
            machine::parse(&text, &file).map(own).map_err(|why| match content(&text) {
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

/// Reads a machine from the text of a URDF or MJCF file, which errors name.
///
/// # Errors
/// If it is no planar machine; the error has all values that are wrong, or the first other fault.
pub fn model(text: &str, file: &str) -> Result<ImportedMachine, FileError> {
    import(text).map_err(|why| wrong_file(file, faults(text, why)))
}

/// Returns whether a text is a model of another program; TOML cannot begin with this character.
fn is_model(text: &str) -> bool {
    text.trim_start().starts_with('<')
}

/// Returns the fault of a whole file.
fn whole_file(why: impl Into<String>) -> Fault {
    Fault { line: None, column: None, key: String::new(), text: why.into(), example: String::new() }
}

/// Returns the error of a file with faults.
fn wrong_file(file: &str, faults: Faults) -> FileError {
    let (line, text) = faults.list.first().map_or((None, String::new()), |fault| (fault.line, fault.text.clone()));
    FileError::Wrong { file: shortened(file, 300), line, error: MachineError::Syntax(text), faults: Box::new(faults) }
}

/// A scenario, with notes on its origin.
#[derive(Clone, Debug)]
pub struct FoundScenario {
    /// The scenario.
    pub scenario: Scenario,
    /// Note that the scenario was made for a machine; `None` otherwise.
    pub note: Option<String>,
    /// What was left out of the model of another program; empty for files of this one.
    pub left_out: Vec<String>,
}

/// Returns a scenario by built-in name or by file. A machine file that the scenario names is resolved in the folder of
/// the scenario. For the name or file of a machine, makes a scenario with a task.
///
/// # Errors
/// If there is no such scenario, machine or file, the file is neither, or no task can be stated for the machine.
pub fn scenario(name: &str) -> Result<FoundScenario, ScenarioError> {
    if let Some(scenario) = Scenario::builtin(name) {
        return Ok(FoundScenario { scenario, note: None, left_out: Vec::new() });
    }
    if let Some(scenario) = recorded(name) {
        return scenario;
    }
    let file = Path::new(name);
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
    if is_model(&text) {
        let ImportedMachine { machine, notes, .. } = model(&text, name)?;
        return Ok(FoundScenario { left_out: notes, ..scenario_for(name, &machine)? });
    }
    if content(&text) == Some(FileContent::Machine) {
        return scenario_for(name, &machine::parse(&text, &shortened(name, 300))?);
    }
    let scenario = Scenario::parse(&text, name, Some(&|name| machine(name, file.parent())))?;
    Ok(FoundScenario { scenario, note: None, left_out: Vec::new() })
}

/// Returns the session of a recording, the first of several; `None` if the name is not that of a recording.
#[cfg(feature = "record")]
fn recorded(name: &str) -> Option<Result<FoundScenario, ScenarioError>> {
    let wrong = |message: String| ScenarioError::Syntax { file: shortened(name, 300), line: None, message };
    let cases = crate::recorded::CaseName::of(name)?.cases().map_err(|why| wrong(why.why));
    let first = |cases: Vec<crate::recorded::RecordedCase>| {
        let names: Vec<&str> = cases.iter().map(|case| case.name.as_str()).collect();
        let [first, .., last] = &names[..] else { return Ok((cases[0].scenario()?, None)) };
        let all = shortened(&names.join(", "), 300);
        let note = format!("{name} holds the cases {all}: taken is {first}; {name}:{last} names another");
        Ok((cases[0].scenario()?, Some(note)))
    };
    Some(cases.and_then(first).map(|(scenario, note)| FoundScenario { scenario, note, left_out: Vec::new() }))
}

#[cfg(not(feature = "record"))]
fn recorded(name: &str) -> Option<Result<FoundScenario, ScenarioError>> {
    let message = "this build reads no recordings: want a TOML file".into();
    let is_recording = name.to_ascii_lowercase().ends_with(".rrd");
    is_recording.then(|| Err(ScenarioError::Syntax { file: shortened(name, 300), line: None, message }))
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
    Ok(FoundScenario { scenario, note: Some(made), left_out: Vec::new() })
}
