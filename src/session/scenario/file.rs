//! Reads and writes scenarios as TOML.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::definition::Scenario;
use super::design::{DesignBrief, is_default};
use super::error::ScenarioError;
use super::kept::{Bookmark, StatedBranch, branches, check_bookmarks};
use super::machine_file::MachineFile;
use super::note::{StatedNote, notes};
use super::own::ScenarioSettings;
use super::task::{IncompleteTask, Task};
use super::tolerance::Tolerance;
use super::words::ScenarioWords;
use crate::assembly::AssemblyScenario;
use crate::{TimedEdit, check_edits};
use stillbase_mechanics::machine::{self, FileError, KeyPath, KeyStep, Machine, MachineError, MachineSpec};
use stillbase_mechanics::sketch::{Sketch, SketchRefusal};
use stillbase_settings::change;
use stillbase_settings::mending::{Problem, Wrong, called, faults_of};
use stillbase_settings::range::{MAX_SAID, quote_clipped, range_error, shortened};
use stillbase_settings::stated::{MendValue, StatedFile};
use stillbase_settings::text::{control_character, plain};
use stillbase_simulation::control::Control;
use stillbase_simulation::plant::{Base, PlantDifferences};

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    name: Option<String>,
    #[serde(default)]
    title: String,
    #[serde(default, skip_serializing_if = "String::is_empty")]
    summary: String,
    machine: MachineRef,
    /// Settings of the machine, as on the command line: `payload.mass=0.5`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    set: Vec<String>,
    #[serde(default = "usual_step")]
    step: f64,
    duration: Option<f64>,
    #[serde(default = "usual_pose_acceleration")]
    pose_acceleration: f64,
    compare_b: Option<f64>,
    #[serde(serialize_with = "stated_task")]
    task: Task,
    #[serde(default, skip_serializing_if = "is_default")]
    control: Control,
    #[serde(default, skip_serializing_if = "is_default")]
    plant: PlantDifferences,
    #[serde(default, skip_serializing_if = "is_default")]
    base: Base,
    #[serde(default, skip_serializing_if = "Tolerance::is_empty")]
    tolerance: Tolerance,
    #[serde(default, skip_serializing_if = "is_default")]
    design: DesignBrief,
    sketch: Option<Sketch>,
    /// Edits as unparsed tables, so that an error can name the wrong one.
    #[serde(default, rename = "edit", skip_serializing_if = "Vec::is_empty")]
    edits: Vec<toml::Table>,
    #[serde(default, rename = "bookmark", skip_serializing_if = "Vec::is_empty")]
    bookmarks: Vec<Bookmark>,
    #[serde(default, rename = "note", skip_serializing_if = "Vec::is_empty")]
    notes: Vec<StatedNote>,
    #[serde(default, rename = "branch", skip_serializing_if = "Vec::is_empty")]
    branches: Vec<StatedBranch>,
}

/// Writes a task without A and b if they follow from its start: a machine without b has none to state.
fn stated_task<S: serde::Serializer>(task: &Task, serializer: S) -> Result<S::Ok, S::Error> {
    if task.start.is_none() || task.samples.is_some() {
        return task.serialize(serializer);
    }
    let mut stated = toml::Table::try_from(task).map_err(serde::ser::Error::custom)?;
    stated.retain(|key, _| !["from", "b"].contains(&key));
    stated.serialize(serializer)
}

fn usual_step() -> f64 {
    ScenarioSettings::default().step
}

fn usual_pose_acceleration() -> f64 {
    ScenarioSettings::default().pose_acceleration
}

#[derive(Serialize, Deserialize)]
#[serde(untagged, expecting = "want the name of a machine, a file, or a whole machine as a table")]
enum MachineRef {
    Name(String),
    Inline(Box<MachineSpec>),
}

/// Requirement on name, title and summary.
const PRINTABLE: &str = "want printable characters";

/// Content of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileContent {
    /// A machine.
    Machine,
    /// A scenario, with its machine.
    Scenario,
    /// Several machines on one base.
    Assembly,
}

/// Returns whether a file is a machine, a scenario or an assembly, by tables that only one of them has. Returns `None` if
/// it has tables of none or of several, or is not TOML.
pub fn content(text: &str) -> Option<FileContent> {
    let table: toml::Table = text.parse().ok()?;
    let has = |keys: [&str; 2]| keys.iter().any(|key| table.contains_key(*key));
    let is_assembly =
        table.contains_key("block") || table.get("kind").is_some_and(|kind| kind.as_str() == Some("assembly"));
    match (has(["link", "drive"]), has(["task", "machine"]), is_assembly) {
        (true, false, false) => Some(FileContent::Machine),
        (false, true, false) => Some(FileContent::Scenario),
        (false, false, true) => Some(FileContent::Assembly),
        _ => None,
    }
}

/// Looks up a machine by name or file, with the brief that its file holds.
pub type FindMachine<'a> = &'a dyn Fn(&str) -> Result<MachineFile, FileError>;

/// The first problem of a text, with the error that it makes.
type FirstProblem = Box<(Problem, ScenarioError)>;

/// A scenario being read from a file.
struct Reading<'a> {
    file: &'a StatedFile<'a>,
    label: &'a str,
    find: Option<FindMachine<'a>>,
    /// Task in place of that of the file.
    task: Option<&'a Task>,
}

impl Reading<'_> {
    /// Makes a problem at a place, and the error that says so.
    fn wrong(&self, path: KeyPath, message: String) -> FirstProblem {
        let (file, line) = (self.label.into(), self.line(&path));
        let problem = Problem { path, wrong: Wrong::Value(message) };
        let message = shortened(&problem.text(&ScenarioWords), MAX_SAID);
        Box::new((problem, ScenarioError::Syntax { file, line, message }))
    }

    fn line(&self, path: &KeyPath) -> Option<usize> {
        self.file.place(path).map(|place| place.line)
    }

    /// Makes the error of a problem that the TOML reader has found.
    fn syntax(&self, problem: Problem) -> FirstProblem {
        let (file, line) = (self.label.into(), self.line(&problem.path));
        let message = shortened(&problem.text(&ScenarioWords), MAX_SAID);
        Box::new((problem, ScenarioError::Syntax { file, line, message }))
    }

    /// Reads the parts of the file, and its machine if the file holds a whole one.
    fn parts(&self) -> Result<(File, Option<Machine>), FirstProblem> {
        let Some(inline) = self.file.inner("machine") else {
            let file = self.file.read().map_err(|error| self.syntax(Problem::of(self.file, &error)))?;
            return Ok((file, None));
        };
        let machine = machine::read_stated(&inline).map_err(|first| {
            let (problem, error) = *first;
            let problem = problem.under("machine");
            let (file, line) = (self.label.into(), self.line(&problem.path));
            let error = match error {
                MachineError::Syntax(message) => {
                    ScenarioError::Syntax { file, line, message: format!("machine: {message}") }
                }
                error => ScenarioError::Machine { file, line, error },
            };
            Box::new((problem, error))
        })?;
        let mut rest = self.file.clone();
        rest.set(&KeyPath::new(&[&"machine"]), &MendValue::Word(String::new()));
        let file = rest.read().map_err(|error| self.syntax(Problem::of(&rest, &error)))?;
        Ok((file, Some(machine)))
    }

    /// Returns the machine that the file names.
    fn named_machine(&self, name: &str) -> Result<MachineFile, FirstProblem> {
        self.find.map_or_else(|| machine::named(name).map(MachineFile::from), |find| find(name)).map_err(|error| {
            let wrong = Wrong::Last(error.to_string());
            Box::new((Problem { path: KeyPath::new(&[&"machine"]), wrong }, error.into()))
        })
    }

    /// Returns a machine with the settings of the key `set`.
    fn set(&self, machine: Machine, stated: &[String]) -> Result<Machine, FirstProblem> {
        let mut settings = Vec::with_capacity(stated.len());
        for (i, setting) in stated.iter().enumerate() {
            let pair = setting.split_once('=').map(|(key, value)| (key.trim(), value.trim()));
            let message = || format!("is {:?}: want KEY=VALUE", quote_clipped(setting));
            settings.push(pair.ok_or_else(|| self.wrong(KeyPath::new(&[&"set", &i]), message()))?);
        }
        if settings.is_empty() {
            return Ok(machine);
        }
        machine.set_all(settings).map_err(|error| {
            let path = KeyPath::new(&[&"set"]);
            let (file, line) = (self.label.into(), self.line(&path));
            Box::new((
                Problem { path, wrong: Wrong::Value(error.to_string()) },
                ScenarioError::Machine { file, line, error },
            ))
        })
    }

    fn scenario(&self) -> Result<Scenario, FirstProblem> {
        let label = self.label;
        if !self.file.keys().any(|key| OWN_TABLES.contains(&key)) {
            let what =
                if self.file.keys().next().is_none() { "the file states nothing" } else { "this is no file of ours" };
            let said = format!("{what}: want a machine, as in the example, or a scenario, with machine and [task]");
            let wrong = Wrong::Whole(said.clone(), machine::SMALLEST.into());
            let error = ScenarioError::Syntax { file: label.into(), line: None, message: said };
            return Err(Box::new((Problem { path: KeyPath::default(), wrong }, error)));
        }
        let tolerances = self.file.inner("tolerance").and_then(|inner| inner.read().ok());
        if let Some(problem) = tolerances.and_then(|stated| Tolerance::try_from_stated(stated).err()) {
            return Err(self.syntax(problem));
        }
        let (file, own_machine) = self.parts()?;
        let stated: toml::Table = self.file.read().unwrap_or_default();
        // Missing keys of the task are derived from given ones, which have to be finite.
        if let Some(key) = change::not_finite(&stated).filter(|key| key.starts_with("task")) {
            return Err(self.wrong(KeyPath::of_key(&key), "is not a finite number: want one".into()));
        }
        let name = file.name.as_deref().unwrap_or_default();
        for (key, text) in [("name", name), ("title", &file.title), ("summary", &file.summary)] {
            if let Some(c) = control_character(text) {
                let message = format!("holds the control character U+{:04X}: {PRINTABLE}", u32::from(c));
                return Err(self.wrong(KeyPath::new(&[&key]), message));
            }
        }
        let MachineFile { machine, design } = match (own_machine, &file.machine) {
            (Some(machine), _) => machine.into(),
            (None, MachineRef::Name(name)) => self.named_machine(name)?,
            (None, MachineRef::Inline(_)) => {
                return Err(self.wrong(KeyPath::new(&[&"machine"]), "is no machine".into()));
            }
        };
        // The brief of the scenario overrules that of the machine's file, key by key.
        let design = match stated.get("design").and_then(toml::Value::as_table) {
            Some(own) => {
                change::with_changes(&design, own).map_err(|why| self.wrong(KeyPath::new(&[&"design"]), why))?
            }
            None => design,
        };
        let stated_machine = machine.clone();
        let machine = self.set(machine, &file.set)?;
        let stem = Path::new(label).file_stem().map_or_else(|| label.into(), |s| s.to_string_lossy());
        let stem = plain(&stem).into_owned();
        let states = |key: &str| stated.get("task").is_some_and(|task| task.get(key).is_some());
        let completed = self.task.map_or_else(|| file.task.completed(states, &machine), |task| Ok(task.clone()));
        let task = completed.map_err(|why| match why {
            IncompleteTask::Missing(key) => {
                self.syntax(Problem { path: KeyPath::new(&[&"task"]), wrong: Wrong::Missing(key.into()) })
            }
            // Without a start of all angles it is unknown which other keys the task lacks.
            off @ (IncompleteTask::Angles { .. } | IncompleteTask::Samples { .. }) => {
                let key = if matches!(off, IncompleteTask::Angles { .. }) { "start" } else { "samples" };
                let path = KeyPath::new(&[&"task", &key]);
                let said = format!("{}: {off}", called(&path, &ScenarioWords));
                self.syntax(Problem { path, wrong: Wrong::Last(said) })
            }
        })?;
        let sketch = match file.sketch {
            Some(sketch) => {
                let bent =
                    |why: SketchRefusal| self.wrong(KeyPath::new(&[&"sketch"]), shortened(&why.to_string(), MAX_SAID));
                sketch.check().map_err(bent)?;
                Some(match file.set.is_empty() {
                    true => sketch,
                    false => sketch.following_machine(&stated_machine, &machine),
                })
            }
            None => None,
        };
        let mut edits = Vec::with_capacity(file.edits.len());
        let wrong_edit = |(i, message): (usize, String)| {
            let path = KeyPath::new(&[&"edit", &i]);
            let (file, line) = (label.into(), self.line(&path));
            let message = shortened(&message, MAX_SAID);
            let error = ScenarioError::Edit { file, line, entry: i + 1, message: message.clone() };
            Box::new((Problem { path, wrong: Wrong::Value(message) }, error))
        };
        for (i, entry) in file.edits.into_iter().enumerate() {
            edits.push(TimedEdit::read(entry).map_err(|problem| self.syntax(problem.in_list("edit", i)))?);
        }
        let mut scenario = Scenario {
            name: file.name.unwrap_or(stem),
            title: file.title,
            summary: file.summary,
            machine,
            plant: file.plant,
            base: file.base,
            control: file.control,
            step: file.step,
            pose_acceleration: file.pose_acceleration,
            compare_b: file.compare_b,
            duration: file.duration,
            task,
            tolerance: file.tolerance,
            design,
            sketch,
            edits,
            bookmarks: file.bookmarks,
            notes: Vec::new(),
            branches: Vec::new(),
            assembly: None,
        };
        scenario.check(label).map_err(|error| self.placed(error))?;
        check_edits(&scenario).map_err(wrong_edit)?;
        let wrong_entry = |of: &str, (i, message): (usize, String)| {
            self.wrong(KeyPath::new(&[&of, &i]), shortened(&message, MAX_SAID))
        };
        let sound = |edits: &[TimedEdit]| check_edits(&Scenario { edits: edits.to_vec(), ..scenario.without_edits() });
        check_bookmarks(&scenario.bookmarks).map_err(|wrong| wrong_entry("bookmark", wrong))?;
        let notes = notes(file.notes, &scenario.machine).map_err(|wrong| wrong_entry("note", wrong))?;
        let branches = branches(file.branches, sound).map_err(|wrong| wrong_entry("branch", wrong))?;
        (scenario.notes, scenario.branches) = (notes, branches);
        Ok(scenario)
    }

    /// Adds the place of the wrong key in the file to an error of [`Scenario::check`].
    fn placed(&self, error: ScenarioError) -> FirstProblem {
        match error {
            ScenarioError::OutOfRange { file, key, value, want, .. } => {
                let path = KeyPath::of_key(&key);
                let said = range_error("", value, &want).trim_start().to_owned();
                let error = ScenarioError::OutOfRange { file, line: self.line(&path), key, value, want };
                Box::new((Problem { path, wrong: Wrong::Value(said) }, error))
            }
            ScenarioError::Machine { file, error, .. } => {
                let file = file.trim_end_matches(": plant").to_owned();
                // Links are keyed by name in the plant, by index in the machine. `lengths` is `length` in the plant.
                let place = error.place().map_or_else(KeyPath::default, |place| match place.0.as_slice() {
                    [link, KeyStep::Named(_, name), rest @ ..] => {
                        let named = [link.clone(), KeyStep::Key(name.clone())];
                        KeyPath(named.into_iter().chain(rest.iter().cloned()).collect())
                    }
                    [KeyStep::Key(word), rest @ ..] if word == "lengths" => {
                        KeyPath(std::iter::once(KeyStep::Key("length".into())).chain(rest.iter().cloned()).collect())
                    }
                    [KeyStep::Key(key)] => KeyPath::of_key(key),
                    _ => place.clone(),
                });
                let path = place.under("plant");
                let (line, said) = (self.line(&path), error.to_string());
                Box::new((Problem { path, wrong: Wrong::Said(said) }, ScenarioError::Machine { file, line, error }))
            }
            other => Box::new((Problem { path: KeyPath::default(), wrong: Wrong::Last(other.to_string()) }, other)),
        }
    }
}

/// Reads the scenario of a given machine from a file, which names some machine. A task is taken in place of the file's.
///
/// # Errors
/// The first thing that is wrong.
pub(crate) fn read_of_machine(
    file: &StatedFile,
    label: &str,
    machine: &Machine,
    task: Option<&Task>,
) -> Result<Scenario, Problem> {
    let find: FindMachine = &|_| Ok(machine.clone().into());
    Reading { file, label, find: Some(find), task }.scenario().map_err(|first| first.0)
}

/// Keys of which a scenario has at least one.
const OWN_TABLES: [&str; 3] = ["machine", "task", "edit"];

impl Scenario {
    /// Reads a scenario from text. Errors name `label`; `find`, if given, looks up the machine by its name.
    ///
    /// # Errors
    /// If the text is not a valid scenario; the error has all faults of the text.
    pub fn parse(text: &str, label: &str, find: Option<FindMachine>) -> Result<Self, ScenarioError> {
        let read = |file: &StatedFile| Reading { file, label, find, task: None }.scenario();
        let first = match StatedFile::parse(text) {
            Ok(file) => match read(&file) {
                Ok(scenario) => return Ok(scenario),
                Err(first) => match first.1 {
                    // The faults of the machine's own file are told.
                    error @ ScenarioError::MachineFile(_) => return Err(error),
                    error => Some(error),
                },
            },
            Err(_) => None,
        };
        let faults = faults_of(text, &ScenarioWords, &|file| read(file).map(|_| ()).map_err(|first| first.0));
        let of_text = || {
            let fault = faults.list.first();
            let (line, message) = fault.map_or((None, String::new()), |fault| (fault.line, fault.text.clone()));
            ScenarioError::Syntax { file: label.into(), line, message }
        };
        let first = Box::new(first.unwrap_or_else(of_text));
        Err(ScenarioError::Faulty { file: label.into(), first, faults: Box::new(faults) })
    }

    /// Returns the scenario as TOML, from which [`parse`](Self::parse) gives an equal one. A built-in machine is named,
    /// any other is written out.
    ///
    /// # Panics
    /// Never: every scenario can be written.
    pub fn to_toml(&self) -> String {
        if let Some(whole) = AssemblyScenario::of(self) {
            return whole.to_toml();
        }
        let machine = match machine::builtin(self.machine.name()) {
            Some(known) if *known == self.machine => MachineRef::Name(self.machine.name().into()),
            _ => MachineRef::Inline(Box::new(self.machine.spec().clone())),
        };
        let Self {
            name,
            title,
            summary,
            machine: _,
            plant,
            base,
            task,
            control,
            step,
            pose_acceleration,
            compare_b,
            duration,
            tolerance,
            design,
            sketch,
            edits,
            bookmarks,
            notes,
            branches,
            assembly: _,
        } = self.clone();
        let file = File {
            name: Some(name),
            title,
            summary,
            machine,
            set: Vec::new(),
            step,
            duration,
            pose_acceleration,
            compare_b,
            task,
            control,
            plant,
            base,
            tolerance,
            design,
            sketch,
            edits: edits.iter().map(TimedEdit::to_table).collect(),
            bookmarks,
            notes: notes.into_iter().map(StatedNote::from).collect(),
            branches: branches.into_iter().map(StatedBranch::from).collect(),
        };
        toml::to_string(&file).expect("a scenario is plain data")
    }
}
