//! Windows of plots beside the main window: they open, move, and close as the state of the interface has it.

use std::sync::Arc;

use egui::{ViewportBuilder, ViewportId};
use winit::dpi::PhysicalPosition;
use winit::event_loop::{ActiveEventLoop, EventLoopProxy};

use super::app::App;
use super::monitors::{MonitorArea, visible_place};
use super::pane::Pane;
use super::shell::{Wake, last_clause};
use super::windows::Windows;
use crate::{MIN_PLOT_WINDOW_PT, PlotWindow};

/// Least difference of a side that a window follows, points.
const MIN_CHANGE_PT: f32 = 0.5;

impl Windows {
    /// Opens, moves, names and closes windows of plots. If one cannot be opened, all plots stay in the main window.
    pub fn follow(&mut self, app: &mut App, events: &ActiveEventLoop, wakes: &EventLoopProxy<Wake>) {
        if self.ctx.embed_viewports() {
            return;
        }
        let wanted = app.app_state().plot_windows();
        self.plots.retain(|pane| wanted.iter().any(|plot| plot.id == pane.id));
        for plot in wanted {
            let Some(i) = self.plots.iter().position(|pane| pane.id == plot.id) else {
                if let Err(why) = self.open_plot(plot, events, wakes) {
                    self.plots.clear();
                    self.ctx.set_embed_viewports(true);
                    self.ctx.request_repaint_of(ViewportId::ROOT);
                    return app.stays_in_window(&why);
                }
                continue;
            };
            self.renew(i, plot, events);
        }
    }

    /// Gives an open window its present title, and the place of a session that was opened meanwhile.
    fn renew(&mut self, i: usize, plot: PlotWindow, events: &ActiveEventLoop) {
        let Some(kept) = self.plots[i].plot.replace(plot.clone()) else { return };
        let window = self.plots[i].window.clone();
        if kept.title != plot.title {
            window.set_title(&plot.title);
        }
        let [_, _, width, height] = plot.place;
        let [_, _, kept_width, kept_height] = kept.place;
        if (width - kept_width).abs().max((height - kept_height).abs()) > MIN_CHANGE_PT {
            let scale = egui_winit::pixels_per_point(&self.ctx, &window);
            let size = winit::dpi::PhysicalSize::new((width * scale).round(), (height * scale).round());
            let _ = window.request_inner_size(size);
        }
        if kept.desktop != plot.desktop
            && let Some(at) = self.place_of(&plot, events)
        {
            window.set_outer_position(at);
        }
    }

    /// Returns where a plot's window belongs on the desktop: where it stood last, else where its place over the scene
    /// is; `None` if the system tells no places.
    fn place_of(&self, plot: &PlotWindow, events: &ActiveEventLoop) -> Option<PhysicalPosition<i32>> {
        let main = &self.main.window;
        let scale = egui_winit::pixels_per_point(&self.ctx, main);
        let [left, top, width, height] = plot.place.map(|x| (x * scale).round());
        let at = plot.desktop.or_else(|| {
            let corner = main.inner_position().ok()?;
            Some([corner.x.saturating_add(left as i32), corner.y.saturating_add(top as i32)])
        })?;
        let area = |monitor: winit::monitor::MonitorHandle| {
            let (at, size) = (monitor.position(), monitor.size());
            MonitorArea { at: [at.x, at.y], size: [size.width, size.height] }
        };
        let monitors: Vec<MonitorArea> = events.available_monitors().map(area).collect();
        Some(visible_place(at, [width as u32, height as u32], &monitors).into())
    }

    fn open_plot(
        &mut self,
        plot: PlotWindow,
        events: &ActiveEventLoop,
        wakes: &EventLoopProxy<Wake>,
    ) -> Result<(), String> {
        let Some(screen) = &self.screen else { return Ok(()) };
        let [_, _, width, height] = plot.place;
        let builder = ViewportBuilder::default()
            .with_title(plot.title.clone())
            .with_app_id("stillbase")
            .with_inner_size([width, height])
            .with_min_inner_size(MIN_PLOT_WINDOW_PT)
            .with_visible(false);
        let mut attributes = egui_winit::create_winit_window_attributes(&self.ctx, builder.clone());
        attributes.position = self.place_of(&plot, events).map(Into::into);
        let window = events.create_window(attributes).map_err(|why| last_clause(&why.to_string()))?;
        egui_winit::apply_viewport_builder_to_window(&self.ctx, &window, &builder);
        let window = Arc::new(window);
        let canvas = screen.canvas(&window).map_err(|why| why.to_string())?;
        let mut pane = Pane::new(&self.ctx, plot.id, (window, canvas), screen.longest_side(), (events, wakes));
        pane.plot = Some(plot);
        self.plots.push(pane);
        Ok(())
    }

    /// Keeps the place of a window of a plot with the session, after the window was moved or resized.
    pub fn keep_place(&mut self, app: &mut App, id: ViewportId) {
        let Some(pane) = self.plots.iter_mut().find(|pane| pane.id == id) else { return };
        let size = pane.window.inner_size();
        // A minimised window has no place.
        if !pane.is_shown || pane.window.is_minimized() == Some(true) || size.width == 0 || size.height == 0 {
            return;
        }
        let scale = egui_winit::pixels_per_point(&self.ctx, &pane.window);
        let size = [size.width, size.height].map(|side| side as f32 / scale);
        let at = pane.window.outer_position().ok().map(|at| [at.x, at.y]);
        if app.app_state_mut().keep_place(id, at, size) {
            pane.plot = app.app_state().plot_windows().into_iter().find(|plot| plot.id == id);
            self.ctx.request_repaint_of(ViewportId::ROOT);
        }
    }
}
