//! Branches of a session: courses of the run that were replaced when the user went back in time and edited. Each is a
//! script for the same scenario, and is run again when it is shown.

use std::sync::Arc;

use super::Session;
use super::change::HistoryStep;
use crate::Refusal;
use crate::changes::in_order;
use crate::document::{AnnotationKind, Document, LeftBranch, ProgressCallback};
use crate::fork::{Fork, Forks};
use crate::scenario::{Bookmark, Branch, MAX_BRANCHES, MAX_FRAMES, Note, Scenario};
use stillbase_query::{ByIdentity, QuickWork};

impl Session {
    /// Returns the number of branches that are kept.
    pub fn branch_count(&self) -> usize {
        self.document.branches.len()
    }

    /// Returns the number of branches made so far, and the title of the branch that the last of them has displaced.
    pub fn branch_events(&self) -> (u64, Option<&str>) {
        (self.branch_events.0, self.branch_events.1.as_deref())
    }

    /// Returns the difference of each branch from the run on display, the oldest first; no two have the same title.
    pub fn forks(&self) -> Arc<Vec<Fork>> {
        let branches = &self.document.branches;
        // Differences do not depend on how far the run goes beyond the longest branch.
        let end = self.end_of_motion().min(branches.iter().map(|left| left.end).max().unwrap_or(0));
        self.run.queries().ask::<QuickWork<Forks>>(&(ByIdentity(branches.clone()), self.edits.clone(), end))
    }

    fn fork(&self, left: &LeftBranch) -> Fork {
        left.difference_from(&self.edits, self.end_of_motion())
    }

    /// Returns the step at which the motion of the run on display ends, whether or not it has come that far.
    fn end_of_motion(&self) -> u64 {
        let last = (self.length() / self.scenario().step).round() as u64;
        let end = if self.frames.last().is_some_and(|frame| frame.is_finite()) { last } else { 0 };
        end.min(MAX_FRAMES as u64 - 1).max(self.document.end)
    }

    /// Returns the run on display as a branch.
    fn as_left(&self) -> LeftBranch {
        let (script, step) = (self.document.script.clone(), self.scenario().step);
        LeftBranch { script, end: self.end_of_motion(), step }
    }

    /// Returns the branches with the present run added, and the new value of `branch_events`.
    pub(super) fn with_left(&self) -> (Arc<Vec<LeftBranch>>, (u64, Option<String>)) {
        let left = self.as_left();
        let mut all = self.document.branches.to_vec();
        let mut branch_events = (self.branch_events.0, None);
        match all.iter_mut().find(|known| known.script.is(&left.script)) {
            Some(known) => known.end = known.end.max(left.end),
            None => {
                all.push(left);
                branch_events.0 += 1;
            }
        }
        if all.len() > MAX_BRANCHES {
            branch_events.1 = Some(self.fork(&all.remove(0)).title);
        }
        (Arc::new(all), branch_events)
    }

    /// Shows a branch; the run on display takes its place among the branches.
    ///
    /// # Errors
    /// If the branch cannot be run again, or `watch` cancels it; then nothing has changed.
    pub fn switch_branch_while(&mut self, branch: usize, watch: ProgressCallback<'_>) -> Result<(), Refusal> {
        self.end_gesture();
        let Some(next) = self.document.branches.get(branch) else { return Ok(()) };
        let title = format!("branch: {}", self.fork(next).title);
        let before = self.document.clone();
        let mut branches = before.branches.to_vec();
        branches[branch] = self.as_left();
        let (script, end) = (next.script.clone(), next.end);
        self.restore(Document { script, end, branches: Arc::new(branches), ..before.clone() }, true, watch)?;
        self.playing = false;
        self.redo.clear();
        self.undo.push(Arc::new(HistoryStep { before, edit: None, inverse: None, title, annotation: None }));
        Ok(())
    }

    /// Removes a branch. Returns a description of the change, if there is such a branch.
    pub fn drop_branch(&mut self, branch: usize) -> Option<String> {
        let title = format!("remove branch: {}", self.fork(self.document.branches.get(branch)?).title);
        self.change_beside(title.clone(), AnnotationKind::Branches, |document| {
            Arc::make_mut(&mut document.branches).remove(branch);
        });
        Some(title)
    }

    /// Returns a branch as a separate scenario.
    pub fn branch(&self, branch: usize) -> Option<Scenario> {
        let left = self.document.branches.get(branch)?;
        let mut scenario = Scenario::clone(&self.document.scenario);
        scenario.edits = left.script.to_vec();
        scenario.duration = Some(left.end as f64 * left.step);
        Some(scenario)
    }

    /// Returns the branches as they are saved.
    pub(super) fn kept_branches(&self) -> Vec<Branch> {
        let saved = |left: &LeftBranch| Branch { duration: left.end as f64 * left.step, edits: left.script.to_vec() };
        self.document.branches.iter().map(saved).collect()
    }

    /// Adopts saved bookmarks, notes and branches.
    pub(super) fn keep_beside(&mut self, mut bookmarks: Vec<Bookmark>, notes: Vec<Note>, branches: &[Branch]) {
        bookmarks.sort_by(|a, b| a.time.total_cmp(&b.time));
        let left = |branch: &Branch| {
            let mut script = self.document.script.replaced(in_order(&branch.edits));
            let own = script.in_order().into_iter().rev().find_map(|timed| timed.edit.own_number("step"));
            let step = own.unwrap_or(self.document.scenario.step);
            let last = script.last().map_or(0, |timed| timed.step);
            let end = ((branch.duration / step).round() as u64).max(last).min(MAX_FRAMES as u64 - 1);
            script.truncate(end);
            LeftBranch { script, end, step }
        };
        let branches = branches.iter().map(left).collect();
        (self.document.bookmarks, self.document.branches) = (Arc::new(bookmarks), Arc::new(branches));
        self.document.notes = Arc::new(notes);
    }
}
