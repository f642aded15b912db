//! `stillbase report`

use std::path::PathBuf;

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;
use stillbase_app::export::{ReportDone, write_report};
use stillbase_app::{AppState, Switch, ViewChange};
use stillbase_picture::scene::palette::Theme;
use stillbase_session::verdict::Statements;
use stillbase_settings::number::counted;
use stillbase_settings::text::shell_word;

use super::exit::print_message;
use super::failure::Failure;
use super::file_form::FileForm;
use super::input::{DEFAULT_SCENARIO, Settings, scenario};
use super::output::{Format, file_words};
use super::progress::goes_on;
use super::simulate::require_audit;
use super::strict::{Strict, bad_statements};

/// Write a report on a run as one HTML page: verdicts, pictures, plots, task, settings and machine
///
/// A browser shows the page and prints it. It needs no other file; without a graphics adapter it has no pictures.
#[derive(Args)]
#[command(after_help = "\
Examples:
  stillbase report case-3 -o report.html
  stillbase report case-3 -o loaded.html --set plant.payload.mass=0.2
  stillbase report spacecraft -o ways.html --compare")]
pub struct ReportArguments {
    /// A built-in scenario or machine, or a TOML file of either
    #[arg(value_name = "SCENARIO", default_value = DEFAULT_SCENARIO)]
    scenario: String,
    /// The page to write; `-` is standard output
    #[arg(short, long, value_name = "FILE.html")]
    output: PathBuf,
    /// Add a table that compares the same task done in other ways, each of which is simulated
    #[arg(long)]
    compare: bool,
    /// Replace the file if it exists
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    settings: Settings,
    #[command(flatten)]
    strict: Strict,
    #[command(flatten)]
    form: FileForm,
    #[command(flatten)]
    format: Format,
}

#[derive(JsonSchema, Serialize)]
pub struct Answer {
    file: String,
    /// Number of pictures of the scene.
    pictures: usize,
    /// Number of plots.
    plots: usize,
    /// Statements on machine, plan and run, as the report shows them.
    statements: Statements,
}

impl ReportArguments {
    /// Simulates the scenario and writes the report.
    pub fn run(&self) -> Result<(), Failure> {
        self.form.check(&self.format, Some(&self.output), self.force, &["html", "htm"])?;
        let scenario = scenario(&self.scenario, &self.settings)?;
        let name = scenario.name.clone();
        let mut app_state =
            AppState::new(scenario.clone(), Theme::Light).map_err(|why| Failure::refused(&scenario, why))?;
        if self.compare {
            app_state.carry_out(ViewChange::Switch(Switch::Compare, true));
        }
        let done = write_report(&mut app_state, Some(self.command()), &self.output, self.force, &mut |_| goes_on())?;
        let ReportDone { pictures, plots, statements, fault } = done;
        let pictures = pictures.unwrap_or_else(|why| {
            print_message(format!("the report has no pictures: {why}"));
            0
        });
        let answer = Answer { file: self.output.display().to_string(), pictures, plots, statements };
        self.format.print(&answer, |answer| {
            let (pictures, plots) = (counted(answer.pictures, "picture"), counted(answer.plots, "plot"));
            format!("{}: {pictures}, {plots}; {}\n", file_words(&self.output), answer.statements.line())
        })?;
        let Statements { machine, plan, run } = &answer.statements;
        require_audit(&name, fault)?;
        self.strict.require(bad_statements([("machine", machine), ("plan", plan), ("run", run)]))
    }

    /// Returns the command that writes the same report, without `--force` and `--json`.
    fn command(&self) -> String {
        let output = self.output.display().to_string();
        let compare = if self.compare { " --compare" } else { "" };
        let (name, output) = (shell_word(&self.scenario), shell_word(&output));
        format!("stillbase report {name}{} -o {output}{compare}", self.settings.as_typed())
    }
}
