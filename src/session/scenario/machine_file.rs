//! [`MachineFile`]: a machine with the brief of its design, as a machine file holds them.

use serde::{Deserialize, Serialize};
use toml::{Table, Value};

use super::design::{DesignBrief, is_default};
use super::keys::key_of;
use super::words::ScenarioWords;
use stillbase_mechanics::machine::{
    self, FileError, FirstProblem, KeyPath, KeyStep, Machine, MachineError, MachineWords,
};
use stillbase_settings::key;
use stillbase_settings::mending::{Meant, Problem, Vocabulary, Wrong};
use stillbase_settings::range::{RangeCheck, range_error};
use stillbase_settings::stated::StatedFile;

/// The key of the brief in machine files and in scenarios.
const DESIGN: &str = "design";

/// A machine with the brief of its design.
///
/// ```toml
/// [[drive]]                               # … and all else of a machine
/// name = "1"
/// [design]
/// clearance = 0.005                       # m
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct MachineFile {
    /// The machine.
    pub machine: Machine,
    /// Requirements on changes of it; the defaults if the file states none.
    pub design: DesignBrief,
}

/// What a machine file states beside its machine.
#[derive(Serialize, Deserialize)]
struct Beside {
    #[serde(default, skip_serializing_if = "is_default")]
    design: DesignBrief,
}

impl MachineFile {
    /// Reads a machine and its brief from text; `file` is the name used in errors.
    ///
    /// # Errors
    /// If the text does not describe a machine, or its `[design]` is wrong; the error has all faults of the text.
    pub fn parse(text: &str, file: &str) -> Result<Self, FileError> {
        machine::parse_with(text, file, &MachineFileWords, &read)
    }

    /// Returns the file as TOML, from which [`parse`](Self::parse) gives an equal one. A brief with its defaults is left
    /// out.
    ///
    /// # Panics
    /// Never: every machine and every brief can be written.
    pub fn to_toml(&self) -> String {
        let beside = toml::to_string(&Beside { design: self.design.clone() }).expect("a brief is plain data");
        let gap = if beside.is_empty() { "" } else { "\n" };
        format!("{}{gap}{beside}", machine::to_toml(&self.machine))
    }
}

/// A machine without a brief of its own.
impl From<Machine> for MachineFile {
    fn from(machine: Machine) -> Self {
        Self { machine, design: DesignBrief::default() }
    }
}

fn read(file: &StatedFile) -> Result<MachineFile, FirstProblem> {
    let wrong = |problem: Problem| {
        let text = problem.text(&MachineFileWords);
        Box::new((problem, MachineError::Syntax(text)))
    };
    let mut rest = file.clone();
    rest.remove(&KeyPath::new(&[&DESIGN]));
    // A file with nothing but a brief does state something.
    let of_machine = if rest.keys().next().is_some() { &rest } else { file };
    let machine = machine::read_stated(of_machine).map_err(|first| match *first {
        (Problem { path, wrong: Wrong::UnknownKey(known) }, _) if path.0.len() == 1 => {
            let known = known.into_iter().chain([DESIGN.to_owned()]).collect();
            wrong(Problem { path, wrong: Wrong::UnknownKey(known) })
        }
        other => Box::new(other),
    })?;
    let Beside { design } = file.read().map_err(|error| wrong(Problem::of(file, &error)))?;
    let stated = Table::try_from(&design)
        .map_err(|error| wrong(Problem { path: KeyPath::new(&[&DESIGN]), wrong: Wrong::Value(error.to_string()) }))?;
    let stated = Table::from_iter([(DESIGN.to_owned(), Value::Table(stated))]);
    let mut checks = key::checks(key_of, &stated).into_iter().chain(design.range_checks());
    if let Some(RangeCheck { key, value, want, .. }) = checks.find(|check| !check.ok) {
        let said = range_error("", value, &want).trim_start().to_owned();
        return Err(wrong(Problem { path: KeyPath::of_key(&key), wrong: Wrong::Value(said) }));
    }
    Ok(MachineFile { machine, design })
}

/// The words of machine files: those of machines, and those of scenarios for the brief.
struct MachineFileWords;

fn words_of(path: &KeyPath) -> &'static dyn Vocabulary {
    match path.0.first() {
        Some(KeyStep::Key(key)) if key == DESIGN => &ScenarioWords,
        _ => &MachineWords,
    }
}

impl Vocabulary for MachineFileWords {
    fn name(&self, path: &KeyPath) -> Option<String> {
        words_of(path).name(path)
    }

    fn want(&self, path: &KeyPath) -> Option<String> {
        words_of(path).want(path)
    }

    fn example(&self, path: &KeyPath) -> Option<&'static str> {
        words_of(path).example(path)
    }

    fn meant(&self, path: &KeyPath) -> Option<Meant> {
        words_of(path).meant(path)
    }

    fn with_own_names(&self, example: String, file: &StatedFile) -> String {
        MachineWords.with_own_names(example, file)
    }
}
