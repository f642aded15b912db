//! [`Beside`]: a run that is drawn beside the one on display.

use super::exaggeration::{DrawnFrame, Exaggeration};
use super::framing::ViewContent;
use super::stage::Stage;
use crate::numbers::round_up;
use stillbase_query::{Portion, ProgressCallback, Query, Shared};
use stillbase_session::scenario::Scenario;
use stillbase_session::{Refusal, Run};
use stillbase_simulation::frame::Frame;
use stillbase_study::comparison::{ComparedRun, Comparison};

/// A finished run with the stage on which it is drawn.
#[derive(Clone, Debug)]
pub struct Beside {
    /// A table of this run alone, for plots and marks.
    pub table: Comparison,
    /// Its stage, without a workspace.
    pub stage: Stage,
    run: ComparedRun,
}

/// Drawn rotation of the base at the largest moment of its run, rad, and bound on that of the other base.
const DRAWN_TURN: f64 = 0.035;
const MAX_DRAWN_TURN: f64 = 0.08;
/// A run with smaller moments leaves its base at rest, N m.
const AT_REST_N_M: f64 = 1e-3;
/// Compliance of the drawn mount if the base is at rest, rad/(N m).
const USUAL_COMPLIANCE: f64 = 0.03;
/// Number of instants whose poses a view must contain.
const SAMPLES: usize = 9;

impl Beside {
    /// Runs a scenario as long as `watch` returns `true`.
    ///
    /// # Errors
    /// If the scenario cannot start, or one of its edits cannot be applied, or if `watch` returns `false`.
    pub fn of_while(scenario: &Scenario, watch: ProgressCallback<'_>) -> Result<Self, Refusal> {
        let stage = Stage::begun(&Run::new(scenario)?).without_workspace();
        let run = ComparedRun::of_while(scenario.clone(), watch)?;
        let mut table = Comparison::empty(scenario);
        table.keep_run(run.clone());
        Ok(Self { table, stage, run })
    }

    /// The scenario.
    pub fn scenario(&self) -> &Scenario {
        &self.run.scenario
    }

    /// Returns the frame at a time, s; after the end the last one.
    pub fn at(&self, time: f64) -> Option<&Frame> {
        self.run.at(time)
    }

    /// Largest moment on the base, N m.
    pub fn peak_moment(&self) -> f64 {
        self.run.summary.peak_moment
    }

    /// Returns the compliance of the mount on which two bases are drawn, rad/(N m), so that this run's largest moment
    /// is seen. It is a round number of degrees, unless `other_peak`, the other run's largest moment, N m, bounds it.
    pub fn compliance(&self, other_peak: f64) -> f64 {
        let peak = self.peak_moment();
        let wanted = if peak > AT_REST_N_M { DRAWN_TURN / peak } else { USUAL_COMPLIANCE };
        let most = if other_peak > AT_REST_N_M { MAX_DRAWN_TURN / other_peak } else { f64::INFINITY };
        round_up(wanted.to_degrees()).to_radians().min(most)
    }

    /// Returns what a view of the run must contain.
    pub fn content(&self) -> ViewContent {
        let last = self.run.frames.len().saturating_sub(1);
        let frames = (0..SAMPLES).filter_map(|i| self.run.frames.get(i * last / (SAMPLES - 1)));
        let outline = |frame| {
            let shown = DrawnFrame::of(frame, Exaggeration::default());
            self.stage.outline(&shown).collect::<Vec<_>>()
        };
        ViewContent { first: frames.flat_map(outline).collect(), then: Vec::new() }
    }
}

/// Query for a run to be drawn beside the one on display.
#[derive(Debug)]
pub struct BesideQuery(Shared<Scenario>);

impl Query for BesideQuery {
    type Input = Shared<Scenario>;
    /// The run, or the reason why there is none.
    type Answer = Result<Beside, String>;

    fn begin(scenario: Self::Input) -> Self {
        Self(scenario)
    }

    fn go_on(&mut self, goes_on: ProgressCallback<'_>) -> Portion<Self::Answer> {
        match Beside::of_while(&self.0.0, goes_on) {
            Err(Refusal::Stopped) => Portion::Stopped,
            answer => Portion::Done(answer.map_err(|why| why.to_string())),
        }
    }
}
