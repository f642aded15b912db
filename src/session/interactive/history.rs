//! Undo and redo of a session.

use std::sync::Arc;

use super::Session;
use super::change::HistoryStep;
use crate::document::Document;
use crate::edit::{Edit, TimedEdit};
use crate::refusal::Refusal;
use crate::scenario::Scenario;
use stillbase_query::ProgressCallback;

impl Session {
    /// Adds an undo entry for an edit; edits of one gesture share one entry.
    pub(super) fn remember(&mut self, before: Document, timed: TimedEdit, inverse: Option<Edit>) {
        self.redo.clear();
        let joins = self.gesture
            && self.undo.last().is_some_and(|c| c.edit.as_ref().is_some_and(|e| e.edit.is_replaced_by(&timed.edit)));
        match self.undo.last_mut() {
            Some(last) if joins => {
                let last = Arc::make_mut(last);
                last.title = timed.edit.title_after(last.inverse.as_ref());
                last.edit = Some(timed);
            }
            _ => {
                let title = timed.edit.title_after(inverse.as_ref());
                self.undo.push(Arc::new(HistoryStep { before, edit: Some(timed), inverse, title, annotation: None }));
            }
        }
        self.gesture = true;
    }

    /// Ends a gesture: the next edit gets a separate undo entry.
    pub fn end_gesture(&mut self) {
        self.gesture = false;
        self.gesture_now = None;
        self.unedited = None;
    }

    /// Returns whether the last change belongs to a gesture in progress.
    pub fn is_in_gesture(&self) -> bool {
        self.gesture
    }

    /// Returns the number of changes that can be undone.
    pub fn undo_count(&self) -> usize {
        self.undo.len()
    }

    /// Returns the title of the change that undo would take back.
    pub fn undo_title(&self) -> Option<&str> {
        self.undo.last().map(|c| c.title.as_str())
    }

    /// Returns the title of the change that redo would bring back.
    pub fn redo_title(&self) -> Option<&str> {
        self.redo.last().map(|c| c.title.as_str())
    }

    /// Returns the titles of all changes: those that can be undone, the oldest first, then those that can be redone.
    pub fn history(&self) -> impl Iterator<Item = &str> {
        self.undo.iter().chain(self.redo.iter().rev()).map(|change| change.title.as_str())
    }

    /// Undoes the last change: in motion by the inverse edit at the present step, paused or at rest by restoring the
    /// document before the change.
    ///
    /// # Errors
    /// If that document cannot be restored; then nothing has changed.
    pub fn undo(&mut self) -> Result<(), Refusal> {
        self.undo_while(&mut |_| true)
    }

    /// Does the same as [`undo`](Self::undo), unless `watch` cancels it.
    ///
    /// # Errors
    /// As [`undo`](Self::undo), and if `watch` cancels it.
    pub fn undo_while(&mut self, watch: ProgressCallback<'_>) -> Result<(), Refusal> {
        self.end_gesture();
        let Some(change) = self.undo.last().cloned() else { return Ok(()) };
        let after = self.document.clone();
        self.go_to(&change, change.inverse.as_ref(), watch)?;
        self.undo.pop();
        self.redo.push(Arc::new(HistoryStep { before: after, ..HistoryStep::clone(&change) }));
        Ok(())
    }

    /// Goes to the document of an undo or redo entry: in motion by applying `edit`, paused or at rest by restoring the
    /// document.
    fn go_to(&mut self, change: &HistoryStep, edit: Option<&Edit>, watch: ProgressCallback<'_>) -> Result<(), Refusal> {
        match (edit, change.annotation) {
            (_, Some(kept)) => {
                self.document.keep_as(&change.before, kept);
                Ok(())
            }
            (_, None) if change.affects_no_frame() && self.go_aside(&change.before) => Ok(()),
            (Some(edit), None) if self.is_running() && !change.plans() => {
                self.append(edit.clone(), watch).or_else(|why| self.restore_unless_stopped(why, &change.before, watch))
            }
            _ => self.return_to(&change.before, watch),
        }
    }

    /// Redoes the change that was undone last.
    ///
    /// # Errors
    /// If it cannot apply; then nothing has changed.
    pub fn redo(&mut self) -> Result<(), Refusal> {
        self.redo_while(&mut |_| true)
    }

    /// Does the same as [`redo`](Self::redo), unless `watch` cancels it.
    ///
    /// # Errors
    /// As [`redo`](Self::redo), and if `watch` cancels it.
    pub fn redo_while(&mut self, watch: ProgressCallback<'_>) -> Result<(), Refusal> {
        self.end_gesture();
        let Some(change) = self.redo.last().cloned() else { return Ok(()) };
        let before = self.document.clone();
        self.go_to(&change, change.edit.as_ref().map(|timed| &timed.edit), watch)?;
        self.redo.pop();
        self.undo.push(Arc::new(HistoryStep { before, ..HistoryStep::clone(&change) }));
        Ok(())
    }

    /// Returns a document of the history with the present end, and the scenario of its run, if the present frames are
    /// also valid for it.
    fn aside(&self, before: &Document) -> Option<(Document, Scenario)> {
        let document = Document { end: self.document.end, ..before.clone() };
        let scenario = document.aside_of(&self.document)?;
        Some((document, scenario))
    }

    /// Goes to a document of the history without running it again. Returns whether this was possible.
    fn go_aside(&mut self, before: &Document) -> bool {
        let Some((document, scenario)) = self.aside(before) else { return false };
        if self.run.set_asides(&scenario).is_err() {
            return false;
        }
        self.unedited = None;
        self.edits = document.script.to_vec().into_iter().collect();
        self.document = document;
        true
    }

    /// Restores a document after an edit that could not apply for the reason `why`, unless `watch` has cancelled the
    /// edit.
    fn restore_unless_stopped(
        &mut self,
        why: Refusal,
        document: &Document,
        watch: ProgressCallback<'_>,
    ) -> Result<(), Refusal> {
        if why == Refusal::Stopped { Err(why) } else { self.return_to(document, watch) }
    }

    /// Restores a document and pauses.
    fn return_to(&mut self, document: &Document, watch: ProgressCallback<'_>) -> Result<(), Refusal> {
        self.restore(document.clone(), true, watch)?;
        self.playing = false;
        if self.is_dragged() {
            self.cursor = self.frames.len() - 1;
        }
        Ok(())
    }

    /// Replaces the session by that of another scenario; undo restores the present one.
    ///
    /// # Errors
    /// If the scenario cannot start; then nothing has changed.
    pub fn switch(&mut self, scenario: Scenario) -> Result<(), Refusal> {
        self.take_over(Self::open(scenario)?);
        Ok(())
    }

    /// Replaces the session by another one that has just been opened; undo restores the present one.
    pub fn take_over(&mut self, next: Self) {
        let title = format!("open {}", next.document.scenario.title);
        self.take_over_as(next, title);
    }

    /// Does the same as [`take_over`](Self::take_over) under a title of its own in the history.
    pub fn take_over_as(&mut self, mut next: Self, title: String) {
        next.undo = std::mem::take(&mut self.undo);
        next.branch_events.0 = self.branch_events.0;
        next.undo.push(Arc::new(HistoryStep {
            before: self.document.clone(),
            edit: None,
            inverse: None,
            title,
            annotation: None,
        }));
        *self = next;
    }
}

impl Session {
    /// Returns the limits of a relative angle before the last change of them, as a file states them; `None` if they
    /// have not been changed.
    pub(crate) fn limits_before(&self, angle: &str) -> Option<toml::Value> {
        let of = |step: &Arc<HistoryStep>| {
            let edit = &step.edit.as_ref()?.edit;
            edit.part("limits")?.get(angle)?;
            step.inverse.as_ref()?.part("limits")?.get(angle).cloned()
        };
        self.undo.iter().rev().find_map(of)
    }
}
