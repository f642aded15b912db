//! [`Change`]: one step of history.

use crate::session::document::{Document, Kept};
use crate::session::edit::{Edit, TimedEdit};

/// One step of history.
#[derive(Clone, Debug)]
pub(super) struct Change {
    /// What it was made to.
    pub before: Document,
    /// What was done; none where another scenario was opened.
    pub edit: Option<TimedEdit>,
    /// What takes it back while the machine moves.
    pub inverse: Option<Edit>,
    /// In words.
    pub title: String,
    /// Only this of what is kept beside the run has changed.
    pub beside: Option<Kept>,
}

impl Change {
    /// Whether it changes the task or the base: the motion is then planned anew, so it can stand only before the first
    /// step.
    pub fn plans(&self) -> bool {
        self.edit.as_ref().is_some_and(|e| e.edit.sets_path() || e.edit.sets(&["base"]))
    }

    /// Whether no frame depends on what it has changed.
    pub fn is_aside(&self) -> bool {
        self.edit.as_ref().is_some_and(|e| e.edit.is_aside())
    }
}
