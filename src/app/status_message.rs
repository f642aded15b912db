//! Messages of the window: the last message, and the last refused edit.

use std::sync::Arc;

use stillbase_picture::scene::options::RefusedCurve;
use stillbase_query::Shared;
use stillbase_session::scenario::Scenario;
use stillbase_session::{Edit, Proposal, Refusal};

/// Messages shown until the next command.
#[derive(Clone, Debug, Default)]
pub struct StatusMessage {
    /// The last message.
    pub message: Option<Message>,
    /// Whether the message concerns a branch that was left: a button then shows that branch.
    pub left_branch: bool,
    /// The last refused edit.
    pub refused: Option<RefusedEdit>,
}

impl StatusMessage {
    /// Returns the text of the last message if it reports a problem.
    pub fn problem(&self) -> Option<&String> {
        self.message.as_ref().filter(|message| message.is_problem).map(|message| &message.text)
    }
}

/// A message.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    /// Its text.
    pub text: String,
    /// Whether it reports a problem.
    pub is_problem: bool,
}

/// A refused edit.
#[derive(Clone, Debug)]
pub struct RefusedEdit {
    /// The requested curve, and the point from which it cannot be followed.
    pub curve: Option<Arc<RefusedCurve>>,
    /// The scenario with the edit, and the reason why it is refused; `None` if the edit is no change of settings.
    pub refused: Option<(Shared<Scenario>, Refusal)>,
    /// The edit.
    edit: Edit,
}

impl RefusedEdit {
    /// Returns the refusal of an edit of a scenario.
    pub(super) fn of(scenario: &Scenario, edit: &Edit, refusal: &Refusal) -> Self {
        let curve = RefusedCurve::of(refusal).map(Arc::new);
        let changed = match edit {
            Edit::Set { change } => scenario.without_edits().with_settings(change).ok(),
            _ => None,
        };
        let refused = changed.map(|changed| (Shared(Arc::new(changed)), refusal.clone()));
        Self { curve, refused, edit: edit.clone() }
    }

    /// Returns the edit with a proposal that makes it feasible.
    pub fn edit_with(&self, proposal: &Proposal) -> Edit {
        proposal.edit_after(&self.edit)
    }
}
