//! A [`Session`]: a scenario, what was done to it, and every frame so far.
//!
//! The window owns one and only sends it [`Edit`](super::Edit)s and transport commands (play, pause, seek);
//! [`replay`](super::replay()) carries out the same edits without a window. Because a run is a function of scenario and
//! edits, undo, scrubbing and saving need no snapshots of state: the run is made again.

mod bookmarks;
mod branches;
mod change;
mod editing;
mod history;
mod opening;
mod passing;

use std::sync::Arc;

use change::Change;

use super::document::Document;
use super::edit::TimedEdit;
use super::events::{Gestures, Watched};
use super::machines::Machines;
use super::run::Run;
use crate::query::{Grown, Queries, Sequence};
use crate::session::scenario::{MAX_FRAMES, MAX_TIME, Scenario};
use crate::simulation::frame::Frame;

/// A run that a person edits while it goes on. A copy shares frames and history, so that it costs the same however long
/// the session is; what takes long can be done to it beside the window.
#[derive(Clone, Debug)]
pub struct Session {
    document: Document,
    /// The script of the document, one after the other.
    edits: Sequence<TimedEdit>,
    run: Run,
    frames: Sequence<Frame>,
    machines: Machines,
    cursor: usize,
    playing: bool,
    undo: Vec<Arc<Change>>,
    redo: Vec<Arc<Change>>,
    /// Edits of one kind join into one undo while a gesture lasts.
    gesture: bool,
    /// Whether the gesture's parameter edits apply at the present step; the first one decides.
    gesture_now: Option<bool>,
    /// The run as it was before the last edit of the script, until the next step: where the gesture's next edit in
    /// the same step starts from.
    unedited: Option<Run>,
    /// How many branches were left, and the title of the one that the last has displaced.
    partings: (u64, Option<String>),
}

impl Session {
    /// The instant on display.
    pub fn frame(&self) -> &Frame {
        &self.frames[self.cursor]
    }

    /// Every frame so far, one a step.
    pub fn frames(&self) -> &Sequence<Frame> {
        &self.frames
    }

    /// Which machine it had when.
    pub fn machines(&self) -> &Machines {
        &self.machines
    }

    /// The scenario with everything that edits have set.
    pub fn scenario(&self) -> &Scenario {
        self.run.scenario()
    }

    /// The run at its newest step.
    pub fn run(&self) -> &Run {
        &self.run
    }

    /// Edits so far.
    pub fn script(&self) -> &Sequence<TimedEdit> {
        &self.edits
    }

    /// What hands have done, told by a store of answers.
    pub fn gestures(&self, queries: &Queries) -> Grown<Gestures> {
        queries.grow(&self.scenario().step, &self.edits, usize::MAX)
    }

    /// What has happened apart from that, told by a store of answers that reads so many new frames at most.
    pub fn events(&self, queries: &Queries, at_most: usize) -> Grown<Watched> {
        queries.grow(&(self.scenario().step, self.machines.clone()), &self.frames, at_most)
    }

    /// Whether time is to pass.
    pub fn is_playing(&self) -> bool {
        self.playing
    }

    /// Whether the display will change by itself.
    pub fn is_moving(&self) -> bool {
        self.playing && self.run.waiting().is_none() && !(self.is_at_end() && self.is_settled())
    }

    /// Whether there can be one more frame.
    fn has_room(&self) -> bool {
        let goes_on = self.frames.last().is_some_and(Frame::is_finite);
        goes_on && !self.is_full() && self.run.waiting().is_none()
    }

    /// Whether it holds as many frames as it can: time stands still until it starts over.
    pub fn is_full(&self) -> bool {
        self.frames.len() >= MAX_FRAMES || self.run.simulation().time() >= MAX_TIME
    }

    /// Whether the newest frame is on display.
    pub fn is_at_end(&self) -> bool {
        self.cursor + 1 == self.frames.len()
    }

    fn is_settled(&self) -> bool {
        self.run.simulation().is_settled()
    }

    /// Length of the time line, s: the planned motion, or as far as the run has got.
    pub fn length(&self) -> f64 {
        let done = self.run.simulation().time();
        if self.is_led() { done } else { done.max(self.run.planned_time()) }
    }

    /// The pose constant that the machine is sent to, rad; on display, if it was scrubbed back, what it was then.
    pub fn b_aim(&self) -> f64 {
        match self.run.simulation().guide() {
            crate::simulation::Guide::Follow(follower) if self.is_at_end() => follower.b_aim(),
            _ => self.frame().b_reference,
        }
    }

    /// The b nearest to one, rad, at which the points of the task stay where they are; `None` if no b serves them all.
    pub fn serving(&self, b: f64) -> Option<f64> {
        let task = &self.scenario().task;
        if task.samples.as_ref().is_some_and(|samples| samples.columns() != 2) {
            // Samples of the drives have a b of their own.
            return Some(task.b);
        }
        // Where a point is reached at one b alone, points turn with it.
        let several = self.run.pose_space().is_ok_and(|space| space.reaches_area());
        let common = if several { self.run.bands()? } else { return None };
        let nearest = common.nearest(b)?;
        Some(if nearest == b { b } else { common.inwards(nearest, 1e-6) })
    }

    /// The b nearest to one within a range, rad, at which the points of the task stay where they are: unlike
    /// [`serving`](Self::serving) it never goes round the circle of b.
    pub fn serving_within(&self, b: f64, [low, high]: [f64; 2]) -> Option<f64> {
        if self.serving(b)? == b {
            return Some(b);
        }
        let common = self.run.bands()?;
        let turns = |from: f64| [-1.0, 0.0, 1.0].map(|turn| from + turn * common.period);
        let near = common.near(0.5 * (low + high));
        let ends = near.intervals.iter().flatten().flat_map(|end| turns(*end));
        let ends = ends.filter(|end| (low..=high).contains(end));
        let nearest = ends.min_by(|x, y| (x - b).abs().total_cmp(&(y - b).abs()))?;
        Some(common.inwards(nearest, 1e-6))
    }

    /// Whether somebody has led the machine off its planned motion.
    pub fn is_led(&self) -> bool {
        self.document.script.is_led()
    }

    /// Whether a hand can lead the machine: it has a b to hold, and the run does not wait.
    pub fn follows_hands(&self) -> bool {
        self.run.waiting().is_none() && self.run.pose_space().is_ok()
    }

    /// The session as a scenario: replayed or opened again, it gives equal frames. One that has not begun covers its
    /// motion.
    pub fn to_scenario(&self) -> Scenario {
        let mut scenario = Scenario::clone(&self.document.scenario);
        scenario.edits = self.edits.to_vec();
        scenario.bookmarks.clone_from(&self.document.bookmarks);
        scenario.branches = self.kept_branches();
        scenario.duration = match self.document.end {
            0 => self.scenario().duration,
            end => Some(end as f64 * self.scenario().step),
        };
        scenario
    }
}
