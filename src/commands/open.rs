//! `stillbase [SCENARIO]`: the window, or a recording where there is no display.

#[cfg(feature = "window")]
use std::path::PathBuf;

use clap::Args;
#[cfg(feature = "window")]
use stillbase_app::window::WindowError;
#[cfg(feature = "window")]
use stillbase_files::recorded_case::is_recording;
#[cfg(feature = "window")]
use stillbase_files::table::{TABLE_ENDINGS, is_table};
#[cfg(feature = "ui")]
use stillbase_picture::scene::palette::Theme;
use stillbase_session::scenario::Scenario;

#[cfg(any(feature = "window", feature = "record"))]
use super::exit::print_message;
use super::failure::Failure;
#[cfg(not(feature = "ui"))]
use super::input::overlay_for_study;
#[cfg(feature = "ui")]
use super::input::overlay_of_any;
use super::input::{DEFAULT_SCENARIO, Settings};

/// Arguments of the program without a subcommand.
#[derive(Args)]
pub struct OpenArguments {
    /// A built-in scenario (case-1, spacecraft …; an unknown name lists them all) or a TOML file to open in a window
    #[arg(value_name = "SCENARIO", default_value = DEFAULT_SCENARIO)]
    scenario: String,
    /// Tables of a motion of your own or of measurements to open beside it, .csv or .parquet
    #[cfg(feature = "window")]
    #[arg(value_name = "TABLE")]
    tables: Vec<PathBuf>,
    /// Colours of the window
    #[cfg(feature = "window")]
    #[arg(long, value_enum)]
    theme: Option<ThemeName>,
    #[command(flatten)]
    settings: Settings,
}

/// Colours of a window or a picture.
#[cfg(feature = "ui")]
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
pub enum ThemeName {
    /// Dark
    Dark,
    /// Light
    Light,
}

#[cfg(feature = "ui")]
impl From<ThemeName> for Theme {
    fn from(name: ThemeName) -> Self {
        match name {
            ThemeName::Dark => Self::Dark,
            ThemeName::Light => Self::Light,
        }
    }
}

impl OpenArguments {
    /// Returns the file of the scenario, if it is opened as it is: the window then shows it as it was left.
    #[cfg(feature = "window")]
    fn file(&self) -> Option<PathBuf> {
        let file = PathBuf::from(&self.scenario);
        let is_file = Scenario::builtin(&self.scenario).is_none() && (file.is_file() || is_recording(&self.scenario));
        (is_file && self.settings.is_empty()).then_some(file)
    }

    /// Shows the scenario in a window, or records it if there is no window.
    pub fn run(&self) -> Result<(), Failure> {
        #[cfg(feature = "ui")]
        let found = overlay_of_any(&self.scenario, &self.settings);
        #[cfg(not(feature = "ui"))]
        let found = overlay_for_study(&self.scenario, &self.settings);
        let scenario = found.map_err(|failure| match failure {
            // The name may be a mistyped command.
            failure if Scenario::builtin(&self.scenario).is_none() && !self.scenario.ends_with(".toml") => {
                let failure = failure.worded(&|why| format!("{why}; `stillbase --help` lists the commands"));
                let misnamed = failure.misnamed().cloned().map(|misnamed| misnamed.or_command(&super::names()));
                failure.with_misnamed(misnamed)
            }
            failure => failure,
        })?;
        #[cfg(feature = "window")]
        if let Some(other) = self.tables.iter().find(|file| !is_table(file)) {
            let want = TABLE_ENDINGS.join(" or .");
            return Err(Failure::wrong_input(format!("{}: want a table, .{want}", other.display())));
        }
        #[cfg(feature = "window")]
        let theme = self.theme.map(Theme::from);
        #[cfg(feature = "window")]
        let why = match stillbase_app::window::run(scenario.clone(), self.file(), self.tables.clone(), theme) {
            Ok(()) => return Ok(()),
            Err(WindowError::Refused(refusal)) => return Err(Failure::refused(&scenario, refusal)),
            Err(lost @ WindowError::DeviceLost { .. }) => return Err(Failure::no_answer(lost)),
            // Without a window, the scenario is recorded.
            Err(error) => error.to_string(),
        };
        #[cfg(not(feature = "window"))]
        let why = "this build has no window".to_string();
        #[cfg(feature = "window")]
        if !self.tables.is_empty() {
            print_message(
                "note: tables are shown in a window only; `stillbase import` and `trim` read them without one",
            );
        }
        record_instead(scenario, &why)
    }
}

#[cfg(feature = "record")]
fn record_instead(scenario: Scenario, why: &str) -> Result<(), Failure> {
    use stillbase_files::free_name;
    use stillbase_settings::number::counted;

    use super::headless::{Target, record_with_bar, unpictured};

    let file = free_name(&scenario.name, "rrd");
    print_message(format!("{}; recording {} without a window instead", why.trim_end_matches('.'), scenario.name));
    for done in record_with_bar(&[scenario], &Target::File(file.clone()), &unpictured())? {
        print_message(format!(
            "wrote {}: {}, {}",
            file.display(),
            counted(done.steps, "step"),
            done.verdict.sentence()
        ));
    }
    Ok(())
}

#[cfg(not(feature = "record"))]
fn record_instead(scenario: Scenario, why: &str) -> Result<(), Failure> {
    Err(Failure::WrongInput(format!(
        "{why}, and this build does not record: want a display, or `stillbase simulate {}`",
        scenario.name
    )))
}
