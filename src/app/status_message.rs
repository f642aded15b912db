//! Messages of the window: the last message, and the last refused edit.

use std::sync::Arc;

use stillbase_picture::scene::options::RefusedCurve;
use stillbase_planning::reactionless::Decimal;
use stillbase_session::{Edit, Refusal};

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
    /// The edit with a feasible b, rad, and this b as displayed.
    pub remedy: Option<(Edit, Decimal)>,
}

impl RefusedEdit {
    pub(super) fn of(edit: &Edit, refusal: &Refusal) -> Self {
        let curve = RefusedCurve::of(refusal);
        let remedy =
            edit.part("task").zip(refusal.feasible_b().zip(refusal.displayed_b())).map(|(change, (b, shown))| {
                let mut change = change.clone();
                change.insert("b".into(), b.into());
                (Edit::of("task", change), shown)
            });
        Self { curve: curve.map(Arc::new), remedy }
    }
}
