//! Applies edits to a session: at the present step, or to the run as a whole.

use super::Session;
use crate::changes::ScriptError;
use crate::document::{Document, DocumentRun};
use crate::edit::{Edit, TimedEdit};
use crate::refusal::Refusal;
use stillbase_query::ProgressCallback;

impl Session {
    /// Applies an edit. Drags and pushes apply at the present step, as do most other edits while the machine moves.
    /// All others change the start, and the run so far is computed again.
    ///
    /// # Errors
    /// If the edit cannot apply; then nothing has changed. Joint limits always apply: if the task does not fit them,
    /// the run waits.
    pub fn apply(&mut self, edit: Edit) -> Result<(), Refusal> {
        self.apply_while(edit, &mut |_| true)
    }

    /// Does the same as [`apply`](Self::apply), unless `watch` cancels it.
    ///
    /// # Errors
    /// As [`apply`](Self::apply), and if `watch` cancels it.
    pub fn apply_while(&mut self, edit: Edit, watch: ProgressCallback<'_>) -> Result<(), Refusal> {
        let before = matches!(edit, Edit::Sketch(_)).then(|| self.run.shared_scenario());
        let mut now = self.concerns_now(&edit);
        if let (true, Some(waiting)) = (now, self.run.waiting()) {
            return Err(waiting.why.clone());
        }
        let done = match now {
            true => self.apply_now(edit.clone(), watch),
            false => self.amend(edit.clone(), watch),
        };
        match done {
            Err(why) if now && edit.sets_limits() && why != Refusal::Stopped => {
                // The motion in progress does not keep the new limits, so they are applied from its start.
                now = false;
                self.amend(edit, watch)?;
            }
            done => done?,
        }
        self.gesture_now = Some(now);
        if let Some(before) = before {
            self.give_own_task(&before.0, watch);
        }
        Ok(())
    }

    /// Returns whether an edit applies at the present step rather than to the run as a whole.
    pub(super) fn concerns_now(&self, edit: &Edit) -> bool {
        match edit {
            edit if edit.acts_in_motion() => true,
            Edit::Push { .. } => true,
            Edit::PoseB { .. } => self.is_dragged(),
            // A dragged machine has the new limits from the present step on.
            edit if edit.sets_limits() && self.is_dragged() && self.run.waiting().is_none() => true,
            // A motion in progress cannot change its time or its base.
            edit if edit.applies_to_whole_run() => false,
            // Edits of a gesture apply as its first edit did, even if that set the machine in motion.
            _ => self.gesture_now.unwrap_or_else(|| self.is_running()),
        }
    }

    /// Returns whether the newest frame is on display and time passes.
    pub(super) fn is_running(&self) -> bool {
        self.is_moving() && self.is_at_end()
    }

    /// Applies an edit at the present step. If an earlier frame is on display, the later frames are replaced.
    fn apply_now(&mut self, edit: Edit, watch: ProgressCallback<'_>) -> Result<(), Refusal> {
        if self.is_full() && self.is_at_end() && (edit.acts_in_motion() || matches!(edit, Edit::Push { .. })) {
            return Err(Refusal::Full { time: self.run.simulation().time() });
        }
        let before = self.document.clone();
        let mut document = before.clone();
        let (mut remade, mut branch_events) = (None, self.branch_events.clone());
        if !self.is_at_end() {
            (document.branches, branch_events) = self.with_left();
            document.end = self.cursor as u64;
            document.script.truncate(document.end);
            remade = Some(document.perform(Some(&self.run), false, watch).map_err(ScriptError::refusal)?);
        }
        let timed = TimedEdit { step: document.end, edit };
        let joins = self.gesture
            && remade.is_none()
            && document.script.last().is_some_and(|e| e.step == timed.step && e.edit.is_replaced_by(&timed.edit));
        // An edit that replaces the previous edit starts from the run before both, as if the previous one had not been
        // made.
        let unedited = match (&remade, &self.unedited) {
            (Some(remade), _) => remade.run.clone(),
            (None, Some(run)) if joins => {
                document.script.pop();
                run.clone()
            }
            _ => self.run.clone(),
        };
        let inverse = unedited.inverse_of(&timed.edit);
        let mut run = unedited.clone();
        run.apply(&timed.edit)?;
        self.edits.truncate(document.script.len());
        self.edits.push(timed.clone());
        document.script.push(timed.clone());
        if let Some(remade) = remade {
            (self.frames, self.others, self.machines) = (remade.frames, remade.others, remade.machines);
        }
        (self.document, self.run, self.unedited, self.branch_events) = (document, run, Some(unedited), branch_events);
        self.show_present();
        self.cursor = self.frames.len() - 1;
        if timed.edit.is_drag() {
            self.playing = true;
        }
        self.remember(before, timed, inverse);
        Ok(())
    }

    /// Applies an edit before the first step, so that a setting applies to the whole run.
    pub(super) fn amend(&mut self, edit: Edit, watch: ProgressCallback<'_>) -> Result<(), Refusal> {
        let (before, inverse) = (self.document.clone(), self.run.inverse_of(&edit));
        let timed = TimedEdit { step: 0, edit };
        let mut document = self.document.amended(&timed);
        let mut branch_events = self.branch_events.clone();
        // The dragged motion would be lost, so it becomes a branch.
        if self.is_dragged() && !document.script.is_dragged() {
            (document.branches, branch_events) = self.with_left();
        }
        match &timed.edit {
            edit if edit.affects_no_frame() => {
                self.run.apply(&timed.edit)?;
                self.unedited = None;
                self.edits = document.script.to_vec().into_iter().collect();
                self.document = document;
            }
            edit => {
                let patient = edit.sets_machine() || self.run.waiting().is_some();
                self.restore_amended(document, patient, watch)?;
            }
        }
        self.branch_events = branch_events;
        self.remember(before, timed, inverse);
        Ok(())
    }

    /// Replaces the newest frame after an edit.
    fn show_present(&mut self) {
        let frame = self.run.frame();
        self.machines.set_from(frame.step, &self.scenario().machine.clone());
        self.frames.replace_last(frame);
        self.others.replace_last(&self.run);
    }

    /// Applies an edit while time passes, without an undo entry.
    pub(super) fn append(&mut self, edit: Edit, watch: ProgressCallback<'_>) -> Result<(), Refusal> {
        if !self.concerns_now(&edit) {
            return self.restore_amended(self.document.amended(&TimedEdit { step: 0, edit }), false, watch);
        }
        self.run.apply(&edit)?;
        let timed = TimedEdit { step: self.document.end, edit };
        self.edits.push(timed.clone());
        self.document.script.push(timed);
        self.show_present();
        Ok(())
    }

    /// Runs a document and shows the same instant as before, if there is a frame. If `patient` is true and the task
    /// does not fit its machine, the run waits. The document stays complete, so that the run continues where it was
    /// once the task fits again.
    pub(super) fn restore(
        &mut self,
        document: Document,
        patient: bool,
        watch: ProgressCallback<'_>,
    ) -> Result<(), Refusal> {
        let done = document.perform(Some(&self.run), patient, watch).map_err(ScriptError::refusal)?;
        self.show_remade(document, done);
        Ok(())
    }

    /// Does the same as [`restore`](Self::restore) for a document whose start has been edited: a shorter plan ends the
    /// run earlier.
    fn restore_amended(
        &mut self,
        mut document: Document,
        patient: bool,
        watch: ProgressCallback<'_>,
    ) -> Result<(), Refusal> {
        let done = document.perform_amended(&self.run, patient, watch).map_err(ScriptError::refusal)?;
        self.show_remade(document, done);
        Ok(())
    }

    fn show_remade(&mut self, document: Document, DocumentRun { run, frames, others, machines }: DocumentRun) {
        self.playing &= run.waiting().is_none();
        self.edits = document.script.to_vec().into_iter().collect();
        (self.document, self.run, self.unedited) = (document, run, None);
        (self.frames, self.others, self.machines) = (frames, others, machines);
        self.cursor = self.cursor.min(self.frames.len() - 1);
    }
}
