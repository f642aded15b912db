//! What the application starts beside the window, and what it does with what comes back.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::AppState;
use crate::app::background::{Background, File, Opening, Slot, ended};
use crate::app::change::{Change, NotOpened, Opened, Source};
use crate::app::{Activity, Command, ComparisonCommand, Framing, LeftOff, PlotFile, RefusedEdit, plots};
use crate::exchange::cut::Cut;
use crate::exchange::form::Form;
use crate::mechanics::machine::Machine;
use crate::picture::scene::stage::Outlining;
use crate::query::{Asked, Job, Queries, Same, Shared, State, Ticket, Workers};
use crate::session::scenario::{MAX_BRANCHES, Scenario};
use crate::session::{Ahead, Edit, Refusal, Session};
use crate::study::comparison::{Compared, Comparison, Ways};
use crate::study::tolerance::{Studied, Study, Studying};

/// The most steps that are run ahead to see how far the base will move.
const MOST_AHEAD: f64 = 20_000.0;

impl AppState {
    /// The same with somebody who works beside it.
    #[must_use]
    pub fn with_workers(mut self, workers: impl Workers + Send + Sync + 'static) -> Self {
        self.background.hire(workers);
        self
    }

    /// What is derived of the session.
    pub(super) fn queries(&self) -> &Queries {
        &self.background.queries
    }

    /// Says how something went.
    pub(super) fn tell(&mut self, said: Result<Option<String>, String>) {
        match said {
            Ok(None) => {}
            Ok(Some(news)) => self.view_state.message = Some((news, false)),
            Err(problem) => self.view_state.message = Some((problem, true)),
        }
    }

    /// Takes what jobs have done; whether one has ended.
    pub(super) fn collect(&mut self) -> bool {
        let [changed, opened] = [self.collect_change(), self.collect_opening()];
        let mut any = changed || opened;
        if let (Some(comparison), Some(ways)) = (&mut self.comparison, self.background.queries.newest::<Ways>())
            && let Some(ways) = ways.known()
        {
            comparison.follow(ways);
        }
        while let Some(first) = self.background.kept.pop_front() {
            let mut first = Some(first);
            let Some((news, run)) = ended(&mut first) else {
                self.background.kept.extend(first);
                self.background.kept.rotate_right(1);
                break;
            };
            let run = run.map_or_else(|| Err(fault("the run")), |run| run.map_err(|why| why.to_string()));
            let said = match (run, &mut self.comparison) {
                (Ok(run), Some(comparison)) => {
                    comparison.keep_run(run);
                    Ok(news.map(String::from))
                }
                (run, _) => run.map(|_| None),
            };
            self.tell(said);
            any = true;
        }
        if let Some(((), said)) = ended(&mut self.background.recording) {
            let said = said.unwrap_or_else(|| Err(fault("the recording")));
            self.tell(said.map(Some));
            any = true;
        }
        if let Some((session, said)) = ended(&mut self.background.saving) {
            let said = said.unwrap_or_else(|| Err(fault("saving")));
            if let (Ok(_), Some((changes, file))) = (&said, session) {
                self.saving.saved = changes;
                self.saving.uses(&file);
            }
            self.tell(said.map(Some));
            any = true;
        }
        self.adjust();
        any
    }

    /// Has what the machine reaches outlined, where that is yet to be found and takes long; whether it has come.
    pub(super) fn outline(&mut self) -> bool {
        let Some(space) = self.views.unoutlined() else {
            // What was being outlined is wanted no more.
            if self.queries().progress::<Outlining>().is_some() {
                self.queries().forget::<Outlining>();
            }
            return false;
        };
        if self.queries().ask_beside::<Outlining>(&Shared(space)).known().is_none() {
            return false;
        }
        self.refresh_views();
        true
    }

    /// Changes a copy of the session, which shares its frames, and shows that once it is made: most are by the next
    /// repaint, and what was shown stays until then.
    pub(super) fn change(&mut self, change: Change) {
        let mut next = self.session.clone();
        let job = self.background.start_short({
            let change = change.clone();
            move |ticket| {
                let done = change.make(&mut next, &mut |done| ticket.goes_on(done));
                (next, done)
            }
        });
        self.background.change = Some(((change, 0), job));
        self.collect_change();
    }

    fn collect_change(&mut self) -> bool {
        let Some(((change, _), made)) = ended(&mut self.background.change) else { return false };
        match made {
            Some((next, done)) => {
                if done.is_ok() {
                    let old = std::mem::replace(&mut self.session, next);
                    self.parts(&change, (old.partings().0, old.frame().time, old.is_led()));
                    self.background.let_go(old, &self.session);
                }
                self.changed(&change, done);
            }
            None => self.tell(Err("the change broke off: this is a fault of the program; nothing has changed".into())),
        }
        true
    }

    /// Remembers that a change has left a branch, where so many had been left before, at the instant then shown, s, and
    /// of a run that had been led by hand or not.
    fn parts(&mut self, change: &Change, (partings, shown, led): (u64, f64, bool)) {
        let (now, gone) = self.session.partings();
        if !matches!(change, Change::Edit(_)) || now == partings {
            return;
        }
        let kept = match led && !self.session.is_led() {
            true => "what you led by hand is kept as a branch".into(),
            false => format!("what came after {shown:.3} s is kept as a branch"),
        };
        self.parted = Some(match gone {
            Some(gone) => format!("{kept} (H); the oldest of {MAX_BRANCHES} is gone: {gone}"),
            None => format!("{kept} (H)"),
        });
    }

    /// After a change of the session, or its refusal.
    fn changed(&mut self, change: &Change, done: Result<Option<String>, Refusal>) {
        if let (Change::Edit(edit), Err(refusal)) = (change, &done) {
            self.view_state.refused = Some(RefusedEdit::of(edit, refusal));
        }
        if done.is_ok() {
            self.saving.changes += u64::from(!matches!(change, Change::Seek(_)));
            match change {
                // A push sends an edit many times a second for as long as it lasts: too often to run ahead each time.
                Change::Edit(Edit::Push { .. }) => self.view_state.refused = None,
                Change::Edit(edit) if edit.is_aside() => self.view_state.refused = None,
                Change::Edit(_) => {
                    self.view_state.refused = None;
                    self.foresee();
                }
                Change::Undo | Change::Redo | Change::GoTo(_) | Change::Branch(_) | Change::BackToPath => {
                    self.foresee()
                }
                Change::Seek(_) => {}
            }
        }
        self.tell(done.map_err(|refusal| refusal.to_string()));
        self.refresh();
    }

    /// Does what had to wait for a change of the session, up to the next that takes long.
    pub(super) fn catch_up(&mut self) {
        while self.background.change.is_none() {
            let Some(command) = self.background.later.pop_front() else { return };
            self.do_now(command);
        }
    }

    /// Opens a session in place of the present one; only the newest counts.
    pub(super) fn open(&mut self, source: Source, opening: Opening) {
        self.background.opening = None;
        let job = self.background.start(move |ticket| source.open(&mut |done| ticket.goes_on(done)));
        self.background.opening = Some((opening, job));
        self.collect_opening();
    }

    fn collect_opening(&mut self) -> bool {
        // What is done to the present session comes first.
        if self.background.is_changing() {
            return false;
        }
        let Some((opening, opened)) = ended(&mut self.background.opening) else { return false };
        let broken = || NotOpened { why: "opening broke off: this is a fault of the program".into(), refused: None };
        match opened.unwrap_or_else(|| Err(broken())) {
            Ok(Opened { session, said, left_off }) => {
                let news = said.or_else(|| opening.news.clone());
                self.take_over(session, Opening { news, ..opening });
                if let Some(LeftOff { plots, .. }) = left_off {
                    self.view_state.charts = plots;
                }
            }
            Err(_) if opening.instead.is_some() => {
                if let Some((scenario, said)) = opening.instead.map(|instead| *instead) {
                    let opening = Opening { news: Some(said), instead: None, ..opening };
                    self.open(Source::Scenario(Box::new(scenario)), opening);
                }
            }
            Err(NotOpened { why, refused }) => {
                if let Some(File::Own(file)) = &opening.file {
                    self.saving.misses(file);
                }
                self.view_state.refused = refused;
                self.tell(Err(why));
            }
        }
        self.refresh();
        true
    }

    fn take_over(&mut self, next: Session, Opening { plays, closes, news, file, .. }: Opening) {
        self.saving.opened();
        match file {
            Some(File::Own(file)) => self.saving.uses(&file),
            // It is in no file of the person's own yet.
            Some(File::LeftBehind(file)) => {
                self.saving.changes += 1;
                self.saving.recovered = Some(file);
            }
            None => {}
        }
        let old = self.session.clone();
        self.session.take_over(next);
        self.view_state.framing.iter_mut().for_each(Framing::renew);
        self.background.let_go(old, &self.session);
        self.foresee();
        if plays {
            self.session.play();
        }
        if closes {
            self.view_state.dialog = None;
        }
        self.tell(Ok(news));
    }

    /// Opens one of the paper's cases. A machine that was chosen in the window stays, and the message says so.
    pub(super) fn open_case(&mut self, name: &str) {
        let Some(case) = Scenario::builtin(name) else { return };
        let present = &self.session.scenario().machine;
        let other = (present.name() != case.machine.name()).then(|| present.clone());
        let own = case.machine.name();
        let news = |machine: &Machine| {
            format!("{}, with {}; the paper's machine is {own}, top left", case.title, machine.name())
        };
        let instead = |machine: &Machine| {
            let said = format!(
                "{}, with the paper's machine, as {} cannot do it; Ctrl Z goes back",
                case.title,
                machine.name()
            );
            Box::new((case.clone(), said))
        };
        let (news, instead) = (other.as_ref().map(news), other.as_ref().map(instead));
        let scenario = Scenario { machine: other.unwrap_or_else(|| case.machine.clone()), ..case };
        let opening = Opening { plays: true, closes: false, news, file: None, instead };
        self.open(Source::Scenario(Box::new(scenario)), opening);
    }

    /// Opens a file.
    pub(super) fn open_file(&mut self, path: PathBuf) {
        let news = Some(format!("opened {}", path.display()));
        let file = Some(File::Own(path.clone()));
        self.open(Source::File(path), Opening { plays: false, closes: true, news, file, instead: None });
    }

    /// Whether a file is replaced where it is there; it may not be without the person's word for that.
    fn may_replace(&mut self, file: &Path) -> Result<bool, String> {
        let agreed = self.saving.replaces.take().is_some_and(|agreed| agreed == file);
        match file.exists() && !agreed {
            true => Err(format!("{} exists: want another name", file.display())),
            false => Ok(agreed),
        }
    }

    /// Starts to write a file; what is done at once says at once how it went, with the dialog still open where it failed.
    fn write<K>(
        &mut self,
        slot: fn(&mut Self) -> &mut Slot<K, Result<String, String>>,
        of: K,
        job: Job<Result<String, String>>,
    ) {
        *slot(self) = Some((of, job));
        self.collect();
        let failed = matches!(self.view_state.message, Some((_, true)));
        if slot(self).is_some() || !failed {
            self.view_state.dialog = None;
        }
    }

    /// Saves the session.
    pub(super) fn save(&mut self, path: &Path) -> Result<(), String> {
        let replaces = self.may_replace(path)?;
        if self.background.saving.is_some() {
            return Err("one session is being saved: want that to end first".into());
        }
        let (scenario, path) = (self.session.to_scenario(), path.to_owned());
        let of = Some((self.saving.changes, path.clone()));
        let job = self.background.start(move |_| {
            let text = scenario.to_toml();
            crate::files::write_new(&path, text.as_bytes(), replaces).map_err(|e| e.to_string())?;
            Ok(format!("saved {}", whole(&path)))
        });
        self.write(|app_state| &mut app_state.background.saving, of, job);
        Ok(())
    }

    /// Writes a plot to a file.
    pub(super) fn write_plot(&mut self, path: &Path, plot: &str, file: PlotFile) -> Result<(), String> {
        let replaces = self.may_replace(path)?;
        if self.background.saving.is_some() {
            return Err("one file is being saved: want that to end first".into());
        }
        let (session, signals, view_state) = (&self.session, &self.signals(), &self.view_state);
        let queries = self.queries();
        let what = plots::Shown { session, queries, signals, comparison: self.comparison.as_ref(), view_state };
        let (content, path) = (plots::written(&what, plot, file)?, path.to_owned());
        let job = self.background.start(move |_| {
            crate::files::write_new(&path, &content()?, replaces).map_err(|e| e.to_string())?;
            Ok(format!("saved {}", whole(&path)))
        });
        self.write(|app_state| &mut app_state.background.saving, None, job);
        Ok(())
    }

    /// Writes the machine for another program, in the pose on display.
    pub(super) fn take_elsewhere(&mut self, path: &Path) -> Result<(), String> {
        let ending = path.extension().unwrap_or_default().to_string_lossy();
        let form = Form::of(&ending).map_err(|e| format!("{}: {e}", path.display()))?;
        let replaces = self.may_replace(path)?;
        if self.background.saving.is_some() {
            return Err("one file is being saved: want that to end first".into());
        }
        let machine = &self.session.scenario().machine;
        let pose = &self.session.frame().q.0[..machine.drives()];
        // Of the material that the design view has counterweights of.
        let cut = Cut { density: self.session.scenario().design.density, ..Cut::default() };
        let text = form.written(machine, pose, &cut).map_err(|e| e.to_string())?;
        let path = path.to_owned();
        let job = self.background.start(move |_| {
            crate::files::write_new(&path, text.as_bytes(), replaces).map_err(|e| e.to_string())?;
            Ok(format!("saved {}", whole(&path)))
        });
        self.write(|app_state| &mut app_state.background.saving, None, job);
        Ok(())
    }

    /// Records the run.
    #[cfg(feature = "record")]
    pub(super) fn record(&mut self, path: &Path) -> Result<(), String> {
        let force = self.may_replace(path)?;
        if self.background.recording.is_some() {
            return Err("one recording is under way: want it to end first".into());
        }
        let options = crate::recording::Options { pictures: None, force };
        let mut scenario = self.session.to_scenario();
        scenario.duration = Some(self.session.length());
        let path = path.to_owned();
        let job = self.background.start(move |ticket| {
            let mut told =
                |progress: crate::recording::Progress| ticket.goes_on(progress.done as f64 / progress.of.max(1) as f64);
            let done = crate::recording::record(&[scenario], &path, &options, &mut told).map_err(|e| e.to_string())?;
            let verdict = if done.iter().all(|r| r.reactionless) { "reactionless" } else { "with reactions" };
            Ok(format!("recorded {} ({verdict}); open it with the Rerun viewer", whole(&path)))
        });
        self.write(|app_state| &mut app_state.background.recording, (), job);
        Ok(())
    }

    #[cfg(not(feature = "record"))]
    pub(super) fn record(&mut self, _path: &Path) -> Result<(), String> {
        Err("this build cannot record: build it with the feature `record`".into())
    }

    /// Runs ahead to where the planned motion ends, to know how far the base will move.
    pub(super) fn foresee(&mut self) {
        let run = self.session.run();
        if run.scenario().base.moves() && !self.session.is_led() && run.planned_steps() <= MOST_AHEAD {
            let _ = self.queries().ask_beside::<Ahead>(&Same(Arc::new(run.clone())));
        } else {
            self.queries().forget::<Ahead>();
        }
        self.adjust();
    }

    /// Studies the run on display; only the newest counts.
    pub(super) fn refresh_study(&mut self) {
        if !self.view_state.study {
            self.queries().forget::<Studying>();
        } else if self.view_state.grabbed.is_none() {
            let _ = self.queries().ask_beside::<Studying>(&Studied(Arc::new(self.session.run().clone())));
        }
    }

    /// What there is to show of that study, or why there is none.
    pub(super) fn study(&self) -> Option<Arc<Result<Study, String>>> {
        let Asked { last, state } = self.queries().newest::<Studying>()?;
        match state {
            State::Broken => Some(Arc::new(Err(fault("the study")))),
            // It is not begun again until something changes.
            State::Stopped if last.is_none() => {
                Some(Arc::new(Err("cancelled: to change something draws machines again".into())))
            }
            _ => last,
        }
    }

    /// Runs the ways of the task on display, if those of the table are of another. Not during a drag.
    pub(super) fn refresh_comparison(&mut self) {
        if !self.view_state.compare {
            self.comparison = None;
            self.queries().forget::<Ways>();
            self.background.kept.clear();
            return;
        }
        let scenario = self.session.scenario();
        let first = self.comparison.is_none();
        let comparison = self.comparison.get_or_insert_with(|| Comparison::empty(scenario));
        let ours = comparison
            .entries()
            .iter()
            .any(|e| e.outcome.as_ref().is_ok_and(|run| run.scenario.task == scenario.task && !e.kept));
        let task = comparison.task();
        let stale = first || (task != scenario && (!ours || !same_but_task(task, scenario)));
        let wanted = stale || self.queries().progress::<Ways>().is_some();
        if wanted && (first || self.view_state.grabbed.is_none()) {
            let _ = self.queries().ask_beside::<Ways>(&self.session.run().shared_scenario());
        }
    }

    pub(super) fn change_comparison(&mut self, on: ComparisonCommand) {
        let Some(comparison) = &mut self.comparison else { return };
        match on {
            ComparisonCommand::Sort(column) => comparison.sort_by(column),
            ComparisonCommand::Show(entry, shown) => comparison.show(entry, shown),
            ComparisonCommand::Remove(entry) => comparison.remove(entry),
            ComparisonCommand::Add(scenario) => self.keep(*scenario, None),
            ComparisonCommand::Keep => {
                let mut scenario = self.session.to_scenario();
                scenario.duration = Some(self.session.length());
                self.keep(scenario, Some("added this run to the comparison"));
            }
            ComparisonCommand::Open(entry) => {
                let run = comparison.entries().get(entry).and_then(|e| e.outcome.as_ref().ok()).cloned();
                if let Some(run) = run {
                    let opening = Opening { plays: false, closes: false, news: None, file: None, instead: None };
                    self.open(Source::Scenario(Box::new(run.scenario.clone())), opening);
                }
            }
        }
    }

    /// Runs a branch to be kept beside the ways of the task.
    pub(super) fn compare_branch(&mut self, branch: usize) {
        let Some(mut scenario) = self.session.branch(branch) else { return };
        if let Some(fork) = self.session.forks().get(branch) {
            scenario.name = format!("branch at {:.3} s", fork.from);
        }
        (self.view_state.compare, self.view_state.study) = (true, false);
        self.refresh_comparison();
        self.keep(scenario, Some("added the branch to the runs side by side"));
    }

    /// Runs a scenario to be kept beside the ways of the task.
    fn keep(&mut self, scenario: Scenario, news: Option<&'static str>) {
        let work = move |ticket: &Ticket| Compared::of_while(scenario, &mut |done| ticket.goes_on(done));
        let job = self.background.start(work);
        self.background.kept.push_back((news, job));
        self.collect();
    }

    /// Ends the program's work: a session that is being saved is saved whole, all else is stopped.
    pub(in crate::app) fn close(&mut self) {
        if let Some((_, job)) = self.background.saving.take() {
            // Nobody is left to tell.
            let _ = job.wait();
        }
        self.background = Background::default();
    }

    /// Stops what is under way; what was shown stays.
    pub(super) fn cancel(&mut self, activity: Activity) -> String {
        match activity {
            Activity::Change => {
                self.background.change = None;
                self.background.later.clear();
                self.session.end_gesture();
            }
            Activity::Opening => self.background.opening = None,
            Activity::Recording => self.background.recording = None,
            Activity::Study => self.queries().stop::<Studying>(),
            Activity::Ways => self.queries().stop::<Ways>(),
            Activity::Kept => self.background.kept.clear(),
            Activity::Saving => {}
        }
        activity.cancelled().into()
    }

    /// What waits while the session is being changed.
    pub(super) fn waits(&self, command: &Command) -> bool {
        self.background.is_changing() && command.is_of_session()
    }
}

/// The whole name of a file, so that it can be found again.
fn whole(path: &Path) -> String {
    crate::files::whole(path).unwrap_or_else(|| path.into()).display().to_string()
}

/// What is said of work that broke off.
fn fault(what: &str) -> String {
    format!("{what} broke off: this is a fault of the program")
}

/// Whether two scenarios differ in their tasks at most.
fn same_but_task(a: &Scenario, b: &Scenario) -> bool {
    a.machine == b.machine && a.plant == b.plant && a.control == b.control && a.base == b.base && a.step == b.step
}
