//! [`Pane`]: one window of the desktop, with what it receives and what it is drawn on.

use std::sync::Arc;
use std::time::Instant;

use egui::epaint::ClippedShape;
use egui::{Context, ViewportId, ViewportInfo};
use winit::event_loop::{ActiveEventLoop, EventLoopProxy};
use winit::window::Window;

use super::screen::Canvas;
use super::shell::Wake;
use crate::PlotWindow;

/// A window of the desktop.
pub struct Pane {
    pub id: ViewportId,
    pub input: egui_winit::State,
    pub info: ViewportInfo,
    /// `None` only while the device is being replaced.
    pub canvas: Option<Canvas>,
    /// Whether it has had its first picture; before, it is hidden.
    pub is_shown: bool,
    /// When the last pass began.
    pub passed: Instant,
    /// When the next pass is due.
    pub next: Option<Instant>,
    /// The shapes of the last picture.
    pub shapes: Vec<ClippedShape>,
    /// The plot that it shows, with the place that is kept; `None` for the main window.
    pub plot: Option<PlotWindow>,
    /// The last field, so that it is dropped after those that draw in it and listen to it.
    pub window: Arc<Window>,
}

impl Pane {
    /// Creates the pane of a hidden window. A screen reader must be initialised before the window is shown.
    pub fn new(
        ctx: &Context,
        id: ViewportId,
        (window, canvas): (Arc<Window>, Canvas),
        longest_side: usize,
        (events, wakes): (&ActiveEventLoop, &EventLoopProxy<Wake>),
    ) -> Self {
        let (scale, side) = (Some(window.scale_factor() as f32), Some(longest_side));
        let mut input = egui_winit::State::new(ctx.clone(), id, &window, scale, window.theme(), side);
        input.init_accesskit(events, &window, wakes.clone());
        Self {
            id,
            input,
            info: ViewportInfo { parent: (id != ViewportId::ROOT).then_some(ViewportId::ROOT), ..Default::default() },
            canvas: Some(canvas),
            is_shown: false,
            passed: Instant::now(),
            next: None,
            shapes: Vec::new(),
            plot: None,
            window,
        }
    }

    /// Whether nobody can see it: it is minimised or covered.
    pub fn is_unseen(&self) -> bool {
        self.is_shown && (self.window.is_minimized() == Some(true) || self.info.occluded == Some(true))
    }

    /// Requests a pass at an instant, if none is due before.
    pub fn wants_pass(&mut self, when: Instant) {
        self.next = Some(self.next.map_or(when, |next| next.min(when)));
    }

    /// Shows the window, which has a picture now.
    pub fn show(&mut self) {
        if !self.is_shown {
            self.is_shown = true;
            self.window.set_visible(true);
        }
    }
}
