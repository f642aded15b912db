//! A [`Session`]: a scenario, its edits, and every frame so far.
//!
//! The window owns one and only sends it [`Edit`](super::Edit)s and transport commands (play, pause, seek);
//! [`replay`](super::replay()) carries out the same edits without a window. Because a run is a function of scenario and
//! edits, undo, scrubbing and saving need no snapshots of state: the run is computed again.

mod bookmarks;
mod branches;
mod change;
mod editing;
mod history;
mod notes;
mod opening;
mod own_task;
mod passing;

use std::sync::Arc;

use nalgebra::Vector3;

use change::HistoryStep;

use super::document::Document;
use super::edit::{Edit, TimedEdit};
use super::events::{EventLog, Gestures};
use super::machines::Machines;
use super::other_frames::OtherFrames;
use super::run::Run;
use crate::gentle_motion::has_made_task;
use crate::scenario::{MAX_FRAMES, MAX_TIME, Scenario};
use stillbase_mechanics::sketch::{SketchStep, resolve};
use stillbase_query::{IncrementalAnswer, Queries, Sequence};
use stillbase_simulation::frame::Frame;

/// A run that the user edits while it goes on. Copies share frames and history, so the cost of a copy does not grow
/// with the session. Slow operations can run on a copy in the background.
#[derive(Clone, Debug)]
pub struct Session {
    document: Document,
    /// Edits of the document's script, in order.
    edits: Sequence<TimedEdit>,
    run: Run,
    frames: Sequence<Frame>,
    others: OtherFrames,
    machines: Machines,
    cursor: usize,
    playing: bool,
    undo: Vec<Arc<HistoryStep>>,
    redo: Vec<Arc<HistoryStep>>,
    /// Whether a gesture is in progress; its edits of one kind join into one undo entry.
    gesture: bool,
    /// Whether settings changed in the gesture apply at the present step; the first edit of the gesture decides.
    gesture_now: Option<bool>,
    /// Run before the last edit of the script, kept until the next step. The next edit of the gesture in the same step
    /// starts from it.
    unedited: Option<Run>,
    /// Number of branches made so far, and the title of the branch that the last of them has displaced.
    branch_events: (u64, Option<String>),
}

impl Session {
    /// Returns the frame on display.
    pub fn frame(&self) -> &Frame {
        &self.frames[self.cursor]
    }

    /// Returns every frame so far, one for each step.
    pub fn frames(&self) -> &Sequence<Frame> {
        &self.frames
    }

    /// Returns the frames on display of the other blocks of an assembly, each with the place of its block.
    pub fn others(&self) -> impl Iterator<Item = (usize, &Frame)> + Clone {
        self.others.at(self.cursor)
    }

    /// Returns the machine at each step.
    pub fn machines(&self) -> &Machines {
        &self.machines
    }

    /// Returns the scenario with all settings of its edits.
    pub fn scenario(&self) -> &Scenario {
        self.run.scenario()
    }

    /// Returns the run at its newest step.
    pub fn run(&self) -> &Run {
        &self.run
    }

    /// Returns the edits so far.
    pub fn script(&self) -> &Sequence<TimedEdit> {
        &self.edits
    }

    /// Returns the gestures of the user, from the cache of queries.
    pub fn gestures(&self, queries: &Queries) -> IncrementalAnswer<Gestures> {
        queries.grow(&self.scenario().step, &self.edits, usize::MAX)
    }

    /// Returns all other events, from the cache of queries, which reads no more than `at_most` new frames.
    pub fn events(&self, queries: &Queries, at_most: usize) -> IncrementalAnswer<EventLog> {
        queries.grow(&(self.scenario().step, self.machines.clone()), &self.frames, at_most)
    }

    /// Returns whether the session is playing, not paused.
    pub fn is_playing(&self) -> bool {
        self.playing
    }

    /// Returns whether the display will change by itself.
    pub fn is_moving(&self) -> bool {
        self.playing && self.run.waiting().is_none() && !(self.is_at_end() && self.is_settled())
    }

    /// Returns whether one more frame can be computed.
    fn has_room(&self) -> bool {
        let goes_on = self.frames.last().is_some_and(Frame::is_finite);
        goes_on && !self.is_full() && self.run.waiting().is_none()
    }

    /// Returns whether the session has the maximum number of frames, or has reached the maximum time, so that it has to
    /// start over.
    pub fn is_full(&self) -> bool {
        self.frames.len() >= MAX_FRAMES || self.run.simulation().time() >= MAX_TIME
    }

    /// Returns whether the newest frame is on display.
    pub fn is_at_end(&self) -> bool {
        self.cursor + 1 == self.frames.len()
    }

    fn is_settled(&self) -> bool {
        self.run.is_settled()
    }

    /// Returns the length of the time line, s: of the planned motion or of the run so far, whichever is longer. For a
    /// dragged machine it is that of the run.
    pub fn length(&self) -> f64 {
        let done = self.run.simulation().time();
        if self.is_dragged() { done } else { done.max(self.run.whole_time()) }
    }

    /// Returns the reference b of the frame on display, rad. If this is the newest frame of a dragged machine, returns
    /// the b to which the machine moves.
    pub fn b_aim(&self) -> f64 {
        match self.run.simulation().guide() {
            stillbase_simulation::Guide::Follow(follower) if self.is_at_end() => follower.b_aim(),
            _ => self.frame().b_reference,
        }
    }

    /// Returns the edit that sends the end effector of a carried block to a point, m, in the axes of the block, its height
    /// from that of the end effector; what carries it goes along. `None` if there is no way.
    pub fn edit_in_space(&self, [x, y, height]: [f64; 3]) -> Option<Edit> {
        let shared = self.run.shared()?;
        let own = &shared.block().scenario.assembly.blocks()[shared.block().block];
        let point = Vector3::new(x, y, own.platform_height() + height);
        Some(Edit::DragBlocks { targets: shared.targets_in_space(&self.run, &point)? })
    }

    /// Returns where the end effector of the led block is, m, in axes of the base of its assembly.
    pub fn tip_on_base(&self) -> Option<[f64; 3]> {
        let shared = self.run.shared()?;
        Some(shared.now().tips[shared.block().block].into())
    }

    /// Returns the edit that sends the end effector of a carried block to a place, m, in axes of the base.
    pub fn edit_on_base(&self, place: [f64; 3]) -> Option<Edit> {
        let shared = self.run.shared()?;
        Some(Edit::DragBlocks { targets: shared.targets_on_base(&self.run, &place.into())? })
    }

    /// Returns the edit for a new b, rad. While the newest frame plays, the machine moves to the plane b; else it is put
    /// there. A dragged machine takes any b, and so does a task whose points may turn with the plane. Otherwise the
    /// edit takes the nearest b that is feasible for the points, which stay in any case.
    pub fn edit_of_b(&self, b: f64, turns_task: bool) -> Edit {
        if self.is_playing() && self.is_at_end() {
            return Edit::SlideB { b };
        }
        if self.is_dragged() || turns_task {
            return Edit::PoseB { b };
        }
        let stay = self.run.pose_space().is_ok_and(|space| space.reaches_area());
        match self.nearest_feasible_b(b) {
            Some(b) => Edit::PoseB { b },
            // No b serves all points yet: the run waits, and will go on waiting.
            None if stay => Edit::set("task.b", b),
            None => Edit::PoseB { b },
        }
    }

    /// Returns the pose constant nearest to `b`, rad, at which the points of the task stay where they are. Returns
    /// `None` if no b reaches all, or if the workspace at constant b is no area. Drive samples give the task's b.
    pub fn nearest_feasible_b(&self, b: f64) -> Option<f64> {
        let task = &self.scenario().task;
        if task.samples.as_ref().is_some_and(|samples| samples.columns() != 2) {
            // Samples of drive angles determine b.
            return Some(task.b);
        }
        // If each point is reached at a single b, points turn with b.
        let several = self.run.pose_space().is_ok_and(|space| space.reaches_area());
        let common = if several { self.run.feasible_b()? } else { return None };
        let nearest = common.nearest(b)?;
        Some(if nearest == b { b } else { common.moved_inside(nearest, 1e-6) })
    }

    /// Returns the pose constant nearest to `b` within a range, rad, at which the points of the task stay where they
    /// are. Unlike [`nearest_feasible_b`](Self::nearest_feasible_b) it does not wrap around the period of b.
    pub fn nearest_feasible_b_within(&self, b: f64, [low, high]: [f64; 2]) -> Option<f64> {
        if self.nearest_feasible_b(b)? == b {
            return Some(b);
        }
        let common = self.run.feasible_b()?;
        let turns = |from: f64| [-1.0, 0.0, 1.0].map(|turn| from + turn * common.period);
        let near = common.shifted_near(0.5 * (low + high));
        let ends = near.intervals.iter().flatten().flat_map(|end| turns(*end));
        let ends = ends.filter(|end| (low..=high).contains(end));
        let nearest = ends.min_by(|x, y| (x - b).abs().total_cmp(&(y - b).abs()))?;
        Some(common.moved_inside(nearest, 1e-6))
    }

    /// Returns whether the user has dragged the machine off its planned motion.
    pub fn is_dragged(&self) -> bool {
        self.document.script.is_dragged()
    }

    /// Returns whether the user can drag the end effector of the machine, and the run does not wait.
    pub fn can_be_dragged(&self) -> bool {
        self.run.can_be_led()
    }

    /// Returns whether a file of the machine holds all that the user has changed: no edit concerns anything else, there is
    /// no bookmark, note or branch, a drawing is complete, and none was begun in place of another machine of the user.
    pub fn changes_machine_only(&self) -> bool {
        let kept =
            [self.document.bookmarks.is_empty(), self.document.notes.is_empty(), self.document.branches.is_empty()];
        let scenario = self.scenario();
        let is_drawn = || match &scenario.sketch {
            Some(sketch) => resolve(sketch).machine.as_ref() == Some(&scenario.machine),
            None => true,
        };
        let begins = |edit: &Edit| matches!(edit, Edit::Sketch(SketchStep::New { .. }));
        // A task that was made for the machine is made again when its file is opened.
        let is_made_again = |edit: &Edit| {
            matches!(edit, Edit::Set { change } if change.keys().all(|key| key == "task")) && has_made_task(scenario)
        };
        kept == [true; 3]
            && self.edits.iter().all(|timed| timed.edit.is_of_machine() || is_made_again(&timed.edit))
            && !self.edits.iter().skip(1).any(|timed| begins(&timed.edit))
            && is_drawn()
    }

    /// Returns the session as a scenario, which gives equal frames when it is replayed or opened again. At step 0 the
    /// duration stays that of the scenario.
    pub fn to_scenario(&self) -> Scenario {
        let mut scenario = Scenario::clone(&self.document.scenario);
        scenario.edits = self.edits.to_vec();
        scenario.bookmarks.clone_from(&self.document.bookmarks);
        scenario.notes.clone_from(&self.document.notes);
        scenario.branches = self.kept_branches();
        scenario.duration = match self.document.end {
            0 => self.scenario().duration,
            end => Some(end as f64 * self.scenario().step),
        };
        scenario
    }
}
