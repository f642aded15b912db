//! One pass of the user interface.

use egui::ViewportId;

use super::AppState;
use super::plot_window::laid_over;
use crate::export::{self, DisplaySize};
use crate::facts::ScenarioFacts;
use crate::finder::FinderContent;
use crate::marks::Marks;
use crate::sketching::{SketchFacts, SketchScene};
use crate::status::news::News;
use crate::{
    BottomPanel, Command, DrawingGuard, Intro, Layout, SessionCommand, StatusMessage, ViewChange, WindowCommand,
    compare, file_report, finder, focus, given, guide, keys, notation, notes, order, place, plots, rail, saving, side,
    sketching, status, studio, study, theme, top, viewport, watched_file, widgets,
};
use stillbase_picture::scene::views::ViewKind;
use stillbase_session::Session;
use stillbase_study::comparison::Comparison;

/// Time between two repaints that show progress, s.
const PROGRESS_INTERVAL_S: f32 = 0.1;

impl AppState {
    /// Returns a guard to be kept while the window is drawn. Background work other than short jobs starts only when
    /// the guard is dropped, so that the work does not delay the drawing.
    #[must_use]
    pub fn drawing(&self) -> DrawingGuard {
        self.background.drawing()
    }

    /// Runs one pass of the user interface; the commands of its panels are carried out at the end.
    pub fn ui(&mut self, ui: &mut egui::Ui) {
        self.apply_style(ui.ctx());
        notation::set(ui.ctx(), self.view_state.notation());
        if let Some(field) = self.view_state.asked_field.take() {
            focus::ask(ui.ctx(), field);
        }
        // Panels have no fill; content that fades out at their edges needs the background colour.
        let behind = egui::Frame::new().fill(ui.visuals().panel_fill);
        let info = egui::UiStackInfo::new(egui::UiKind::Frame).with_frame(behind);
        ui.scope_builder(egui::UiBuilder::new().ui_stack_info(info), |ui| self.panels(ui));
    }

    fn panels(&mut self, ui: &mut egui::Ui) {
        if self.collect() | self.outline() {
            ui.ctx().request_repaint();
        }
        if !self.session.is_dragged() {
            self.motion_before_drag = Some(self.base_motion());
        }
        if let Some(text) = self.clipboard.take() {
            ui.ctx().copy_text(text);
        }
        self.catch_up();
        self.keep_plot_windows(ui.ctx());
        self.background.count_repaint();
        if let Some(tour) = &mut self.view_state.open.tour {
            tour.follow(&self.session);
        }
        let other = self.view_state.pair.as_ref().and_then(|_| self.beside());
        let beside = laid_over(other.as_deref(), self.comparison.as_ref());
        self.view_state.charts.wheels_differ = wheels_differ(&self.session, beside);
        let queries = self.queries().clone();
        let marks = Marks::of(&queries, &self.session, beside);
        if !marks.is_whole {
            ui.ctx().request_repaint();
        }
        let mut commands = Vec::new();
        // While a question is open, it alone receives the keys.
        if self.saving.has_question() {
            saving::keep_keys(ui.ctx());
        } else {
            keys::read(ui.ctx(), &self.session, &self.view_state, &mut commands);
        }
        let presents = self.view_state.arrangement.layout == Layout::Present;
        let facts = ScenarioFacts::of(&queries, &self.session, self.stated_in_file());
        if !presents {
            let line = (&marks, self.pace.lagging_rate());
            top::show(ui, &self.session, &facts, &self.saving.recent, line, &self.view_state, &mut commands);
            let under_way = self.background.under_way();
            let improvements = || self.improvements();
            status::show(ui, &self.session, &facts, &improvements, &self.view_state, under_way, &mut commands);
            rail::show(ui, &self.session, &self.session.forks(), &self.view_state, &mut commands);
        }
        if let Some(comparison) = &self.comparison {
            compare::show(ui, comparison, &self.view_state, &mut commands);
        }
        if self.view_state.below == Some(BottomPanel::Tolerances) {
            study::show(ui, self.study().as_deref(), self.session.frame().time, &self.view_state, &mut commands);
        }
        if let Some(table) = self.opened_table.as_ref().filter(|_| self.view_state.below == Some(BottomPanel::Table)) {
            let found = self.assessed();
            let is_known = found.as_ref().is_some_and(|(_, is_known)| *is_known);
            let shown = given::TableView { table, answer: found.as_ref().map(|(answer, _)| &**answer), is_known };
            given::show(ui, shown, &self.view_state, &mut commands);
        }
        let width = ui.ctx().content_rect().width();
        let contrasts = self.view_state.pair.as_ref().is_some_and(|pair| pair.hides_settings(width));
        let designs = self.view_state.view == ViewKind::Design && !presents;
        let drawing = self.view_state.drawing_pen().map(|pen| SketchFacts::of(&queries, &self.session, pen));
        if let Some((drawing, pen)) = drawing.as_ref().zip(self.view_state.pen.as_mut()) {
            pen.keep_to(&drawing.sketch);
        }
        let draws = drawing.is_some();
        let mut chosen = Vec::new();
        if designs {
            // The table of links stands in place of a drawing.
            if let Some(path) = self.view_state.looked_up.take() {
                self.view_state.pen = None;
                studio::look_up(ui.ctx(), &path);
            }
            let shown = drawing.as_ref().and_then(SketchFacts::previewed_machine);
            let found = match self.view_state.arrangement.shows_equations {
                true => studio::DesignFacts::learned(&queries, &self.session, shown),
                false => {
                    let by = self.view_state.front_by;
                    studio::DesignFacts::weighed(&queries, (&self.session, shown), by, &self.fronts)
                }
            };
            studio::show(ui, &self.session, (&found, drawing.as_ref()), &self.view_state, &mut commands);
            chosen = self.view_state.ghost.map_or_else(Vec::new, |i| found.weights(i));
        }
        if !contrasts && self.view_state.arrangement.now().side.shown && !designs {
            if let Some(thing) = self.view_state.revealed.take() {
                place::open(ui.ctx(), thing, &self.session);
            }
            if let Some(path) = self.view_state.looked_up.take() {
                side::look_up(ui.ctx(), &path);
            }
            let width = side::show(ui, &self.session, &facts, &self.view_state, &mut commands);
            self.view_state.arrangement.now_mut().side.width = width;
        }
        self.view_state.pointed.panel_object = place::lit(ui.ctx());
        self.view_state.pointed.lit_links = place::lit_links(ui.ctx());
        let has_panel = self.view_state.arrangement.now().plots.shown;
        if !designs && (has_panel || !presents) {
            if std::mem::take(&mut self.focuses_search) {
                plots::focus(ui.ctx());
            }
            let (session, signals, view_state) = (&self.session, &self.signals(), &self.view_state);
            let what = plots::DisplayContext { session, queries: &queries, signals, comparison: beside, view_state };
            let width = plots::show(ui, &what, has_panel, &mut commands);
            self.view_state.arrangement.now_mut().plots.width = width;
        }
        self.view_state.put_away = News::still_put_away(&self.session, &self.view_state.put_away);
        // While a machine is drawn, the panel says what its task needs.
        let news = News::of(&self.session, &self.view_state).filter(|news| !(draws && news.is_of_run()));
        let content = viewport::SceneContent {
            session: &self.session,
            views: &self.views,
            blocks: self.blocks.as_ref(),
            exaggeration: self.base_exaggeration(),
            comparison: self.comparison.as_ref(),
            intro: self.intro.as_ref().filter(|_| !presents),
            other: other.as_deref(),
            weights: &chosen,
            news: news.as_ref(),
        };
        let scene = match &drawing {
            Some(facts) => {
                let scene = SketchScene { facts, views: &self.views };
                sketching::show(ui, scene, &mut self.view_state, &mut commands)
            }
            None => match (self.session.run().unfinished(), sketching::waits::facts(&queries, &self.session)) {
                (Some(unfinished), Some(facts)) => {
                    let scene = SketchScene { facts: &facts, views: &self.views };
                    sketching::waits::scene(ui, unfinished, scene, &self.view_state, &mut commands)
                }
                _ => viewport::show(ui, content, &mut self.view_state, &mut commands),
            },
        };
        let window = ui.ctx().content_rect().size();
        self.view_state.displayed =
            DisplaySize { window: window.into(), scene: scene.size().into(), scale: ui.ctx().pixels_per_point() };
        let proposals = self.proposals();
        let proposals = proposals.as_ref().map_or(&[][..], |known| known);
        if let Some(news) = &news {
            status::news::show(ui.ctx(), scene, news, &self.view_state, proposals, &mut commands);
        }
        guide::show(ui.ctx(), &queries, &mut self.view_state, &mut commands);
        side::window(ui.ctx(), &facts, &self.view_state, &mut commands);
        keys::help(ui.ctx(), &self.view_state, &mut commands);
        saving::show(ui.ctx(), (&self.saving, self.session.undo_count()), &self.view_state, &mut commands);
        let recent = &self.saving.recent;
        let improvements = self.view_state.open.finder.is_some().then(|| self.improvements()).flatten();
        let content = FinderContent { signals: &self.signals(), recent, improvements };
        finder::show(ui.ctx(), &self.session, &facts, &content, &mut self.view_state, &mut commands);
        notes::show(ui.ctx(), &self.session, &self.views, &mut self.view_state, &mut commands);
        top::dialog(ui.ctx(), &mut self.view_state, &mut commands);
        watched_file::show(ui.ctx(), self.watched.as_ref(), &self.view_state, &mut commands);
        file_report::show(ui.ctx(), &self.view_state, &mut commands);
        export::show(ui.ctx(), &self.session, (&queries, &self.signals()), &self.view_state, &mut commands);
        commands
            .extend(widgets::refused_entry(ui.ctx()).map(|entry| Command::Window(WindowCommand::RefuseEntry(entry))));
        if widgets::drag_cancelled(ui.ctx()) {
            // The cancelled drag is undone before its gesture ends.
            commands.insert(0, Command::Session(SessionCommand::GiveUp));
        }
        self.carry_out_all(ui.ctx(), commands);
        if (self.session.is_moving() || self.loops()) && !self.background.is_changing() {
            ui.ctx().request_repaint();
        } else if self.background.is_busy() || self.intro.as_ref().is_some_and(Intro::is_resting) {
            ui.ctx().request_repaint_after_secs(PROGRESS_INTERVAL_S);
        }
    }

    /// Carries out the commands of a pass, of whichever window.
    pub(super) fn carry_out_all(&mut self, ctx: &egui::Context, commands: Vec<Command>) {
        if commands
            .iter()
            .any(|c| !matches!(c, Command::Session(SessionCommand::EndGesture) | Command::View(ViewChange::Preview(_))))
        {
            self.view_state.status = StatusMessage::default();
        }
        if !commands.is_empty() {
            ctx.request_repaint_of(ViewportId::ROOT);
        }
        for command in commands {
            let seen = self.intro.is_some().then(|| command.clone());
            self.carry_out(command);
            let held = self.view_state.gesture.grabbed.is_some();
            if let (Some(intro), Some(command)) = (&mut self.intro, seen)
                && intro.observe(&command, &self.session, held)
            {
                self.view_state.pair = self.view_state.pair.take().filter(|pair| !pair.demonstrates);
            }
        }
        if self.intro.as_ref().is_some_and(Intro::is_over) && self.view_state.gesture.grabbed.is_none() {
            self.hints = false;
            if self.hand_back() {
                self.announce("the hints are over: your session is as it was");
            }
        }
    }

    fn apply_style(&mut self, ctx: &egui::Context) {
        self.background.set_context(ctx);
        if !self.has_fonts {
            theme::install_fonts(ctx);
            ctx.add_plugin(order::EventQueue::default());
            self.has_fonts = true;
        }
        if self.applied_theme != Some(self.view_state.arrangement.theme) {
            theme::apply(ctx, self.view_state.arrangement.theme);
            self.applied_theme = Some(self.view_state.arrangement.theme);
        }
    }
}

/// Whether of the session's run and those drawn with it some have a reaction wheel and some have none.
fn wheels_differ(session: &Session, table: Option<&Comparison>) -> bool {
    let feels_more = session.scenario().base.feels_more_than_n_b();
    table.is_some_and(|table| table.shown().any(|(_, run)| run.scenario.base.feels_more_than_n_b() != feels_more))
}
