//! The windows of the desktop that show one plot each.

use egui::{Context, Key, Modifiers, Popup, Ui, ViewportBuilder, ViewportCommand, ViewportId};

use super::{AppState, run_name};
use crate::plots::{self, DisplayContext, PlotWindow};
use crate::{Command, ViewChange, keys, saving};
use stillbase_picture::charts::choice::PlotChange;
use stillbase_picture::scene::beside::Beside;
use stillbase_study::comparison::Comparison;

/// Returns the runs whose curves plots show beside those of the session: the other run of a pair, or the table's.
pub(super) fn laid_over<'a>(
    other: Option<&'a Result<Beside, String>>,
    comparison: Option<&'a Comparison>,
) -> Option<&'a Comparison> {
    let table = other.and_then(|other| other.as_ref().ok()).map(|other| &other.table);
    table.or(comparison)
}

impl AppState {
    /// Returns the plots that have windows of their own.
    pub fn plot_windows(&self) -> Vec<PlotWindow> {
        let charts = &self.view_state.charts;
        if charts.changes.values().all(|changes| changes.window.is_none()) {
            return Vec::new();
        }
        let signals = self.signals();
        let plots = self.view_state.plots(self.session.scenario(), &signals);
        let run = run_name(self.session.scenario());
        plots.iter().filter_map(|plot| PlotWindow::of(plot, run)).collect()
    }

    /// Tells egui which plots have windows of the desktop; it forgets the others.
    pub(super) fn keep_plot_windows(&self, ctx: &Context) {
        if !ctx.embed_viewports() {
            for window in self.plot_windows() {
                // The shell of the window runs the passes, because they need the whole state.
                ctx.show_viewport_deferred(window.id, ViewportBuilder::default(), |_, _| {});
            }
        }
    }

    /// Runs one pass of a plot's window. Keys do what they do in the main window, except Esc, which puts the plot back
    /// among the others as the window's close button does.
    pub fn plot_ui(&mut self, ui: &mut Ui, id: ViewportId) {
        let ctx = ui.ctx().clone();
        let mut commands = Vec::new();
        let before = self.wants_keys(&ctx);
        // Esc first ends a drag or closes a menu.
        let is_busy = Popup::is_any_open(&ctx) || ui.input(|i| i.pointer.any_down());
        let asks = self.saving.has_question();
        let leaves = !asks && !is_busy && ui.input_mut(|i| i.consume_key(Modifiers::NONE, Key::Escape));
        if leaves || ui.input(|i| i.viewport().close_requested()) {
            let window = self.plot_windows().into_iter().find(|window| window.id == id);
            let back = |window: PlotWindow| Command::View(ViewChange::Charts(PlotChange::Window(window.name, None)));
            commands.extend(window.map(back));
        }
        match asks {
            true => saving::keep_keys(&ctx),
            false => keys::read(&ctx, &self.session, &self.view_state, &mut commands),
        }
        let other = self.view_state.pair.as_ref().and_then(|_| self.beside());
        let what = DisplayContext {
            session: &self.session,
            queries: &self.queries().clone(),
            signals: &self.signals(),
            comparison: laid_over(other.as_deref(), self.comparison.as_ref()),
            view_state: &self.view_state,
        };
        plots::alone(ui, &what, id, &mut commands);
        self.carry_out_all(&ctx, commands);
        if self.wants_keys(&ctx) > before {
            // What has opened in the main window is read and typed there.
            ctx.send_viewport_cmd_to(ViewportId::ROOT, ViewportCommand::Minimized(false));
            ctx.send_viewport_cmd_to(ViewportId::ROOT, ViewportCommand::Focus);
        }
    }

    /// Keeps where the desktop shows a plot's window: left and top, pixels, if the system tells them; width and height,
    /// points. Returns whether that is new.
    pub fn keep_place(&mut self, id: ViewportId, at: Option<[i32; 2]>, size: [f32; 2]) -> bool {
        let Some(window) = self.plot_windows().into_iter().find(|window| window.id == id) else { return false };
        let before = self.view_state.charts.clone();
        self.view_state.apply(ViewChange::Charts(PlotChange::Desktop(window.name, at, size)));
        self.view_state.charts != before
    }

    /// Counts what is open in the main window and needs the keyboard or an answer there.
    fn wants_keys(&self, ctx: &Context) -> usize {
        let open = &self.view_state.open;
        let looks_up = self.view_state.looked_up.is_some() || self.focuses_search || plots::is_looking(ctx);
        let all = [
            self.saving.has_question(),
            looks_up,
            open.help,
            open.settings,
            open.finder.is_some(),
            open.guide.is_some(),
            open.dialog.is_some(),
            open.export.is_some(),
            open.naming.is_some(),
            open.note.is_some(),
        ];
        all.into_iter().filter(|is_open| *is_open).count()
    }
}
