//! A [`Document`]: everything that determines a run, and how an edit before its first step changes it.

use std::sync::Arc;

use super::changes::{ScriptError, changed};
use super::edit::{Edit, TimedEdit};
use super::machines::Machines;
use super::other_frames::OtherFrames;
use super::replay;
use super::run::Run;
use super::script::Script;
use crate::scenario::{Bookmark, Note, Scenario};
use stillbase_query::Sequence;
use stillbase_simulation::frame::Frame;

/// Callback that receives the progress, from 0 to 1, and returns whether the work is to go on.
pub use stillbase_query::ProgressCallback;

/// Number of frames between two progress reports.
pub(super) const REPORT_FRAMES: usize = 256;

/// Kind of data that is saved with a run and on which no frame depends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AnnotationKind {
    /// Named instants.
    Bookmarks,
    /// Texts at points and instants.
    Notes,
    /// Earlier courses of the run that other edits have replaced.
    Branches,
}

/// Everything that determines a run, with its bookmarks, notes and branches. Undo restores a document; a saved session
/// is one.
#[derive(Clone, Debug)]
pub(super) struct Document {
    /// Scenario without its edits, bookmarks, notes and branches; these are the fields below.
    pub scenario: Arc<Scenario>,
    /// Edits in the order of steps, none after `end`.
    pub script: Script,
    /// Number of steps done.
    pub end: u64,
    /// Bookmarks in the order of time.
    pub bookmarks: Arc<Vec<Bookmark>>,
    /// Notes in the order in which they were written.
    pub notes: Arc<Vec<Note>>,
    /// Courses of the run that were replaced when the user went back in time and edited, the oldest first.
    pub branches: Arc<Vec<LeftBranch>>,
}

/// Result of running a document.
pub(super) struct DocumentRun {
    /// Run at its last step.
    pub run: Run,
    /// One frame for each step.
    pub frames: Sequence<Frame>,
    /// Those of the other blocks of an assembly.
    pub others: OtherFrames,
    pub machines: Machines,
}

/// A branch: the same scenario with a script that was replaced by another one.
#[derive(Clone, Debug)]
pub(super) struct LeftBranch {
    pub script: Script,
    /// Number of steps to its end.
    pub end: u64,
    /// Step size of the branch, s.
    pub step: f64,
}

impl Document {
    /// Returns a document without bookmarks, notes and branches.
    pub fn new(scenario: Scenario, script: Script, end: u64) -> Self {
        let scenario = Arc::new(scenario);
        Self { scenario, script, end, bookmarks: Arc::default(), notes: Arc::default(), branches: Arc::default() }
    }

    /// Copies the bookmarks, the notes or the branches of another document.
    pub fn keep_as(&mut self, other: &Self, kept: AnnotationKind) {
        match kept {
            AnnotationKind::Bookmarks => self.bookmarks.clone_from(&other.bookmarks),
            AnnotationKind::Notes => self.notes.clone_from(&other.notes),
            AnnotationKind::Branches => self.branches.clone_from(&other.branches),
        }
    }

    /// Runs the document from its first to its last step, reusing the query cache of a `known` run, if there is one. If
    /// `patient` is true and the task does not fit its machine, the run waits at its first step instead of failing.
    pub fn perform(
        &self,
        known: Option<&Run>,
        patient: bool,
        watch: ProgressCallback<'_>,
    ) -> Result<DocumentRun, ScriptError> {
        self.perform_to(known, patient, |_| self.end, watch)
    }

    /// Does the same as [`perform`](Self::perform) up to the step that `end` returns for the run at its start.
    fn perform_to(
        &self,
        known: Option<&Run>,
        patient: bool,
        end: impl FnOnce(&Run) -> u64,
        watch: ProgressCallback<'_>,
    ) -> Result<DocumentRun, ScriptError> {
        let (mut frames, mut others, mut machines) = (Sequence::default(), OtherFrames::default(), Machines::default());
        let see = |run: &Run, frame: &Frame| {
            frames.push(*frame);
            others.push(run);
            machines.set_from(frame.step, &run.scenario().machine);
            !frames.len().is_multiple_of(REPORT_FRAMES) || watch(frames.len() as f64 / (self.end + 1) as f64)
        };
        let end = |run: &Run, _: &[TimedEdit]| Ok(end(run));
        let run = replay::perform(&self.scenario, &self.script.to_vec(), end, patient, known, see)?;
        Ok(DocumentRun { run, frames, others, machines })
    }

    /// Runs the document after an edit of its start. If the edit has made the planned motion shorter than that of the
    /// `known` run, the run ends with it, or with the last edit: it does not keep the length of the earlier plan.
    pub fn perform_amended(
        &mut self,
        known: &Run,
        patient: bool,
        watch: ProgressCallback<'_>,
    ) -> Result<DocumentRun, ScriptError> {
        let last_edit = self.script.last().map_or(0, |timed| timed.step);
        let is_planned = !self.script.is_dragged() && known.waiting().is_none();
        let end = |run: &Run| match is_planned && run.whole_time() < known.whole_time() {
            true => self.end.min(last_edit.max(run.planned_steps() as u64)),
            false => self.end,
        };
        let done = self.perform_to(Some(known), patient, end, watch)?;
        if done.run.waiting().is_none() {
            self.end = done.run.simulation().step_count();
        }
        Ok(done)
    }

    /// Compares scenario and script with those of another document. If they differ only in settings on which no frame
    /// depends, returns the scenario of the run with these settings from `self`. Otherwise returns `None`.
    pub fn aside_of(&self, other: &Self) -> Option<Scenario> {
        fn moving(document: &Document) -> impl Iterator<Item = &TimedEdit> {
            document.script.in_order().into_iter().filter(|timed| !timed.edit.affects_no_frame())
        }
        if !moving(self).eq(moving(other)) || other.scenario.with_asides_of(&self.scenario).ok()? != *self.scenario {
            return None;
        }
        let mut asides = self.script.in_order().into_iter().filter_map(|timed| timed.edit.frameless_settings());
        asides.try_fold(Scenario::clone(&self.scenario), |now, edit| changed(&now, &edit).ok())
    }

    /// Returns the document with an edit inserted before the first step.
    pub fn amended(&self, timed: &TimedEdit) -> Self {
        let mut document = self.clone();
        let mut timed = timed.clone();
        if let Some(change) = timed.edit.take_key("duration") {
            // A saved session stores its length as `duration`, so this setting changes the scenario and is not part of
            // the script.
            if let Ok(scenario) = document.scenario.with_settings(&change) {
                document.scenario = Arc::new(scenario);
            }
            if timed.edit.sets_nothing() {
                return document;
            }
        }
        let mut script = document.script.to_vec();
        script.retain(|e| !e.edit.is_replaced_by(&timed.edit));
        if timed.edit.sets_path() && document.script.is_dragged() {
            // A new plan puts a dragged machine back on its path. Drags, hand-overs and later changes of b are dropped, and all
            // other edits move to step 0.
            let mut kept: Vec<TimedEdit> = Vec::with_capacity(script.len());
            for e in script.drain(..).filter(|e| !e.edit.acts_in_motion()) {
                if e.step > 0 && matches!(e.edit, Edit::PoseB { .. }) {
                    continue;
                }
                kept.retain(|old| !old.edit.is_replaced_by(&e.edit));
                kept.push(TimedEdit { step: 0, edit: e.edit });
            }
            script = kept;
            document.end = 0;
        }
        // The edit goes before the first drag, so that a drag at step 0 starts from the pose that this edit gives.
        let place = script.iter().position(|e| e.step > 0 || e.edit.acts_in_motion());
        let sets_no_key = timed.edit.part("task").is_some_and(toml::Table::is_empty);
        if !sets_no_key {
            script.insert(place.unwrap_or(script.len()), timed.clone());
        }
        document.script = document.script.replaced(script);
        document
    }
}
