//! [`Shell`]: the windows of the desktop around an [`App`], from their first picture to their last.

use std::time::{Duration, Instant};

use egui::{ViewportBuilder, ViewportEvent, ViewportId};
use egui_winit::accesskit_winit;
use winit::application::ApplicationHandler;
use winit::error::EventLoopError;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop, EventLoopProxy};
use winit::window::WindowId;

use super::app::App;
use super::error::WindowError;
use super::screen::Screen;
use super::windows::{Passed, Windows};

/// Minimum time between the passes of a hidden window, and while a plot's window beside it is in sight: only the main
/// window waits for the monitor.
const HIDDEN_PASS_INTERVAL: Duration = Duration::from_millis(250);
const BESIDE_PASS_INTERVAL: Duration = Duration::from_millis(16);

/// Events that wake the event loop from outside the window system.
#[derive(Debug)]
pub enum Wake {
    /// egui requests a pass over a window at this instant. The number is that of the pass in which it was requested.
    Pass(ViewportId, Instant, u64),
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
    let mut shell = Shell { app, place, wakes, open: None, ended: Ok(()) };
    let ran = events.run_app(&mut shell);
    shell.ended.and(ran.map_err(|why| WindowError::Failed(why.to_string())))
}

/// Returns the last clause of an error of the window system, which begins with a place in its source.
pub fn last_clause(text: &str) -> String {
    text.rsplit(": ").next().unwrap_or(text).to_owned()
}

struct Shell<'a> {
    app: &'a mut App,
    place: ViewportBuilder,
    wakes: EventLoopProxy<Wake>,
    open: Option<Windows>,
    ended: Result<(), WindowError>,
}

impl Shell<'_> {
    /// Closes the window, with its error if there is one.
    fn end(&mut self, events: &ActiveEventLoop, ended: Result<(), WindowError>) {
        if self.ended.is_ok() {
            self.ended = ended;
        }
        events.exit();
    }

    /// Runs one pass over the main window, draws it if it is visible, and then the windows of plots.
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
        let drawing = self.app.app_state().drawing();
        let is_unseen = open.main.is_unseen();
        let passed = open.run(events, ViewportId::ROOT, |ui| self.app.ui(ui));
        let Some(Passed { shapes, pixels_per_point, closes }) = passed else { return };
        if closes {
            return self.end(events, Ok(()));
        }
        if is_unseen {
            drop(drawing);
        } else {
            let shapes = open.ctx.tessellate(shapes, pixels_per_point);
            // Presenting may wait for the screen. So the guard `drawing` is dropped before, and work can start.
            drop(drawing);
            open.draw(ViewportId::ROOT, &shapes, pixels_per_point);
        }
        open.main.show();
        open.follow(self.app, events, &self.wakes);
        let plots: Vec<ViewportId> = open.plots.iter().map(|pane| pane.id).collect();
        plots.into_iter().for_each(|id| self.pass_plot(events, id, false));
    }

    /// Runs one pass over the window of a plot, and draws it if its shapes have changed or `draws` is set.
    fn pass_plot(&mut self, events: &ActiveEventLoop, id: ViewportId, draws: bool) {
        let Some(open) = self.open.as_mut().filter(|_| !events.exiting()) else { return };
        // The next pass of the main window replaces a lost device.
        if open.screen.as_ref().is_none_or(Screen::is_lost) {
            return open.main.wants_pass(Instant::now());
        }
        let Some(pane) = open.pane(id) else { return };
        if pane.is_unseen() && pane.info.events.is_empty() {
            pane.next = None;
            return;
        }
        let passed = open.run(events, id, |ui| self.app.plot_ui(ui, id));
        let Some(Passed { shapes, pixels_per_point, .. }) = passed else { return };
        let Some(pane) = open.pane(id) else { return };
        if draws || pane.shapes != shapes {
            pane.shapes.clone_from(&shapes);
            let shapes = open.ctx.tessellate(shapes, pixels_per_point);
            open.draw(id, &shapes, pixels_per_point);
        }
    }
}

impl ApplicationHandler<Wake> for Shell<'_> {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        if self.open.is_some() {
            return;
        }
        match Windows::open(events, &self.place, &self.wakes) {
            Ok(open) => {
                self.app.shown_in(open.main.window.clone());
                self.open = Some(open);
                // The window becomes visible with its first picture.
                self.pass(events);
            }
            Err(why) => self.end(events, Err(why)),
        }
    }

    fn user_event(&mut self, _: &ActiveEventLoop, wake: Wake) {
        let Some(open) = &mut self.open else { return };
        let ctx = open.ctx.clone();
        match wake {
            // A later pass may already have met the request.
            Wake::Pass(id, when, asked) => {
                if ctx.cumulative_pass_nr_for(id) <= asked + 1
                    && let Some(pane) = open.pane(id)
                {
                    pane.wants_pass(when);
                }
            }
            Wake::Lost => open.main.wants_pass(Instant::now()),
            Wake::Reader(event) => {
                let Some(id) = open.viewport(event.window_id) else { return };
                let Some(pane) = open.pane(id) else { return };
                match event.window_event {
                    accesskit_winit::WindowEvent::InitialTreeRequested => ctx.enable_accesskit(),
                    accesskit_winit::WindowEvent::ActionRequested(action) => {
                        pane.input.on_accesskit_action_request(action);
                    }
                    // Readers read all windows or none; the main one tells when they end.
                    accesskit_winit::WindowEvent::AccessibilityDeactivated if id == ViewportId::ROOT => {
                        return ctx.disable_accesskit();
                    }
                    accesskit_winit::WindowEvent::AccessibilityDeactivated => return,
                }
                pane.wants_pass(Instant::now());
            }
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, window: WindowId, event: WindowEvent) {
        let Some(open) = &mut self.open else { return };
        // A window that was closed a moment ago may still receive events.
        let Some(id) = open.viewport(window) else { return };
        let Some(pane) = open.pane(id) else { return };
        let is_main = id == ViewportId::ROOT;
        let pane_window = pane.window.clone();
        match &event {
            WindowEvent::RedrawRequested if is_main => return self.pass(events),
            WindowEvent::RedrawRequested => return self.pass_plot(events, id, true),
            WindowEvent::Occluded(occluded) => {
                pane.info.occluded = Some(*occluded);
                pane.window.request_redraw();
            }
            WindowEvent::CloseRequested if is_main => {
                pane.info.events.push(ViewportEvent::Close);
                // A hidden window may never receive a request to redraw.
                return self.pass(events);
            }
            WindowEvent::Destroyed if is_main => return self.end(events, Ok(())),
            WindowEvent::CloseRequested | WindowEvent::Destroyed => {
                pane.info.events.push(ViewportEvent::Close);
                return self.pass_plot(events, id, false);
            }
            WindowEvent::Resized(_) => open.resize(id),
            _ => {}
        }
        if matches!(event, WindowEvent::Moved(_) | WindowEvent::Resized(_) | WindowEvent::Focused(_)) {
            open.keep_place(self.app, id);
        }
        if let Some(pane) = open.pane(id)
            && pane.input.on_window_event(&pane_window, &event).repaint
        {
            pane_window.request_redraw();
        }
    }

    fn about_to_wait(&mut self, events: &ActiveEventLoop) {
        let Some(open) = &mut self.open else { return };
        let now = Instant::now();
        // Some systems do not send redraw requests to a hidden window: its passes are limited in rate, but continue.
        let is_unseen = open.main.next.is_some() && open.main.is_unseen();
        if is_unseen {
            let is_beside = open.plots.iter().any(|pane| !pane.is_unseen());
            let interval = if is_beside { BESIDE_PASS_INTERVAL } else { HIDDEN_PASS_INTERVAL };
            let soonest = open.main.passed + interval;
            open.main.next = open.main.next.map(|next| next.max(soonest));
        }
        let mut wakes: Option<Instant> = None;
        let mut is_due = false;
        for pane in open.all() {
            match pane.next {
                Some(next) if next <= now => {
                    pane.next = None;
                    match is_unseen && pane.id == ViewportId::ROOT {
                        true => is_due = true,
                        false => pane.window.request_redraw(),
                    }
                }
                next => wakes = [wakes, next].into_iter().flatten().min(),
            }
        }
        events.set_control_flow(wakes.map_or(ControlFlow::Wait, ControlFlow::WaitUntil));
        if is_due {
            self.pass(events);
        }
    }

    fn exiting(&mut self, _: &ActiveEventLoop) {
        self.app.close();
        // Listeners to the window system must be dropped before it.
        self.open = None;
    }
}
