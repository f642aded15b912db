//! The [`AppState`]: a session, how it is shown, and what carries out commands. Every window, test and figure has one.

mod beside;
mod carry_out;
mod changing;
mod designing;
mod given;
mod opening;
mod pass;
mod time;
mod writing;

use std::path::PathBuf;
use std::sync::Arc;

use super::background::Background;
use super::change::Change;
use super::given::assess::Given;
use super::pace::Pace;
use super::saving::Saving;
use super::{Activity, Framing, Intro, Layout, LeftOff, Preferences, SessionCommand, ViewState};
use crate::mechanics::machine::Machine;
use crate::picture::scene::exaggeration::exaggeration;
use crate::picture::scene::palette::Theme;
use crate::picture::scene::stage::Stage;
use crate::picture::scene::views::{ViewKind, Views};
use crate::query::{Queries, Query, Whole, Workers};
use crate::session::scenario::Scenario;
use crate::session::{Ahead, Edit, Refusal, Session};
use crate::simulation::frame::Totals;
use crate::simulation::signals::{Signal, SignalsOf};
use crate::study::comparison::Comparison;
use crate::study::fronts::FrontOf;
use crate::study::lengths::Seeking;

/// A session on display.
pub struct AppState {
    session: Session,
    /// The views on display: framing follows where others take their place.
    views: Arc<Views>,
    /// The machine before the change under way in that view.
    designed_from: Option<Machine>,
    view_state: ViewState,
    /// What is left of the first minute, and whether it is to be shown at the next start.
    intro: Option<Intro>,
    hints: bool,
    /// What of the session is in a file.
    saving: Saving,
    /// Runs side by side, while they are on display.
    comparison: Option<Comparison>,
    /// Machines whose fronts are drawn beside that of the machine that is designed.
    fronts: Vec<FrontOf>,
    /// The lengths that are sought, or were found.
    seeking: Option<<Seeking as Query>::Input>,
    /// The table that was opened last.
    given: Option<Given>,
    /// What is under way beside the window.
    background: Background<Self>,
    /// Wall time not yet turned into steps, s.
    owed: f64,
    pace: Pace,
    /// What there is to say of a branch that the gesture under way has left.
    parted: Option<String>,
    dressed: Option<Theme>,
    fonts: bool,
    /// A signal is to be sought in the next pass.
    looks: bool,
}

impl AppState {
    /// Opens a scenario.
    ///
    /// # Errors
    /// If it cannot start.
    pub fn new(scenario: Scenario, theme: Theme) -> Result<Self, Refusal> {
        Ok(Self::around(Session::open(scenario)?, theme))
    }

    fn around(session: Session, theme: Theme) -> Self {
        let background = Background::default();
        let views = Views::made(&background.queries, session.run(), None);
        let view_state = ViewState::new(theme, &views);
        let mut app_state = Self {
            designed_from: None,
            views,
            session,
            view_state,
            intro: None,
            hints: true,
            saving: Saving::default(),
            comparison: None,
            given: None,
            fronts: Vec::new(),
            seeking: None,
            background,
            owed: 0.0,
            pace: Pace::default(),
            parted: None,
            dressed: None,
            fonts: false,
            looks: false,
        };
        app_state.foresee();
        app_state
    }

    /// The same as a person likes it, with the first minute if that is still to come.
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
        if liked.hints && usual && liked.layout == Layout::Explore {
            self.intro = Intro::beside(&self.session).ok();
        }
        self
    }

    /// The same with a session that a program left behind: its file, and when that was written, in words.
    #[must_use]
    pub fn finding(mut self, left: Option<(PathBuf, String)>) -> Self {
        self.saving.found = left;
        self
    }

    /// The same with somebody who works beside it.
    #[must_use]
    pub fn with_workers(mut self, workers: impl Workers + Send + Sync + 'static) -> Self {
        self.background.hire(workers);
        self
    }

    /// How it is liked, to be remembered; of a window so large, points.
    pub fn preferences(&self, size: [f32; 2]) -> Preferences {
        Preferences::of(&self.view_state.arrangement, size, self.hints, &self.saving.recent)
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
        app_state.carry_out(SessionCommand::Edit(Edit::of("task", change)));
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

    /// What is derived of the session.
    pub(super) fn queries(&self) -> &Queries {
        &self.background.queries
    }

    /// Files that were opened and saved, newest first.
    pub fn recent(&self) -> &[PathBuf] {
        &self.saving.recent
    }

    /// What belongs to the session and is in none of its edits.
    pub fn left_off(&self) -> LeftOff {
        LeftOff { time: self.session.frame().time, plots: self.view_state.charts.clone() }
    }

    /// What stands above the window: the scenario, marked where changes are in no file.
    pub fn title(&self) -> String {
        let scenario = self.session.scenario();
        let name = if scenario.title.is_empty() { &scenario.name } else { &scenario.title };
        let mark = if self.saving.is_unsaved() { " *" } else { "" };
        format!("{}{mark} – Stillbase", crate::settings::text::brief(name))
    }

    /// What of the session is in a file: how many changes there were, and whether some are in no file of the person's
    /// own.
    pub fn changes(&self) -> (u64, bool) {
        (self.saving.changes, self.saving.is_unsaved())
    }

    /// Whether the window may close as it is.
    pub fn may_leave(&self) -> bool {
        self.saving.leaves || !(self.saving.is_unsaved() || self.is_making())
    }

    /// Whether a change is being made beside the window, and is in no count yet.
    fn is_making(&self) -> bool {
        let change = self.background.change.as_ref();
        change.is_some_and(|(change, _)| !matches!(change, Change::Seek(_))) || !self.background.later.is_empty()
    }

    /// Whether the window is to close.
    pub fn wants_to_leave(&self) -> bool {
        self.saving.leaves
    }

    /// The file of a session that was left behind, once it is not needed any more.
    pub fn take_recovered(&mut self) -> Option<PathBuf> {
        self.saving.recovered.take()
    }

    /// Whether something is under way beside the window.
    pub fn is_working(&self) -> bool {
        self.background.is_busy()
    }

    /// What is under way beside the window, as far as it is spoken of.
    pub fn under_way(&self) -> Vec<Activity> {
        self.background.all_under_way().into_iter().map(|(activity, _)| activity).collect()
    }

    /// Says how something went.
    pub(super) fn tell(&mut self, said: Result<Option<String>, String>) {
        match said {
            Ok(None) => {}
            Ok(Some(news)) => self.view_state.said.message = Some((news, false)),
            Err(problem) => self.view_state.said.message = Some((problem, true)),
        }
    }

    /// Says something that the person did not ask for.
    pub(super) fn announce(&mut self, news: &str) {
        self.view_state.said.message = Some((news.into(), false));
    }

    /// How many times the motion of the base is shown: as often as it takes to be seen, from as much of the run as is
    /// known.
    pub fn base_exaggeration(&self) -> f64 {
        if !self.view_state.exaggerates_base || !self.session.scenario().base.moves() {
            return 1.0;
        }
        let newest = self.session.frames().last().map_or_else(Totals::default, |frame| frame.totals);
        let ahead = self.queries().last::<Ahead>().map_or_else(Totals::default, |totals| *totals);
        let motion = [newest.shift.max(ahead.shift), newest.base_angle.max(ahead.base_angle)];
        exaggeration(motion, self.views.stage().linkage().reach())
    }

    /// The signals of the machine on display.
    fn signals(&self) -> Arc<Vec<Signal>> {
        self.queries().ask::<Whole<SignalsOf>>(&self.session.scenario().machine)
    }

    /// Forgets all that is derived, so that it is made afresh: what is shown stays the same.
    pub fn forget(&mut self) {
        self.queries().forget_all();
        self.session.run().queries().forget_all();
        self.foresee();
        self.refresh();
    }

    /// Shows the views of the run as it is now.
    fn refresh_views(&mut self) {
        let (run, queries) = (self.session.run(), self.queries());
        let made = Views::made(queries, run, None);
        let views = Views::completed(&made, queries, run, Some(self.view_state.drives));
        if Arc::ptr_eq(&views, &self.views) {
            return;
        }
        if Views::has(self.view_state.view, run).is_err() {
            self.view_state.view = ViewKind::Flat;
        }
        // A camera that was not moved goes on showing everything; limits that are pulled at move nothing under the hand.
        let is_outlined = self.views.unoutlined().is_some() && views.unoutlined().is_none();
        if !views.looks_like(&self.views) || (is_outlined && self.view_state.gesture.grabbed.is_none()) {
            self.view_state.framing.iter_mut().for_each(Framing::renew);
        }
        self.views = views;
    }

    /// Shows what follows from the session as it is now.
    fn refresh(&mut self) {
        self.refresh_views();
        self.refresh_study();
        self.refresh_comparison();
        self.refresh_given();
        self.refresh_seeking();
        self.refresh_fronts();
        self.collect();
    }
}
