//! The [`AppState`]: a session, how it is shown, and what carries out commands. Every window, test and figure has one.

use std::path::Path;
use std::sync::Arc;

use super::jobs::{AtOnce, Job, Poll, Ticket, Workers};
use super::{
    Command, ComparisonCommand, RefusedEdit, ViewState, compare, keys, order, plots, side, status, study, theme, top,
    viewport,
};
use crate::app::widgets;
use crate::mechanics::machine::Machine;
use crate::picture::scene::exaggeration::exaggeration;
use crate::picture::scene::palette::Theme;
use crate::picture::scene::stage::Stage;
use crate::picture::scene::views::{ViewKind, Views};
use crate::session::scenario::Scenario;
use crate::session::{Edit, Refusal, Session};
use crate::settings::text::brief;
use crate::simulation::frame::Totals;
use crate::simulation::signals::{Signal, signals};
use crate::study::comparison::{Comparison, Outcome, run_ways};
use crate::study::tolerance::{Study, ToleranceError};

/// A session on display.
pub struct AppState {
    session: Session,
    views: Arc<Views>,
    signals: Vec<Signal>,
    stage_of: (Machine, String),
    view_state: ViewState,
    /// Runs side by side, while they are on display.
    comparison: Option<Comparison>,
    /// Tolerances and what they were found for, while they are on display.
    study: Option<(Scenario, Result<Study, String>)>,
    /// Who works beside the window, and what is under way.
    workers: Arc<dyn Workers + Send + Sync>,
    jobs: Jobs,
    /// Woken when a job has ended.
    ctx: Option<egui::Context>,
    /// Totals of the planned motion, simulated ahead: how far the base will move.
    foreseen: Totals,
    /// Wall time not yet turned into steps, s.
    owed: f64,
    dressed: Option<Theme>,
    fonts: bool,
}

/// A job that may be stopped on the way, and has no result then.
type JobOf<T> = Job<Option<T>>;

/// What is under way beside the window; studies and runs side by side with the scenario that they are of.
#[derive(Default)]
struct Jobs {
    /// A study, or why there is none.
    study: Option<(Scenario, JobOf<Result<Study, String>>)>,
    /// Runs side by side.
    ways: Option<(Scenario, JobOf<Vec<Outcome>>)>,
    /// What to say when the recording is there.
    recording: Option<Job<Result<String, String>>>,
    /// How far the base will move.
    foreseen: Option<Job<Totals>>,
}

/// The most steps that are run ahead to see how far the base will move.
const MOST_AHEAD: f64 = 20_000.0;

/// How soon progress is shown again, s.
const SHOWN_AGAIN: f32 = 0.1;

/// The most wall time that one repaint makes up for, s: after a pause of the program time does not jump.
const MOST_OWED: f64 = 0.1;

impl AppState {
    /// Opens a scenario.
    ///
    /// # Errors
    /// If it cannot start.
    pub fn new(scenario: Scenario, theme: Theme) -> Result<Self, Refusal> {
        Ok(Self::around(Session::open(scenario)?, theme))
    }

    fn around(session: Session, theme: Theme) -> Self {
        let views = Views::of(session.run());
        let view_state = ViewState::new(theme, &views);
        let mut app_state = Self {
            signals: signals(&session.scenario().machine),
            stage_of: stage_key(&session),
            views: Arc::new(views),
            foreseen: Totals::default(),
            session,
            view_state,
            comparison: None,
            study: None,
            workers: Arc::new(AtOnce),
            jobs: Jobs::default(),
            ctx: None,
            owed: 0.0,
            dressed: None,
            fonts: false,
        };
        app_state.foresee();
        app_state.adjust();
        app_state
    }

    /// The same with somebody who works beside it.
    #[must_use]
    pub fn with_workers(self, workers: impl Workers + Send + Sync + 'static) -> Self {
        Self { workers: Arc::new(workers), ..self }
    }

    /// Starts work beside the window.
    fn start<T: Send + 'static>(&self, work: impl FnOnce(&Ticket) -> T + Send + 'static) -> Job<T> {
        let ctx = self.ctx.clone();
        let wake = move || {
            if let Some(ctx) = ctx {
                ctx.request_repaint();
            }
        };
        Job::start(&*self.workers, wake, work)
    }

    /// What is under way and how far it is, for the line at the bottom.
    fn under_way(&self) -> Option<(&'static str, f64)> {
        let study = self.jobs.study.as_ref().map(|(_, job)| ("drawing machines", job.progress()));
        let ways = self.jobs.ways.as_ref().map(|(_, job)| ("running the ways of the task", job.progress()));
        let recording = self.jobs.recording.as_ref().map(|job| ("recording", job.progress()));
        recording.or(study).or(ways)
    }

    /// Takes what jobs have done; whether one has ended.
    fn collect(&mut self) -> bool {
        let mut ended = false;
        if let Some((of, job)) = self.jobs.study.take() {
            match job.poll() {
                Poll::Working => self.jobs.study = Some((of, job)),
                Poll::Done(study) => {
                    self.study = study.map(|study| (of, study)).or(self.study.take());
                    ended = true;
                }
                Poll::Broken => {
                    self.study = Some((of, Err("the study broke off: this is a fault of the program".into())));
                    ended = true;
                }
            }
        }
        if let Some((of, job)) = self.jobs.ways.take() {
            match job.poll() {
                Poll::Working => self.jobs.ways = Some((of, job)),
                Poll::Done(ways) => {
                    if let (Some(comparison), Some(ways)) = (&mut self.comparison, ways) {
                        comparison.follow_with(&of, ways);
                    }
                    ended = true;
                }
                Poll::Broken => ended = true,
            }
        }
        if let Some(job) = self.jobs.recording.take() {
            match job.poll() {
                Poll::Working => self.jobs.recording = Some(job),
                Poll::Done(said) => {
                    self.view_state.message = Some(said.map_or_else(|why| (why, true), |news| (news, false)));
                    ended = true;
                }
                Poll::Broken => {
                    let why = "the recording broke off: this is a fault of the program";
                    self.view_state.message = Some((why.into(), true));
                    ended = true;
                }
            }
        }
        if let Some(job) = self.jobs.foreseen.take() {
            match job.poll() {
                Poll::Working => self.jobs.foreseen = Some(job),
                Poll::Done(totals) => {
                    self.foreseen = totals;
                    self.adjust();
                    ended = true;
                }
                Poll::Broken => ended = true,
            }
        }
        ended
    }

    /// Opens a scenario; where its task cannot be planned, its machine with the paper's task, and what is in the way.
    /// A machine that cannot do that either waits where it stands.
    ///
    /// # Errors
    /// If not even that can start.
    pub fn open_or_explain(scenario: Scenario, theme: Theme) -> Result<Self, Refusal> {
        let refusal = match Self::new(scenario.clone(), theme) {
            Ok(app_state) => return Ok(app_state),
            Err(refusal) => refusal,
        };
        let (change, known) = (scenario.task.whole(), Scenario::builtin("case-3"));
        let fallback = known.map(|known| Scenario { task: known.task, edits: Vec::new(), ..scenario.clone() });
        let Some(Ok(mut app_state)) = fallback.map(|fallback| Self::new(fallback, theme)) else {
            return Session::open_waiting(scenario).map_or(Err(refusal), |session| Ok(Self::around(session, theme)));
        };
        app_state.carry_out(Command::Edit(Edit::of("task", change)));
        Ok(app_state)
    }

    /// The session.
    pub fn session(&self) -> &Session {
        &self.session
    }

    /// How it is shown.
    pub fn view_state(&self) -> &ViewState {
        &self.view_state
    }

    /// Runs side by side, while they are on display.
    pub fn comparison(&self) -> Option<&Comparison> {
        self.comparison.as_ref()
    }

    /// What scenes are made from.
    pub fn stage(&self) -> &Stage {
        self.views.stage()
    }

    /// The linked views.
    pub fn views(&self) -> &Views {
        &self.views
    }

    /// Lets wall time pass, s.
    pub fn pass(&mut self, wall: f64) {
        if !self.session.is_moving() {
            self.owed = 0.0;
            return;
        }
        let dt = self.session.scenario().step;
        self.owed += wall.clamp(0.0, MOST_OWED) * self.view_state.speed;
        let steps = (self.owed / dt).floor();
        self.owed -= steps * dt;
        self.session.tick(steps as u64);
        self.adjust();
    }

    /// One pass of the user interface; commands are carried out at its end.
    pub fn ui(&mut self, ui: &mut egui::Ui) {
        self.dress(ui.ctx());
        if self.collect() {
            ui.ctx().request_repaint();
        }
        let mut commands = Vec::new();
        keys::read(ui.ctx(), &self.session, &self.view_state, &mut commands);
        top::show(ui, &self.session, &self.view_state, &mut commands);
        status::show(ui, &self.session, &self.views, &self.view_state, self.under_way(), &mut commands);
        if let Some(comparison) = &self.comparison {
            compare::show(ui, comparison, &self.view_state, &mut commands);
        }
        if self.view_state.study {
            let study = self.study.as_ref().map(|(_, study)| study);
            study::show(ui, study, self.session.frame().time, &self.view_state, &mut commands);
        }
        side::show(ui, &self.session, &self.view_state, &mut commands);
        plots::show(ui, &self.session, &self.signals, self.comparison.as_ref(), &self.view_state, &mut commands);
        viewport::show(ui, &self.session, &self.views, self.comparison.as_ref(), &mut self.view_state, &mut commands);
        status::news(ui.ctx(), &self.session, &self.view_state, &mut commands);
        keys::help(ui.ctx(), &self.view_state, &mut commands);
        top::dialog(ui.ctx(), &mut self.view_state, &mut commands);
        commands.extend(widgets::refused_entry(ui.ctx()).map(Command::Refuse));
        if commands.iter().any(|c| !matches!(c, Command::EndGesture | Command::Preview(_))) {
            self.view_state.message = None;
            self.view_state.refused = None;
        }
        if !commands.is_empty() {
            ui.ctx().request_repaint();
        }
        for command in commands {
            self.carry_out(command);
        }
        if self.session.is_moving() {
            ui.ctx().request_repaint();
        } else if self.under_way().is_some() {
            ui.ctx().request_repaint_after_secs(SHOWN_AGAIN);
        }
    }

    fn dress(&mut self, ctx: &egui::Context) {
        self.ctx.get_or_insert_with(|| ctx.clone());
        if !self.fonts {
            theme::install_fonts(ctx);
            ctx.add_plugin(order::Order::default());
            self.fonts = true;
        }
        if self.dressed != Some(self.view_state.theme) {
            theme::apply(ctx, self.view_state.theme);
            self.dressed = Some(self.view_state.theme);
        }
    }

    /// Carries out one command. A command that cannot be carried out changes nothing; a message says why.
    pub fn carry_out(&mut self, command: Command) {
        match self.attempt(command) {
            Ok(None) => {}
            Ok(Some(news)) => self.view_state.message = Some((news, false)),
            Err(problem) => self.view_state.message = Some((problem, true)),
        }
        self.refresh();
    }

    fn attempt(&mut self, command: Command) -> Result<Option<String>, String> {
        let refused = |r: Refusal| r.to_string();
        match command {
            Command::Edit(edit) => {
                if let Err(refusal) = self.session.apply(edit.clone()) {
                    self.view_state.refused = Some(RefusedEdit::of(&edit, &refusal));
                    return Err(refusal.to_string());
                }
                self.view_state.refused = None;
                // A push sends an edit many times a second for as long as it lasts: too often to run ahead each time.
                if !matches!(edit, Edit::Push { .. }) {
                    self.foresee();
                }
                // What a drag has changed, Esc takes back.
                self.view_state.dragged |= self.view_state.grabbed.is_some();
            }
            Command::Preview(b) => self.view_state.preview = b,
            Command::Draw(draw) => {
                self.view_state.stroke = draw.then(Vec::new);
                self.view_state.pushing &= !draw;
            }
            Command::Push(push) => {
                self.view_state.pushing = push;
                self.view_state.stroke = self.view_state.stroke.take().filter(|_| !push);
            }
            Command::Exaggerate(on) => self.view_state.exaggerates_base = on,
            Command::EndGesture => self.session.end_gesture(),
            Command::TogglePlay if self.session.is_playing() => self.session.pause(),
            Command::TogglePlay => self.session.play(),
            Command::Seek(time) => {
                self.session.pause();
                self.session.seek(time);
            }
            Command::Step(steps) => self.session.step_by(steps),
            Command::Speed(speed) => self.view_state.speed = speed,
            Command::Open(scenario) => {
                self.session.switch(*scenario).map_err(refused)?;
                self.foresee();
                self.session.play();
            }
            Command::Case(name) => return self.case(name),
            Command::BackToPath => {
                if self.session.is_led() {
                    self.session.apply(Edit::of("task", Default::default())).map_err(refused)?;
                    self.session.end_gesture();
                    self.session.pause();
                    self.session.seek(0.0);
                    self.foresee();
                    return Ok(Some("back on the planned path, at its start".into()));
                }
            }
            Command::TurnTask(turn) => self.view_state.turn_task = turn,
            Command::Refuse(why) => return Err(why),
            Command::OpenFile(path) => return self.open(&path).map(Some),
            Command::SaveFile(path) => return self.save(&path).map(Some),
            Command::Record(path) => return self.record(&path),
            Command::Undo => {
                let title = self.session.undo_title().map(|t| format!("undone: {t}"));
                self.session.undo().map_err(refused)?;
                self.foresee();
                return Ok(title);
            }
            Command::Redo => {
                let title = self.session.redo_title().map(|t| format!("redone: {t}"));
                self.session.redo().map_err(refused)?;
                self.foresee();
                return Ok(title);
            }
            Command::View(view) => self.view_state.view = view,
            Command::Dexterity(shown) => self.view_state.dexterity = shown,
            Command::Fit => *self.view_state.camera_mut() = self.views.camera(self.view_state.view),
            Command::Theme(theme) => self.view_state.theme = theme,
            Command::Help(help) => self.view_state.help = help,
            Command::Mark(time) => self.view_state.mark = time,
            Command::Snapshots(shown) => self.view_state.snapshots = shown,
            // The window has room for one of the two panels.
            Command::Compare(compare) => {
                (self.view_state.compare, self.view_state.study) = (compare, self.view_state.study && !compare)
            }
            Command::Study(study) => {
                (self.view_state.study, self.view_state.compare) = (study, self.view_state.compare && !study)
            }
            Command::Pins(shown) => self.view_state.pins = shown,
            Command::Comparison(on) => return self.change_comparison(on),
            Command::Dialog(dialog) => self.view_state.dialog = dialog,
        }
        Ok(None)
    }

    fn change_comparison(&mut self, on: ComparisonCommand) -> Result<Option<String>, String> {
        let Some(comparison) = &mut self.comparison else { return Ok(None) };
        match on {
            ComparisonCommand::Sort(column) => comparison.sort_by(column),
            ComparisonCommand::Show(entry, shown) => comparison.show(entry, shown),
            ComparisonCommand::Remove(entry) => comparison.remove(entry),
            ComparisonCommand::Add(scenario) => comparison.keep(*scenario).map_err(|why| why.to_string())?,
            ComparisonCommand::Keep => {
                let mut scenario = self.session.to_scenario();
                scenario.duration = Some(self.session.length());
                comparison.keep(scenario).map_err(|why| why.to_string())?;
                return Ok(Some("added this run to the comparison".into()));
            }
            ComparisonCommand::Open(entry) => {
                let run = comparison.entries().get(entry).and_then(|e| e.outcome.as_ref().ok()).cloned();
                if let Some(run) = run {
                    self.session.switch(run.scenario.clone()).map_err(|why| why.to_string())?;
                    self.foresee();
                }
            }
        }
        Ok(None)
    }

    /// Opens one of the paper's cases. A machine that was chosen in the window stays, and the message says so.
    fn case(&mut self, name: &str) -> Result<Option<String>, String> {
        let Some(case) = Scenario::builtin(name) else { return Ok(None) };
        let present = &self.session.scenario().machine;
        let other = (present.name() != case.machine.name()).then(|| present.clone());
        let news = other.as_ref().map(|machine| format!("{}, with the machine {}", case.title, machine.name()));
        let scenario = Scenario { machine: other.unwrap_or_else(|| case.machine.clone()), ..case };
        self.session.switch(scenario).map_err(|why| why.to_string())?;
        self.foresee();
        self.session.play();
        Ok(news)
    }

    fn open(&mut self, path: &Path) -> Result<String, String> {
        let found = crate::files::scenario(&path.display().to_string());
        let scenario = found.map_err(|e| brief(&e.to_string()).into_owned())?;
        let change = scenario.task.whole();
        if let Err(refusal) = self.session.switch(scenario) {
            self.view_state.refused = Some(RefusedEdit::of(&Edit::of("task", change), &refusal));
            return Err(refusal.to_string());
        }
        self.foresee();
        self.view_state.dialog = None;
        Ok(format!("opened {}", path.display()))
    }

    fn save(&mut self, path: &Path) -> Result<String, String> {
        check_name(path)?;
        crate::files::write_new(path, self.session.to_scenario().to_toml().as_bytes(), false)
            .map_err(|e| e.to_string())?;
        self.view_state.dialog = None;
        Ok(format!("saved {}", whole(path)))
    }

    #[cfg(feature = "record")]
    fn record(&mut self, path: &Path) -> Result<Option<String>, String> {
        check_name(path)?;
        if self.jobs.recording.is_some() {
            return Err("one recording is under way: want it to end first".into());
        }
        let options = crate::recording::Options { pictures: None, force: false };
        let mut scenario = self.session.to_scenario();
        scenario.duration = Some(self.session.length());
        let path = path.to_owned();
        let job = self.start(move |ticket| {
            let mut told = |progress: crate::recording::Progress| {
                ticket.goes_on(progress.done as f64 / progress.of.max(1) as f64);
            };
            let done = crate::recording::record(&[scenario], &path, &options, &mut told).map_err(|e| e.to_string())?;
            let verdict = if done.iter().all(|r| r.reactionless) { "reactionless" } else { "with reactions" };
            Ok(format!("recorded {} ({verdict}); open it with the Rerun viewer", whole(&path)))
        });
        // What is done at once says at once how it went, with the dialog still open where it failed.
        match job.poll() {
            Poll::Done(Err(why)) => return Err(why),
            Poll::Done(Ok(news)) => {
                self.view_state.dialog = None;
                return Ok(Some(news));
            }
            Poll::Working | Poll::Broken => self.jobs.recording = Some(job),
        }
        self.view_state.dialog = None;
        Ok(None)
    }

    #[cfg(not(feature = "record"))]
    fn record(&mut self, _path: &Path) -> Result<Option<String>, String> {
        Err("this build cannot record: build it with the feature `record`".into())
    }

    /// Runs ahead to where the planned motion ends, to know how far the base will move.
    fn foresee(&mut self) {
        self.foreseen = Totals::default();
        let scenario = self.session.scenario();
        let steps = (self.session.run().planned_time() / scenario.step).ceil();
        self.jobs.foreseen = None;
        if scenario.base.moves() && !self.session.is_led() && steps <= MOST_AHEAD {
            let mut run = self.session.run().clone();
            let job = self.start(move |ticket| {
                let mut wanted = true;
                while wanted && (run.simulation().step_count() as f64) < steps {
                    run.advance();
                    let done = run.simulation().step_count();
                    wanted = !done.is_multiple_of(256) || ticket.goes_on(done as f64 / steps);
                }
                run.frame().totals
            });
            self.jobs.foreseen = Some(job);
            self.collect();
        }
    }

    /// Finds how many times the motion of the base has to be enlarged to be seen, from as much of the run as is known.
    fn adjust(&mut self) {
        let reach = self.views.stage().linkage().reach();
        let newest = self.session.frames().last().map_or_else(Totals::default, |frame| frame.totals);
        let motion = [newest.shift.max(self.foreseen.shift), newest.base_angle.max(self.foreseen.base_angle)];
        self.view_state.enough_exaggeration = match self.session.scenario().base.moves() {
            true => exaggeration(motion, reach),
            false => 1.0,
        };
    }

    /// Makes the stage again when what it shows has changed.
    fn refresh(&mut self) {
        let key = stage_key(&self.session);
        if key != self.stage_of {
            let views = Views::of(self.session.run());
            for kind in ViewKind::ALL {
                // A camera that was not moved goes on showing everything.
                let camera = &mut self.view_state.cameras[kind as usize];
                if *camera == self.views.camera(kind) {
                    *camera = views.camera(kind);
                }
            }
            self.views = Arc::new(views);
            self.signals = signals(&self.session.scenario().machine);
            self.stage_of = key;
        }
        Arc::make_mut(&mut self.views).refresh(self.session.run());
        self.adjust();
        self.refresh_study();
        self.refresh_comparison();
        self.collect();
    }

    /// Studies the run on display, if its last study is of another; only the newest counts.
    fn refresh_study(&mut self) {
        if !self.view_state.study {
            (self.study, self.jobs.study) = (None, None);
            return;
        }
        let scenario = self.session.scenario();
        let known = self.jobs.study.as_ref().map(|(of, _)| of).or(self.study.as_ref().map(|(of, _)| of));
        if self.view_state.grabbed.is_some() || known == Some(scenario) {
            return;
        }
        self.jobs.study = None;
        match self.session.run().waiting() {
            Some(waiting) => self.study = Some((scenario.clone(), Err(waiting.why.to_string()))),
            None => {
                let run = self.session.run().clone();
                let job = self.start(move |ticket| match Study::watched(&run, &mut |done| ticket.goes_on(done)) {
                    Err(ToleranceError::Stopped) => None,
                    study => Some(study.map_err(|why| why.to_string())),
                });
                self.jobs.study = Some((scenario.clone(), job));
            }
        }
    }

    /// Runs the ways of the task on display, if those of the table are of another. Not during a drag.
    fn refresh_comparison(&mut self) {
        if !self.view_state.compare {
            (self.comparison, self.jobs.ways) = (None, None);
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
        let wanted = match &self.jobs.ways {
            Some((of, _)) => of != scenario,
            None => stale,
        };
        if !wanted || (!first && self.view_state.grabbed.is_some()) {
            return;
        }
        let of = scenario.clone();
        let job = self.start({
            let of = of.clone();
            move |ticket| run_ways(&of, &mut |done| ticket.goes_on(done))
        });
        self.jobs.ways = Some((of, job));
    }
}

/// A file that exists is not replaced from a window.
fn check_name(path: &Path) -> Result<(), String> {
    match path.exists() {
        true => Err(format!("{} exists: want another name", path.display())),
        false => Ok(()),
    }
}

/// The whole name of a file, so that it can be found again.
fn whole(path: &Path) -> String {
    path.canonicalize().unwrap_or_else(|_| path.into()).display().to_string()
}

/// Whether two scenarios differ in their tasks at most.
fn same_but_task(a: &Scenario, b: &Scenario) -> bool {
    a.machine == b.machine && a.plant == b.plant && a.control == b.control && a.base == b.base && a.step == b.step
}

/// What a stage depends on.
fn stage_key(session: &Session) -> (Machine, String) {
    let s = session.scenario();
    let differs = format!("{:?} {:?}", s.plant.length, s.plant.link);
    (s.machine.clone(), format!("{:?} {:?} {} {differs}", s.task, s.compare_b, session.run().motion().is_some()))
}
