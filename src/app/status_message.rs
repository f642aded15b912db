//! Messages of the window: the last message, and the last refused edit.

use std::sync::Arc;

use super::SessionCommand;
use super::widgets::RefusedEntry;
use stillbase_picture::scene::options::RefusedCurve;
use stillbase_query::Shared;
use stillbase_session::scenario::Scenario;
use stillbase_session::{Edit, Proposal, Refusal, RefusedChange};

/// Messages shown until the next command.
#[derive(Clone, Debug, Default)]
pub struct StatusMessage {
    /// The last message.
    pub message: Option<Message>,
    /// Whether the message concerns a branch that was left: a button then shows that branch.
    pub left_branch: bool,
    /// The last refused edit.
    pub refused: Option<RefusedEdit>,
    /// Proposals that solve the problem of the last message and are known without a search.
    pub(super) proposals: Vec<Proposal>,
    /// The typed entry that the last message refuses.
    pub(super) entry: Option<RefusedEntry>,
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
    /// What is refused, for the search for proposals; `None` if the edit changes neither settings nor the start.
    pub refused: Option<RefusedChange>,
    /// What was to be done.
    attempt: Attempt,
}

/// What was to be done.
#[derive(Clone, Debug)]
enum Attempt {
    /// An edit of the session.
    Edit(Edit),
    /// Opening a scenario.
    Open(Box<Scenario>),
}

impl RefusedEdit {
    /// Returns the refusal of an edit of a scenario.
    pub(super) fn of(scenario: &Scenario, edit: &Edit, refusal: &Refusal) -> Self {
        let curve = RefusedCurve::of(refusal).map(Arc::new);
        Self { curve, refused: RefusedChange::of_edit(scenario, edit, refusal), attempt: Attempt::Edit(edit.clone()) }
    }

    /// Returns the refusal to open a scenario.
    pub(super) fn of_opening(scenario: &Scenario, refusal: &Refusal) -> Self {
        Self {
            curve: None,
            refused: Some(RefusedChange::of(Shared(Arc::new(scenario.clone())), refusal.clone())),
            attempt: Attempt::Open(Box::new(scenario.clone())),
        }
    }

    /// Returns the commands that do what was refused, with a proposal that makes it feasible; none if the proposal
    /// cannot be combined with it.
    pub fn commands_with(&self, proposal: &Proposal) -> Vec<SessionCommand> {
        match &self.attempt {
            Attempt::Edit(edit) => proposal.edits_after(edit).into_iter().map(SessionCommand::Edit).collect(),
            Attempt::Open(scenario) => {
                let changed = proposal.change().and_then(|change| scenario.with_settings(change).ok());
                changed.map(|changed| SessionCommand::Open(Box::new(changed))).into_iter().collect()
            }
        }
    }
}
