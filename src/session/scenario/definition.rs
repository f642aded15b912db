//! [`Scenario`]: machine, task and all settings from which a run starts.

use std::sync::Arc;

use super::design::DesignBrief;
use super::error::ScenarioError;
use super::kept::{Bookmark, Branch};
use super::note::Note;
use super::task::Task;
use super::tolerance::Tolerance;
use crate::TimedEdit;
use crate::assembly::AssemblyBlock;
use stillbase_mechanics::machine::{Machine, MachineError};
use stillbase_mechanics::sketch::Sketch;
use stillbase_settings::range::RangeCheck;
use stillbase_simulation::Setup;
use stillbase_simulation::control::Control;
use stillbase_simulation::plant::{Base, PlantDifferences};

/// Machine, task and all settings from which a run starts.
#[derive(Clone, Debug, PartialEq)]
pub struct Scenario {
    /// Short name: `case-3`.
    pub name: String,
    /// Description in a few words.
    pub title: String,
    /// Description in one sentence.
    pub summary: String,
    /// Nominal machine, which control assumes.
    pub machine: Machine,
    /// Differences of the plant, the machine that moves, from the nominal machine.
    pub plant: PlantDifferences,
    /// Base on which the machine stands.
    pub base: Base,
    /// The task.
    pub task: Task,
    /// Control of the motors.
    pub control: Control,
    /// Fixed step size, s.
    pub step: f64,
    /// Bound on |b̈| while b is slid, rad/s².
    pub pose_acceleration: f64,
    /// Pose constant of a second workspace to compare with, rad.
    pub compare_b: Option<f64>,
    /// Time that a headless run covers, s; by default that of the planned motion.
    pub duration: Option<f64>,
    /// Tolerances of machines as built.
    pub tolerance: Tolerance,
    /// Requirements on the machine in the design view.
    pub design: DesignBrief,
    /// The drawing of the machine, if it is drawn by hand. While it is incomplete, the machine is the last complete one.
    pub sketch: Option<Sketch>,
    /// Edits by the user.
    pub edits: Vec<TimedEdit>,
    /// Bookmarks; no motion depends on them.
    pub bookmarks: Vec<Bookmark>,
    /// Notes; no motion depends on them.
    pub notes: Vec<Note>,
    /// Courses of the run that other edits have replaced.
    pub branches: Vec<Branch>,
    /// The assembly of which the machine is a block; `None` for a machine by itself.
    pub assembly: Option<Arc<AssemblyBlock>>,
}

impl Scenario {
    /// Checks every number, and the machine that moves. Errors name `file`.
    ///
    /// # Errors
    /// If a number is out of range, or the machine that moves is not valid.
    pub fn check(&self, file: &str) -> Result<(), ScenarioError> {
        if let Some(RangeCheck { key, value, want, .. }) = self.checks().into_iter().find(|check| !check.ok) {
            return Err(ScenarioError::OutOfRange { file: file.into(), line: None, key: key.into(), value, want });
        }
        let named = self.plant.machine(&self.machine).map(|_| ());
        named.map_err(|error| ScenarioError::Machine { file: format!("{file}: plant"), line: None, error })
    }

    /// Returns the machine that moves, with the payload that it holds at the start.
    ///
    /// # Errors
    /// If it is not a valid machine.
    pub fn plant_machine(&self) -> Result<Machine, MachineError> {
        let (machine, load) = (self.plant.machine(&self.machine)?, &self.plant.payload);
        if load.is_held(0.0, 0.5 * self.step) { load.held_by(&machine) } else { Ok(machine) }
    }

    /// Returns the scenario without edits, bookmarks, notes and branches.
    pub fn without_edits(&self) -> Self {
        let Self { name, title, summary, machine, plant, base, task, control, step, .. } = self;
        let Self { pose_acceleration, compare_b, duration, tolerance, design, sketch, assembly, .. } = self;
        Self {
            name: name.clone(),
            title: title.clone(),
            summary: summary.clone(),
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
            sketch: sketch.clone(),
            edits: Vec::new(),
            bookmarks: Vec::new(),
            notes: Vec::new(),
            branches: Vec::new(),
            assembly: assembly.clone(),
        }
    }

    /// Returns the scenario without edits on another machine. A start that the task states brings A and b of that machine.
    #[must_use]
    pub fn on_machine(&self, machine: &Machine) -> Self {
        let mut other =
            Self { machine: machine.clone(), sketch: None, compare_b: None, assembly: None, ..self.without_edits() };
        if let Some(task) = other.task.at_its_start(machine) {
            other.task = task;
        }
        other
    }

    /// Returns the input of a simulation.
    pub fn setup(&self) -> Setup<'_> {
        let Self { machine: model, plant, base, control, step, .. } = self;
        Setup { model, plant, base, control, step: *step }
    }
}
