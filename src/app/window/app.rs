//! [`App`]: the application in a window, with its clock, its title, and its stored files.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use egui::{Key, KeyboardShortcut, Modifiers};
use winit::window::Window;

use super::chooser::Chooser;
use super::error::WindowError;
use super::keeper::Keeper;
use super::times::Times;
use super::waker::Waker;
use crate::{AppState, Preferences, SessionCommand, WindowCommand};

/// The application, in a window or driven by tests without one.
pub struct App {
    app_state: AppState,
    clock: Clock,
    /// The title of the window.
    title: String,
    times: Times,
    /// The desktop window, if there is one.
    window: Option<Arc<Window>>,
    /// Whether a key simulates the loss of the graphics device: for tests.
    may_break: bool,
    /// Whether that key was pressed.
    breaks: bool,
    /// Whether the graphics device was lost for good: the session is then offered at the next start.
    is_cut_off: bool,
    /// Writes preferences and journal; `None` in tests.
    keeper: Option<Keeper>,
    /// Wakes the window when the file of the session changes; `None` in tests.
    waker: Option<Waker>,
    /// Shows the system's file dialogs; `None` in tests, where the window shows its own.
    chooser: Option<Chooser>,
}

/// Source of wall time.
#[derive(Clone, Copy, Debug)]
pub enum Clock {
    /// The system clock, and its last reading.
    Wall(Option<Instant>),
    /// A fixed time per repaint, s: for tests.
    Fixed(f64),
}

impl App {
    /// Creates the application around a state.
    pub fn new(app_state: AppState, clock: Clock) -> Self {
        let (title, times, window) = (String::new(), Times::default(), None);
        let (may_break, breaks, is_cut_off) = (false, false, false);
        Self {
            app_state,
            clock,
            title,
            times,
            window,
            may_break,
            breaks,
            is_cut_off,
            keeper: None,
            waker: None,
            chooser: None,
        }
    }

    /// Enables preferences, journal and the system's file dialogs; `may_break` says whether a key simulates the loss of
    /// the graphics device.
    pub(super) fn with_storage(self, liked: Preferences, may_break: bool) -> Self {
        let keeper = Keeper::new(liked, &self.app_state);
        let waker = Some(Waker::default());
        Self { keeper: Some(keeper), waker, chooser: Some(Chooser::default()), may_break, ..self }
    }

    /// Sets the desktop window.
    pub(super) fn shown_in(&mut self, window: Arc<Window>) {
        self.window = Some(window);
    }

    /// Takes the request to simulate the loss of the graphics device.
    pub(super) fn breaks(&mut self) -> bool {
        std::mem::take(&mut self.breaks)
    }

    /// Tells the user that another graphics device has taken over.
    pub(super) fn was_replaced(&mut self) {
        self.app_state.announce("the graphics device was lost, and another one took over: all is as it was");
    }

    /// Writes the journal after the graphics device was lost for good; returns the error.
    pub(super) fn cut_off(&mut self, why: String) -> WindowError {
        self.is_cut_off = true;
        WindowError::DeviceLost { why, kept: self.keep_now() }
    }

    /// Ends the application with its window.
    pub(super) fn close(&mut self) {
        if let Some(keeper) = self.keeper.as_mut().filter(|_| !self.is_cut_off) {
            keeper.end();
        }
        self.app_state.close();
        // An unfinished recording leaves no incomplete file.
        drop(stillbase_files::abandon());
        self.window = None;
    }

    /// Writes the journal at once; returns its file.
    fn keep_now(&mut self) -> Option<PathBuf> {
        self.keeper.as_mut()?.keep_now(&self.app_state)
    }

    /// The state of the user interface.
    pub fn app_state(&self) -> &AppState {
        &self.app_state
    }

    /// The mutable state of the user interface.
    pub fn app_state_mut(&mut self) -> &mut AppState {
        &mut self.app_state
    }

    /// Runs one pass of the user interface over the whole window.
    pub fn ui(&mut self, ui: &mut egui::Ui) {
        self.breaks |= self.may_break && ui.input_mut(|i| i.consume_shortcut(&BREAK));
        let now = Instant::now();
        self.times.begin(now);
        let wall = match &mut self.clock {
            Clock::Fixed(wall) => *wall,
            Clock::Wall(last) => last.replace(now).map_or(0.0, |last| (now - last).as_secs_f64()),
        };
        self.app_state.pass(wall);
        self.app_state.look_at_file(wall);
        if let Clock::Wall(_) = self.clock {
            self.app_state.record_cost(now.elapsed().as_secs_f64());
        }
        self.open_dropped(ui);
        self.app_state.ui(ui);
        let now = Instant::now();
        self.times.end(now);
        if self.app_state.view_state().open.times {
            self.times.show(ui.ctx(), &self.app_state.view_state().palette(), now);
        }
        if let Some((chooser, window)) = self.chooser.as_mut().zip(self.window.as_deref()) {
            chooser.follow(ui.ctx(), window, &mut self.app_state);
        }
        if let Some(waker) = &mut self.waker {
            waker.follow(ui.ctx(), self.app_state.watched_file());
        }
        if let Some(keeper) = &mut self.keeper {
            keeper.keep(ui.ctx(), &mut self.app_state);
        }
        if self.app_state.wants_to_leave() {
            ui.ctx().send_viewport_cmd(egui::ViewportCommand::Close);
        } else if ui.input(|i| i.viewport().close_requested()) && !self.app_state.may_leave() {
            ui.ctx().send_viewport_cmd(egui::ViewportCommand::CancelClose);
            self.app_state.carry_out(WindowCommand::AskToLeave(true));
        }
        let title = self.app_state.title();
        if self.title != title {
            ui.ctx().send_viewport_cmd(egui::ViewportCommand::Title(title.clone()));
            self.title = title;
        }
    }

    /// Runs one pass of the user interface over the window of a plot.
    pub fn plot_ui(&mut self, ui: &mut egui::Ui, id: egui::ViewportId) {
        self.open_dropped(ui);
        self.app_state.plot_ui(ui, id);
    }

    /// Opens a file that was dropped on a window.
    fn open_dropped(&mut self, ui: &egui::Ui) {
        let dropped: Option<PathBuf> = ui.input(|i| i.raw.dropped_files.first().map(|f| f.path().to_path_buf()));
        if let Some(path) = dropped {
            self.app_state.carry_out(SessionCommand::OpenFile(path));
            ui.ctx().request_repaint_of(egui::ViewportId::ROOT);
        }
    }

    /// Tells the user why a plot has no window of the desktop.
    pub(super) fn stays_in_window(&mut self, why: &str) {
        self.app_state.announce(&format!("the desktop shows no second window: {why}; plots stay over the scene"));
    }
}

/// The keys that simulate the loss of the graphics device.
const BREAK: KeyboardShortcut = KeyboardShortcut::new(Modifiers::CTRL.plus(Modifiers::SHIFT), Key::F12);
