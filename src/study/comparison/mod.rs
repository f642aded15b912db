//! Comparison of runs on one time axis: alternatives for one task, or any scenarios.

mod alternative;
mod design;
mod difference;
mod entries;
mod row;
mod summary;

pub use alternative::{Alternative, SLOW_FACTOR};
pub use design::{DESIGN_COLUMNS, DesignCandidate, DesignMeasures};
pub use difference::SignalDifference;
pub use entries::{AlternativeRuns, Comparison, ComparisonEntry, ComparisonOutcome, RefusedRun};
pub use row::{BaselineMachines, ComparisonRow, ComparisonTable};
pub use summary::{OLD_NAMES, SUMMARY_COLUMNS, Summary, SummaryColumn};

use stillbase_mechanics::machine::Machine;
use stillbase_query::Sequence;
use stillbase_session::scenario::Scenario;
use stillbase_session::{ProgressCallback, Refusal, replay_while};
use stillbase_simulation::frame::Frame;

/// Maximum number of frames stored per run. A longer run keeps every second, fourth, eighth … frame, and its last.
const MAX_FRAMES: usize = 4000;

/// A run to compare with others.
#[derive(Clone, Debug)]
pub struct ComparedRun {
    /// The scenario.
    pub scenario: Scenario,
    /// Frames in the order of time, evenly spaced except the last.
    pub frames: Sequence<Frame>,
    /// Results of the run.
    pub summary: Summary,
    /// Its machine after all edits, its task and its motion.
    pub candidate: DesignCandidate,
}

impl ComparedRun {
    /// Runs a scenario.
    ///
    /// # Errors
    /// If the scenario cannot start, an edit cannot apply, the run has too many steps, or the motion diverges.
    pub fn of(scenario: Scenario) -> Result<Self, Refusal> {
        Self::of_while(scenario, &mut |_| true)
    }

    /// Runs a scenario as long as `watch` returns `true`.
    ///
    /// # Errors
    /// As [`of`](Self::of), and if `watch` returns `false`.
    pub fn of_while(scenario: Scenario, watch: ProgressCallback<'_>) -> Result<Self, Refusal> {
        let (mut frames, mut every): (Vec<Frame>, u64) = (Vec::new(), 1);
        let run = replay_while(&scenario, |run, frame| {
            let wanted = !frame.step.is_multiple_of(256) || watch(frame.step as f64 / run.last_step().max(1) as f64);
            if frame.step.is_multiple_of(every) {
                if frames.len() >= MAX_FRAMES {
                    every *= 2;
                    frames.retain(|f| f.step.is_multiple_of(every));
                }
                if frame.step.is_multiple_of(every) {
                    frames.push(*frame);
                }
            }
            wanted
        })?;
        let last = run.frame();
        if frames.last().is_none_or(|f| f.step != last.step) {
            frames.push(last);
        }
        let summary = Summary::of(&scenario, &last);
        let frames = frames.into_iter().collect();
        Ok(Self { scenario, frames, summary, candidate: DesignCandidate::of(&run) })
    }

    /// Returns the machine that control assumes before any edit.
    pub fn machine(&self) -> &Machine {
        &self.scenario.machine
    }

    /// Returns the duration, s.
    pub fn duration(&self) -> f64 {
        self.frames.last().map_or(0.0, |f| f.time)
    }

    /// Returns the last frame up to a time, s. For a time before the start, returns the first frame.
    pub fn at(&self, time: f64) -> Option<&Frame> {
        let after = self.frames.partition_point(|f| f.time <= time + 1e-9);
        self.frames.get(after.saturating_sub(1))
    }
}

/// Returns the alternatives for a scenario's task, each with its scenario. The scenario as given is omitted if it has
/// no edits and another alternative has the same task and kind of base.
pub fn alternatives(scenario: &Scenario) -> Vec<(Alternative, Scenario)> {
    let mut all: Vec<(Alternative, Scenario)> =
        Alternative::ALL.into_iter().filter(|way| way.is_of(scenario)).map(|way| (way, way.of(scenario))).collect();
    // Wheels are not compared, because a wheel does not change the task.
    let given = |s: &Scenario| s.task == scenario.task && s.base.kind == scenario.base.kind;
    if scenario.edits.is_empty() && all.iter().skip(1).any(|(_, s)| given(s)) {
        all.remove(0);
    }
    all
}
