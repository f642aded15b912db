//! `stillbase [SCENARIO]`: the window, or a recording where there is no display.

use clap::Args;
use stillbase::scenario::Scenario;
use stillbase::session::Run;

use super::failure::Failure;
use super::input::{DEFAULT_SCENARIO, Settings, scenario};

/// What to open.
#[derive(Args)]
pub struct Open {
    /// A built-in scenario (case-1, case-2, case-3) or a TOML file to open in a window
    #[arg(value_name = "SCENARIO", default_value = DEFAULT_SCENARIO)]
    scenario: String,
    #[command(flatten)]
    settings: Settings,
}

impl Open {
    /// Shows the scenario, or records it beside the reader.
    pub fn run(&self) -> Result<(), Failure> {
        let scenario = scenario(&self.scenario, &self.settings).map_err(|failure| match failure {
            // Most likely a command mistyped.
            Failure::WrongInput(why) if !self.scenario.ends_with(".toml") => {
                Failure::WrongInput(format!("{why}; `stillbase --help` lists the commands"))
            }
            other => other,
        })?;
        // What cannot start is said here, before anything opens.
        Run::new(&scenario).map_err(|e| Failure::from(e).of(&scenario.name))?;
        #[cfg(feature = "window")]
        let why = match window::run(scenario.clone()) {
            Ok(()) => return Ok(()),
            Err(error) => error.to_string(),
        };
        #[cfg(not(feature = "window"))]
        let why = "this build has no window".to_string();
        record_instead(scenario, &why)
    }
}

#[cfg(feature = "record")]
fn record_instead(scenario: Scenario, why: &str) -> Result<(), Failure> {
    use super::headless::{record_with_bar, unpictured};
    use super::output::{fixed, say, yes};

    let file = free_name(&scenario.name);
    say(format!("{why}; recording {} without a window instead", scenario.name));
    for done in record_with_bar(&[scenario], &file, &unpictured())? {
        say(format!(
            "wrote {}: {} steps, peak |n_B| {} N m, reactionless: {}",
            done.file.display(),
            done.steps,
            fixed(done.peak_base_moment, 6),
            yes(done.reactionless),
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

/// `NAME.rrd` in the current folder, or the first of `NAME-1.rrd`, `NAME-2.rrd` … that is free.
#[cfg(feature = "record")]
fn free_name(name: &str) -> std::path::PathBuf {
    // A scenario's name is free text; as a file name it must stay in this folder.
    let plain = |c: char| if c.is_alphanumeric() || matches!(c, '-' | '_' | ' ') { c } else { '-' };
    let stem: String = name.chars().map(plain).collect();
    let numbered = (1_u64..).map(|i| format!("{stem}-{i}.rrd"));
    std::iter::once(format!("{stem}.rrd"))
        .chain(numbered)
        .map(std::path::PathBuf::from)
        .find(|file| file.symlink_metadata().is_err())
        .unwrap_or_default()
}

// MERGE: replace this module by `use stillbase::window;`.
#[cfg(feature = "window")]
mod window {
    use stillbase::scenario::Scenario;

    pub fn run(_: Scenario) -> Result<(), String> {
        Err("no display".into())
    }
}
