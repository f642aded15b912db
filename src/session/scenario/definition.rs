//! [`Scenario`]: what a run starts from.

use super::design::Brief;
use super::error::ScenarioError;
use super::kept::{Bookmark, Branch};
use super::task::Task;
use super::tolerance::Tolerance;
use crate::mechanics::machine::{Machine, MachineError};
use crate::session::TimedEdit;
use crate::settings::range::Check;
use crate::simulation::Setup;
use crate::simulation::control::Control;
use crate::simulation::plant::{Base, PlantDifferences};

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
    pub plant: PlantDifferences,
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
    /// What is asked of the machine while it is designed.
    pub design: Brief,
    /// What was done, in the order of steps.
    pub edits: Vec<TimedEdit>,
    /// Instants to find again, by time; no motion depends on them.
    pub bookmarks: Vec<Bookmark>,
    /// How it went on before somebody went back and did something else.
    pub branches: Vec<Branch>,
}

impl Scenario {
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
        let Self { pose_acceleration, compare_b, duration, tolerance, design, .. } = self;
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
            design: design.clone(),
            edits: Vec::new(),
            bookmarks: Vec::new(),
            branches: Vec::new(),
        }
    }

    /// What a simulation of it is made of.
    pub fn setup(&self) -> Setup<'_> {
        let Self { machine: model, plant, base, control, step, .. } = self;
        Setup { model, plant, base, control, step: *step }
    }
}
