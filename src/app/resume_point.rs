//! [`ResumePoint`]: the state of the display that no edit contains: the instant, the plots, the layout, the view and its
//! camera. Saved sessions and journals contain this state in comments before the session.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use super::layout::{BottomPanel, Layout};
use super::saved_runs::SavedRuns;
use super::view_state::{Framing, ViewState};
use stillbase_files::heading;
use stillbase_picture::charts::choice::PlotChoice;
use stillbase_picture::scene::Measure;
use stillbase_picture::scene::camera::Camera;
use stillbase_picture::scene::measurement::Measurement;
use stillbase_picture::scene::views::{ViewKind, Views};
use stillbase_session::{Run, Session};

/// What the window shows of a session.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ResumePoint {
    /// The instant on display, s.
    pub time: f64,
    /// Layout of the window.
    pub layout: Layout,
    /// The view of the scene.
    pub view: ViewKind,
    /// The panel below the scene.
    pub below: Option<BottomPanel>,
    /// The measure of dexterity that shades the workspace.
    pub dexterity: Option<Measure>,
    /// Playback rate, simulated seconds per second.
    pub speed: f64,
    /// Whether the run is played in a loop.
    pub loops: bool,
    /// Time of the second cursor, s.
    pub mark: Option<f64>,
    /// Whether pin forces are shown.
    pub pins: bool,
    /// Whether snapshots along the motion are shown.
    pub snapshots: bool,
    /// Whether the points of the task turn with b.
    pub turn_task: bool,
    /// The file of the session; only a journal names it.
    pub file: Option<PathBuf>,
    /// The choice of plots.
    pub plots: PlotChoice,
    /// Distances and angles that the scene shows.
    pub measurements: Vec<Measurement>,
    /// The user's part of the table of runs.
    pub runs: SavedRuns,
    /// Time up to which the run had been simulated, s.
    pub reached: f64,
    /// Cameras that the user has moved; a view without one shows everything.
    pub cameras: Vec<ViewCamera>,
}

/// The camera of a view.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ViewCamera {
    /// The view.
    pub view: ViewKind,
    /// Its camera.
    pub camera: Camera,
}

impl Default for ResumePoint {
    fn default() -> Self {
        Self {
            time: 0.0,
            layout: Layout::default(),
            view: ViewKind::default(),
            below: None,
            dexterity: None,
            speed: 1.0,
            loops: false,
            mark: None,
            pins: false,
            snapshots: false,
            turn_task: false,
            file: None,
            plots: PlotChoice::default(),
            measurements: Vec::new(),
            runs: SavedRuns::default(),
            reached: 0.0,
            cameras: Vec::new(),
        }
    }
}

impl ResumePoint {
    /// Returns what a window shows, without file and runs. The panel of an open table is left out, because the table
    /// is a file of its own.
    pub(super) fn of_view(session: &Session, view_state: &ViewState) -> Self {
        let moved = |view: &ViewKind| matches!(view_state.framing[*view as usize], Framing::Manual);
        let camera = |view: ViewKind| ViewCamera { view, camera: view_state.cameras[view as usize] };
        Self {
            time: session.frame().time,
            measurements: view_state.measurements.clone(),
            reached: session.frames().last().map_or(0.0, |frame| frame.time),
            layout: view_state.arrangement.layout,
            view: view_state.view,
            below: view_state.below.filter(|below| *below != BottomPanel::Table),
            dexterity: view_state.dexterity,
            speed: view_state.speed,
            loops: view_state.loops,
            mark: view_state.mark,
            pins: view_state.pins,
            snapshots: view_state.snapshots,
            turn_task: view_state.turn_task,
            file: None,
            runs: SavedRuns::default(),
            plots: view_state.charts.clone(),
            cameras: ViewKind::ALL.iter().copied().filter(moved).map(camera).collect(),
        }
    }

    /// Shows this state, except a view that the machine lacks, and except instant and runs, which opening sets.
    pub(super) fn show(self, view_state: &mut ViewState, run: &Run) {
        if self.layout != view_state.arrangement.layout {
            view_state.lay_out(self.layout);
        }
        view_state.view = if Views::has(self.view, run).is_ok() { self.view } else { ViewKind::default() };
        view_state.below = self.below.or(view_state.below.filter(|below| *below == BottomPanel::Table));
        view_state.dexterity = self.dexterity;
        view_state.speed = self.speed;
        view_state.loops = self.loops;
        view_state.mark = self.mark;
        view_state.pins = self.pins;
        view_state.snapshots = self.snapshots;
        view_state.turn_task = self.turn_task;
        view_state.charts = self.plots;
        let machine = &run.scenario().machine;
        view_state.measurements = self.measurements.into_iter().filter(|one| one.is_of(machine)).collect();
        view_state.framing = Default::default();
        for ViewCamera { view, camera } in self.cameras {
            let i = view as usize;
            if view_state.cameras[i].is_flat() == camera.is_flat() {
                (view_state.cameras[i], view_state.framing[i]) = (camera, Framing::Manual);
            }
        }
    }

    /// Whether another state differs from this one at most in the instant and in how far the run is simulated.
    pub fn is_alike_at_another_time(&self, other: &Self) -> bool {
        Self { time: self.time, reached: self.reached, ..other.clone() } == *self
    }

    /// Returns the text of a session, with this state in comments before it.
    pub fn before(&self, session: &str) -> String {
        heading::under(self, session)
    }

    /// Reads the state from the comments before a session; `None` if they contain no valid state.
    pub fn of(text: &str) -> Option<Self> {
        let is_time = |time: f64| time.is_finite() && time >= 0.0;
        heading::of(text).filter(|left: &Self| {
            is_time(left.time)
                && is_time(left.reached)
                && left.mark.is_none_or(is_time)
                && (MIN_SPEED..=MAX_SPEED).contains(&left.speed)
                && left.cameras.iter().all(|kept| kept.camera.is_valid())
        })
    }
}

/// Limits of a playback rate that is read from a file, simulated seconds per second.
const MIN_SPEED: f64 = 1e-3;
const MAX_SPEED: f64 = 1e3;
