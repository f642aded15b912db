//! A task for a machine that is drawn anew: where a step of its drawing ends what its task asks for, one is made for it.

use std::sync::Arc;

use super::Session;
use crate::edit::Edit;
use crate::gentle_motion::{has_made_task, own_task};
use crate::scenario::Scenario;
use stillbase_mechanics::sketch::SketchStep;
use stillbase_query::ProgressCallback;

/// What the title of a step says that brought a task along.
const WITH_TASK: &str = ", with a task made for it";

impl Session {
    /// Returns whether the last change was a step of drawing that brought a task along.
    pub fn has_just_made_task(&self) -> bool {
        self.undo_title().is_some_and(|title| title.ends_with(WITH_TASK))
    }

    /// Gives the machine a task made for it, if a step of drawing has left it with one that it cannot do and that is no
    /// task of the user's. Both are one change. `before` is the scenario before the step.
    pub(super) fn give_own_task(&mut self, before: &Scenario, watch: ProgressCallback<'_>) {
        let waits = self.run.waiting().is_some() && self.run.unfinished().is_none();
        if !(waits && (self.is_drawn_anew() || has_made_task(before))) {
            return;
        }
        let Some(edit) = own_task(self.scenario()) else { return };
        let count = self.undo.len();
        // Refused or cancelled, the step stands alone, and the run waits as before.
        if self.amend(edit, watch).is_err() {
            return;
        }
        self.undo.truncate(count);
        if let Some(last) = self.undo.last_mut() {
            Arc::make_mut(last).title.push_str(WITH_TASK);
        }
    }

    /// Returns whether the machine was drawn from nothing, and the user has not set its task since.
    fn is_drawn_anew(&self) -> bool {
        let start = &self.document.scenario;
        let is_other = start.sketch.as_ref().is_some_and(|sketch| sketch.name != start.machine.name());
        let begins = |edit: &Edit| matches!(edit, Edit::Sketch(SketchStep::New { .. }));
        let edits = || self.edits.iter().map(|timed| &timed.edit);
        (is_other || edits().any(begins)) && !edits().any(|edit| edit.part("task").is_some())
    }
}
