//! [`Shell`]: a window of the desktop around an [`App`], from its first picture to its last.

use std::sync::Arc;
use std::time::{Duration, Instant};

use egui::{FullOutput, ViewportBuilder, ViewportCommand, ViewportEvent, ViewportId, ViewportInfo};
use egui_winit::accesskit_winit;
use winit::application::ApplicationHandler;
use winit::error::EventLoopError;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop, EventLoopProxy};
use winit::window::{Window, WindowId};

use super::app::App;
use super::error::{WindowError, what_is_missing};
use super::screen::{PaintOutcome, Screen};
use stillbase_picture::paint::enable_draft_quality;
use stillbase_picture::render::offscreen::NoAdapter;

/// A device lost again within this time is not replaced again.
const MIN_DEVICE_LIFETIME: Duration = Duration::from_secs(10);
/// Minimum time between the passes of a hidden window.
const HIDDEN_PASS_INTERVAL: Duration = Duration::from_millis(250);

/// Events that wake the event loop from outside the window system.
#[derive(Debug)]
enum Wake {
    /// egui requests a pass at this instant. The number is that of the pass in which it was requested.
    Pass(Instant, u64),
    /// The graphics device is lost.
    Lost,
    /// A screen reader begins, acts or ends.
    Reader(accesskit_winit::Event),
}

impl From<accesskit_winit::Event> for Wake {
    fn from(event: accesskit_winit::Event) -> Self {
        Self::Reader(event)
    }
}

/// Shows an application in a window until the window is closed.
///
/// # Errors
/// If there is no display, the window system fails, or no device can draw, at the start or after the device was lost.
pub fn show(app: &mut App, place: ViewportBuilder) -> Result<(), WindowError> {
    let events = EventLoop::<Wake>::with_user_event().build().map_err(|why| match why {
        EventLoopError::Os(why) => WindowError::NoDisplay(last_clause(&why.to_string())),
        why => WindowError::NoDisplay(why.to_string()),
    })?;
    let wakes = events.create_proxy();
    let mut shell = Shell { app, place, wakes, open: None, next: None, ended: Ok(()) };
    let ran = events.run_app(&mut shell);
    shell.ended.and(ran.map_err(|why| WindowError::Failed(why.to_string())))
}

/// Returns the last clause of an error of the window system, which begins with a place in its source.
fn last_clause(text: &str) -> String {
    text.rsplit(": ").next().unwrap_or(text).to_owned()
}

struct Shell<'a> {
    app: &'a mut App,
    place: ViewportBuilder,
    wakes: EventLoopProxy<Wake>,
    open: Option<OpenWindow>,
    /// When the next pass is due.
    next: Option<Instant>,
    ended: Result<(), WindowError>,
}

/// The window while it is open.
struct OpenWindow {
    ctx: egui::Context,
    input: egui_winit::State,
    info: ViewportInfo,
    /// `None` only while it is being replaced.
    screen: Option<Screen>,
    /// When the screen was last replaced.
    replaced: Option<Instant>,
    is_shown: bool,
    /// When the last pass began.
    passed: Instant,
    /// The last field, so that it is dropped after those that draw in it and listen to it.
    window: Arc<Window>,
}

impl OpenWindow {
    fn new(
        events: &ActiveEventLoop,
        place: &ViewportBuilder,
        wakes: &EventLoopProxy<Wake>,
    ) -> Result<Self, WindowError> {
        let ctx = egui::Context::default();
        let wake = wakes.clone();
        ctx.set_request_repaint_callback(move |asked| {
            // An infinite delay requests no pass.
            if let Some(when) = Instant::now().checked_add(asked.delay) {
                // Sending fails only after the end of the loop, when there is nothing to draw.
                let _ = wake.send_event(Wake::Pass(when, asked.current_cumulative_pass_nr));
            }
        });
        // The window is hidden until its first picture; a screen reader must be initialised before it is shown, too.
        let place = clamped(events, place.clone()).with_visible(false);
        let window = egui_winit::create_window(&ctx, events, &place);
        let window = Arc::new(window.map_err(|why| WindowError::Failed(last_clause(&why.to_string())))?);
        let scale = Some(window.scale_factor() as f32);
        let screen = screen(&window, events, wakes).map_err(|_| WindowError::NoAdapter(what_is_missing()))?;
        let side = Some(screen.longest_side());
        let mut input = egui_winit::State::new(ctx.clone(), ViewportId::ROOT, &window, scale, window.theme(), side);
        input.init_accesskit(events, &window, wakes.clone());
        if screen.is_software() {
            enable_draft_quality(&ctx);
        }
        let info = ViewportInfo::default();
        let screen = Some(screen);
        Ok(Self { ctx, input, info, screen, replaced: None, is_shown: false, passed: Instant::now(), window })
    }

    fn is_unseen(&self) -> bool {
        self.is_shown && (self.window.is_minimized() == Some(true) || self.info.occluded == Some(true))
    }

    /// Replaces a lost device, and restores its textures.
    fn replace(&mut self, events: &ActiveEventLoop, wakes: &EventLoopProxy<Wake>) -> Result<(), String> {
        if self.replaced.is_some_and(|last| last.elapsed() < MIN_DEVICE_LIFETIME) {
            return Err("so was the one that took over".into());
        }
        // Two surfaces may not share a window.
        self.screen = None;
        let mut screen = screen(&self.window, events, wakes).map_err(|why| why.to_string())?;
        screen.send_letters(&self.ctx);
        self.screen = Some(screen);
        self.replaced = Some(Instant::now());
        Ok(())
    }
}

fn screen(window: &Arc<Window>, events: &ActiveEventLoop, wakes: &EventLoopProxy<Wake>) -> Result<Screen, NoAdapter> {
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

impl Shell<'_> {
    /// Closes the window, with its error if there is one.
    fn end(&mut self, events: &ActiveEventLoop, ended: Result<(), WindowError>) {
        if self.ended.is_ok() {
            self.ended = ended;
        }
        events.exit();
    }

    /// Runs one pass of the user interface, and draws it if the window is visible.
    fn pass(&mut self, events: &ActiveEventLoop) {
        let Some(open) = &mut self.open else { return };
        if events.exiting() {
            return;
        }
        if let Some(screen) = open.screen.as_ref().filter(|_| self.app.breaks()) {
            screen.destroy();
        }
        if open.screen.as_ref().is_none_or(Screen::is_lost) {
            match open.replace(events, &self.wakes) {
                Ok(()) => self.app.was_replaced(),
                Err(why) => {
                    let why = self.app.cut_off(why);
                    return self.end(events, Err(why));
                }
            }
        }
        open.passed = Instant::now();
        let is_unseen = open.is_unseen();
        let OpenWindow { ctx, input, info, screen: Some(screen), window, is_shown, passed, .. } = open else { return };
        info.native_pixels_per_point = Some(window.scale_factor() as f32);
        info.focused = Some(window.has_focus());
        let mut raw = input.take_egui_input(window);
        raw.viewports.insert(ViewportId::ROOT, info.clone());
        info.events.clear();
        let closes = raw.viewport().close_requested();
        let drawing = self.app.app_state().drawing();
        let output = ctx.run_ui(raw, |ui| self.app.ui(ui));
        let FullOutput { platform_output, textures_delta, shapes, pixels_per_point, mut viewport_output } = output;
        screen.take_textures(textures_delta);
        input.handle_platform_output_with_event_loop(window, events, platform_output);
        let root = viewport_output.remove(&ViewportId::ROOT);
        // New widgets reach their final layout in a second pass, which no event requests.
        let again = root.as_ref().and_then(|root| passed.checked_add(root.repaint_delay));
        let commands = root.map(|root| root.commands).unwrap_or_default();
        let stays = commands.contains(&ViewportCommand::CancelClose);
        // No command of the interface needs an answer: the interface copies text itself, and takes no screenshots.
        egui_winit::process_viewport_commands(ctx, info, commands, window, &mut Vec::new());
        if closes && !stays {
            return self.end(events, Ok(()));
        }
        if !info.events.is_empty() {
            window.request_redraw();
        }
        if !is_unseen {
            let shapes = ctx.tessellate(shapes, pixels_per_point);
            // Presenting may wait for the screen. So the guard `drawing` is dropped before, and work can start.
            drop(drawing);
            let behind = ctx.global_style().visuals.panel_fill;
            if screen.draw(window, &shapes, pixels_per_point, behind) == PaintOutcome::Again {
                window.request_redraw();
            }
        }
        if !*is_shown {
            *is_shown = true;
            window.set_visible(true);
        }
        if let Some(again) = again {
            self.wants_pass(again);
        }
    }

    fn wants_pass(&mut self, when: Instant) {
        self.next = Some(self.next.map_or(when, |next| next.min(when)));
    }
}

impl ApplicationHandler<Wake> for Shell<'_> {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        if self.open.is_some() {
            return;
        }
        match OpenWindow::new(events, &self.place, &self.wakes) {
            Ok(open) => {
                self.app.shown_in(open.window.clone());
                self.open = Some(open);
                // The window becomes visible with its first picture.
                self.pass(events);
            }
            Err(why) => self.end(events, Err(why)),
        }
    }

    fn user_event(&mut self, _: &ActiveEventLoop, wake: Wake) {
        let Some(open) = &mut self.open else { return };
        match wake {
            // A later pass may already have met the request.
            Wake::Pass(when, asked) => {
                let passes = open.ctx.cumulative_pass_nr_for(ViewportId::ROOT);
                if passes <= asked + 1 {
                    self.wants_pass(when);
                }
            }
            Wake::Lost => self.wants_pass(Instant::now()),
            Wake::Reader(event) => {
                match event.window_event {
                    accesskit_winit::WindowEvent::InitialTreeRequested => open.ctx.enable_accesskit(),
                    accesskit_winit::WindowEvent::ActionRequested(action) => {
                        open.input.on_accesskit_action_request(action);
                    }
                    accesskit_winit::WindowEvent::AccessibilityDeactivated => return open.ctx.disable_accesskit(),
                }
                self.wants_pass(Instant::now());
            }
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(open) = &mut self.open else { return };
        match &event {
            WindowEvent::RedrawRequested => {
                self.next = None;
                return self.pass(events);
            }
            // The size in the event may be outdated.
            WindowEvent::Resized(_) => {
                let size = open.window.inner_size();
                if let Some(screen) = &mut open.screen {
                    screen.resize([size.width, size.height]);
                }
                open.window.request_redraw();
            }
            WindowEvent::Occluded(occluded) => {
                open.info.occluded = Some(*occluded);
                open.window.request_redraw();
            }
            WindowEvent::CloseRequested => {
                open.info.events.push(ViewportEvent::Close);
                // A hidden window may never receive a request to redraw.
                return self.pass(events);
            }
            WindowEvent::Destroyed => return self.end(events, Ok(())),
            _ => {}
        }
        let window = open.window.clone();
        if open.input.on_window_event(&window, &event).repaint {
            window.request_redraw();
        }
    }

    fn about_to_wait(&mut self, events: &ActiveEventLoop) {
        let Some(open) = &self.open else { return };
        let now = Instant::now();
        // Some systems do not send redraw requests to a hidden window: its passes are limited in rate, but continue.
        let is_unseen = self.next.is_some() && open.is_unseen();
        let due = self.next.map(|next| if is_unseen { next.max(open.passed + HIDDEN_PASS_INTERVAL) } else { next });
        let is_due = due.is_some_and(|due| due <= now);
        events.set_control_flow(due.filter(|_| !is_due).map_or(ControlFlow::Wait, ControlFlow::WaitUntil));
        if is_due {
            self.next = None;
            match is_unseen {
                true => self.pass(events),
                false => open.window.request_redraw(),
            }
        }
    }

    fn exiting(&mut self, _: &ActiveEventLoop) {
        self.app.close();
        // Listeners to the window system must be dropped before it.
        self.open = None;
    }
}
