//! The [`AppState`]: a session, its view state, and the execution of commands. Every window, test and figure has one.

mod aside;
mod background;
mod carry_out;
mod changing;
mod copy;
mod designing;
mod exporting;
mod given;
mod opening;
mod pass;
mod plot_window;
mod time;
mod watching;
mod writing;

use std::path::PathBuf;
use std::sync::Arc;

use super::background::Background;
use super::change::SessionChange;
use super::given::assess::OpenedTable;
use super::pace::PlaybackRate;
use super::pair::Pair;
use super::saved_runs::SavedRuns;
use super::saving::{LeftSession, Saving};
use super::watched_file::WatchedFile;
use super::{Activity, Framing, Intro, Layout, Message, Preferences, ResumePoint, SessionCommand, ViewState};
use stillbase_mechanics::machine::Machine;
use stillbase_picture::scene::blocks::BlockStages;
use stillbase_picture::scene::exaggeration::{exaggeration, exaggeration_kept};
use stillbase_picture::scene::palette::Theme;
use stillbase_picture::scene::stage::Stage;
use stillbase_picture::scene::views::{ViewKind, Views};
use stillbase_query::{Queries, Query, QuickWork, Workers};
use stillbase_session::scenario::Scenario;
use stillbase_session::{Edit, Refusal, RunAhead, Session};
use stillbase_simulation::frame::Totals;
use stillbase_simulation::signals::{Signal, SignalsOf};
use stillbase_study::comparison::Comparison;
use stillbase_study::fronts::FrontCase;
use stillbase_study::lengths::LengthsQuery;

/// A session on display.
pub struct AppState {
    session: Session,
    /// The views on display; the framing may be renewed when they are replaced.
    views: Arc<Views>,
    /// The machine before the gesture under way in the design view.
    designed_from: Option<Machine>,
    view_state: ViewState,
    /// The other blocks of the assembly of which the machine is one.
    blocks: Option<BlockStages>,
    /// The person's own session while the tour or the hints are on display.
    aside: Option<Box<aside::SetAside>>,
    /// The hints while they are shown, and whether to show them at the next start.
    intro: Option<Intro>,
    hints: bool,
    /// Record of saved and unsaved changes, with the questions about unsaved ones.
    saving: Saving,
    /// The file of the session, which other programs may change.
    watched: Option<WatchedFile>,
    /// Runs side by side, while they are on display.
    comparison: Option<Comparison>,
    /// What the table of runs holds while it is closed, and runs that are still to be made for it.
    runs: SavedRuns,
    /// Machines whose Pareto fronts are drawn beside that of the machine being designed.
    fronts: Vec<FrontCase>,
    /// Request of the search for link lengths, under way or finished.
    seeking: Option<<LengthsQuery as Query>::Input>,
    /// The table opened last.
    opened_table: Option<OpenedTable>,
    /// [`Self::base_motion`] before the machine was dragged off its plan.
    motion_before_drag: Option<[f64; 2]>,
    /// Work in the background.
    background: Background<Self>,
    /// Simulated time that is due but not simulated yet, s.
    due_s: f64,
    pace: PlaybackRate,
    /// Message about the branch that the current gesture has left.
    branch_message: Option<String>,
    applied_theme: Option<Theme>,
    has_fonts: bool,
    /// Whether the next pass moves the keyboard focus to the search for signals.
    focuses_search: bool,
    /// Text for the clipboard, taken with the next frame.
    clipboard: Option<String>,
}

impl AppState {
    /// Opens a scenario.
    ///
    /// # Errors
    /// If the scenario cannot start.
    pub fn new(scenario: Scenario, theme: Theme) -> Result<Self, Refusal> {
        Ok(Self::around(Session::open(scenario)?, theme))
    }

    fn around(session: Session, theme: Theme) -> Self {
        let background = Background::default();
        let views = Views::base_views(&background.queries, session.run(), None);
        let view_state = ViewState::new(theme, &views);
        let blocks = BlockStages::of(session.run(), views.stage());
        let mut app_state = Self {
            designed_from: None,
            views,
            session,
            blocks,
            view_state,
            aside: None,
            intro: None,
            hints: true,
            saving: Saving::default(),
            watched: None,
            comparison: None,
            runs: SavedRuns::default(),
            opened_table: None,
            motion_before_drag: None,
            fronts: Vec::new(),
            seeking: None,
            background,
            due_s: 0.0,
            pace: PlaybackRate::default(),
            branch_message: None,
            applied_theme: None,
            has_fonts: false,
            focuses_search: false,
            clipboard: None,
        };
        app_state.show_blocks();
        app_state.run_ahead();
        app_state
    }

    /// Chooses the view that shows all blocks of an assembly.
    fn show_blocks(&mut self) {
        if self.session.scenario().assembly.is_some() && self.view_state.view == ViewKind::Flat {
            self.view_state.view = ViewKind::Space;
        }
    }

    /// Applies the user's preferences, and starts the introduction if the preferences and the scenario call for it.
    #[must_use]
    pub fn with_preferences(mut self, liked: &Preferences) -> Self {
        self.view_state.arrangement = liked.arrangement();
        if liked.layout != Layout::Explore {
            self.view_state.lay_out(liked.layout);
            self.refresh();
        }
        self.hints = liked.hints;
        self.saving.recent.clone_from(&liked.recent);
        let usual = Scenario::builtin("case-3").is_some_and(|case| case == *self.session.scenario());
        if liked.hints && usual && self.watched.is_none() && liked.layout == Layout::Explore {
            // Nothing was done yet: the hints accompany the person's own session, and set none aside.
            self.intro = Some(Intro::of(&self.session));
            self.view_state.pair = Some(Pair::demonstration());
            self.refresh();
        }
        self
    }

    /// Offers to recover a session left by an earlier program run.
    #[must_use]
    pub fn offering_recovery(mut self, left: Option<LeftSession>) -> Self {
        self.saving.left_session = left;
        self
    }

    /// Sets the worker threads for work in the background.
    #[must_use]
    pub fn with_workers(mut self, workers: impl Workers + Send + Sync + 'static) -> Self {
        self.background.set_workers(workers);
        self
    }

    /// Returns the preferences to be stored, for a window of this size, points.
    pub fn preferences(&self, size: [f32; 2]) -> Preferences {
        let mut arrangement = self.view_state.arrangement.clone();
        if self.intro.is_none() {
            // The tour arranges the window in its own way.
            arrangement = self.own_view_state().arrangement.clone();
            arrangement.theme = self.view_state.arrangement.theme;
        }
        Preferences::of(&arrangement, size, self.hints, &self.saving.recent)
    }

    /// Opens a scenario. If its task cannot be planned, opens its machine with the paper's task and shows the reason.
    /// If that cannot be planned either, the machine waits in its start pose.
    ///
    /// # Errors
    /// If the waiting session cannot start either.
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
        app_state.carry_out(SessionCommand::Edit(Edit::of("task", change)));
        Ok(app_state)
    }

    /// The session.
    pub fn session(&self) -> &Session {
        &self.session
    }

    /// The view state.
    pub fn view_state(&self) -> &ViewState {
        &self.view_state
    }

    /// Runs side by side, while they are on display.
    pub fn comparison(&self) -> Option<&Comparison> {
        self.comparison.as_ref()
    }

    /// The stage from which scenes are made.
    pub fn stage(&self) -> &Stage {
        self.views.stage()
    }

    /// The linked views.
    pub fn views(&self) -> &Views {
        &self.views
    }

    /// The queries about the session.
    pub(super) fn queries(&self) -> &Queries {
        &self.background.queries
    }

    /// Recently opened and saved files, newest first.
    pub fn recent(&self) -> &[PathBuf] {
        &self.saving.recent
    }

    /// Returns the file of the session, and the state of the display that no edit contains, such as the instant.
    pub fn left_off(&self) -> ResumePoint {
        let file = self.own_saving().own_file(self.own_session().undo_count()).cloned();
        let runs = self.own_runs();
        ResumePoint { file, runs, ..ResumePoint::of_view(self.own_session(), self.own_view_state()) }
    }

    /// Returns the window title: the file, if there is one, and the scenario, with ` *` if there are unsaved changes.
    pub fn title(&self) -> String {
        let name = run_name(self.own_session().scenario());
        let mark = if self.own_saving().is_unsaved() { " *" } else { "" };
        let file = self.own_saving().own_file(self.own_session().undo_count()).and_then(|file| file.file_name());
        let name = match file {
            Some(file) => format!("{}{mark} – {name}", file.display()),
            None => format!("{name}{mark}"),
        };
        format!("{} – Stillbase", stillbase_settings::text::shorten_message(&name))
    }

    /// Returns the number of changes of the person's own session so far, and whether some are in no file of the user.
    pub fn changes(&self) -> (u64, bool) {
        (self.own_saving().changes, self.own_saving().is_unsaved())
    }

    /// Whether the window may close without a question.
    pub fn may_leave(&self) -> bool {
        self.saving.leaves || !(self.own_saving().is_unsaved() || (self.aside.is_none() && self.is_making()))
    }

    /// Whether a change is being made in the background that the count of changes does not contain yet.
    fn is_making(&self) -> bool {
        let change = self.background.change.as_ref();
        change.is_some_and(|(change, _)| !matches!(change, SessionChange::Seek(_)))
            || !self.background.waiting_commands.is_empty()
    }

    /// Whether the window must close.
    pub fn wants_to_leave(&self) -> bool {
        self.saving.leaves
    }

    /// Takes the path of the recovered or discarded session out of this state; the caller deletes the file later.
    pub fn take_recovered(&mut self) -> Option<PathBuf> {
        self.saving.recovered.take()
    }

    /// Whether work is under way in the background.
    pub fn is_working(&self) -> bool {
        self.background.is_busy()
    }

    /// Returns the activities in the background that are reported to the user.
    pub fn under_way(&self) -> Vec<Activity> {
        self.background.all_under_way().into_iter().map(|(activity, _)| activity).collect()
    }

    /// Shows the outcome of a command as the message.
    pub(super) fn show_outcome(&mut self, said: Result<Option<String>, String>) {
        if !matches!(said, Ok(None)) {
            self.view_state.status.proposals.clear();
            self.view_state.status.entry = None;
        }
        match said {
            Ok(None) => {}
            Ok(Some(text)) => self.view_state.status.message = Some(Message { text, is_problem: false }),
            Err(text) => self.view_state.status.message = Some(Message { text, is_problem: true }),
        }
    }

    /// Shows a message that no command has caused.
    pub(super) fn announce(&mut self, news: &str) {
        self.view_state.status.message = Some(Message { text: news.into(), is_problem: false });
    }

    /// Returns the factor by which the drawn motion of the base is enlarged, so that it can be seen. It depends on the
    /// largest base motion of the run, as far as the run is computed.
    pub fn base_exaggeration(&self) -> f64 {
        // A plan that accounts for the base puts the end effector where it is to be; enlarged, it would seem to miss.
        let is_planned = self.session.frames().first().is_some_and(|frame| frame.base_is_planned);
        if !self.view_state.exaggerates_base || !self.session.scenario().base.moves() || is_planned {
            return 1.0;
        }
        let (motion, reach) = (self.base_motion(), self.views.stage().linkage().reach());
        // A hand that leads the machine off its plan finds the picture as it was.
        match self.motion_before_drag.filter(|_| self.session.is_dragged()) {
            Some(before) => exaggeration_kept(before, motion, reach),
            None => exaggeration(motion, reach),
        }
    }

    /// Returns the largest displacement of the base, m, and its largest rotation, rad, of the run as far as it is known.
    fn base_motion(&self) -> [f64; 2] {
        let newest = self.session.frames().last().map_or_else(Totals::default, |frame| frame.totals);
        let ahead = self.queries().last::<RunAhead>().map_or_else(Totals::default, |totals| *totals);
        [newest.shift.max(ahead.shift), newest.base_angle.max(ahead.base_angle)]
    }

    /// The signals of the machine on display.
    fn signals(&self) -> Arc<Vec<Signal>> {
        let (machine, shared) = (&self.session.scenario().machine, self.session.frame().shared.map(|base| base.moves));
        let is_known = |known: &(Machine, Option<bool>)| known.0 == *machine && known.1 == shared;
        self.queries().ask_if::<QuickWork<SignalsOf>>(is_known, || (machine.clone(), shared))
    }

    /// Clears all cached queries, so that they are computed anew; the display stays the same.
    pub fn forget(&mut self) {
        self.queries().forget_all();
        self.session.run().queries().forget_all();
        self.run_ahead();
        self.refresh();
    }

    /// Updates the views for the current run.
    fn refresh_views(&mut self) {
        let (run, queries) = (self.session.run(), self.queries());
        let made = Views::base_views(queries, run, None);
        let views = Views::completed(&made, queries, run, Some(self.view_state.drives));
        let had_others = self.blocks.is_some();
        if !self.blocks.as_ref().is_some_and(|blocks| blocks.is_of(run)) {
            self.blocks = BlockStages::of(run, views.stage());
            if had_others || self.blocks.is_some() {
                self.view_state.framing.iter_mut().for_each(Framing::renew);
            }
        }
        if Arc::ptr_eq(&views, &self.views) {
            self.refresh_blocks();
            return;
        }
        if Views::has(self.view_state.view, run).is_err() {
            self.view_state.view = ViewKind::Flat;
        }
        // A camera that the user has not moved continues to show everything. The view stays still while a joint limit
        // is dragged.
        let is_outlined = self.views.unoutlined().is_some() && views.unoutlined().is_none();
        let draws = self.view_state.drawing_pen().is_some();
        if draws {
            // The view of a drawing stays still while its machine changes.
        } else if !views.looks_like(&self.views) || (is_outlined && self.view_state.gesture.grabbed.is_none()) {
            self.view_state.framing.iter_mut().for_each(Framing::renew);
        }
        self.views = views;
        self.refresh_blocks();
    }

    /// Updates what blocks of an assembly reach for the frame on display.
    fn refresh_blocks(&mut self) {
        if let Some(blocks) = &mut self.blocks {
            blocks.refresh(self.views.stage(), self.session.frame(), self.session.others());
        }
    }

    /// Updates everything that depends on the session.
    fn refresh(&mut self) {
        self.refresh_views();
        self.refresh_study();
        self.refresh_proposals();
        self.refresh_comparison();
        self.refresh_pair();
        self.refresh_given();
        self.refresh_seeking();
        self.refresh_fronts();
        self.collect();
    }
}

/// Returns the title of a run, or the name of a run without one.
fn run_name(scenario: &Scenario) -> &str {
    if scenario.title.is_empty() { &scenario.name } else { &scenario.title }
}
