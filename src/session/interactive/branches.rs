//! Branches of a session: how it went on before somebody went back and did something else. Each is a script over the
//! same scenario, made again when it is asked for.

use std::sync::Arc;

use super::Session;
use super::change::Change;
use crate::query::{Same, Whole};
use crate::session::Refusal;
use crate::session::changes::in_order;
use crate::session::document::{Document, Kept, Left, Watch};
use crate::session::fork::{Fork, Forks};
use crate::session::scenario::{Bookmark, Branch, MAX_BRANCHES, MAX_FRAMES, Scenario};

impl Session {
    /// How many branches are kept.
    pub fn branch_count(&self) -> usize {
        self.document.branches.len()
    }

    /// How many were left so far, and the title of the one that went because the last was one too many.
    pub fn partings(&self) -> (u64, Option<&str>) {
        (self.partings.0, self.partings.1.as_deref())
    }

    /// What tells each of them from the run on display, the oldest first; no two have the same title.
    pub fn forks(&self) -> Arc<Vec<Fork>> {
        let branches = &self.document.branches;
        // How far the run goes beyond all of them tells nothing.
        let end = self.document.end.min(branches.iter().map(|left| left.end).max().unwrap_or(0));
        self.run.queries().ask::<Whole<Forks>>(&(Same(branches.clone()), self.edits.clone(), end))
    }

    fn fork(&self, left: &Left) -> Fork {
        left.beside(&self.edits, self.document.end)
    }

    /// The run on display, to be found again.
    fn as_left(&self) -> Left {
        let last = (self.length() / self.scenario().step).round() as u64;
        let end = if self.frames.last().is_some_and(|frame| frame.is_finite()) { last } else { 0 };
        let (script, step) = (self.document.script.clone(), self.scenario().step);
        Left { script, end: end.min(MAX_FRAMES as u64 - 1).max(self.document.end), step }
    }

    /// The branches with the run as it goes on after the instant on display, and the partings then.
    pub(super) fn with_left(&self) -> (Arc<Vec<Left>>, (u64, Option<String>)) {
        let left = self.as_left();
        let mut all = self.document.branches.to_vec();
        let mut partings = (self.partings.0, None);
        match all.iter_mut().find(|known| known.script.is(&left.script)) {
            Some(known) => known.end = known.end.max(left.end),
            None => {
                all.push(left);
                partings.0 += 1;
            }
        }
        if all.len() > MAX_BRANCHES {
            partings.1 = Some(self.fork(&all.remove(0)).title);
        }
        (Arc::new(all), partings)
    }

    /// Shows a branch; the run on display becomes one in its place.
    ///
    /// # Errors
    /// If it cannot be made again, or is not wanted any more; then nothing has changed.
    pub fn switch_branch_while(&mut self, branch: usize, watch: Watch<'_>) -> Result<(), Refusal> {
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
        self.undo.push(Arc::new(Change { before, edit: None, inverse: None, title, beside: None }));
        Ok(())
    }

    /// Lets go of a branch; what became of it.
    pub fn drop_branch(&mut self, branch: usize) -> Option<String> {
        let title = format!("remove branch: {}", self.fork(self.document.branches.get(branch)?).title);
        self.change_beside(title.clone(), Kept::Branches, |document| {
            Arc::make_mut(&mut document.branches).remove(branch);
        });
        Some(title)
    }

    /// A branch as a scenario of its own.
    pub fn branch(&self, branch: usize) -> Option<Scenario> {
        let left = self.document.branches.get(branch)?;
        let mut scenario = Scenario::clone(&self.document.scenario);
        scenario.edits = left.script.to_vec();
        scenario.duration = Some(left.end as f64 * left.step);
        Some(scenario)
    }

    /// As they are saved.
    pub(super) fn kept_branches(&self) -> Vec<Branch> {
        let saved = |left: &Left| Branch { duration: left.end as f64 * left.step, edits: left.script.to_vec() };
        self.document.branches.iter().map(saved).collect()
    }

    /// Takes over what was saved beside a run.
    pub(super) fn keep_beside(&mut self, mut bookmarks: Vec<Bookmark>, branches: &[Branch]) {
        bookmarks.sort_by(|a, b| a.time.total_cmp(&b.time));
        let left = |branch: &Branch| {
            let mut script = self.document.script.replaced(in_order(&branch.edits));
            let own = script.in_order().into_iter().rev().find_map(|timed| timed.edit.own_number("step"));
            let step = own.unwrap_or(self.document.scenario.step);
            let last = script.last().map_or(0, |timed| timed.step);
            let end = ((branch.duration / step).round() as u64).max(last).min(MAX_FRAMES as u64 - 1);
            script.cut(end);
            Left { script, end, step }
        };
        let branches = branches.iter().map(left).collect();
        (self.document.bookmarks, self.document.branches) = (Arc::new(bookmarks), Arc::new(branches));
    }
}
