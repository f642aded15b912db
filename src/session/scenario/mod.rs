//! Scenarios: a machine, what it is to do, and what is done to it meanwhile; TOML files.
//!
//! A saved session is a scenario with `[[edit]]` entries, each with the step at which it applies.

mod task;
mod tolerance;

use std::path::Path as FilePath;

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::mechanics::machine::{self, FileError, Machine, MachineError, MachineSpec, Place, Step};
use crate::session::{TimedEdit, survey};
use crate::settings::change;
use crate::settings::range::{Check, Range, Short, Want, clipped, shortened};
use crate::settings::text::{self, MOST_BYTES};
use crate::simulation::Setup;
use crate::simulation::control::Control;
use crate::simulation::plant::{Base, Plant, is_default};

pub use task::{Change, Corners, Least, MAX_POINTS, PLACE, POSE_CONSTANT, Shape, TIME, Task, TaskKind, Value};
pub use tolerance::{Amount, MAX_SAMPLES, Spread, Tolerance, default_spreads};

/// What a run starts from.
#[derive(Clone, Debug, PartialEq)]
pub struct Scenario {
    /// Short name: `case-3`.
    pub name: String,
    /// A line about it.
    pub title: String,
    /// The machine that control believes in.
    pub machine: Machine,
    /// What differs in the machine that moves.
    pub plant: Plant,
    /// What it stands on.
    pub base: Base,
    /// The task.
    pub task: Task,
    /// What the motors are told.
    pub control: Control,
    /// Fixed step, s.
    pub step: f64,
    /// Bound on |b̈| while b is slid, rad/s².
    pub pose_acceleration: f64,
    /// Pose constant of a second workspace to compare with, rad.
    pub compare_b: Option<f64>,
    /// Time that a headless run covers, s; by default that of the planned motion.
    pub duration: Option<f64>,
    /// How machines that are built differ from it.
    pub tolerance: Tolerance,
    /// What was done, in the order of steps.
    pub edits: Vec<TimedEdit>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    name: Option<String>,
    #[serde(default)]
    title: String,
    machine: MachineRef,
    /// Settings of the machine, as on the command line: `payload.mass=0.5`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    set: Vec<String>,
    #[serde(default = "one_millisecond")]
    step: f64,
    duration: Option<f64>,
    #[serde(default = "default_pose_acceleration")]
    pose_acceleration: f64,
    compare_b: Option<f64>,
    task: Task,
    #[serde(default, skip_serializing_if = "is_default")]
    control: Control,
    #[serde(default, skip_serializing_if = "is_default")]
    plant: Plant,
    #[serde(default, skip_serializing_if = "is_default")]
    base: Base,
    #[serde(default, skip_serializing_if = "Tolerance::is_empty")]
    tolerance: Tolerance,
    /// As they stand there, so that a wrong one can be named.
    #[serde(default, rename = "edit", skip_serializing_if = "Vec::is_empty")]
    edits: Vec<toml::Table>,
}

fn one_millisecond() -> f64 {
    0.001
}
fn default_pose_acceleration() -> f64 {
    2.0
}

#[derive(Serialize, Deserialize)]
#[serde(untagged, expecting = "want the name of a machine, a file, or a whole machine as a table")]
enum MachineRef {
    Name(String),
    Inline(Box<MachineSpec>),
}

/// Why a file is not a scenario.
#[derive(Debug, Error)]
pub enum ScenarioError {
    /// The file itself.
    #[error("{file}: {source}: want a plain file that can be read, of at most {MOST_BYTES} bytes")]
    Unreadable {
        /// The file.
        file: String,
        /// Why.
        source: std::io::Error,
    },
    /// Not TOML, or not of a scenario.
    #[error("{file}{}: {message}", at(*line))]
    Syntax {
        /// The file.
        file: String,
        /// Line, counted from 1.
        line: Option<usize>,
        /// What.
        message: String,
    },
    /// A number out of range.
    #[error("{file}{}: {key} is {}: want {want}", at(*line), Short(*value))]
    OutOfRange {
        /// The file.
        file: String,
        /// Line, counted from 1, where it is known.
        line: Option<usize>,
        /// Which.
        key: String,
        /// What stands there.
        value: f64,
        /// What would be right.
        want: Want,
    },
    /// Its machine.
    #[error("{file}{}: machine: {error}", at(*line))]
    Machine {
        /// The file.
        file: String,
        /// Line, counted from 1, where it is known.
        line: Option<usize>,
        /// What.
        error: MachineError,
    },
    /// One of its edits.
    #[error("{file}{}: the {} [[edit]]: {message}", at(*line), ordinal(*entry))]
    Edit {
        /// The file.
        file: String,
        /// Line, counted from 1, where it is known.
        line: Option<usize>,
        /// Which, counted from 1.
        entry: usize,
        /// What.
        message: String,
    },
    /// Its machine's file.
    #[error(transparent)]
    MachineFile(#[from] FileError),
}

/// A line behind the name of its file.
fn at(line: Option<usize>) -> String {
    line.map(|line| format!(":{line}")).unwrap_or_default()
}

/// 1st, 2nd, 3rd, 4th …
pub(crate) fn ordinal(n: usize) -> String {
    let ending = match (n % 10, n % 100) {
        (_, 11..=13) => "th",
        (1, _) => "st",
        (2, _) => "nd",
        (3, _) => "rd",
        _ => "th",
    };
    format!("{n}{ending}")
}

/// The most characters of what somebody else's reader says of a file.
const MOST_WORDS: usize = 300;

/// How many of the scenarios that come along are the paper's cases; they stand first.
const CASES: usize = 3;

/// The scenarios that come along: the paper's three cases, what planning can do besides, and plants and bases that are
/// not ideal.
const BUILTIN: [(&str, &str); 12] = [
    ("case-1", include_str!("../../../assets/scenarios/case-1.toml")),
    ("case-2", include_str!("../../../assets/scenarios/case-2.toml")),
    ("case-3", include_str!("../../../assets/scenarios/case-3.toml")),
    ("circle", include_str!("../../../assets/scenarios/circle.toml")),
    ("change-b", include_str!("../../../assets/scenarios/change-b.toml")),
    ("least-reaction", include_str!("../../../assets/scenarios/least-reaction.toml")),
    ("drift", include_str!("../../../assets/scenarios/drift.toml")),
    ("spacecraft", include_str!("../../../assets/scenarios/spacecraft.toml")),
    ("bench-top", include_str!("../../../assets/scenarios/bench-top.toml")),
    ("pick-up", include_str!("../../../assets/scenarios/pick-up.toml")),
    ("friction", include_str!("../../../assets/scenarios/friction.toml")),
    ("wheel", include_str!("../../../assets/scenarios/wheel.toml")),
];

impl Scenario {
    /// The names of the built-in scenarios, the paper's cases first.
    pub fn builtin_names() -> impl Iterator<Item = &'static str> {
        BUILTIN.iter().map(|(name, _)| *name)
    }

    /// The names of the paper's cases.
    pub fn cases() -> impl Iterator<Item = &'static str> {
        Self::builtin_names().take(CASES)
    }

    /// A built-in scenario.
    pub fn builtin(name: &str) -> Option<Self> {
        let (name, text) = BUILTIN.iter().find(|(n, _)| *n == name)?;
        Some(Self::parse(text, name, None).expect("the scenarios that come along are valid"))
    }

    /// A scenario by built-in name or by file.
    ///
    /// # Errors
    /// If it is neither, or the file is not a scenario.
    pub fn find(name: &str) -> Result<Self, ScenarioError> {
        if let Some(scenario) = Self::builtin(name) {
            return Ok(scenario);
        }
        let file = FilePath::new(name);
        let text = text::read(file).map_err(|source| match source.kind() {
            std::io::ErrorKind::NotFound if !name.ends_with(".toml") => ScenarioError::Syntax {
                file: shortened(name, 300),
                line: None,
                message: format!(
                    "no such scenario: want {}, or a TOML file",
                    Self::builtin_names().collect::<Vec<_>>().join(", ")
                ),
            },
            _ => ScenarioError::Unreadable { file: shortened(name, 300), source },
        })?;
        Self::parse(&text, name, file.parent())
    }

    /// Reads a scenario from text; `label` is what errors call it, `folder` where its machine file is looked up.
    ///
    /// # Errors
    /// If it is not a scenario.
    pub fn parse(text: &str, label: &str, folder: Option<&FilePath>) -> Result<Self, ScenarioError> {
        let file: File = toml::from_str(text).map_err(|e| ScenarioError::Syntax {
            file: label.into(),
            line: e.span().map(|s| machine::line_of(text, s.start)),
            message: shortened(e.message(), MOST_WORDS),
        })?;
        let line_of = |key: &str| machine::line_of_place(text, &Place::of_key(key));
        // A key that is left out may stand as such a number until it is filled in, so it has to be seen here.
        if let Some(key) =
            text.parse().ok().and_then(|table| change::not_finite(&table)).filter(|key| key.starts_with("task"))
        {
            let message = format!("{key} is not a finite number: want one");
            return Err(ScenarioError::Syntax { file: label.into(), line: line_of(&key), message });
        }
        let machine = match file.machine {
            MachineRef::Name(name) => machine::find(&name, folder)?,
            MachineRef::Inline(spec) => Machine::new(*spec).map_err(|error| {
                let place = error.place().cloned().unwrap_or_default().under("machine");
                ScenarioError::Machine { file: label.into(), line: machine::line_of_place(text, &place), error }
            })?,
        };
        let wrong = |message: String| ScenarioError::Syntax { file: label.into(), line: line_of("set"), message };
        let mut settings = Vec::with_capacity(file.set.len());
        for setting in &file.set {
            let pair = setting.split_once('=').map(|(key, value)| (key.trim(), value.trim()));
            settings.push(pair.ok_or_else(|| wrong(format!("set: {:?}: want KEY=VALUE", clipped(setting))))?);
        }
        let machine = match settings.is_empty() {
            true => machine,
            false => machine.set_all(settings).map_err(|error| {
                let (file, line) = (label.into(), line_of("set"));
                ScenarioError::Machine { file, line, error }
            })?,
        };
        let stem = FilePath::new(label).file_stem().map_or_else(|| label.into(), |s| s.to_string_lossy().into_owned());
        let task = file.task.completed(&machine).map_err(|key| ScenarioError::Syntax {
            file: label.into(),
            line: line_of("task"),
            message: format!("missing field `{key}`"),
        })?;
        let mut edits = Vec::with_capacity(file.edits.len());
        let wrong_edit = |(i, message): (usize, String)| {
            let place = Place::new(&[&"edit", &i]);
            let (file, line) = (label.into(), machine::line_of_place(text, &place));
            ScenarioError::Edit { file, line, entry: i + 1, message: shortened(&message, MOST_WORDS) }
        };
        for (i, entry) in file.edits.into_iter().enumerate() {
            edits.push(TimedEdit::from_table(entry).map_err(|why| wrong_edit((i, why)))?);
        }
        let scenario = Self {
            name: file.name.unwrap_or(stem),
            title: file.title,
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
            edits,
        };
        scenario.check(label).map_err(|error| scenario.with_line(error, text))?;
        survey(&scenario).map_err(wrong_edit)?;
        Ok(scenario)
    }

    /// An error of [`check`](Self::check) with the line of its key in a text.
    fn with_line(&self, error: ScenarioError, text: &str) -> ScenarioError {
        let line_of = |place: Place| machine::line_of_place(text, &place);
        match error {
            ScenarioError::OutOfRange { file, key, value, want, .. } => {
                let line = line_of(Place::of_key(&key));
                ScenarioError::OutOfRange { file, line, key, value, want }
            }
            ScenarioError::Machine { file, error, .. } => {
                let file = file.trim_end_matches(": plant").to_owned();
                // What differs goes by the names of links and lengths, not by their places in the machine.
                let place = error.place().map_or_else(Place::default, |place| match place.0.as_slice() {
                    [Step::Key(word), Step::At(i), rest @ ..] if word == "link" => {
                        let name = self.machine.links().get(*i).map_or("", |link| link.name.as_str());
                        Place(
                            [Step::Key("link".into()), Step::Key(name.into())]
                                .into_iter()
                                .chain(rest.iter().cloned())
                                .collect(),
                        )
                    }
                    [Step::Key(word), rest @ ..] if word == "lengths" => {
                        Place(std::iter::once(Step::Key("length".into())).chain(rest.iter().cloned()).collect())
                    }
                    [Step::Key(key)] => Place::of_key(key),
                    _ => place.clone(),
                });
                ScenarioError::Machine { file, line: line_of(place.under("plant")), error }
            }
            other => other,
        }
    }

    /// Whether every number is in its range; `file` is what errors call it.
    ///
    /// # Errors
    /// The first that is not.
    pub fn check(&self, file: &str) -> Result<(), ScenarioError> {
        if let Some(Check { key, value, want, .. }) = self.checks().into_iter().find(|check| !check.ok) {
            return Err(ScenarioError::OutOfRange { file: file.into(), line: None, key: key.into(), value, want });
        }
        let named = self.plant.machine(&self.machine).map(|_| ());
        named.map_err(|error| ScenarioError::Machine { file: format!("{file}: plant"), line: None, error })
    }

    /// Every number with its key, and whether it may stand there.
    fn checks(&self) -> Vec<Check> {
        let n = self.machine.drives();
        let mut list = vec![STEP.check("step", self.step)];
        list.extend(DURATION.check_some("duration", self.duration));
        list.push(POSE_ACCELERATION.check("pose_acceleration", self.pose_acceleration));
        list.extend(POSE_CONSTANT.check_some("compare_b", self.compare_b));
        list.extend(self.task.checks(self.step));
        list.extend(self.control.checks(n, self.step));
        list.extend(self.plant.checks(n));
        list.extend(self.base.checks());
        list
    }

    /// The scenario as TOML, so that [`parse`](Self::parse) gives an equal one. A built-in machine is named, any
    /// other is written out.
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
            edits,
        } = self.clone();
        let file = File {
            name: Some(name),
            title,
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
            edits: edits.iter().map(TimedEdit::to_table).collect(),
        };
        toml::to_string(&file).expect("a scenario is plain data")
    }

    /// The machine that moves, with what it holds at the start.
    ///
    /// # Errors
    /// If what differs leaves no valid machine.
    pub fn plant_machine(&self) -> Result<Machine, MachineError> {
        let (machine, load) = (self.plant.machine(&self.machine)?, &self.plant.payload);
        if load.is_held(0.0, 0.5 * self.step) { load.held_by(&machine) } else { Ok(machine) }
    }

    /// The same before anything was done to it.
    pub(crate) fn without_edits(&self) -> Self {
        let Self { name, title, machine, plant, base, task, control, step, .. } = self;
        let Self { pose_acceleration, compare_b, duration, tolerance, .. } = self;
        Self {
            name: name.clone(),
            title: title.clone(),
            machine: machine.clone(),
            plant: plant.clone(),
            base: *base,
            task: task.clone(),
            control: *control,
            step: *step,
            pose_acceleration: *pose_acceleration,
            compare_b: *compare_b,
            duration: *duration,
            tolerance: tolerance.clone(),
            edits: Vec::new(),
        }
    }

    /// What a simulation of it is made of.
    pub fn setup(&self) -> Setup<'_> {
        let Self { machine: model, plant, base, control, step, .. } = self;
        Setup { model, plant, base, control, step: *step }
    }
}

/// The longest run, s.
pub const MAX_TIME: f64 = 3600.0;

/// The most steps of a run: an hour of 1 ms each, and some to spare.
pub const MAX_STEPS: u64 = 4_000_000;

/// What a step may be.
pub const STEP: Range = Range::new(1e-5, 0.01, "s");
const DURATION: Range = Range::new(0.0, MAX_TIME, "s");
const POSE_ACCELERATION: Range = Range::new(1e-6, 1e6, "rad/s²");
