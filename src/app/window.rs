//! A real window around an [`AppState`].

mod chooser;
mod device;
mod keeper;
mod times;

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use egui::{Key, KeyboardShortcut, Modifiers};
use thiserror::Error;

use chooser::Chooser;
use device::{Device, Left};
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
    /// The graphics device went away while the window was open, and none could be had in its place.
    #[error("the graphics device was lost: {why}; {}", kept_in(.kept.as_deref()))]
    DeviceLost {
        /// Why there is no other.
        why: String,
        /// Where the session is kept, if something was done to it.
        kept: Option<PathBuf>,
    },
}

fn kept_in(kept: Option<&Path>) -> String {
    match kept {
        Some(file) => format!("what was done is in {}, and the next start offers it", file.display()),
        None => "nothing was done that is in no file".into(),
    }
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
    let place = egui::ViewportBuilder::default().with_inner_size(liked.size);
    let mut app = App::of(app_state, Clock::Wall(None)).kept(liked);
    app.may_break = std::env::var_os("STILLBASE_BREAK_DEVICE").is_some();
    let mut ended = open_soundly(&mut app, place, None);
    while let Some(lost) = app.device.take_if(|device| device.is_lost()) {
        let begun = Instant::now();
        if ended.is_ok() {
            let Left { ctx, place, events } = lost.left();
            app.events = events;
            app.app_state.announce("the graphics device was lost, and another one took over: all is as it was");
            ended = open_soundly(&mut app, place, Some(ctx));
        }
        let lost_again = |device: &Device| device.is_lost() && (ended.is_err() || begun.elapsed() < LASTS);
        if app.device.as_ref().is_none_or(lost_again) {
            let why = ended.err().map_or("so was the one that took over".into(), |why| why.to_string());
            let kept = app.keep_now();
            app.end();
            return Err(WindowError::DeviceLost { why, kept });
        }
    }
    ended
}

/// A device that is lost again sooner would be lost for ever.
const LASTS: Duration = Duration::from_secs(10);

/// Shows the application in a window as [`open`] does, whatever drivers do once their device is lost.
fn open_soundly(app: &mut App, place: egui::ViewportBuilder, ctx: Option<egui::Context>) -> Result<(), WindowError> {
    catch_unwind(AssertUnwindSafe(|| open(app, place, ctx))).unwrap_or_else(|panic| {
        if !app.device.as_ref().is_some_and(Device::is_lost) {
            resume_unwind(panic);
        }
        Err(WindowError::Failed("the window broke off when its device was lost".into()))
    })
}

/// Shows the application in a window at a place until that is closed or its device is lost.
fn open(app: &mut App, place: egui::ViewportBuilder, ctx: Option<egui::Context>) -> Result<(), WindowError> {
    let viewport = place.with_title("Stillbase").with_app_id("stillbase").with_min_inner_size([960.0, 600.0]);
    let options = eframe::NativeOptions { viewport, renderer: eframe::Renderer::Wgpu, ..Default::default() };
    let opened = Cell::new(false);
    let create: eframe::AppCreator<'_> = Box::new(|cc| {
        app.draw_on(cc).ok_or("no graphics adapter")?;
        let adapter = cc.wgpu_render_state.as_ref().map(|state| state.adapter.get_info().device_type);
        if adapter == Some(wgpu::DeviceType::Cpu) {
            draw_drafts(&cc.egui_ctx);
        }
        opened.set(true);
        Ok(Box::new(Guest(app)))
    });
    match eframe::run_native_ext("stillbase", options, ctx, create) {
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
    /// What it draws on.
    device: Option<Device>,
    /// A key takes the device away: for tests.
    may_break: bool,
    /// What the next window gets to know first.
    events: Vec<egui::Event>,
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
    fn of(app_state: AppState, clock: Clock) -> Self {
        let (title, times) = (String::new(), Times::default());
        let (device, events, keeper, chooser) = (None, Vec::new(), None, None);
        Self { app_state, clock, title, encodes: false, times, device, may_break: false, events, keeper, chooser }
    }

    /// Around a state; `None` if eframe has no graphics adapter, or one whose shaders read no lists.
    pub fn new(cc: &eframe::CreationContext<'_>, app_state: AppState, clock: Clock) -> Option<Self> {
        let mut app = Self::of(app_state, clock);
        app.draw_on(cc)?;
        Some(app)
    }

    /// Draws from now on what eframe has, be it the first or after another was lost; `None` as [`Self::new`].
    pub fn draw_on(&mut self, cc: &eframe::CreationContext<'_>) -> Option<()> {
        let state = cc.wgpu_render_state.as_ref()?;
        if state.device.limits().max_storage_buffers_per_shader_stage == 0 {
            return None;
        }
        let renderers = Renderers::new(&state.device, state.target_format);
        state.renderer.write().callback_resources.insert(renderers);
        self.encodes = state.target_format.is_srgb();
        self.device = Some(Device::watched(&state.device, &cc.egui_ctx));
        self.title.clear();
        Some(())
    }

    /// The same, which writes down what is to last, and asks for files as the system does.
    fn kept(self, liked: Preferences) -> Self {
        let keeper = Keeper::new(liked, &self.app_state);
        Self { keeper: Some(keeper), chooser: Some(Chooser::default()), ..self }
    }

    /// Stops what is under way.
    fn end(&mut self) {
        self.app_state.close();
        // A recording that is not there yet leaves nothing half written.
        drop(crate::files::abandon());
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
}

/// The keys that take the device away where that is allowed.
const BREAK: KeyboardShortcut = KeyboardShortcut::new(Modifiers::CTRL.plus(Modifiers::SHIFT), Key::F12);

/// The application as a guest of a window, which it outlives.
struct Guest<'a>(&'a mut App);

impl eframe::App for Guest<'_> {
    fn ui(&mut self, ui: &mut egui::Ui, frame: &mut eframe::Frame) {
        self.0.ui(ui, frame);
    }

    fn raw_input_hook(&mut self, ctx: &egui::Context, input: &mut egui::RawInput) {
        self.0.raw_input_hook(ctx, input);
    }

    fn clear_color(&self, visuals: &egui::Visuals) -> [f32; 4] {
        self.0.clear_color(visuals)
    }

    fn on_exit(&mut self) {
        self.0.on_exit();
    }
}

impl eframe::App for App {
    fn ui(&mut self, ui: &mut egui::Ui, frame: &mut eframe::Frame) {
        if let Some(device) = &mut self.device {
            let broken = self.may_break && ui.input_mut(|i| i.consume_shortcut(&BREAK));
            if broken {
                device.destroy();
            }
            // Nothing can be drawn on it any more, nor should anything be asked: the window closes to be opened again.
            if device.is_lost() {
                device.leave();
                return;
            }
        }
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
            self.app_state.carry_out(Command::OpenFile(path));
        }
        self.app_state.ui(ui);
        let now = Instant::now();
        self.times.end(now);
        if self.app_state.view_state().times {
            self.times.show(ui.ctx(), &self.app_state.view_state().palette(), now);
        }
        if let Some(chooser) = &mut self.chooser {
            chooser.follow(ui.ctx(), frame, &mut self.app_state);
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

    fn raw_input_hook(&mut self, _: &egui::Context, input: &mut egui::RawInput) {
        input.events.splice(0..0, self.events.drain(..));
    }

    /// Panels lie on it: what is cleared need not be filled.
    fn clear_color(&self, visuals: &egui::Visuals) -> [f32; 4] {
        match self.encodes {
            true => egui::Rgba::from(visuals.panel_fill).to_array(),
            false => visuals.panel_fill.to_normalized_gamma_f32(),
        }
    }

    fn on_exit(&mut self) {
        if self.device.as_ref().is_some_and(Device::is_lost) {
            return;
        }
        if let Some(keeper) = &mut self.keeper {
            keeper.end();
        }
        self.end();
    }
}
