//! What the window says: the last message, and what was refused.

use std::sync::Arc;

use crate::picture::scene::options::Refused;
use crate::planning::reactionless::Decimal;
use crate::session::{Edit, Refusal};

/// What is said until the next command.
#[derive(Clone, Debug, Default)]
pub struct Said {
    /// The last thing to say, and whether it is bad news.
    pub message: Option<(String, bool)>,
    /// The message is of a branch that was left: a button leads back to it.
    pub left_branch: bool,
    /// What was asked for last and refused.
    pub refused: Option<RefusedEdit>,
}

/// An edit that was refused.
#[derive(Clone, Debug)]
pub struct RefusedEdit {
    /// The curve that was asked for, and where it stops.
    pub curve: Option<Arc<Refused>>,
    /// The same with another b, rad, that would do, as it is shown.
    pub remedy: Option<(Edit, Decimal)>,
}

impl RefusedEdit {
    pub(super) fn of(edit: &Edit, refusal: &Refusal) -> Self {
        let curve = Refused::of(refusal);
        let remedy = edit.part("task").zip(refusal.mending_b().zip(refusal.shown_b())).map(|(change, (b, shown))| {
            let mut change = change.clone();
            change.insert("b".into(), b.into());
            (Edit::of("task", change), shown)
        });
        Self { curve: curve.map(Arc::new), remedy }
    }
}
