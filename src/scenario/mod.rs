//! Scenarios: a machine, what it is to do, and what is done to it meanwhile; TOML files.
//!
//! A saved session is a scenario with `[[edit]]` entries, each with the step at which it applies.

mod task;

use std::path::Path as FilePath;

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::control::Gains;
use crate::machine::{self, FileError, Machine, MachineError, MachineSpec, Payload};
use crate::session::TimedEdit;
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
    /// The task.
    pub task: Task,
    /// Feedback.
    pub gains: Gains,
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

/// How the plant differs from the model.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Plant {
    /// A payload that control does not know of; it adds to the machine's own.
    #[serde(default)]
    pub payload: Payload,
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
    #[serde(default)]
    control: Gains,
    #[serde(default)]
    plant: Plant,
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
    #[error("{file}: {source}: want a file that can be read")]
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

/// The scenarios that come along: the paper's three cases, and what planning can do besides.
const BUILTIN: [(&str, &str); 7] = [
    ("case-1", include_str!("../../assets/scenarios/case-1.toml")),
    ("case-2", include_str!("../../assets/scenarios/case-2.toml")),
    ("case-3", include_str!("../../assets/scenarios/case-3.toml")),
    ("circle", include_str!("../../assets/scenarios/circle.toml")),
    ("change-b", include_str!("../../assets/scenarios/change-b.toml")),
    ("least-reaction", include_str!("../../assets/scenarios/least-reaction.toml")),
    ("drift", include_str!("../../assets/scenarios/drift.toml")),
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
        let text = std::fs::read_to_string(file).map_err(|source| match source.kind() {
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
        let scenario = Self {
            name: file.name.unwrap_or(stem),
            title: file.title,
            machine,
            plant: file.plant,
            gains: file.control,
            step: file.step,
            pose_acceleration: file.pose_acceleration,
            compare_b: file.compare_b,
            duration: file.duration,
            task: file.task,
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
            ("control.kp", self.gains.kp, "0 to 1/step² s⁻²", (0.0..=1.0 / self.step.powi(2)).contains(&self.gains.kp)),
            ("control.kd", self.gains.kd, "0 to 2/step s⁻¹", (0.0..=2.0 / self.step).contains(&self.gains.kd)),
            (
                "plant.payload.mass",
                self.plant.payload.mass,
                "0 to 10000 kg",
                (0.0..=MAX_PAYLOAD).contains(&self.plant.payload.mass),
            ),
            (
                "plant.payload.inertia",
                self.plant.payload.inertia,
                "0 to 10000 kg m²",
                (0.0..=MAX_PAYLOAD).contains(&self.plant.payload.inertia),
            ),
        ];
        let finite = [
            ("task.from", t.from[0]),
            ("task.from", t.from[1]),
            ("task.to", t.to[0]),
            ("task.to", t.to[1]),
            ("task.b", t.b),
            ("task.first_drive_to", t.first_drive_to.unwrap_or(0.0)),
            ("compare_b", self.compare_b.unwrap_or(0.0)),
            ("task.b_to", t.b_to.unwrap_or(0.0)),
        ];
        let via = t.via.iter().flatten().map(|x| ("task.via", *x));
        let finite = finite.into_iter().chain(via).map(|(key, value)| (key, value, "a finite number", true));
        for (key, value, want, ok) in positive.into_iter().chain(finite) {
            if !ok || !value.is_finite() {
                return Err(ScenarioError::OutOfRange { file: file.into(), key, value, want });
            }
        }
        Ok(())
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
        let Self { name, title, machine: _, plant, task, gains, step, pose_acceleration, compare_b, .. } = self.clone();
        let Self { duration, tolerance, edits, .. } = self.clone();
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
            control: gains,
            plant,
            tolerance,
            edits,
        };
        toml::to_string(&file).expect("a scenario is plain data")
    }

    /// The machine that moves: the model with what differs in the plant.
    ///
    /// # Errors
    /// If the difference leaves no valid machine.
    pub fn plant_machine(&self) -> Result<Machine, MachineError> {
        let mut spec = self.machine.spec().clone();
        spec.payload.mass += self.plant.payload.mass;
        spec.payload.inertia += self.plant.payload.inertia;
        Machine::new(spec)
    }
}

/// The heaviest unknown payload, kg; also the bound on its inertia, kg m².
pub const MAX_PAYLOAD: f64 = 1e4;

/// The longest run, s.
pub const MAX_TIME: f64 = 3600.0;
