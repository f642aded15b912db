//! Background work for the display: outlines, the run ahead, studies, runs side by side.

use std::sync::Arc;

use super::AppState;
use crate::background::{Background, Opening};
use crate::change::SessionSource;
use crate::saved_runs::{AddedRun, SavedRun, SavedRuns};
use crate::{Activity, BottomPanel, ComparisonCommand};
use stillbase_picture::scene::beside::{Beside, BesideQuery};
use stillbase_picture::scene::stage::OutlineQuery;
use stillbase_query::{ByIdentity, QueryResult, QueryStatus, Shared, Ticket};
use stillbase_session::scenario::Scenario;
use stillbase_session::{Proposal, ProposalsQuery, RefusedChange, RunAhead, is_improvable};
use stillbase_study::comparison::{AlternativeRuns, ComparedRun, Comparison};
use stillbase_study::tolerance::{StudiedRun, Study, StudyQuery};

/// Maximum number of planned steps of a run that is simulated ahead to find the motion of its base.
const MAX_STEPS_AHEAD: f64 = 100_000.0;

impl AppState {
    /// Runs the follow-up of all finished background work; returns whether there was any.
    pub(super) fn finish(&mut self) -> bool {
        let mut any = false;
        while let Some(then) = self.background.ended() {
            then(self);
            any = true;
        }
        any
    }

    /// Takes over the results of all finished background work; returns whether any follow-up ran.
    pub(super) fn collect(&mut self) -> bool {
        let any = self.finish();
        if let (Some(comparison), Some(ways)) =
            (&mut self.comparison, self.background.queries.newest::<AlternativeRuns>())
            && let Some(ways) = ways.known()
        {
            comparison.follow(ways);
        }
        any
    }

    /// Requests the outline of the workspace in the background if it is still missing; returns whether it has just
    /// arrived.
    pub(super) fn outline(&mut self) -> bool {
        let Some(subject) = self.views.unoutlined() else {
            // The outline is not needed any more.
            self.queries().give_up::<OutlineQuery>();
            return false;
        };
        if self.queries().ask_in_background::<OutlineQuery>(&subject).known().is_none() {
            return false;
        }
        self.refresh_views();
        true
    }

    /// Computes the outline of the workspace now if it is still missing: for a picture, which shows it.
    pub(crate) fn await_outline(&mut self) {
        if let Some(subject) = self.views.unoutlined() {
            let _ = self.queries().ask::<OutlineQuery>(&subject);
            self.refresh_views();
        }
    }

    /// Simulates the planned motion to its end in the background, to find how far the base will move.
    pub(super) fn run_ahead(&mut self) {
        let run = self.session.run();
        if run.scenario().base.moves() && !self.session.is_dragged() && run.planned_steps() <= MAX_STEPS_AHEAD {
            let _ = self.queries().ask_in_background::<RunAhead>(&ByIdentity(Arc::new(run.clone())));
        } else {
            self.queries().forget::<RunAhead>();
        }
    }

    /// Requests the study of tolerances for the run on display, if its panel is open; a newer request replaces an
    /// older one.
    pub(super) fn refresh_study(&mut self) {
        if self.view_state.below != Some(BottomPanel::Tolerances) {
            self.queries().forget::<StudyQuery>();
        } else if self.view_state.gesture.grabbed.is_none() {
            let _ = self.queries().ask_in_background::<StudyQuery>(&StudiedRun(Arc::new(self.session.run().clone())));
        }
    }

    /// Returns what is refused, with the reason: the last edit, or the task of a run that waits.
    fn refused(&self) -> Option<RefusedChange> {
        let refused = self.view_state.status.refused.as_ref().and_then(|refused| refused.refused.clone());
        let run = self.session.run();
        // No other setting finishes a drawing.
        let waits = run.waiting().filter(|_| run.unfinished().is_none());
        let waiting = || Some(RefusedChange::of(run.shared_scenario(), waits?.why.clone()));
        refused.or_else(waiting)
    }

    /// Requests proposals that make the refused edit or task possible; a newer request replaces an older one.
    pub(super) fn refresh_proposals(&mut self) {
        match self.refused() {
            None => self.queries().forget::<ProposalsQuery>(),
            Some(_) if self.view_state.gesture.grabbed.is_some() => {}
            Some(refused) => drop(self.queries().ask_in_background::<ProposalsQuery>(&refused)),
        }
    }

    /// Returns the proposals that make the refused edit or task possible, once they are known.
    pub(super) fn proposals(&self) -> Option<Arc<Vec<Proposal>>> {
        self.queries().known::<ProposalsQuery>(&self.refused()?)
    }

    /// Requests proposals that improve the plan on display; returns them once they are known. While something is
    /// refused, there are none.
    pub(super) fn improvements(&self) -> Option<Arc<Vec<Proposal>>> {
        let run = self.session.run();
        let asks = self.refused().is_none() && run.unfinished().is_none() && is_improvable(run);
        let input = asks.then(|| RefusedChange::to_improve(run.shared_scenario()))?;
        self.queries().ask_in_background::<ProposalsQuery>(&input).known().cloned()
    }

    /// Returns the study of tolerances, or the reason why there is none.
    pub(super) fn study(&self) -> Option<Arc<Result<Study, String>>> {
        let QueryResult { last, state } = self.queries().newest::<StudyQuery>()?;
        match state {
            QueryStatus::Broken => Some(Arc::new(Err(fault("the study")))),
            // A stopped study is not started again until something changes.
            QueryStatus::Stopped if last.is_none() => {
                Some(Arc::new(Err("cancelled: any change samples the machines again".into())))
            }
            _ => last,
        }
    }

    /// Requests runs of the task on display in several ways, if the table of runs shows another task. During a drag,
    /// only a new table requests them. While its panel is closed, there is no table.
    pub(super) fn refresh_comparison(&mut self) {
        if self.view_state.below != Some(BottomPanel::Runs) {
            self.runs = SavedRuns::all(self.comparison.take().as_ref(), &self.runs);
            self.queries().forget::<AlternativeRuns>();
            self.background.stop(Activity::ExtraRun);
            return;
        }
        let scenario = self.session.scenario();
        let first = self.comparison.is_none();
        let comparison = self.comparison.get_or_insert_with(|| Comparison::empty(scenario));
        let ours = comparison
            .entries()
            .iter()
            .any(|e| e.outcome.as_ref().is_ok_and(|run| run.scenario.task == scenario.task && !e.added_by_user));
        let task = comparison.task();
        let stale = first || (task != scenario && (!ours || !same_but_task(task, scenario)));
        let wanted = stale || self.queries().progress::<AlternativeRuns>().is_some();
        if wanted && (first || self.view_state.gesture.grabbed.is_none()) {
            let _ = self.queries().ask_in_background::<AlternativeRuns>(&self.session.run().shared_scenario());
        }
        if first {
            self.restore_runs();
        }
    }

    /// Gives a table of runs what it held when it was closed or saved. Runs that were read are made in the background.
    fn restore_runs(&mut self) {
        let SavedRuns { ticked, sorted_by, descending, added } = std::mem::take(&mut self.runs);
        let Some(table) = &mut self.comparison else { return };
        table.tick(ticked);
        table.sort_by_key(&sorted_by, descending);
        for AddedRun { shown, run } in added {
            match run {
                SavedRun::Made(ByIdentity(run)) => table.restore(run, shown),
                run @ SavedRun::Text(_) => self.runs.added.push(AddedRun { shown, run }),
            }
        }
        if self.runs.added.is_empty() {
            return;
        }
        let wanted = self.runs.added.clone();
        let work = move |ticket: &Ticket| {
            let count = wanted.len() as f64;
            let make = |(i, one): (usize, &AddedRun)| {
                let run = one.run.make(&mut |done| ticket.goes_on((i as f64 + done) / count));
                run.map(|run| (run, one.shown))
            };
            wanted.iter().enumerate().map(make).collect::<Vec<_>>()
        };
        self.background.run(Activity::ExtraRun, work, move |app_state, made| {
            app_state.runs.added.clear();
            let mut failed = if made.is_none() { vec![fault("the runs side by side")] } else { Vec::new() };
            for run in made.into_iter().flatten() {
                match (run, &mut app_state.comparison) {
                    (Ok((run, shown)), Some(table)) => table.restore(run, shown),
                    (Ok(_), None) => {}
                    (Err(why), _) => failed.push(why),
                }
            }
            if !failed.is_empty() {
                app_state.show_outcome(Err(failed.join("\n")));
            }
        });
        self.collect();
    }

    /// Requests the run to be shown beside that on display, if there is a pair; during a drag the last one stays.
    pub(super) fn refresh_pair(&mut self) {
        let Some(pair) = &self.view_state.pair else {
            self.queries().forget::<BesideQuery>();
            return;
        };
        if self.view_state.gesture.grabbed.is_none()
            && let Some(scenario) = pair.with.scenario(&self.session)
        {
            let _ = self.queries().ask_in_background::<BesideQuery>(&Shared(Arc::new(scenario)));
        }
    }

    /// Returns the run beside that on display, or the reason why there is none; `None` while it is being made.
    pub(super) fn beside(&self) -> Option<Arc<Result<Beside, String>>> {
        let QueryResult { last, state } = self.queries().newest::<BesideQuery>()?;
        match state {
            QueryStatus::Broken => Some(Arc::new(Err(fault("the run beside")))),
            QueryStatus::Stopped if last.is_none() => Some(Arc::new(Err("it was stopped".into()))),
            _ => last,
        }
    }

    pub(super) fn change_comparison(&mut self, on: ComparisonCommand) {
        let Some(comparison) = &mut self.comparison else { return };
        match on {
            ComparisonCommand::Sort(column) => comparison.sort_by(column),
            ComparisonCommand::Show(entry, shown) => comparison.show(entry, shown),
            ComparisonCommand::Remove(entry) => comparison.remove(entry),
            ComparisonCommand::Add(scenario) => self.keep(*scenario, None),
        }
    }

    /// Adds the session's run to the table of runs, if the table is on display.
    pub(super) fn keep_run(&mut self) {
        if self.comparison.is_some() {
            let mut scenario = self.session.to_scenario();
            scenario.duration = Some(self.session.length());
            self.keep(scenario, Some("added this run to the comparison"));
        }
    }

    /// Opens the scenario of a row of the table of runs.
    pub(super) fn open_run(&mut self, entry: usize) {
        let entry = self.comparison.as_ref().and_then(|comparison| comparison.entries().get(entry));
        if let Some(Ok(run)) = entry.map(|entry| &entry.outcome) {
            let source = SessionSource::Scenario(Box::new(run.scenario.clone()));
            self.open(source, Opening::default());
        }
    }

    /// Runs a branch and adds it to the table of runs.
    pub(super) fn compare_branch(&mut self, branch: usize) {
        let Some(mut scenario) = self.session.branch(branch) else { return };
        if let Some(fork) = self.session.forks().get(branch) {
            scenario.name = format!("branch at {:.3} s", fork.from);
        }
        self.view_state.below = Some(BottomPanel::Runs);
        self.refresh_comparison();
        self.keep(scenario, Some("added the branch to the runs side by side"));
    }

    /// Runs a scenario in the background and adds it to the table of runs; `news` is the message on success.
    pub(super) fn keep(&mut self, scenario: Scenario, news: Option<&'static str>) {
        let work = move |ticket: &Ticket| ComparedRun::of_while(scenario, &mut |done| ticket.goes_on(done));
        self.background.run(Activity::ExtraRun, work, move |app_state, run| {
            let run = run.map_or_else(|| Err(fault("the run")), |run| run.map_err(|why| why.to_string()));
            let said = match (run, &mut app_state.comparison) {
                (Ok(run), Some(comparison)) => {
                    comparison.keep_run(run);
                    Ok(news.map(String::from))
                }
                (run, _) => run.map(|_| None),
            };
            app_state.show_outcome(said);
        });
        self.collect();
    }

    /// Ends the background work: waits until a file that is being saved has been written, and stops everything else.
    #[cfg(feature = "window")]
    pub(crate) fn close(&mut self) {
        self.background.wait_for(Activity::Saving);
        self.background = Background::default();
    }

    /// Stops an activity and returns the message about it. The display does not change.
    pub(super) fn cancel(&mut self, activity: Activity) -> String {
        if activity.can_stop() {
            self.background.stop(activity);
        }
        if activity == Activity::Change {
            self.session.end_gesture();
        }
        activity.cancelled().into()
    }
}

/// Returns the message for background work that panicked.
pub(super) fn fault(what: &str) -> String {
    format!("{what} broke off: this is a fault of the program")
}

/// Whether two scenarios agree in machine, plant, control, base and step.
fn same_but_task(a: &Scenario, b: &Scenario) -> bool {
    a.machine == b.machine && a.plant == b.plant && a.control == b.control && a.base == b.base && a.step == b.step
}
