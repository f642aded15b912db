//! Reads and writes scenarios as TOML.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::definition::Scenario;
use super::design::{DesignBrief, is_default};
use super::error::ScenarioError;
use super::kept::{Bookmark, StatedBranch, branches, check_bookmarks};
use super::note::{StatedNote, notes};
use super::own::ScenarioSettings;
use super::task::Task;
use super::tolerance::Tolerance;
use crate::{TimedEdit, check_edits};
use stillbase_mechanics::machine::{self, FileError, KeyPath, KeyStep, Machine, MachineSpec};
use stillbase_mechanics::sketch::{Sketch, SketchRefusal};
use stillbase_settings::change;
use stillbase_settings::range::{quote_clipped, shortened};
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

/// Maximum length of an error of the TOML reader, characters.
const MAX_MESSAGE_CHARS: usize = 300;

/// Content of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileContent {
    /// A machine.
    Machine,
    /// A scenario, with its machine.
    Scenario,
}

/// Returns whether a file is a machine or a scenario, by tables that only one of them has. Returns `None` if it has
/// tables of neither or of both, or is not TOML.
pub fn content(text: &str) -> Option<FileContent> {
    let table: toml::Table = text.parse().ok()?;
    let has = |keys: [&str; 2]| keys.iter().any(|key| table.contains_key(*key));
    match (has(["link", "drive"]), has(["task", "machine"])) {
        (true, false) => Some(FileContent::Machine),
        (false, true) => Some(FileContent::Scenario),
        _ => None,
    }
}

/// Looks up a machine by name or file.
pub type FindMachine<'a> = &'a dyn Fn(&str) -> Result<Machine, FileError>;

impl Scenario {
    /// Reads a scenario from text. Errors name `label`; `find`, if given, looks up the machine by its name.
    ///
    /// # Errors
    /// If the text is not a valid scenario.
    pub fn parse(text: &str, label: &str, find: Option<FindMachine>) -> Result<Self, ScenarioError> {
        let file: File = toml::from_str(text).map_err(|e| ScenarioError::Syntax {
            file: label.into(),
            line: e.span().map(|s| machine::line_of(text, s.start)),
            message: shortened(e.message(), MAX_MESSAGE_CHARS),
        })?;
        let line_of = |key: &str| machine::line_of_place(text, &KeyPath::of_key(key));
        let stated: toml::Table = text.parse().unwrap_or_default();
        // Missing keys of the task are derived from given ones, which have to be finite.
        if let Some(key) = change::not_finite(&stated).filter(|key| key.starts_with("task")) {
            let message = format!("{} is not a finite number: want one", quote_clipped(&key));
            return Err(ScenarioError::Syntax { file: label.into(), line: line_of(&key), message });
        }
        let name = file.name.as_deref().unwrap_or_default();
        for (key, text) in [("name", name), ("title", &file.title), ("summary", &file.summary)] {
            if let Some(c) = control_character(text) {
                let message = format!("{key} holds the control character U+{:04X}: {PRINTABLE}", u32::from(c));
                return Err(ScenarioError::Syntax { file: label.into(), line: line_of(key), message });
            }
        }
        let machine = match file.machine {
            MachineRef::Name(name) => find.map_or_else(|| machine::named(&name), |find| find(&name))?,
            MachineRef::Inline(spec) => Machine::new(*spec).map_err(|error| {
                let place = error.place().cloned().unwrap_or_default().under("machine");
                ScenarioError::Machine { file: label.into(), line: machine::line_of_place(text, &place), error }
            })?,
        };
        let wrong = |message: String| ScenarioError::Syntax { file: label.into(), line: line_of("set"), message };
        let mut settings = Vec::with_capacity(file.set.len());
        for setting in &file.set {
            let pair = setting.split_once('=').map(|(key, value)| (key.trim(), value.trim()));
            settings.push(pair.ok_or_else(|| wrong(format!("set: {:?}: want KEY=VALUE", quote_clipped(setting))))?);
        }
        let stated_machine = machine.clone();
        let machine = match settings.is_empty() {
            true => machine,
            false => machine.set_all(settings).map_err(|error| {
                let (file, line) = (label.into(), line_of("set"));
                ScenarioError::Machine { file, line, error }
            })?,
        };
        let stem = Path::new(label).file_stem().map_or_else(|| label.into(), |s| s.to_string_lossy());
        let stem = plain(&stem).into_owned();
        let states = |key: &str| stated.get("task").is_some_and(|task| task.get(key).is_some());
        let task = file.task.completed(states, &machine).map_err(|key| ScenarioError::Syntax {
            file: label.into(),
            line: line_of("task"),
            message: format!("missing field `{key}`"),
        })?;
        let sketch = match file.sketch {
            Some(sketch) => {
                let bent = |why: SketchRefusal| ScenarioError::Syntax {
                    file: label.into(),
                    line: line_of("sketch"),
                    message: format!("sketch: {}", shortened(&why.to_string(), MAX_MESSAGE_CHARS)),
                };
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
            let place = KeyPath::new(&[&"edit", &i]);
            let (file, line) = (label.into(), machine::line_of_place(text, &place));
            ScenarioError::Edit { file, line, entry: i + 1, message: shortened(&message, MAX_MESSAGE_CHARS) }
        };
        for (i, entry) in file.edits.into_iter().enumerate() {
            edits.push(TimedEdit::from_table(entry).map_err(|why| wrong_edit((i, why)))?);
        }
        let mut scenario = Self {
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
            design: file.design,
            sketch,
            edits,
            bookmarks: file.bookmarks,
            notes: Vec::new(),
            branches: Vec::new(),
        };
        scenario.check(label).map_err(|error| scenario.with_line(error, text))?;
        check_edits(&scenario).map_err(wrong_edit)?;
        let wrong_entry = |of: &str, (i, message): (usize, String)| {
            let line = machine::line_of_place(text, &KeyPath::new(&[&of, &i]));
            let message = format!("{of} {}: {}", i + 1, shortened(&message, MAX_MESSAGE_CHARS));
            ScenarioError::Syntax { file: label.into(), line, message }
        };
        let sound = |edits: &[TimedEdit]| check_edits(&Self { edits: edits.to_vec(), ..scenario.without_edits() });
        check_bookmarks(&scenario.bookmarks).map_err(|wrong| wrong_entry("bookmark", wrong))?;
        let notes = notes(file.notes, &scenario.machine).map_err(|wrong| wrong_entry("note", wrong))?;
        let branches = branches(file.branches, sound).map_err(|wrong| wrong_entry("branch", wrong))?;
        (scenario.notes, scenario.branches) = (notes, branches);
        Ok(scenario)
    }

    /// Adds the line of the wrong key in a text to an error of [`check`](Self::check).
    fn with_line(&self, error: ScenarioError, text: &str) -> ScenarioError {
        let line_of = |place: KeyPath| machine::line_of_place(text, &place);
        match error {
            ScenarioError::OutOfRange { file, key, value, want, .. } => {
                let line = line_of(KeyPath::of_key(&key));
                ScenarioError::OutOfRange { file, line, key, value, want }
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
                ScenarioError::Machine { file, line: line_of(place.under("plant")), error }
            }
            other => other,
        }
    }

    /// Returns the scenario as TOML, from which [`parse`](Self::parse) gives an equal one. A built-in machine is named,
    /// any other is written out.
    ///
    /// # Panics
    /// Never: every scenario can be written.
    pub fn to_toml(&self) -> String {
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
