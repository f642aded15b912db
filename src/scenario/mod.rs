//! Scenarios: a machine, what it is to do, and what is done to it meanwhile; TOML files.
//!
//! A saved session is a scenario with `[[edit]]` entries, each with the step at which it applies.

mod task;

use std::path::Path as FilePath;

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::control::Control;
use crate::keys;
use crate::machine::{self, FileError, Machine, MachineError, MachineSpec};
use crate::plant::{Base, Plant, is_default};
use crate::session::TimedEdit;
use crate::simulation::Setup;
use crate::text::{self, MOST_BYTES};
use crate::tolerance::Tolerance;

pub use task::{Change, Corners, Least, MAX_POINTS, Shape, Task, TaskKind, Value};

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
    #[serde(default, rename = "edit", skip_serializing_if = "Vec::is_empty")]
    edits: Vec<TimedEdit>,
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
    #[error("{file}{}: {message}", line.map(|l| format!(":{l}")).unwrap_or_default())]
    Syntax {
        /// The file.
        file: String,
        /// Line, counted from 1.
        line: Option<usize>,
        /// What.
        message: String,
    },
    /// A number out of range.
    #[error("{file}: {key} is {value}: want {want}")]
    OutOfRange {
        /// The file.
        file: String,
        /// Which.
        key: &'static str,
        /// What stands there.
        value: f64,
        /// What would be right.
        want: &'static str,
    },
    /// Its machine.
    #[error("{file}: machine: {error}")]
    Machine {
        /// The file.
        file: String,
        /// What.
        error: MachineError,
    },
    /// Its machine's file.
    #[error(transparent)]
    MachineFile(#[from] FileError),
}

/// How many of the scenarios that come along are the paper's cases; they stand first.
const CASES: usize = 3;

/// The scenarios that come along: the paper's three cases, what planning can do besides, and plants and bases that are
/// not ideal.
const BUILTIN: [(&str, &str); 12] = [
    ("case-1", include_str!("../../assets/scenarios/case-1.toml")),
    ("case-2", include_str!("../../assets/scenarios/case-2.toml")),
    ("case-3", include_str!("../../assets/scenarios/case-3.toml")),
    ("circle", include_str!("../../assets/scenarios/circle.toml")),
    ("change-b", include_str!("../../assets/scenarios/change-b.toml")),
    ("least-reaction", include_str!("../../assets/scenarios/least-reaction.toml")),
    ("drift", include_str!("../../assets/scenarios/drift.toml")),
    ("spacecraft", include_str!("../../assets/scenarios/spacecraft.toml")),
    ("bench-top", include_str!("../../assets/scenarios/bench-top.toml")),
    ("pick-up", include_str!("../../assets/scenarios/pick-up.toml")),
    ("friction", include_str!("../../assets/scenarios/friction.toml")),
    ("wheel", include_str!("../../assets/scenarios/wheel.toml")),
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
                file: name.into(),
                line: None,
                message: format!(
                    "no such scenario: want {}, or a TOML file",
                    Self::builtin_names().collect::<Vec<_>>().join(", ")
                ),
            },
            _ => ScenarioError::Unreadable { file: name.into(), source },
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
            line: e.span().map(|s| text[..s.start.min(text.len())].matches('\n').count() + 1),
            message: e.message().to_owned(),
        })?;
        // A key that is left out may stand as such a number until it is filled in, so it has to be seen here.
        if let Some(key) =
            text.parse().ok().and_then(|table| keys::not_finite(&table)).filter(|key| key.starts_with("task"))
        {
            let message = format!("{key} is not a finite number: want one");
            let last = key.rsplit('.').next().unwrap_or_default();
            let line = text.lines().position(|line| line.trim_start().starts_with(last)).map(|i| i + 1);
            return Err(ScenarioError::Syntax { file: label.into(), line, message });
        }
        let machine = match file.machine {
            MachineRef::Name(name) => machine::find(&name, folder)?,
            MachineRef::Inline(spec) => {
                Machine::new(*spec).map_err(|error| ScenarioError::Machine { file: label.into(), error })?
            }
        };
        let wrong = |message: String| ScenarioError::Syntax { file: label.into(), line: None, message };
        let mut settings = Vec::with_capacity(file.set.len());
        for setting in &file.set {
            let pair = setting.split_once('=').map(|(key, value)| (key.trim(), value.trim()));
            settings.push(pair.ok_or_else(|| wrong(format!("set: {setting:?}: want KEY=VALUE")))?);
        }
        let machine = match settings.is_empty() {
            true => machine,
            false => machine.set_all(settings).map_err(|error| ScenarioError::Machine { file: label.into(), error })?,
        };
        let stem = FilePath::new(label).file_stem().map_or_else(|| label.into(), |s| s.to_string_lossy().into_owned());
        let task = file.task.completed(&machine).map_err(|key| ScenarioError::Syntax {
            file: label.into(),
            line: text.lines().position(|line| line.trim() == "[task]").map(|i| i + 1),
            message: format!("missing field `{key}`"),
        })?;
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
            edits: file.edits,
        };
        scenario.check(label)?;
        Ok(scenario)
    }

    /// Whether every number is in its range; `file` is what errors call it.
    ///
    /// # Errors
    /// The first that is not.
    pub fn check(&self, file: &str) -> Result<(), ScenarioError> {
        let t = &self.task;
        let positive = [
            ("step", self.step, "a step of 0.00001 to 0.01 s", (1e-5..=0.01).contains(&self.step)),
            ("task.time", t.time, "one step to 3600 s", t.time >= self.step && t.time <= MAX_TIME),
            (
                "duration",
                self.duration.unwrap_or(0.0),
                "0 to 3600 s",
                (0.0..=MAX_TIME).contains(&self.duration.unwrap_or(0.0)),
            ),
            ("task.cycles", f64::from(t.cycles), "1 to 100", (1..=100).contains(&t.cycles)),
            ("task.blend", t.blend, "0 to 1", (0.0..=1.0).contains(&t.blend)),
            (
                "task.moment_limit",
                t.moment_limit.unwrap_or(1.0),
                "above 0 N m",
                t.moment_limit.is_none_or(|limit| limit > 0.0),
            ),
            ("task.via", t.via.len() as f64, "at most 2000 points between A and B", t.via.len() <= MAX_POINTS),
            ("pose_acceleration", self.pose_acceleration, "above 0 rad/s²", self.pose_acceleration > 0.0),
        ];
        let finite = [
            ("task.from", t.from[0]),
            ("task.from", t.from[1]),
            ("task.to", t.to[0]),
            ("task.to", t.to[1]),
            ("task.b", t.b),
            ("task.turn", t.turn),
            ("task.first_drive_to", t.first_drive_to.unwrap_or(0.0)),
            ("compare_b", self.compare_b.unwrap_or(0.0)),
            ("task.b_to", t.b_to.unwrap_or(0.0)),
        ];
        let via = t.via.iter().flatten().map(|x| ("task.via", *x));
        let finite = finite.into_iter().chain(via).map(|(key, value)| (key, value, "a finite number", true));
        let n = self.machine.drives();
        let parts = [self.control.checks(n, self.step), self.plant.checks(n), self.base.checks()];
        for (key, value, want, ok) in positive.into_iter().chain(finite).chain(parts.into_iter().flatten()) {
            if !ok || !value.is_finite() {
                return Err(ScenarioError::OutOfRange { file: file.into(), key, value, want });
            }
        }
        let named = self.plant.machine(&self.machine).map(|_| ());
        named.map_err(|error| ScenarioError::Machine { file: format!("{file}: plant"), error })
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
            edits,
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

    /// What a simulation of it is made of.
    pub fn setup(&self) -> Setup<'_> {
        let Self { machine: model, plant, base, control, step, .. } = self;
        Setup { model, plant, base, control, step: *step }
    }
}

/// The longest run, s.
pub const MAX_TIME: f64 = 3600.0;
