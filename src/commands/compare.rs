//! `stillbase compare`

use std::path::PathBuf;

use clap::Args;
use serde::Serialize;
use stillbase_files::{NewFile, WriteError};
use stillbase_session::scenario::Scenario;
use stillbase_study::comparison::{
    ComparisonRow, ComparisonTable, DESIGN_COLUMNS, SUMMARY_COLUMNS, Summary, alternatives,
};

use super::exit::print_message;
use super::failure::Failure;
use super::input::{DEFAULT_SCENARIO, Settings, distinct_name, scenario};
use super::output::{Format, TextTable, check_output};
use stillbase_settings::number::{fixed, nine_digits};
use stillbase_settings::text::sheet_cell;

/// Compare runs of one task done in several ways, or of several scenarios, by base reactions and cost
///
/// One scenario: its task runs in up to six ways. They are as given, reactionless, straight (case 1), to another pose
/// (case 2), straight with a reaction wheel, and slowly. Several scenarios: each runs as given.
/// If their machines differ, a second table gives mass and balance of each, and cost and benefit relative to the first.
#[derive(Args)]
#[command(after_help = "\
Examples:
  stillbase compare case-3                                        five ways from A to B
  stillbase compare case-3 --set base.kind=free                   and what each does to a spacecraft
  stillbase compare case-3 --set base.wheel.torque_limit=0.5      when does the wheel saturate?
  stillbase compare nine-link-bare case-3                         what balance costs, and what it brings
  stillbase compare case-1 case-3 my.toml -o table.csv")]
pub struct CompareArguments {
    /// One scenario to do in several ways, or several to compare
    #[arg(value_name = "SCENARIO", default_value = DEFAULT_SCENARIO)]
    scenarios: Vec<String>,
    /// Write the table as CSV, or with .rrd the runs as a recording
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Replace the file if it exists
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    settings: Settings,
    #[command(flatten)]
    format: Format,
}

#[derive(Serialize)]
struct Answer {
    runs: ComparisonTable,
}

impl CompareArguments {
    /// Runs all scenarios and prints a row for each.
    pub fn run(&self) -> Result<(), Failure> {
        let ending = match &self.output {
            Some(file) => check_output(file, self.force, &["csv", "rrd"])?,
            None => "",
        };
        let scenarios = self.scenarios()?;
        let mut runs = ComparisonTable::default();
        scenarios.iter().for_each(|(way, scenario)| runs.run(*way, scenario));
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
            Some(file) if ending == "rrd" => self.record(&good, file)?,
            Some(file) => self.csv(runs.rows(), file)?,
            None => {}
        }
        let fault = faults().next().map(|(name, why)| Failure::untrusted(name, why));
        self.format.print(&Answer { runs }, |Answer { runs }| match runs.have_designs() {
            true => format!("{}\n{}", table(runs.rows()), designs(runs.rows())),
            false => table(runs.rows()),
        })?;
        fault.map_or(Ok(()), Err)
    }

    fn scenarios(&self) -> Result<Vec<(Option<&'static str>, Scenario)>, Failure> {
        if let [name] = &self.scenarios[..] {
            let scenario = scenario(name, &self.settings)?;
            return Ok(alternatives(&scenario).into_iter().map(|(way, s)| (Some(way.name()), s)).collect());
        }
        let mut all: Vec<(Option<&'static str>, Scenario)> = Vec::new();
        for name in &self.scenarios {
            let mut next = scenario(name, &self.settings)?;
            next.name = distinct_name(&next.name, |name| all.iter().any(|(_, s)| s.name == name));
            all.push((None, next));
        }
        Ok(all)
    }

    #[cfg(feature = "record")]
    fn record(&self, scenarios: &[Scenario], file: &std::path::Path) -> Result<(), Failure> {
        let options = stillbase_recording::Options { force: self.force, ..super::headless::unpictured() };
        super::headless::record_with_bar(scenarios, &super::headless::Target::File(file.into()), &options)?;
        print_message(format!("wrote {}", file.display()));
        Ok(())
    }

    #[cfg(not(feature = "record"))]
    fn record(&self, _: &[Scenario], file: &std::path::Path) -> Result<(), Failure> {
        Err(Failure::wrong_input("this build cannot record: want a name that ends in .csv")
            .with_context(file.display()))
    }

    fn csv(&self, runs: &[ComparisonRow], file: &std::path::Path) -> Result<(), Failure> {
        let mut writer = csv::Writer::from_writer(NewFile::create(file, self.force)?);
        let failed = |e: csv::Error| match e.into_kind() {
            csv::ErrorKind::Io(source) => WriteError::Failed { file: file.into(), source }.into(),
            other => Failure::wrong_input(format!("CSV: {other:?}")),
        };
        let heads = SUMMARY_COLUMNS.iter().map(|c| format!("{} {}", c.name(), c.unit));
        let machines =
            DESIGN_COLUMNS.iter().map(|c| if c.unit == "1" { c.key.into() } else { format!("{} {}", c.key, c.unit) });
        let head = ["scenario".to_owned()].into_iter().chain(heads).chain(["reactionless".into(), "refused".into()]);
        let head = head.chain(machines);
        writer.write_record(head).map_err(failed)?;
        for row in runs {
            let values = SUMMARY_COLUMNS.iter().map(|c| match &row.outcome {
                Ok(summary) => (c.value)(summary).map_or_else(String::new, nine_digits),
                Err(_) => String::new(),
            });
            let (verdict, why) = match &row.outcome {
                Ok(summary) => (summary.verdict.answer(), String::new()),
                Err(why) => (String::new(), why.clone()),
            };
            let machine = DESIGN_COLUMNS.iter().map(|c| {
                let value = row.design.as_ref().and_then(|design| (c.value)(design));
                value.map_or_else(String::new, nine_digits)
            });
            let cells =
                [sheet_cell(&row.name).into_owned()].into_iter().chain(values).chain([verdict, why]).chain(machine);
            writer.write_record(cells).map_err(failed)?;
        }
        match writer.into_inner() {
            Ok(file) => file.finish()?,
            Err(e) => return Err(Failure::wrong_input(e.error())),
        }
        print_message(format!("wrote {}", file.display()));
        Ok(())
    }
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
    let columns: Vec<_> = SUMMARY_COLUMNS
        .iter()
        .filter(|c| moves || !matches!(c.key, "base_shift" | "base_tilt"))
        .filter(|c| good.iter().any(|s| (c.value)(s).is_some()))
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
