//! `stillbase compare`

use std::path::PathBuf;

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;
use stillbase_mechanics::machine::{Machine, is_of_machine};
use stillbase_session::scenario::Scenario;
use stillbase_session::{SharedTask, with_start_edits};
use stillbase_study::comparison::{
    ComparisonRow, ComparisonTable, DESIGN_COLUMNS, OLD_NAMES, SUMMARY_COLUMNS, Summary, alternatives,
};

use super::exit::print_message;
use super::failure::Failure;
use super::file_form::FileForm;
use super::input::{DEFAULT_SCENARIO, Settings, distinct_names, machine, scenario};
#[cfg(feature = "record")]
use super::output::say_written;
use super::output::{Format, TextTable};
use super::progress::{check, goes_on};
use super::rows::{RowTarget, Rows};
use super::strict::{Strict, run_faults};
use stillbase_settings::number::{fixed, nine_digits};

/// Compare runs of one task done in several ways, of several scenarios, or of several machines on one task, by base
/// reactions and cost
///
/// One scenario: its task runs in up to six ways. They are as given, reactionless, straight (case 1), to another pose
/// (case 2), straight with a reaction wheel, and slowly. Several scenarios: each runs as given.
/// With --task: each machine does the task of that scenario, with the same points, the same time and, if possible, the
/// same start. A machine without a pose constant for a kind that wants one moves with the kind minimum-norm.
/// If their machines differ, a second table gives mass and balance of each, and cost and benefit relative to the first.
#[derive(Args)]
#[command(after_help = "\
Examples:
  stillbase compare case-3                                        five ways from A to B
  stillbase compare case-3 --set base.kind=free                   and what each does to a spacecraft
  stillbase compare case-3 --set base.wheel.torque_limit=0.5      when does the wheel saturate?
  stillbase compare nine-link-bare case-3                         what balance costs, and what it brings
  stillbase compare bare.toml balanced.toml --task case-3         before and after of a design, on one task
  stillbase compare case-1 case-3 my.toml -o table.csv")]
pub struct CompareArguments {
    /// One scenario to do in several ways, or several to compare; with --task, one machine or several
    #[arg(value_name = "SCENARIO|MACHINE", default_value = DEFAULT_SCENARIO)]
    names: Vec<String>,
    /// The scenario whose task the machines do
    #[arg(long, value_name = "SCENARIO", requires = "names")]
    task: Option<String>,
    /// Write the table, .csv or .parquet, or with .rrd the runs as a recording
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
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
    runs: ComparisonTable,
}

impl CompareArguments {
    /// Runs all scenarios and prints a row for each.
    pub fn run(&self) -> Result<(), Failure> {
        let output = self.output.as_deref();
        let ending = self.form.check_wanted(&self.format, output, self.force, &["csv", "parquet", "rrd"])?;
        let scenarios = self.scenarios()?;
        let mut runs = ComparisonTable::default();
        for (way, scenario) in &scenarios {
            runs.run(*way, scenario, &mut |_| goes_on());
            check()?;
        }
        let faults =
            || runs.rows().iter().filter_map(|row| Some((&row.name, row.outcome.as_ref().ok()?.fault.as_ref()?)));
        faults().for_each(|(name, fault)| print_message(format!("{name}: audit failed: {fault}")));
        let good = runs.rows().iter().zip(scenarios).filter(|(row, _)| row.outcome.is_ok());
        let good: Vec<Scenario> = good.map(|(_, (_, scenario))| scenario).collect();
        if let [ComparisonRow { name, outcome: Err(why), .. }] = runs.rows() {
            return Err(Failure::NoAnswer(format!("{name}: {why}")));
        }
        if good.is_empty() {
            let why = runs.rows().iter().find_map(|r| r.outcome.as_ref().err()).cloned().unwrap_or_default();
            return Err(Failure::NoAnswer(format!("none of these can be done: {why}")));
        }
        match &self.output {
            Some(file) if ending == Some("rrd") => self.record(&good, file)?,
            Some(_) => rows(runs.rows(), &RowTarget::with_ending(output, self.force, ending.unwrap_or_default()))?,
            None => {}
        }
        let fault = faults().next().map(|(name, why)| Failure::untrusted(name, why));
        let faults = runs.rows().iter().flat_map(|row| match &row.outcome {
            Ok(run) => run_faults(row.title(), &run.verdict),
            Err(why) => vec![format!("{}: {why}", row.title())],
        });
        let faults: Vec<String> = faults.collect();
        self.format.print(&Answer { runs }, |Answer { runs }| match runs.have_designs() {
            true => format!("{}\n{}", table(runs.rows()), designs(runs.rows())),
            false => table(runs.rows()),
        })?;
        fault.map_or(Ok(()), Err)?;
        self.strict.require(faults)
    }

    fn scenarios(&self) -> Result<Vec<(Option<&'static str>, Scenario)>, Failure> {
        if let Some(task) = &self.task {
            return self.on_task(task);
        }
        if let [name] = &self.names[..] {
            let scenario = scenario(name, &self.settings)?;
            return Ok(alternatives(&scenario).into_iter().map(|(way, s)| (Some(way.name()), s)).collect());
        }
        let all: Result<Vec<Scenario>, Failure> =
            self.names.iter().map(|called| scenario(called, &self.settings)).collect();
        let all = all?;
        let names = distinct_names(
            &self.names.iter().zip(&all).map(|(called, s)| (called.as_str(), s.name.as_str())).collect::<Vec<_>>(),
        );
        Ok(names.into_iter().zip(all).map(|(name, scenario)| (None, Scenario { name, ..scenario })).collect())
    }

    /// Returns the task of a scenario on each machine, named as the machine. A single machine is compared with the machine of
    /// the scenario.
    fn on_task(&self, task: &str) -> Result<Vec<(Option<&'static str>, Scenario)>, Failure> {
        let [of_machine, own] = [true, false].map(|wanted| self.settings.of_keys(|key| is_of_machine(key) == wanted));
        let scenario = scenario(task, &own)?;
        let mut machines: Vec<(&str, Machine)> = Vec::new();
        if self.names.len() == 1 {
            machines.push((task, with_start_edits(&scenario)?.0.machine));
        }
        for called in &self.names {
            machines
                .push((called, of_machine.apply(machine(called)?.machine).map_err(|why| why.with_context(called))?));
        }
        let names =
            distinct_names(&machines.iter().map(|(called, machine)| (*called, machine.name())).collect::<Vec<_>>());
        let all: Vec<&Machine> = machines.iter().map(|(_, machine)| machine).collect();
        let tasks = SharedTask::on(&scenario, &all)?;
        let named = names.into_iter().zip(tasks).map(|(name, SharedTask { scenario, note })| {
            note.into_iter().for_each(|note| print_message(format!("note: {name}: {note}")));
            (None, Scenario { name, ..scenario })
        });
        Ok(named.collect())
    }

    #[cfg(feature = "record")]
    fn record(&self, scenarios: &[Scenario], file: &std::path::Path) -> Result<(), Failure> {
        let options = stillbase_recording::Options { force: self.force, ..super::headless::unpictured() };
        super::headless::record_with_bar(scenarios, &super::headless::Target::File(file.into()), &options)?;
        say_written(file);
        Ok(())
    }

    #[cfg(not(feature = "record"))]
    fn record(&self, _: &[Scenario], file: &std::path::Path) -> Result<(), Failure> {
        Err(Failure::wrong_input("this build cannot record: want a name that ends in .csv or .parquet")
            .with_context(file.display()))
    }
}

/// Writes the runs, one in each row, as CSV or Parquet.
fn rows(runs: &[ComparisonRow], to: &RowTarget) -> Result<(), Failure> {
    let heads = SUMMARY_COLUMNS.iter().map(|c| format!("{} {}", c.key, c.unit));
    let machines =
        DESIGN_COLUMNS.iter().map(|c| if c.unit == "1" { c.key.into() } else { format!("{} {}", c.key, c.unit) });
    // Older names stay at the end, until version 0.3.
    let known = |name: &str| SUMMARY_COLUMNS.iter().find(|column| column.key == name);
    let old: Vec<_> = OLD_NAMES.iter().filter_map(|(name, old)| Some((known(name)?, *old))).collect();
    let old_heads = old.iter().map(|(column, old)| format!("{old} {}", column.unit));
    let heads: Vec<String> = heads.chain(machines).chain(old_heads).collect();
    let mut rows = Rows::begin_with(to, ("run", &["scenario", "reactionless", "refused"]), &heads)?;
    for row in runs {
        let values = SUMMARY_COLUMNS.iter().map(|c| (c.value)(row.outcome.as_ref().ok()?));
        let machine = DESIGN_COLUMNS.iter().map(|c| (c.value)(row.design.as_ref()?));
        let old = old.iter().map(|(column, _)| (column.value)(row.outcome.as_ref().ok()?));
        let values = values.chain(machine).chain(old).map(|value| value.map(nine));
        let (verdict, why) = match &row.outcome {
            Ok(summary) => (summary.verdict.answer(), ""),
            Err(why) => (String::new(), why.as_str()),
        };
        rows.named_row(&[&row.name, &verdict, why], values)?;
    }
    rows.finish()
}

/// Rounds a number to nine digits.
fn nine(x: f64) -> f64 {
    nine_digits(x).parse().unwrap_or(x)
}

/// Formats the machines of the runs, compared with that of the first run; empty columns are left out.
fn designs(rows: &[ComparisonRow]) -> String {
    let all = || rows.iter().filter_map(|row| Some((row, row.design.as_ref()?)));
    let columns: Vec<_> =
        DESIGN_COLUMNS.iter().filter(|c| all().any(|(_, design)| (c.value)(design).is_some())).collect();
    let heads = columns.iter().map(|c| if c.unit == "1" { c.head.into() } else { format!("{} {}", c.head, c.unit) });
    let mut table = TextTable::new(["machine of".to_owned()].into_iter().chain(heads));
    let mut apart = String::new();
    for (row, design) in all() {
        let cells = columns.iter().map(|c| (c.value)(design).map_or_else(|| "–".into(), |x| fixed(x, c.decimals)));
        let name = row.title();
        table.row([name.to_owned()].into_iter().chain(cells));
        if let Some(why) = &design.why_not {
            apart += &format!("{name}: {why}\n");
        }
    }
    format!("{table}{apart}")
}

/// Formats the runs, one in each row; empty columns are left out.
fn table(rows: &[ComparisonRow]) -> String {
    let good: Vec<&Summary> = rows.iter().filter_map(|r| r.outcome.as_ref().ok()).collect();
    let moves = good.iter().any(|s| s.base_shift > 0.0 || s.base_tilt > 0.0);
    // Without a wheel the base feels all of the moment.
    let has_wheel = good.iter().any(|s| s.wheel_rate.is_some());
    let columns: Vec<_> = SUMMARY_COLUMNS
        .iter()
        .filter(|c| moves || !matches!(c.key, "base_shift" | "base_angle"))
        .filter(|c| good.iter().any(|s| (c.value)(s).is_some()))
        .filter(|c| has_wheel || c.key != "peak_base_moment")
        .collect();
    let heads = columns.iter().map(|c| format!("{} {}", c.head, c.unit));
    let mut table = TextTable::new(["run".to_owned()].into_iter().chain(heads).chain(["reactionless".into()]));
    let mut refused = String::new();
    for row in rows {
        let name = row.title().to_owned();
        match &row.outcome {
            Ok(s) => {
                let cells = columns.iter().map(|c| (c.value)(s).map_or_else(|| "–".into(), |x| fixed(x, c.decimals)));
                table.row([name].into_iter().chain(cells).chain([s.verdict.answer()]));
            }
            Err(why) => refused += &format!("{name}: {why}\n"),
        }
    }
    format!("{table}{refused}")
}
