//! Finds machines and scenarios by name or by file.

use std::io::ErrorKind;
use std::path::Path;

use super::afloat::{base_of, scenario_afloat};
use super::recorded_case::RecordedCase;
#[cfg(not(feature = "record"))]
use super::recorded_case::is_recording;
use super::text::{STANDARD_INPUT, read};
use stillbase_exchange::import::{ImportedMachine, faults, import};
use stillbase_mechanics::assembly::{self, Assembly, builtin_assemblies};
use stillbase_mechanics::machine::{self, FileError, Machine, MachineError};
use stillbase_mechanics::sketch::Template;
use stillbase_session::assembly::{AssemblyScenario, builtin_assembly_scenarios, builtin_scenario_text, changed_keys};
use stillbase_session::gentle_motion;
use stillbase_session::scenario::{DesignBrief, FileContent, MachineFile, Scenario, ScenarioError, TaskKind, content};
use stillbase_session::with_start_edits;
use stillbase_settings::fault::{Fault, Faults};
use stillbase_settings::number::ShortNumber;
use stillbase_settings::range::shortened;
use stillbase_settings::spelling::UnknownName;
use stillbase_simulation::plant::{Base, BaseKind};

const IS_ASSEMBLY: &str = "this is an assembly of several machines: want one machine; the window, check, design --counterweights, \
                           dynamics, simulate, headless, replay, diff, table, render and export-model take an assembly, \
                           too";

const IS_OF_ASSEMBLY: &str = "this is a scenario of an assembly of several machines: want one of a machine; the window, \
                              simulate, headless, replay, diff, table, render and export-model take this one, too";

const IS_SCENARIO: &str = "this is a scenario, not a machine: want the machine that it names; simulate, headless, \
                           compare, joints, export, tolerance, spectrum and plan take a SCENARIO";

/// A machine, with notes on its origin.
#[derive(Clone, Debug)]
pub struct FoundMachine {
    /// The machine.
    pub machine: Machine,
    /// The brief of its design that its file holds; the defaults if it holds none.
    pub design: DesignBrief,
    /// The base of the scenario or of the model, if the file has one that floats.
    pub base: Option<Base>,
    /// The scenario at its start, if the file is one.
    pub scenario: Option<Box<Scenario>>,
    /// What was left out of the model of another program; empty for a machine of this one.
    pub left_out: Vec<String>,
}

/// Returns a machine by built-in name or by file; a relative path is resolved in `folder`, if given.
///
/// # Errors
/// If there is no such machine or file, or if the file is not a machine.
pub fn machine(name: &str, folder: Option<&Path>) -> Result<Machine, FileError> {
    found(name, folder, false).map(|found| found.machine)
}

/// Returns a machine as [`machine()`] does, with what was left out of it. The file may be a model of another program, or
/// a scenario: then its machine at the start is meant.
///
/// # Errors
/// As [`machine()`], and if the start of the scenario has no machine.
pub fn found_machine(name: &str) -> Result<FoundMachine, FileError> {
    found(name, None, true)
}

/// Returns the machine of a scenario at its start: after its edits at step 0, such as a drawing.
fn machine_of(scenario: &Scenario, file: &str) -> Result<FoundMachine, FileError> {
    let wrong = |why: String| wrong_file(file, Faults::one(whole_file(why)));
    let (start, _) = with_start_edits(scenario).map_err(|why| wrong(why.to_string()))?;
    if let Some(unfinished) = start.unfinished() {
        return Err(wrong(unfinished.to_string()));
    }
    let note = format!("it is a scenario, taken is its machine {}", start.machine.name());
    let base = Some(start.base).filter(|base| base.kind == BaseKind::Free);
    let (machine, design) = (start.machine.clone(), start.design.clone());
    Ok(FoundMachine { machine, design, base, scenario: Some(start.into()), left_out: vec![note] })
}

fn found(name: &str, folder: Option<&Path>, takes_scenarios: bool) -> Result<FoundMachine, FileError> {
    let own = |MachineFile { machine, design }| FoundMachine {
        machine,
        design,
        base: None,
        scenario: None,
        left_out: Vec::new(),
    };
    if let Some(machine) = known_machine(name) {
        return Ok(own(machine.into()));
    }
    if let Some(found) = recorded(name).filter(|_| takes_scenarios) {
        let found = found.map_err(|why| wrong_file(name, Faults::one(whole_file(why.to_string()))))?;
        let of_scenario = machine_of(&found.scenario, name)?;
        let left_out = found.note.into_iter().chain(of_scenario.left_out).collect();
        return Ok(FoundMachine { left_out, ..of_scenario });
    }
    if builtin_assemblies().iter().any(|own| own.name == name) {
        return Err(wrong_file(name, Faults::one(whole_file(IS_ASSEMBLY))));
    }
    if builtin_scenario_text(name).is_some() {
        return Err(wrong_file(name, Faults::one(whole_file(IS_OF_ASSEMBLY))));
    }
    let file = folder.map_or_else(|| name.into(), |folder| folder.join(name));
    let other = |file: String| wrong_file(&file, Faults::one(whole_file(IS_SCENARIO)));
    match read(&file) {
        Ok(text) => {
            let file = label(&file.display().to_string()).to_owned();
            if is_model(&text) {
                let ImportedMachine { machine, base, floats, notes, .. } = model(&text, &file)?;
                let base = base.filter(|_| floats).map(|base| base_of(&base));
                return Ok(FoundMachine { base, left_out: notes, ..own(machine.into()) });
            }
            match content(&text) {
                Some(FileContent::Scenario) if takes_scenarios => {
                    let found = scenario(name).map_err(|why| match why {
                        ScenarioError::MachineFile(why) => why,
                        ScenarioError::Faulty { faults, .. } => wrong_file(&file, *faults),
                        why => wrong_file(&file, Faults::one(whole_file(why.to_string()))),
                    });
                    machine_of(&found?.scenario, &file)
                }
                Some(FileContent::Scenario) => MachineFile::parse(&text, &file).map(own).map_err(|_| other(file)),
                Some(FileContent::Assembly) => Err(wrong_file(&file, Faults::one(whole_file(IS_ASSEMBLY)))),
                _ => MachineFile::parse(&text, &file).map(own),
            }
        }
        Err(source) if source.kind() == ErrorKind::NotFound && !name.ends_with(".toml") => {
            match Scenario::builtin(name) {
                Some(scenario) if takes_scenarios => machine_of(&scenario, name),
                Some(_) => Err(other(name.into())),
                None => Err(machine::unknown(name, &Template::ALL.map(Template::word))),
            }
        }
        Err(source) => Err(FileError::Unreadable { file, source }),
    }
}

/// Returns an assembly by built-in name or by file; `None` for anything else. A machine file that it names is resolved in its
/// folder.
///
/// # Errors
/// If the file describes an assembly that is wrong.
pub fn assembly(name: &str) -> Result<Option<Assembly>, FileError> {
    if let Some(known) = builtin_assemblies().iter().find(|own| own.name == name) {
        return Ok(Some(known.clone()));
    }
    let file = Path::new(name);
    // What is no text, or is not there, is told by the reader of machines.
    let text = if known_machine(name).is_some() { None } else { read(file).ok() };
    let Some(text) = text.filter(|text| content(text) == Some(FileContent::Assembly)) else { return Ok(None) };
    assembly::parse(&text, &shortened(label(name), 300), &|name| machine(name, file.parent())).map(Some)
}

/// Returns the scenario of an assembly that a file holds, with keys of the file changed, and the assembly by `apply`; `None`
/// for anything else. Files that it names are resolved in the folders of those that name them.
///
/// # Errors
/// If the scenario or its assembly is wrong, or that of `apply`.
pub fn assembly_scenario<E: From<ScenarioError>>(
    name: &str,
    change: &toml::Table,
    apply: impl FnOnce(Assembly) -> Result<Assembly, E>,
) -> Result<Option<AssemblyScenario>, E> {
    let file = Path::new(name);
    let text = match (builtin_scenario_text(name), recorded(name)) {
        (Some(text), _) => Some(text.to_owned()),
        (None, Some(found)) => {
            let scenario = found?.scenario;
            scenario.assembly.is_some().then(|| scenario.to_toml())
        }
        (None, None) if Scenario::builtin(name).is_some() => None,
        (None, None) => read(file).ok(),
    };
    text.map_or(Ok(None), |text| assembly_scenario_of((&text, name, file.parent()), change, apply))
}

/// Returns the scenario of an assembly that a text holds, as [`assembly_scenario`] does. `label` names the text in errors;
/// files that it names are resolved in `folder`.
///
/// # Errors
/// As [`assembly_scenario`].
pub(crate) fn assembly_scenario_of<E: From<ScenarioError>>(
    (text, name, folder): (&str, &str, Option<&Path>),
    change: &toml::Table,
    apply: impl FnOnce(Assembly) -> Result<Assembly, E>,
) -> Result<Option<AssemblyScenario>, E> {
    let Ok(table) = text.parse::<toml::Table>() else { return Ok(None) };
    let found = match table.get("machine") {
        Some(toml::Value::String(machine)) => {
            let is_known = builtin_assemblies().iter().any(|own| own.name == *machine);
            let beside = folder.filter(|_| !is_known).map_or_else(|| machine.into(), |folder| folder.join(machine));
            assembly(&beside.display().to_string())
        }
        // A session that was saved holds its assembly.
        Some(toml::Value::Table(whole)) if whole.contains_key("block") => {
            let find = |name: &str| machine(name, folder);
            assembly::parse(&whole.to_string(), &shortened(label(name), 300), &find).map(Some)
        }
        _ => return Ok(None),
    };
    let Some(found) = found.map_err(ScenarioError::from)? else { return Ok(None) };
    let assembly = apply(found)?;
    let label = shortened(label(name), 300);
    if change.is_empty() {
        return Ok(Some(AssemblyScenario::parse(text, &label, assembly)?));
    }
    let changed = changed_keys(table, change).to_string();
    let read = AssemblyScenario::parse(&changed, &label, assembly.clone()).map_err(|why| {
        let is_sound = AssemblyScenario::parse(text, &label, assembly).is_ok();
        why.without_lines(if is_sound { "--set" } else { &label })
    });
    Ok(Some(read?))
}

/// Returns a scenario as [`scenario`] does. Of an assembly, returns that of the block which its file leads; for the name or
/// file of an assembly alone, makes a task for each of its blocks.
///
/// # Errors
/// As [`scenario`], and if a scenario of an assembly is wrong.
pub fn any_scenario(name: &str) -> Result<FoundScenario, ScenarioError> {
    let leads = |whole: AssemblyScenario, note| FoundScenario {
        scenario: whole.leading(whole.lead),
        note,
        left_out: Vec::new(),
        recorded: None,
    };
    if let Some(whole) = assembly_scenario::<ScenarioError>(name, &toml::Table::new(), Ok)? {
        return Ok(leads(whole, None));
    }
    match assembly(name).map_err(ScenarioError::from)? {
        Some(assembly) => {
            let note = "a motion was made for each block of the assembly";
            AssemblyScenario::for_assembly(assembly).map(|whole| leads(whole, Some(note.into())))
        }
        None => found_scenario(name),
    }
}

/// Returns a machine that everyone has: a built-in one, or that of a template for drawings.
fn known_machine(name: &str) -> Option<Machine> {
    machine::builtin(name).cloned().or_else(|| Template::of_word(name)?.sketch().machine())
}

/// Reads a machine from the text of a URDF or MJCF file, which errors name.
///
/// # Errors
/// If it is no planar machine; the error has all values that are wrong, or the first other fault.
pub fn model(text: &str, file: &str) -> Result<ImportedMachine, FileError> {
    import(text).map_err(|why| wrong_file(file, faults(text, why)))
}

/// Returns what messages call a file.
fn label(file: &str) -> &str {
    if file == STANDARD_INPUT { "standard input" } else { file }
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
    /// The recording that holds the scenario, if one does.
    pub recorded: Option<Box<RecordedCase>>,
}

/// Returns a scenario by built-in name or by file. A machine file that the scenario names is resolved in the folder of
/// the scenario. For the name or file of a machine, makes a scenario with a task.
///
/// # Errors
/// If there is no such scenario, machine or file, the file is neither, or no task can be stated for the machine.
pub fn scenario(name: &str) -> Result<FoundScenario, ScenarioError> {
    let found = found_scenario(name)?;
    match found.scenario.assembly {
        Some(_) => Err(wrong_file(name, Faults::one(whole_file(IS_OF_ASSEMBLY))).into()),
        None => Ok(found),
    }
}

/// Does the same as [`scenario`], and takes recordings of assemblies.
fn found_scenario(name: &str) -> Result<FoundScenario, ScenarioError> {
    if let Some(scenario) = Scenario::builtin(name) {
        return Ok(FoundScenario { scenario, note: None, left_out: Vec::new(), recorded: None });
    }
    if let Some(scenario) = recorded(name) {
        return scenario;
    }
    if builtin_scenario_text(name).is_some() {
        return Err(wrong_file(name, Faults::one(whole_file(IS_OF_ASSEMBLY))).into());
    }
    if builtin_assemblies().iter().any(|own| own.name == name) {
        return Err(wrong_file(name, Faults::one(whole_file(IS_ASSEMBLY))).into());
    }
    let file = Path::new(name);
    let text = match read(file) {
        Ok(text) => text,
        Err(source) if source.kind() == ErrorKind::NotFound && !name.ends_with(".toml") => {
            return match known_machine(name) {
                Some(machine) => scenario_for(name, machine.into()),
                None => {
                    let builtin = machine::builtins().iter().map(Machine::name);
                    let assemblies = builtin_assemblies().iter().map(|own| own.name.as_str());
                    let machines: Vec<&str> =
                        builtin.chain(assemblies).chain(Template::ALL.map(Template::word)).collect();
                    Err(UnknownName::new(
                        name,
                        "scenario",
                        Scenario::builtin_names().chain(builtin_assembly_scenarios()).collect(),
                        &machines,
                    )
                    .into())
                }
            };
        }
        Err(source) => return Err(ScenarioError::Unreadable { file: shortened(name, 300), source }),
    };
    if assembly_scenario::<ScenarioError>(name, &toml::Table::new(), Ok)?.is_some() {
        return Err(wrong_file(name, Faults::one(whole_file(IS_OF_ASSEMBLY))).into());
    }
    let name = label(name);
    if is_model(&text) {
        let ImportedMachine { machine, base, floats, notes, .. } = model(&text, name)?;
        let found = match base.filter(|_| floats) {
            Some(base) => with_note(name, scenario_afloat(&machine, &base)?),
            None => scenario_for(name, machine.into())?,
        };
        return Ok(FoundScenario { left_out: notes, ..found });
    }
    if content(&text) == Some(FileContent::Machine) {
        return scenario_for(name, MachineFile::parse(&text, &shortened(name, 300))?);
    }
    let find = |name: &str| {
        let FoundMachine { machine, design, .. } = found(name, file.parent(), false)?;
        Ok(MachineFile { machine, design })
    };
    let scenario = Scenario::parse(&text, name, Some(&find))?;
    Ok(FoundScenario { scenario, note: None, left_out: Vec::new(), recorded: None })
}

/// Returns the session of a recording, the first of several; `None` if the name is not that of a recording.
#[cfg(feature = "record")]
fn recorded(name: &str) -> Option<Result<FoundScenario, ScenarioError>> {
    let wrong = |message: String| ScenarioError::Syntax { file: shortened(name, 300), line: None, message };
    let cases = crate::recorded::CaseName::of(name)?.cases().map_err(|why| wrong(why.why));
    let first = |mut cases: Vec<RecordedCase>| {
        let names: Vec<&str> = cases.iter().map(|case| case.name.as_str()).collect();
        let note = match &names[..] {
            [first, .., last] => {
                let all = shortened(&names.join(", "), 300);
                Some(format!("{name} holds the cases {all}: taken is {first}; {name}:{last} names another"))
            }
            _ => None,
        };
        let case = cases.swap_remove(0);
        let (scenario, recorded) = (case.scenario()?, Some(Box::new(case)));
        Ok(FoundScenario { scenario, note, left_out: Vec::new(), recorded })
    };
    Some(cases.and_then(first))
}

#[cfg(not(feature = "record"))]
fn recorded(name: &str) -> Option<Result<FoundScenario, ScenarioError>> {
    let message = "this build reads no recordings: want a TOML file".into();
    is_recording(name).then(|| Err(ScenarioError::Syntax { file: shortened(name, 300), line: None, message }))
}

/// Makes a scenario for a machine, whose name or file is `name`. The scenario has the brief of the file.
fn scenario_for(name: &str, of: MachineFile) -> Result<FoundScenario, ScenarioError> {
    let MachineFile { machine, design } = of;
    Ok(with_note(name, Scenario { design, ..gentle_motion(&machine)? }))
}

/// Returns a scenario that was made for a machine, whose name or file is `name`, with a note that says so.
fn with_note(name: &str, scenario: Scenario) -> FoundScenario {
    let task = &scenario.task;
    let made = format!(
        "{} is a machine, so a task was made for it: {} from {:.3}, {:.3} to {:.3}, {:.3} m in {} s",
        shortened(name, 300),
        match task.kind {
            TaskKind::Reactionless => "reactionless",
            TaskKind::ZeroMomentum => "a straight line without momentum",
            _ => "a straight line",
        },
        task.from[0],
        task.from[1],
        task.to[0],
        task.to[1],
        ShortNumber(task.time)
    );
    FoundScenario { scenario, note: Some(made), left_out: Vec::new(), recorded: None }
}
