//! [`HistoryStep`]: an undo entry.

use crate::document::{AnnotationKind, Document};
use crate::edit::{Edit, TimedEdit};

/// Undo entry.
#[derive(Clone, Debug)]
pub(super) struct HistoryStep {
    /// Document before the change; for an entry of redo, after it.
    pub before: Document,
    /// The edit, if the change is one.
    pub edit: Option<TimedEdit>,
    /// Edit that undoes the change while the machine moves.
    pub inverse: Option<Edit>,
    /// Description of the change.
    pub title: String,
    /// Set if only bookmarks, only notes or only branches have changed.
    pub annotation: Option<AnnotationKind>,
}

impl HistoryStep {
    /// Returns whether the change affects path or base: the motion is then planned anew, so the edit is allowed only
    /// before the first step.
    pub fn plans(&self) -> bool {
        self.edit.as_ref().is_some_and(|e| e.edit.sets_path() || e.edit.sets(&["base"]))
    }

    /// Returns whether no frame depends on the change.
    pub fn affects_no_frame(&self) -> bool {
        self.edit.as_ref().is_some_and(|e| e.edit.affects_no_frame())
    }
}
