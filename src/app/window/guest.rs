//! [`App`]: the application as the guest of a window, with its clock and its title, and what it writes down.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use egui::{Key, KeyboardShortcut, Modifiers};
use winit::window::Window;

use super::chooser::Chooser;
use super::error::WindowError;
use super::keeper::Keeper;
use super::times::Times;
use crate::app::{AppState, Preferences, SessionCommand, WindowCommand};

/// The application as a window shows it, and as tests drive it without one.
pub struct App {
    app_state: AppState,
    clock: Clock,
    /// What stands above the window.
    title: String,
    times: Times,
    /// The window of the desktop, if there is one.
    window: Option<Arc<Window>>,
    /// A key takes the graphics device away: for tests.
    may_break: bool,
    /// That key was pressed.
    breaks: bool,
    /// The graphics device went away for good: the session is to be offered at the next start.
    is_cut_off: bool,
    /// Who writes down what is to last; nobody does in tests.
    keeper: Option<Keeper>,
    /// Who asks for files; the window itself does in tests.
    chooser: Option<Chooser>,
}

/// Where wall time comes from.
#[derive(Clone, Copy, Debug)]
pub enum Clock {
    /// The machine's clock, and what it last said.
    Wall(Option<Instant>),
    /// The same time for each repaint, s: for tests.
    Fixed(f64),
}

impl App {
    /// Around a state.
    pub fn new(app_state: AppState, clock: Clock) -> Self {
        let (title, times, window) = (String::new(), Times::default(), None);
        let (may_break, breaks, is_cut_off) = (false, false, false);
        Self { app_state, clock, title, times, window, may_break, breaks, is_cut_off, keeper: None, chooser: None }
    }

    /// The same, which writes down what is to last, and asks for files as the system does; whether a key takes the
    /// graphics device away.
    pub(super) fn kept(self, liked: Preferences, may_break: bool) -> Self {
        let keeper = Keeper::new(liked, &self.app_state);
        Self { keeper: Some(keeper), chooser: Some(Chooser::default()), may_break, ..self }
    }

    /// From now on it is shown in a window of the desktop.
    pub(super) fn shown_in(&mut self, window: Arc<Window>) {
        self.window = Some(window);
    }

    /// Whether the graphics device is to be taken away; asked for once.
    pub(super) fn breaks(&mut self) -> bool {
        std::mem::take(&mut self.breaks)
    }

    /// Another graphics device has taken over.
    pub(super) fn was_replaced(&mut self) {
        self.app_state.announce("the graphics device was lost, and another one took over: all is as it was");
    }

    /// No graphics device can be had in the place of the one that was lost.
    pub(super) fn cut_off(&mut self, why: String) -> WindowError {
        self.is_cut_off = true;
        WindowError::DeviceLost { why, kept: self.keep_now() }
    }

    /// Ends with its window.
    pub(super) fn close(&mut self) {
        if let Some(keeper) = self.keeper.as_mut().filter(|_| !self.is_cut_off) {
            keeper.end();
        }
        self.app_state.close();
        // A recording that is not there yet leaves nothing half written.
        drop(crate::files::abandon());
        self.window = None;
    }

    /// Writes down what was done, at once; where.
    fn keep_now(&mut self) -> Option<PathBuf> {
        self.keeper.as_mut()?.keep_now(&self.app_state)
    }

    /// What it shows.
    pub fn app_state(&self) -> &AppState {
        &self.app_state
    }

    /// The same, to be told what to do.
    pub fn app_state_mut(&mut self) -> &mut AppState {
        &mut self.app_state
    }

    /// One pass of the interface over a whole window.
    pub fn ui(&mut self, ui: &mut egui::Ui) {
        self.breaks |= self.may_break && ui.input_mut(|i| i.consume_shortcut(&BREAK));
        let now = Instant::now();
        self.times.begin(now);
        let wall = match &mut self.clock {
            Clock::Fixed(wall) => *wall,
            Clock::Wall(last) => last.replace(now).map_or(0.0, |last| (now - last).as_secs_f64()),
        };
        self.app_state.pass(wall);
        if let Clock::Wall(_) = self.clock {
            self.app_state.took(now.elapsed().as_secs_f64());
        }
        let dropped: Option<PathBuf> = ui.input(|i| i.raw.dropped_files.first().map(|f| f.path().to_path_buf()));
        if let Some(path) = dropped {
            self.app_state.carry_out(SessionCommand::OpenFile(path));
        }
        self.app_state.ui(ui);
        let now = Instant::now();
        self.times.end(now);
        if self.app_state.view_state().open.times {
            self.times.show(ui.ctx(), &self.app_state.view_state().palette(), now);
        }
        if let Some((chooser, window)) = self.chooser.as_mut().zip(self.window.as_deref()) {
            chooser.follow(ui.ctx(), window, &mut self.app_state);
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
}

/// The keys that take the device away where that is allowed.
const BREAK: KeyboardShortcut = KeyboardShortcut::new(Modifiers::CTRL.plus(Modifiers::SHIFT), Key::F12);
