//! Changes of the session made in the background, and their consequences.

use super::AppState;
use crate::background::SessionResult;
use crate::change::SessionChange;
use crate::status::news::News;
use crate::{Activity, RefusedEdit};
use stillbase_query::Ticket;
use stillbase_session::scenario::MAX_BRANCHES;
use stillbase_session::{Edit, Refusal};

impl AppState {
    /// Changes a copy of the session in the background, and shows the copy once the change is finished. The copy
    /// shares the frames of the session. Most changes are finished by the next repaint.
    pub(super) fn change(&mut self, change: SessionChange) {
        let mut next = self.session.clone();
        self.background.change = Some((change.clone(), 0));
        let work = move |ticket: &Ticket| {
            let done = change.make(&mut next, &mut |done| ticket.goes_on(done));
            (next, done)
        };
        self.background.run(Activity::Change, work, Self::take_change);
        self.finish();
    }

    fn take_change(&mut self, made: Option<SessionResult>) {
        let Some((change, _)) = self.background.change.take() else { return };
        match made {
            Some((next, done)) => {
                if done.is_ok() {
                    let old = std::mem::replace(&mut self.session, next);
                    self.note_left_branch(&change, old.branch_events().0, old.frame().time, old.is_dragged());
                    self.background.free(old, &self.session);
                }
                self.changed(&change, done);
            }
            None => self
                .show_outcome(Err("the change broke off: this is a fault of the program; nothing has changed".into())),
        }
    }

    /// Stores the message about an edit that has left a branch. The other arguments describe the earlier state:
    /// number of branches left so far, time on display, s, and whether the machine was dragged.
    pub(super) fn note_left_branch(
        &mut self,
        change: &SessionChange,
        branch_events: u64,
        shown: f64,
        was_dragged: bool,
    ) {
        let (now, gone) = self.session.branch_events();
        if !matches!(change, SessionChange::Edit(_)) || now == branch_events {
            return;
        }
        let kept = match was_dragged && !self.session.is_dragged() {
            true => "what you led by hand is kept as a branch".into(),
            false => format!("what came after {shown:.3} s is kept as a branch"),
        };
        self.branch_message = Some(match gone {
            Some(gone) => format!("{kept} (H); the oldest of {MAX_BRANCHES} is gone: {gone}"),
            None => format!("{kept} (H)"),
        });
    }

    /// Updates the state after a change of the session or its refusal.
    pub(super) fn changed(&mut self, change: &SessionChange, done: Result<Option<String>, Refusal>) {
        if matches!(change, SessionChange::Edit(_)) {
            // What the run waits for is told again after each edit, with its remedies.
            self.view_state.put_away.retain(|problem| !News::is_wait(problem));
        }
        if let (SessionChange::Edit(edit), Err(refusal)) = (change, &done) {
            self.view_state.status.refused = Some(RefusedEdit::of(self.session.scenario(), edit, refusal));
        }
        if done.is_ok() {
            self.saving.changes += u64::from(!matches!(change, SessionChange::Seek(_)));
            match change {
                // A push sends many edits a second, too many to simulate the run ahead after each.
                SessionChange::Edit(Edit::Push { .. }) => self.view_state.status.refused = None,
                SessionChange::Edit(edit) if edit.affects_no_frame() => self.view_state.status.refused = None,
                SessionChange::Edit(_) => {
                    self.view_state.status.refused = None;
                    self.run_ahead();
                }
                SessionChange::Undo
                | SessionChange::Redo
                | SessionChange::GoTo(_)
                | SessionChange::Branch(_)
                | SessionChange::BackToPath => self.run_ahead(),
                SessionChange::Seek(_) => {}
            }
        }
        self.show_outcome(done.map_err(|refusal| refusal.to_string()));
        self.refresh();
    }
}
