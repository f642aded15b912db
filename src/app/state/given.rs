//! The open table of numbers: its assessment for the session, and applying results to the session.

use std::path::PathBuf;
use std::sync::Arc;

use super::AppState;
use super::beside::fault;
use crate::app::change::Change;
use crate::app::given::assess::{Assessed, Assessing, Given, Table, TableOptions, Taking};
use crate::app::{Activity, Below};
use crate::query::{Asked, Shared, State};
use crate::session::Edit;
use crate::study::advice::Advice;
use crate::study::trim::taken_by;

impl AppState {
    /// Opens a table and shows its assessment for the session on display.
    pub(super) fn take_up(&mut self, file: PathBuf, table: Table) {
        self.saving.uses(&file);
        let measured = Shared(Arc::new(self.session.scenario().machine.clone()));
        self.given = Some(Given { file, table: Shared(table.into()), options: TableOptions::default(), measured });
        self.view_state.below = Some(Below::Table);
        self.view_state.open.dialog = None;
    }

    /// Requests the assessment of the table on display for the session's machine. Does nothing during a drag.
    pub(super) fn refresh_given(&mut self) {
        if self.view_state.gesture.grabbed.is_some() {
            return;
        }
        let given = self.given.as_ref().filter(|_| self.view_state.below == Some(Below::Table));
        match given.and_then(|given| given.asked(self.session.scenario())) {
            None => self.queries().give_up::<Assessing>(),
            Some(asked) => drop(self.queries().ask_beside::<Assessing>(&asked)),
        }
    }

    /// Returns the assessment of the table, and whether it belongs to the present session.
    pub(super) fn assessed(&self) -> Option<(Arc<Result<Assessed, Advice>>, bool)> {
        let Asked { last, state } = self.queries().newest::<Assessing>()?;
        match state {
            State::Broken => Some((Arc::new(Err(fault("reading the table").into())), true)),
            State::Stopped if last.is_none() => Some((Arc::new(Err(Activity::Table.cancelled().into())), true)),
            _ => last.map(|last| (last, state == State::Known)),
        }
    }

    /// Applies a result of the assessment to the session.
    ///
    /// # Errors
    /// If there is no such result.
    pub(super) fn take_given(&mut self, taking: Taking) -> Result<(), String> {
        let found = self.assessed().filter(|(_, is_known)| *is_known).map(|(found, _)| found);
        let scenario = self.session.scenario();
        let edit = match found.as_deref() {
            Some(Ok(Assessed::Motion { imported, .. })) => imported.as_ref().as_ref().ok().and_then(|imported| {
                let chosen = match taking {
                    Taking::Proposal => imported.scenarios.as_ref().map(|[proposal, _]| proposal)?,
                    Taking::AsGiven => imported.as_given.as_ref()?,
                    Taking::Change | Taking::Measured => return None,
                };
                Some(Edit::of("task", chosen.task.whole()))
            }),
            Some(Ok(Assessed::Measured(trimmed))) => match (&trimmed.outcome, taking) {
                (Ok(trim), Taking::Change | Taking::Measured) => {
                    let measured = self.given.as_ref().map(|given| &*given.measured.0).ok_or("no table is open")?;
                    taken_by(scenario, measured, trim, taking == Taking::Change)?
                }
                _ => None,
            },
            _ => None,
        };
        let edit = edit.ok_or("the session has this already")?;
        self.change(Change::Edit(edit));
        Ok(())
    }
}
