//! A desktop window around an [`AppState`].

mod app;
mod beside;
mod chooser;
mod error;
mod keeper;
mod monitors;
mod pane;
mod screen;
mod shell;
mod times;
mod waker;
mod windows;

pub use app::{App, Clock};
pub use error::WindowError;
pub use monitors::{MonitorArea, visible_place};

use std::path::PathBuf;

use crate::jobs::Threads;
use crate::{AppState, Preferences, ResumePoint, SessionCommand};
use stillbase_files::preferences;
use stillbase_files::recorded_case::is_recording;
use stillbase_picture::scene::palette::Theme;
use stillbase_session::scenario::Scenario;

/// Opens a window on a scenario and returns when it is closed. If `file` is a session that a window wrote, it is shown as
/// it was left.
///
/// # Errors
/// If there is no display, library or adapter, or the scenario cannot start.
pub fn run(
    scenario: Scenario,
    file: Option<PathBuf>,
    tables: Vec<PathBuf>,
    theme: Option<Theme>,
) -> Result<(), WindowError> {
    error::check_libraries()?;
    let liked: Preferences = preferences::load();
    let liked = liked.sound();
    let shown = Preferences { theme: theme.unwrap_or(liked.theme), ..liked.clone() };
    let mut app_state = AppState::open_or_explain(scenario, shown.theme)?
        .with_workers(Threads::Background)
        .watching(file.clone())
        .with_preferences(&shown)
        .offering_recovery(keeper::find_left_session())
        .with_tables(tables);
    // Opening the file tells where it was left, and whether a recording equals its run.
    let left = file.filter(|file| {
        is_recording(&file.to_string_lossy())
            || ResumePoint::of(&stillbase_files::text::read(file).unwrap_or_default()).is_some()
    });
    if let Some(file) = left {
        app_state.carry_out(SessionCommand::OpenFile(file));
    } else if app_state.view_state().status.message.is_none() && app_state.session().run().waiting().is_none() {
        app_state.carry_out(SessionCommand::TogglePlay);
    }
    let place = egui::ViewportBuilder::default()
        .with_title("Stillbase")
        .with_app_id("stillbase")
        .with_inner_size(liked.size)
        .with_min_inner_size([960.0, 600.0]);
    let may_break = std::env::var_os("STILLBASE_BREAK_DEVICE").is_some();
    shell::show(&mut App::new(app_state, Clock::Wall(None)).with_storage(liked, may_break), place)
}
