//! The open table of numbers: its assessment for the session, and the application of its results to the session.

use std::path::PathBuf;
use std::sync::Arc;

use super::AppState;
use super::background::fault;
use crate::change::SessionChange;
use crate::given::assess::{AssessmentQuery, OpenedTable, TableAction, TableAssessment, TableOptions};
use crate::{Activity, BottomPanel};
use stillbase_files::table::Table;
use stillbase_query::{QueryResult, QueryStatus, Shared};
use stillbase_session::Edit;
use stillbase_study::advice::Advice;
use stillbase_study::trim::adopting_edit;

impl AppState {
    /// Opens a table and shows its assessment for the session on display.
    pub(super) fn take_up(&mut self, file: PathBuf, table: Table) {
        self.saving.uses(&file);
        let measured = Shared(Arc::new(self.session.scenario().machine.clone()));
        self.opened_table = Some(OpenedTable {
            file,
            table: Shared(table.into()),
            more: Vec::new(),
            options: TableOptions::default(),
            measured,
        });
        self.view_state.below = Some(BottomPanel::Table);
        self.view_state.open.dialog = None;
    }

    /// Adds a table to the one that is open, with further motions of the same measurement.
    pub(super) fn add_table(&mut self, file: PathBuf, table: Table) {
        self.saving.uses(&file);
        if let Some(given) = &mut self.opened_table {
            given.more.push((file, Shared(table.into())));
        }
        self.view_state.open.dialog = None;
    }

    /// Requests the assessment of the table on display for the session's machine. Does nothing during a drag.
    pub(super) fn refresh_given(&mut self) {
        if self.view_state.gesture.grabbed.is_some() {
            return;
        }
        let given = self.opened_table.as_ref().filter(|_| self.view_state.below == Some(BottomPanel::Table));
        match given.and_then(|given| given.request(self.session.scenario())) {
            None => self.queries().give_up::<AssessmentQuery>(),
            Some(asked) => drop(self.queries().ask_in_background::<AssessmentQuery>(&asked)),
        }
    }

    /// Returns the assessment of the table, and whether it belongs to the present session.
    pub(super) fn assessed(&self) -> Option<(Arc<Result<TableAssessment, Advice>>, bool)> {
        let QueryResult { last, state } = self.queries().newest::<AssessmentQuery>()?;
        match state {
            QueryStatus::Broken => Some((Arc::new(Err(fault("reading the table").into())), true)),
            QueryStatus::Stopped if last.is_none() => Some((Arc::new(Err(Activity::Table.cancelled().into())), true)),
            _ => last.map(|last| (last, state == QueryStatus::Known)),
        }
    }

    /// Applies a result of the assessment to the session.
    ///
    /// # Errors
    /// If there is no such result, or if it does not change the session.
    pub(super) fn take_given(&mut self, taking: TableAction) -> Result<(), String> {
        let found = self.assessed().filter(|(_, is_known)| *is_known).map(|(found, _)| found);
        let scenario = self.session.scenario();
        let edit = match found.as_deref() {
            Some(Ok(TableAssessment::Motion { imported, .. })) => {
                imported.as_ref().as_ref().ok().and_then(|imported| {
                    let chosen = match taking {
                        TableAction::Proposal => imported.scenarios.as_ref().map(|[proposal, _]| proposal)?,
                        TableAction::AsGiven => imported.as_given.as_ref()?,
                        TableAction::Change | TableAction::Measured => return None,
                    };
                    Some(Edit::of("task", chosen.task.whole()))
                })
            }
            Some(Ok(TableAssessment::Measured(trimmed))) => match (&trimmed.outcome, taking) {
                (Ok(trim), TableAction::Change | TableAction::Measured) => {
                    let measured =
                        self.opened_table.as_ref().map(|given| &*given.measured.0).ok_or("no table is open")?;
                    adopting_edit(scenario, measured, trim, taking == TableAction::Change)?
                }
                _ => None,
            },
            _ => None,
        };
        let edit = edit.ok_or("the session has this already")?;
        self.change(SessionChange::Edit(edit));
        Ok(())
    }
}
