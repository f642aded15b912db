//! [`Windows`]: all windows of the program, which share the memory of the interface and the graphics device.

use std::sync::Arc;
use std::time::{Duration, Instant};

use egui::epaint::ClippedShape;
use egui::{Context, FullOutput, Ui, ViewportBuilder, ViewportCommand, ViewportId};
use winit::event_loop::{ActiveEventLoop, EventLoopProxy};
use winit::window::{Window, WindowId};

use super::error::{WindowError, what_is_missing};
use super::pane::Pane;
use super::screen::{Canvas, Drawing, PaintOutcome, Screen};
use super::shell::{Wake, last_clause};
use stillbase_picture::paint::enable_draft_quality;
use stillbase_picture::render::offscreen::NoAdapter;

/// A device lost again within this time is not replaced again.
const MIN_DEVICE_LIFETIME: Duration = Duration::from_secs(10);

/// The windows while they are open.
pub struct Windows {
    pub ctx: Context,
    /// From when all windows count their time.
    begun: Instant,
    pub main: Pane,
    /// Windows of plots.
    pub plots: Vec<Pane>,
    /// `None` only while it is being replaced.
    pub screen: Option<Screen>,
    /// When the screen was last replaced.
    replaced: Option<Instant>,
}

/// What a pass leaves to be drawn and done.
pub struct Passed {
    pub shapes: Vec<ClippedShape>,
    pub pixels_per_point: f32,
    /// Whether the window was asked to close, and nothing objects.
    pub closes: bool,
}

impl Windows {
    /// Opens the main window.
    ///
    /// # Errors
    /// If the window system fails or no device can draw.
    pub fn open(
        events: &ActiveEventLoop,
        place: &ViewportBuilder,
        wakes: &EventLoopProxy<Wake>,
    ) -> Result<Self, WindowError> {
        let ctx = Context::default();
        ctx.set_embed_viewports(false);
        let wake = wakes.clone();
        ctx.set_request_repaint_callback(move |asked| {
            // An infinite delay requests no pass.
            if let Some(when) = Instant::now().checked_add(asked.delay) {
                // Sending fails only after the end of the loop, when there is nothing to draw.
                let _ = wake.send_event(Wake::Pass(asked.viewport_id, when, asked.current_cumulative_pass_nr));
            }
        });
        // The window is hidden until its first picture.
        let place = clamped(events, place.clone()).with_visible(false);
        let window = egui_winit::create_window(&ctx, events, &place);
        let window = Arc::new(window.map_err(|why| WindowError::Failed(last_clause(&why.to_string())))?);
        let made = screen(&window, events, wakes).map_err(|_| WindowError::NoAdapter(what_is_missing()));
        let (screen, canvas) = made?;
        let main = Pane::new(&ctx, ViewportId::ROOT, (window, canvas), screen.longest_side(), (events, wakes));
        if screen.is_software() {
            enable_draft_quality(&ctx);
        }
        let begun = Instant::now();
        Ok(Self { ctx, begun, main, plots: Vec::new(), screen: Some(screen), replaced: None })
    }

    /// Returns the window of a viewport.
    pub fn pane(&mut self, id: ViewportId) -> Option<&mut Pane> {
        self.all().find(|pane| pane.id == id)
    }

    /// Returns the viewport of a window.
    pub fn viewport(&mut self, window: WindowId) -> Option<ViewportId> {
        self.all().find(|pane| pane.window.id() == window).map(|pane| pane.id)
    }

    /// All windows, the main one first.
    pub fn all(&mut self) -> impl Iterator<Item = &mut Pane> {
        std::iter::once(&mut self.main).chain(&mut self.plots)
    }

    /// Replaces a lost device, and restores its textures.
    ///
    /// # Errors
    /// If no device can draw, or the lost one was a replacement of a moment ago.
    pub fn replace(&mut self, events: &ActiveEventLoop, wakes: &EventLoopProxy<Wake>) -> Result<(), String> {
        if self.replaced.is_some_and(|last| last.elapsed() < MIN_DEVICE_LIFETIME) {
            return Err("so was the one that took over".into());
        }
        // Two surfaces may not share a window.
        self.all().for_each(|pane| pane.canvas = None);
        self.screen = None;
        let (mut screen, canvas) = screen(&self.main.window, events, wakes).map_err(|why| why.to_string())?;
        screen.send_letters(&self.ctx);
        self.main.canvas = Some(canvas);
        self.plots.iter_mut().for_each(|pane| pane.canvas = screen.canvas(&pane.window).ok());
        // One that cannot be drawn in any more is opened anew.
        self.plots.retain(|pane| pane.canvas.is_some());
        self.plots.iter().for_each(|pane| pane.window.request_redraw());
        self.screen = Some(screen);
        self.replaced = Some(Instant::now());
        Ok(())
    }

    /// Runs one pass over a window, and does what the interface asks of any window; `None` if there is no such window.
    pub fn run(&mut self, events: &ActiveEventLoop, id: ViewportId, ui: impl FnMut(&mut Ui)) -> Option<Passed> {
        let (ctx, begun) = (self.ctx.clone(), self.begun);
        let pane = self.pane(id)?;
        (pane.passed, pane.next) = (Instant::now(), None);
        pane.info.native_pixels_per_point = Some(pane.window.scale_factor() as f32);
        pane.info.focused = Some(pane.window.has_focus());
        let mut raw = pane.input.take_egui_input(&pane.window);
        // What is remembered for all windows has one time.
        raw.time = Some(begun.elapsed().as_secs_f64());
        raw.viewports.insert(id, pane.info.clone());
        pane.info.events.clear();
        let mut closes = raw.viewport().close_requested();
        let output = ctx.run_ui(raw, ui);
        let FullOutput { platform_output, textures_delta, shapes, pixels_per_point, viewport_output } = output;
        pane.input.handle_platform_output_with_event_loop(&pane.window, events, platform_output);
        self.screen.as_mut()?.take_textures(textures_delta);
        for (of, output) in viewport_output {
            let Some(pane) = self.pane(of) else { continue };
            if of == id {
                closes &= !output.commands.contains(&ViewportCommand::CancelClose);
                // New widgets reach their final layout in a second pass, which no event requests.
                if let Some(again) = pane.passed.checked_add(output.repaint_delay) {
                    pane.wants_pass(again);
                }
            }
            // No command of the interface needs an answer: the interface copies text itself, and takes no screenshots.
            let (info, window) = (&mut pane.info, &pane.window);
            egui_winit::process_viewport_commands(&ctx, info, output.commands, window, &mut Vec::new());
            if !pane.info.events.is_empty() {
                pane.window.request_redraw();
            }
        }
        Some(Passed { shapes, pixels_per_point, closes })
    }

    /// Draws triangles in a window and shows it, if it is not shown yet. Presenting in the main window may wait for the
    /// monitor.
    pub fn draw(&mut self, id: ViewportId, shapes: &[egui::ClippedPrimitive], pixels_per_point: f32) {
        let behind = self.ctx.global_style().visuals.panel_fill;
        let Self { main, plots, screen, .. } = self;
        let pane = std::iter::once(main).chain(plots).find(|pane| pane.id == id);
        let (Some(pane), Some(screen)) = (pane, screen) else { return };
        let Some(canvas) = &pane.canvas else { return };
        let what = Drawing { shapes, pixels_per_point, behind };
        if screen.draw(canvas, &pane.window, &what) == PaintOutcome::Again {
            pane.window.request_redraw();
        }
        pane.show();
    }

    /// Fits the surface of a window to its size; the size in an event may be outdated.
    pub fn resize(&mut self, id: ViewportId) {
        let Self { main, plots, screen, .. } = self;
        let pane = std::iter::once(main).chain(plots).find(|pane| pane.id == id);
        if let (Some(pane), Some(screen)) = (pane, screen) {
            let size = pane.window.inner_size();
            if let Some(canvas) = &mut pane.canvas {
                screen.resize(canvas, [size.width, size.height]);
            }
            pane.window.request_redraw();
        }
    }
}

fn screen(
    window: &Arc<Window>,
    events: &ActiveEventLoop,
    wakes: &EventLoopProxy<Wake>,
) -> Result<(Screen, Canvas), NoAdapter> {
    let wake = wakes.clone();
    Screen::new(window, events.owned_display_handle(), move || {
        let _ = wake.send_event(Wake::Lost);
    })
}

/// Limits the window to the size of the largest monitor: some systems do not show a larger window.
fn clamped(events: &ActiveEventLoop, place: ViewportBuilder) -> ViewportBuilder {
    let sizes = events.available_monitors().map(|monitor| monitor.size().to_logical::<f32>(monitor.scale_factor()));
    let largest = sizes.fold(egui::Vec2::ZERO, |most, size| most.max(egui::vec2(size.width, size.height)));
    match place.inner_size {
        Some(size) if largest.min_elem() > 0.0 => place.with_inner_size(size.min(largest)),
        _ => place,
    }
}
