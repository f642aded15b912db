//! A real window around an [`AppState`].

mod keeper;
mod times;

use std::cell::Cell;
use std::path::PathBuf;
use std::rc::Rc;
use std::time::Instant;

use thiserror::Error;

use keeper::Keeper;
use times::Times;

use crate::app::jobs::Threads;
use crate::app::{AppState, Command, Preferences};
use crate::files::preferences;
use crate::picture::paint::{Renderers, draw_drafts};
use crate::picture::render::offscreen::{Gpu, NoAdapter};
use crate::picture::scene::palette::Theme;
use crate::session::Refusal;
use crate::session::scenario::Scenario;

/// Why there is no window.
#[derive(Debug, Error)]
pub enum WindowError {
    /// No display server answers.
    #[error("no display: {0}")]
    NoDisplay(String),
    /// A library that the window system needs.
    #[error("the window needs {library}: install it with `{install}`")]
    MissingLibrary {
        /// File name of the library.
        library: &'static str,
        /// What installs it on Debian.
        install: &'static str,
    },
    /// The scenario cannot start.
    #[error(transparent)]
    Refused(#[from] Refusal),
    /// Nothing can draw on the display.
    #[error("the window cannot be drawn: {0}")]
    NoAdapter(String),
    /// The window system failed.
    #[error("the window could not be opened: {0}")]
    Failed(String),
}

/// Opens a window on a scenario and returns when it is closed.
///
/// # Errors
/// If there is no display, library or adapter, or the scenario cannot start.
pub fn run(scenario: Scenario, theme: Option<Theme>) -> Result<(), WindowError> {
    check_libraries()?;
    let liked: Preferences = preferences::load();
    let liked = Preferences { theme: theme.unwrap_or(liked.theme), ..liked }.sound();
    let mut app_state = AppState::open_or_explain(scenario, liked.theme)?
        .with_workers(Threads)
        .with_preferences(&liked)
        .finding(keeper::found());
    if app_state.view_state().message.is_none() && app_state.session().run().waiting().is_none() {
        app_state.carry_out(Command::TogglePlay);
    }
    let options = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_title("Stillbase")
            .with_app_id("stillbase")
            .with_inner_size(liked.size)
            .with_min_inner_size([960.0, 600.0]),
        renderer: eframe::Renderer::Wgpu,
        ..Default::default()
    };
    let opened = Rc::new(Cell::new(false));
    let seen = opened.clone();
    let create: eframe::AppCreator<'_> = Box::new(move |cc| {
        let app = App::new(cc, app_state, Clock::Wall(None)).ok_or("no graphics adapter")?.kept(liked);
        let adapter = cc.wgpu_render_state.as_ref().map(|state| state.adapter.get_info().device_type);
        if adapter == Some(wgpu::DeviceType::Cpu) {
            draw_drafts(&cc.egui_ctx);
        }
        seen.set(true);
        Ok(Box::new(app))
    });
    match eframe::run_native("stillbase", options, create) {
        Err(eframe::Error::WinitEventLoop(why)) if !opened.get() => {
            Err(WindowError::NoDisplay(last_clause(&why.to_string())))
        }
        Err(why @ eframe::Error::Winit(_)) => Err(WindowError::Failed(why.to_string())),
        // Where eframe cannot draw, it may end as if the window had been closed, and keep the reason to itself.
        _ if !opened.get() => Err(WindowError::NoAdapter(what_is_missing())),
        Err(why) => Err(WindowError::Failed(why.to_string())),
        Ok(()) => Ok(()),
    }
}

/// Why nothing could be drawn on a display that is there.
fn what_is_missing() -> String {
    // SAFETY: the loader of the graphics drivers, which has been tried a moment ago in the same way; its initialisers
    // do nothing but set up its own state.
    if cfg!(target_os = "linux") && unsafe { libloading::Library::new("libvulkan.so.1") }.is_err() {
        return "libvulkan.so.1 is missing: install it with `apt-get install libvulkan1`".into();
    }
    match Gpu::new() {
        // The list of drivers that were tried would not help a reader.
        Err(NoAdapter::Missing(_)) => "no graphics driver answers; on Debian and its kin one in software comes with \
                                       `apt-get install mesa-vulkan-drivers`"
            .into(),
        Err(other) => other.to_string(),
        Ok(gpu) => format!("the GPU adapter {} cannot draw on this display", gpu.name()),
    }
}

/// winit puts the place in its own source before what is wrong.
fn last_clause(text: &str) -> String {
    text.rsplit(": ").next().unwrap_or(text).to_owned()
}

/// On X11 a missing library would end the program deep inside; name it before.
fn check_libraries() -> Result<(), WindowError> {
    let x11 = cfg!(target_os = "linux")
        && std::env::var_os("WAYLAND_DISPLAY").is_none()
        && std::env::var_os("DISPLAY").is_some();
    if !x11 {
        return Ok(());
    }
    for (library, install) in [
        ("libxkbcommon-x11.so.0", "apt-get install libxkbcommon-x11-0"),
        ("libXcursor.so.1", "apt-get install libxcursor1"),
        ("libXi.so.6", "apt-get install libxi6"),
    ] {
        // SAFETY: these are system libraries that the window system loads a moment later in the same way; their
        // initialisers do nothing but set up their own state.
        if unsafe { libloading::Library::new(library) }.is_err() {
            return Err(WindowError::MissingLibrary { library, install });
        }
    }
    Ok(())
}

/// The application as eframe wants it; tests drive it without a window.
pub struct App {
    app_state: AppState,
    clock: Clock,
    /// What stands above the window.
    title: String,
    /// Whether what it draws on encodes colours by itself.
    encodes: bool,
    times: Times,
    /// Who writes down what is to last; nobody does in tests.
    keeper: Option<Keeper>,
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
    /// Around a state; `None` if eframe has no graphics adapter, or one whose shaders read no lists.
    pub fn new(cc: &eframe::CreationContext<'_>, app_state: AppState, clock: Clock) -> Option<Self> {
        let state = cc.wgpu_render_state.as_ref()?;
        if state.device.limits().max_storage_buffers_per_shader_stage == 0 {
            return None;
        }
        let renderers = Renderers::new(&state.device, state.target_format);
        state.renderer.write().callback_resources.insert(renderers);
        let encodes = state.target_format.is_srgb();
        Some(Self { app_state, clock, title: String::new(), encodes, times: Times::default(), keeper: None })
    }

    /// The same, which writes down what is to last.
    fn kept(self, liked: Preferences) -> Self {
        let keeper = Keeper::new(liked, &self.app_state);
        Self { keeper: Some(keeper), ..self }
    }

    /// What it shows.
    pub fn app_state(&self) -> &AppState {
        &self.app_state
    }

    /// The same, to be told what to do.
    pub fn app_state_mut(&mut self) -> &mut AppState {
        &mut self.app_state
    }
}

impl eframe::App for App {
    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        let now = Instant::now();
        self.times.begin(now);
        let wall = match &mut self.clock {
            Clock::Fixed(wall) => *wall,
            Clock::Wall(last) => last.replace(now).map_or(0.0, |last| (now - last).as_secs_f64()),
        };
        self.app_state.pass(wall);
        let dropped: Option<PathBuf> = ui.input(|i| i.raw.dropped_files.first().map(|f| f.path().to_path_buf()));
        if let Some(path) = dropped {
            self.app_state.carry_out(Command::OpenFile(path));
        }
        self.app_state.ui(ui);
        let now = Instant::now();
        self.times.end(now);
        if self.app_state.view_state().times {
            self.times.show(ui.ctx(), &self.app_state.view_state().palette(), now);
        }
        if let Some(keeper) = &mut self.keeper {
            keeper.keep(ui.ctx(), &mut self.app_state);
        }
        if self.app_state.wants_to_leave() {
            ui.ctx().send_viewport_cmd(egui::ViewportCommand::Close);
        } else if ui.input(|i| i.viewport().close_requested()) && !self.app_state.may_leave() {
            ui.ctx().send_viewport_cmd(egui::ViewportCommand::CancelClose);
            self.app_state.carry_out(Command::AskToLeave(true));
        }
        let title = self.app_state.title();
        if self.title != title {
            ui.ctx().send_viewport_cmd(egui::ViewportCommand::Title(title.clone()));
            self.title = title;
        }
    }

    /// Panels lie on it: what is cleared need not be filled.
    fn clear_color(&self, visuals: &egui::Visuals) -> [f32; 4] {
        match self.encodes {
            true => egui::Rgba::from(visuals.panel_fill).to_array(),
            false => visuals.panel_fill.to_normalized_gamma_f32(),
        }
    }

    fn on_exit(&mut self) {
        if let Some(keeper) = &mut self.keeper {
            keeper.end();
        }
        self.app_state.close();
        // A recording that is not there yet leaves nothing half written.
        drop(crate::files::abandon());
    }
}
