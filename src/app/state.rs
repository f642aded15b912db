//! The [`AppState`]: a session, how it is shown, and what carries out commands. Every window, test and figure has one.

mod work;

use std::path::PathBuf;
use std::sync::Arc;

use super::background::{Background, File, Opening};
use super::change::{Change, Source};
use super::command::DesignCommand;
use super::facts::Facts;
use super::marks::{self, Marks};
use super::pace::Pace;
use super::saving::{self, Saving};
use super::tour::Tour;
use super::{
    Activity, Command, Finder, Framing, Intro, Layout, LeftOff, Panels, Preferences, Recovery, ViewState, compare,
    finder, keys, order, place, plots, rail, side, status, studio, study, theme, top, viewport,
};
use crate::app::widgets;
use crate::mechanics::machine::Machine;
use crate::picture::scene::exaggeration::exaggeration;
use crate::picture::scene::palette::Theme;
use crate::picture::scene::stage::Stage;
use crate::picture::scene::views::{ViewKind, Views};
use crate::query::Whole;
use crate::session::design::{briefed, weights_of};
use crate::session::scenario::Scenario;
use crate::session::{Ahead, Edit, Refusal, Session};
use crate::simulation::frame::Totals;
use crate::simulation::signals::{Signal, SignalsOf};
use crate::study::comparison::Comparison;

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
    /// What is under way beside the window.
    background: Background,
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
        self.view_state.theme = liked.theme;
        self.view_state.kept = liked.panels();
        let Panels { side, plots, .. } = self.view_state.kept[Layout::Explore as usize];
        (self.view_state.side, self.view_state.plots, self.view_state.swapped) = (side, plots, liked.swapped);
        self.view_state.learns = liked.learns;
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

    /// What of the session is in a file: how many changes there were, and whether some are in no file of the person's
    /// own.
    pub fn changes(&self) -> (u64, bool) {
        (self.saving.changes, self.saving.is_unsaved())
    }

    /// What belongs to the session and is in none of its edits.
    pub fn left_off(&self) -> LeftOff {
        LeftOff { time: self.session.frame().time, plots: self.view_state.charts.clone() }
    }

    /// Whether the window may close as it is.
    pub fn may_leave(&self) -> bool {
        self.saving.leaves || !(self.saving.is_unsaved() || self.is_making())
    }

    /// Whether a change is being made beside the window, and is in no count yet.
    fn is_making(&self) -> bool {
        let change = self.background.change.as_ref().map(|((change, _), _)| change);
        change.is_some_and(|change| !matches!(change, Change::Seek(_))) || !self.background.later.is_empty()
    }

    /// Whether the window is to close.
    pub fn wants_to_leave(&self) -> bool {
        self.saving.leaves
    }

    /// What stands above the window: the scenario, marked where changes are in no file.
    pub fn title(&self) -> String {
        let scenario = self.session.scenario();
        let name = if scenario.title.is_empty() { &scenario.name } else { &scenario.title };
        let mark = if self.saving.is_unsaved() { " *" } else { "" };
        format!("{}{mark} – Stillbase", crate::settings::text::brief(name))
    }

    /// Files that were opened and saved, newest first.
    pub fn recent(&self) -> &[PathBuf] {
        &self.saving.recent
    }

    /// The file of a session that was left behind, once it is not needed any more.
    pub fn take_recovered(&mut self) -> Option<PathBuf> {
        self.saving.recovered.take()
    }

    fn recover(&mut self, what: Recovery) {
        let Some((file, _)) = self.saving.found.take() else { return };
        match what {
            Recovery::Open => {
                let (from, news) = (Some(File::LeftBehind(file.clone())), Some("here is where you were".into()));
                self.open(
                    Source::Journal(file),
                    Opening { plays: false, closes: false, news, file: from, instead: None },
                );
            }
            Recovery::Forget => self.saving.recovered = Some(file),
            Recovery::Later => {}
        }
    }

    /// How it is liked, to be remembered; of a window so large, points.
    pub fn preferences(&self, size: [f32; 2]) -> Preferences {
        let ViewState { theme, layout, swapped, learns, .. } = self.view_state;
        let Panels { side, plots, .. } = self.view_state.panels(Layout::Explore);
        let compare = self.view_state.panels(Layout::Compare);
        Preferences {
            theme,
            size,
            hints: self.hints,
            layout,
            swapped,
            learns,
            compare_side: compare.side.shown,
            compare_side_width: compare.side.width,
            compare_plots: compare.plots.shown,
            compare_plots_width: compare.plots.width,
            side: side.shown,
            side_width: side.width,
            plots: plots.shown,
            plots_width: plots.width,
            recent: self.saving.recent.clone(),
        }
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

    /// Whether something is under way beside the window.
    pub fn is_working(&self) -> bool {
        self.background.is_busy()
    }

    /// What is under way beside the window, as far as it is spoken of.
    pub fn under_way(&self) -> Vec<Activity> {
        self.background.all_under_way().map(|(activity, _)| activity).collect()
    }

    /// Forgets all that is derived, so that it is made afresh: what is shown stays the same.
    pub fn forget(&mut self) {
        self.queries().forget_all();
        self.session.run().queries().forget_all();
        self.foresee();
        self.refresh();
    }

    /// Lets wall time pass, s.
    pub fn pass(&mut self, wall: f64) {
        // While the session is being changed, time stands: what is made has to fit what is shown.
        if self.background.is_changing() {
            self.owed = 0.0;
            self.pace.rest();
            return;
        }
        if let Some(from) = self.starts_over(wall) {
            self.session.seek(from);
            self.session.play();
        }
        if !self.session.is_moving() {
            self.owed = 0.0;
            self.pace.rest();
            return;
        }
        let dt = self.session.scenario().step;
        self.owed += wall.clamp(0.0, MOST_OWED) * self.view_state.speed;
        let wanted = (self.owed / dt).floor();
        self.owed -= wanted * dt;
        let (steps, before) = (wanted.min(self.pace.most_steps()), self.session.frame().step);
        self.session.tick(steps as u64);
        let done = self.session.frame().step.abs_diff(before) as f64;
        // What ends on the way is not slow.
        if self.session.is_moving() {
            self.pace.count(wall, done * dt, done, self.view_state.speed);
        } else {
            self.pace.rest();
        }
        self.adjust();
    }

    /// What the last [`pass`](Self::pass) has taken, s, from who reads a clock: steps that take long are done in smaller
    /// portions, so that the picture stays smooth.
    pub fn took(&mut self, seconds: f64) {
        self.pace.took(seconds);
    }

    /// Simulated seconds a second, where that is less than asked for.
    pub fn behind(&self) -> Option<f64> {
        self.pace.behind()
    }

    /// Where time goes back to, if it does, s: to the start in the first minute; while the run is played over and over to
    /// the start or to the beginning of the range that was chosen in the plots. After so much more wall time, s.
    fn starts_over(&mut self, wall: f64) -> Option<f64> {
        if self.intro.as_mut().is_some_and(|intro| intro.rests(&self.session, wall)) {
            return Some(0.0);
        }
        let [from, to] = self.view_state.charts.range.unwrap_or([0.0, f64::INFINITY]);
        let now = self.session.frame().time;
        (self.loops() && now > from && (now >= to || !self.session.is_moving())).then_some(from)
    }

    fn loops(&self) -> bool {
        self.view_state.loops && self.session.is_playing() && self.view_state.grabbed.is_none()
    }

    /// One pass of the user interface; commands are carried out at its end.
    pub fn ui(&mut self, ui: &mut egui::Ui) {
        self.dress(ui.ctx());
        // Panels lie on the cleared window and fill nothing; what fades out at their edges needs to know its colour.
        let behind = egui::Frame::new().fill(ui.visuals().panel_fill);
        let info = egui::UiStackInfo::new(egui::UiKind::Frame).with_frame(behind);
        ui.scope_builder(egui::UiBuilder::new().ui_stack_info(info), |ui| self.panels(ui));
    }

    fn panels(&mut self, ui: &mut egui::Ui) {
        if self.collect() | self.outline() {
            ui.ctx().request_repaint();
        }
        self.catch_up();
        self.background.count();
        if let Some(tour) = &mut self.view_state.tour {
            tour.follow(&self.session);
        }
        let beside = self.intro.as_ref().filter(|intro| intro.contrasts_in(ui.ctx().content_rect().width()));
        let beside = beside.and_then(Intro::beside_it).or(self.comparison.as_ref());
        let queries = self.queries().clone();
        let marks = Marks::of(&queries, &self.session, beside);
        if !marks.is_whole {
            ui.ctx().request_repaint();
        }
        let mut commands = Vec::new();
        // A question has the keys for itself.
        if !self.saving.has_question() {
            keys::read(ui.ctx(), &self.session, &self.view_state, &mut commands);
        }
        let presents = self.view_state.layout == Layout::Present;
        let facts = Facts::of(&queries, &self.session);
        if !presents {
            let (known, line) = ((&facts, &self.saving.recent[..]), (&marks, self.pace.behind()));
            top::show(ui, &self.session, known, line, &self.view_state, &mut commands);
            let under_way = self.background.under_way();
            status::show(ui, &self.session, &facts, &self.view_state, under_way, &mut commands);
            rail::show(ui, &self.session, &self.session.forks(), &self.view_state, &mut commands);
        }
        if let Some(comparison) = &self.comparison {
            compare::show(ui, comparison, &self.view_state, &mut commands);
        }
        if self.view_state.study {
            study::show(ui, self.study().as_deref(), self.session.frame().time, &self.view_state, &mut commands);
        }
        let contrast = self.intro.as_ref().filter(|intro| intro.contrasts_in(ui.ctx().content_rect().width()));
        let designs = self.view_state.view == ViewKind::Design && !presents;
        let mut chosen = Vec::new();
        if designs {
            let ViewState { learns, front_by, .. } = &self.view_state;
            let found = match learns {
                true => studio::Facts::learned(&queries, &self.session),
                false => studio::Facts::weighed(&queries, &self.session, *front_by),
            };
            studio::show(ui, &self.session, &found, &self.view_state, &mut commands);
            chosen = self.view_state.ghost.map_or_else(Vec::new, |i| found.weights(i));
        }
        if contrast.is_none() && self.view_state.side.shown && !designs {
            if let Some(thing) = self.view_state.revealed.take() {
                place::open(ui.ctx(), thing, &self.session);
            }
            if let Some(path) = self.view_state.looked_up.take() {
                side::look_up(ui.ctx(), &path);
            }
            self.view_state.side.width = side::show(ui, &self.session, &facts, &self.view_state, &mut commands);
        }
        self.view_state.lit = place::lit(ui.ctx());
        self.view_state.lit_links = place::lit_links(ui.ctx());
        if self.view_state.plots.shown && !designs {
            let beside = contrast.and_then(Intro::beside_it).or(self.comparison.as_ref());
            if std::mem::take(&mut self.looks) {
                plots::focus(ui.ctx());
            }
            let (session, signals, view_state) = (&self.session, &self.signals(), &self.view_state);
            let what = plots::Shown { session, queries: &queries, signals, comparison: beside, view_state };
            self.view_state.plots.width = plots::show(ui, &what, &mut commands);
        }
        let both = (self.comparison.as_ref(), self.intro.as_ref().filter(|_| !presents), &chosen[..]);
        let scene = viewport::show(ui, &self.session, &self.views, both, &mut self.view_state, &mut commands);
        status::news(ui.ctx(), scene, &self.session, &self.view_state, &mut commands);
        keys::help(ui.ctx(), &self.view_state, &mut commands);
        saving::show(ui.ctx(), &self.saving, &self.session, &self.view_state, &mut commands);
        let known = (&facts, &self.saving.recent[..]);
        finder::show(ui.ctx(), &self.session, known, &mut self.view_state, &mut commands);
        top::dialog(ui.ctx(), &mut self.view_state, &mut commands);
        commands.extend(widgets::refused_entry(ui.ctx()).map(Command::Refuse));
        if widgets::gave_up(ui.ctx()) {
            // Before its gesture ends.
            commands.insert(0, Command::GiveUp);
        }
        if commands.iter().any(|c| !matches!(c, Command::EndGesture | Command::Preview(_))) {
            self.view_state.message = None;
            self.view_state.left_branch = false;
            self.view_state.refused = None;
        }
        if !commands.is_empty() {
            ui.ctx().request_repaint();
        }
        for command in commands {
            let seen = self.intro.is_some().then(|| command.clone());
            self.carry_out(command);
            let held = self.view_state.grabbed.is_some();
            if let (Some(intro), Some(command)) = (&mut self.intro, seen) {
                intro.sees(&command, &self.session, held);
            }
        }
        if self.intro.as_ref().is_some_and(Intro::is_over) {
            (self.intro, self.hints) = (None, false);
        }
        if (self.session.is_moving() || self.loops()) && !self.background.is_changing() {
            ui.ctx().request_repaint();
        } else if self.background.is_busy() || self.intro.as_ref().is_some_and(Intro::is_resting) {
            ui.ctx().request_repaint_after_secs(SHOWN_AGAIN);
        }
    }

    fn dress(&mut self, ctx: &egui::Context) {
        self.background.wakes(ctx);
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

    /// Says something that the person did not ask for.
    pub(super) fn announce(&mut self, news: &str) {
        self.view_state.message = Some((news.into(), false));
    }

    /// Carries out one command, after those before it. A command that cannot be carried out changes nothing; a message
    /// says why.
    pub fn carry_out(&mut self, command: Command) {
        self.collect();
        self.catch_up();
        if self.waits(&command) {
            self.view_state.dragged |= self.view_state.grabbed.is_some() && matches!(command, Command::Edit(_));
            self.background.after(command);
        } else {
            self.do_now(command);
        }
    }

    fn do_now(&mut self, command: Command) {
        let done = self.attempt(command);
        self.tell(done);
        self.refresh();
    }

    /// An edit with what follows from it where a machine that is designed is kept balanced.
    fn designed(&mut self, edit: Edit) -> Result<Edit, String> {
        let Edit::Set { change } = &edit else { return Ok(edit) };
        if self.view_state.view != ViewKind::Design {
            return Ok(edit);
        }
        let scenario = self.session.scenario();
        if edit.sets_machine() {
            let start = self.designed_from.get_or_insert_with(|| scenario.machine.clone());
            return scenario.design.edit(&scenario.machine, start, change);
        }
        if edit.part("design").is_some() { briefed(scenario, change) } else { Ok(edit) }
    }

    fn design(&mut self, command: DesignCommand) -> Result<(), String> {
        match command {
            DesignCommand::Ghost(i) => self.view_state.ghost = i,
            DesignCommand::TakeStillest => {
                let placed = self.session.scenario().design.stillest(&self.session.scenario().machine);
                self.take_weights(&placed.map_err(|why| why.to_string())?.machine);
            }
            DesignCommand::FrontBy(by) => self.view_state.front_by = by,
            DesignCommand::Take(i) => {
                if let Some(machine) = studio::of_front(self.queries(), &self.session, i) {
                    self.take_weights(&machine);
                }
            }
        }
        Ok(())
    }

    /// Takes the counterweights of another machine.
    fn take_weights(&mut self, of: &Machine) {
        let edit = weights_of(self.session.scenario(), of);
        self.change(Change::Edit(edit));
    }

    fn attempt(&mut self, command: Command) -> Result<Option<String>, String> {
        match command {
            Command::Edit(edit) => {
                let edit = self.designed(edit)?;
                self.view_state.refused = None;
                self.change(Change::Edit(edit));
                self.view_state.dragged |= self.view_state.grabbed.is_some() && self.view_state.refused.is_none();
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
            Command::TakeHold => (self.view_state.stroke, self.view_state.pushing) = (None, false),
            Command::Exaggerate(on) => self.view_state.exaggerates_base = on,
            Command::EndGesture => {
                self.session.end_gesture();
                self.designed_from = None;
                let said = self.parted.take();
                self.view_state.left_branch |= said.is_some();
                return Ok(said);
            }
            Command::Design(command) => self.design(command)?,
            Command::TogglePlay if self.session.is_playing() => self.session.pause(),
            Command::TogglePlay => self.session.play(),
            Command::Seek(time) => self.change(Change::Seek(time)),
            Command::Bookmark(time, name) => {
                let done = self.session.bookmark(time, &name)?;
                self.saving.changes += u64::from(done.is_some());
                return Ok(done);
            }
            Command::NameBookmark(time) => self.name_bookmark(time)?,
            Command::ToMark(on) => {
                if let Some(time) = marks::beside(self.queries(), &self.session, on) {
                    self.change(Change::Seek(time));
                }
            }
            Command::Branch(branch) => self.change(Change::Branch(branch)),
            Command::CompareBranch(branch) => self.compare_branch(branch),
            Command::DropBranch(branch) => {
                let done = self.session.drop_branch(branch);
                self.saving.changes += u64::from(done.is_some());
                return Ok(done);
            }
            Command::Step(steps) => self.session.step_by(steps),
            Command::Speed(speed) => self.view_state.speed = speed,
            Command::Loop(loops) => self.view_state.loops = loops,
            Command::Open(scenario) => {
                self.open(
                    Source::Scenario(scenario),
                    Opening { plays: true, closes: false, news: None, file: None, instead: None },
                );
            }
            Command::Case(name) => self.open_case(name),
            Command::BackToPath if self.session.is_led() => self.change(Change::BackToPath),
            Command::BackToPath => {}
            Command::TurnTask(turn) => self.view_state.turn_task = turn,
            Command::Refuse(why) => return Err(why),
            Command::OpenFile(path) => self.open_file(path),
            Command::SaveFile(path) => self.save(&path)?,
            Command::Record(path) => self.record(&path)?,
            Command::Undo => self.change(Change::Undo),
            Command::TakeBack(since) if self.session.undo_count() > since => self.change(Change::Undo),
            Command::TakeBack(_) => {}
            Command::GiveUp if self.session.is_in_gesture() => self.change(Change::Undo),
            Command::GiveUp => {}
            Command::Redo => self.change(Change::Redo),
            Command::Cancel(activity) => return Ok(Some(self.cancel(activity))),
            Command::View(view) => self.show_view(view),
            Command::Learn(learns) => {
                self.view_state.learns = learns;
                // The front is out of sight.
                self.view_state.ghost = None;
                if learns {
                    self.view_state.plots.shown = true;
                    self.show_view(ViewKind::Design);
                }
            }
            Command::Dexterity(shown) => self.view_state.dexterity = shown,
            Command::Fit => self.view_state.framing[self.view_state.view as usize] = Framing::Wanted,
            Command::Theme(theme) => self.view_state.theme = theme,
            Command::AskToLeave(asks) => self.saving.asks = asks,
            Command::Quit if !self.may_leave() => self.saving.asks = true,
            Command::Quit | Command::Leave => (self.saving.asks, self.saving.leaves) = (false, true),
            Command::Recover(what) => self.recover(what),
            Command::SkipHints => {
                self.hints &= self.intro.is_none();
                self.intro = None;
            }
            Command::Reveal(thing) => {
                self.view_state.side.shown = true;
                self.view_state.revealed = Some(thing);
            }
            Command::LookUp(path) => {
                self.view_state.side.shown = true;
                if self.view_state.view == ViewKind::Design {
                    self.show_view(ViewKind::Flat);
                }
                self.view_state.looked_up = Some(path);
            }
            Command::Side(shown) => self.view_state.side.shown = shown,
            Command::Plots(shown) => self.view_state.plots.shown = shown,
            Command::Panels(shown) => {
                (self.view_state.side.shown, self.view_state.plots.shown) = (shown, shown);
            }
            Command::Layout(layout) => self.view_state.lay_out(layout),
            Command::Swap(swapped) => self.view_state.swapped = swapped,
            Command::History(shown) => self.view_state.history = shown,
            Command::GoTo(changes) => self.change(Change::GoTo(changes)),
            Command::Look(look) => self.view_state.look(look),
            Command::Find(find) => self.view_state.finder = find.then(Finder::default),
            Command::Help(help) => self.view_state.help = help,
            Command::Tour(begins) => {
                // One guide at a time; what was not done of the hints may come again.
                self.intro = self.intro.take().filter(|_| !begins);
                self.view_state.help &= !begins;
                self.view_state.tour = begins.then(|| Tour::begin(&self.session));
            }
            Command::TurnTour(forward) => {
                let tour = self.view_state.tour.take();
                self.view_state.tour = tour.and_then(|tour| tour.turned(forward, &self.session));
            }
            Command::Times(shown) => self.view_state.times = shown,
            Command::Mark(time) => self.view_state.mark = time,
            Command::Charts(change) => self.view_state.charts.change(change),
            Command::LookFor => {
                self.view_state.plots.shown = true;
                self.looks = true;
            }
            Command::WritePlot(path, plot, file) => self.write_plot(&path, &plot, file)?,
            Command::TakeElsewhere(path) => self.take_elsewhere(&path)?,
            Command::Snapshots(shown) => self.view_state.snapshots = shown,
            // The window has room for one of the two panels.
            Command::Compare(compare) => {
                (self.view_state.compare, self.view_state.study) = (compare, self.view_state.study && !compare)
            }
            Command::Study(study) => {
                (self.view_state.study, self.view_state.compare) = (study, self.view_state.compare && !study)
            }
            Command::Pins(shown) => self.view_state.pins = shown,
            Command::Drives(drives) => {
                self.view_state.drives = drives;
                self.view_state.framing[ViewKind::Joints as usize].renew();
            }
            Command::Comparison(on) => self.change_comparison(on),
            Command::Dialog(dialog) => self.view_state.dialog = dialog,
            Command::Replace(file) => self.saving.replaces = Some(file),
        }
        Ok(None)
    }

    /// The signals of the machine on display.
    fn signals(&self) -> Arc<Vec<Signal>> {
        self.queries().ask::<Whole<SignalsOf>>(&self.session.scenario().machine)
    }

    fn show_view(&mut self, view: ViewKind) {
        if view == ViewKind::Design {
            // What is designed stands still.
            self.session.pause();
        }
        self.view_state.view = view;
    }

    /// Asks for the name of a bookmark; where there is none it is put there.
    fn name_bookmark(&mut self, time: Option<f64>) -> Result<(), String> {
        if let Some(time) = time.filter(|time| self.session.bookmark_at(*time).is_none()) {
            let name = self.session.free_name();
            self.saving.changes += u64::from(self.session.bookmark(time, &name)?.is_some());
        }
        self.view_state.naming = time;
        Ok(())
    }

    /// Finds how many times the motion of the base has to be enlarged to be seen, from as much of the run as is known.
    fn adjust(&mut self) {
        let reach = self.views.stage().linkage().reach();
        let newest = self.session.frames().last().map_or_else(Totals::default, |frame| frame.totals);
        let ahead = self.queries().last::<Ahead>().map_or_else(Totals::default, |totals| *totals);
        let motion = [newest.shift.max(ahead.shift), newest.base_angle.max(ahead.base_angle)];
        self.view_state.enough_exaggeration = match self.session.scenario().base.moves() {
            true => exaggeration(motion, reach),
            false => 1.0,
        };
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
        if !views.looks_like(&self.views) || (is_outlined && self.view_state.grabbed.is_none()) {
            self.view_state.framing.iter_mut().for_each(Framing::renew);
        }
        self.views = views;
    }

    /// Shows what follows from the session as it is now.
    fn refresh(&mut self) {
        self.refresh_views();
        self.adjust();
        self.refresh_study();
        self.refresh_comparison();
        self.collect();
    }
}
