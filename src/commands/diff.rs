//! `stillbase diff`

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;
use stillbase_settings::number::{at_most_digits, significant};
use stillbase_simulation::signal_table::SignalTable;
use stillbase_study::difference::{Departure, SignalDifference, TableDifference, Tolerances};

use super::failure::Failure;
use super::input::Settings;
use super::output::{Format, TextTable};
use super::signal_choice::{SignalChoice, require_known};
use super::signal_source::SignalSource;

/// Compare two recordings, tables or scenarios, signal by signal
///
/// Each of the two is a recording (.rrd), a table of signals over time (.csv, .parquet), or a scenario, which is run with
/// the settings of `--set`. A recording of several cases is compared case by case; `FILE.rrd:CASE` is one of them. `-`
/// is a scenario or CSV from standard input. The exit status is 0 if every signal stays within its tolerance, and 1
/// otherwise. By default no difference is permitted.
///
/// Both are compared at the instants of the one with fewer rows. At an instant that the other one lacks, its values are
/// interpolated linearly. Two values that are no number are equal. A signal or a time that only one of both has is a
/// difference, unless `--signals`, `--from` and `--to` leave it out.
#[derive(Args)]
#[command(after_help = "\
Examples:
  stillbase diff before.rrd after.rrd                             what a change of the program has changed
  stillbase diff case-3 my.toml --tolerance torque=0.01           within 0.01 N m, and all else equal
  stillbase diff case-3 run.parquet --set plant.payload.mass=0.1  the scenario with a payload, and a table
  stillbase simulate case-3 --set step=0.0005 | stillbase diff case-3 - --tolerance 1e-6
  stillbase diff cases.rrd:case-1 measured.csv --signals angle,torque --tolerance 1e-3 --json")]
pub struct DiffArguments {
    /// A recording, a table or a scenario
    #[arg(value_name = "A")]
    first: String,
    /// Another one
    #[arg(value_name = "B")]
    second: String,
    #[command(flatten)]
    tolerance: ToleranceOptions,
    #[command(flatten)]
    choice: SignalChoice,
    #[command(flatten)]
    settings: Settings,
    #[command(flatten)]
    format: Format,
}

/// Options of permitted differences.
#[derive(Args)]
pub struct ToleranceOptions {
    /// Permit a difference of a signal, in its unit, such as torque/1=1e-6 (N m), of all signals of a group, such as
    /// torque=1e-6, or of all others, such as 1e-9; may be repeated
    #[arg(long = "tolerance", value_name = "SIGNAL=ABS", value_parser = tolerance)]
    given: Vec<(Option<String>, f64)>,
}

fn tolerance(text: &str) -> Result<(Option<String>, f64), String> {
    let (name, number) = match text.rsplit_once('=') {
        Some((name, number)) => (Some(name.trim().to_owned()), number),
        None => (None, text),
    };
    let number = number.trim().parse().ok().filter(|x: &f64| *x >= 0.0 && x.is_finite());
    number.map(|x| (name, x)).ok_or_else(|| "want SIGNAL=ABS, such as torque/1=1e-6, or a number, 0 or more".into())
}

impl ToleranceOptions {
    /// Returns the tolerances; without a number for all signals, that is `all` with its relative part.
    pub fn over(&self, all: Tolerances) -> Tolerances {
        let own = self.given.iter().rev().find(|(name, _)| name.is_none());
        let all = own.map_or(all, |(_, all)| Tolerances { all: *all, ..Tolerances::default() });
        let named = self.given.iter().filter_map(|(name, x)| Some((name.clone()?, *x)));
        Tolerances { named: named.collect(), ..all }
    }

    /// Refuses names of tolerances that no signal has.
    ///
    /// # Errors
    /// If there is such a name.
    pub fn check<'a>(&self, tables: impl IntoIterator<Item = &'a SignalTable>) -> Result<(), Failure> {
        let columns: Vec<&str> = tables.into_iter().flat_map(|t| t.columns.iter().map(|c| c.path.as_str())).collect();
        let names = self.given.iter().filter_map(|(name, _)| name.as_ref());
        require_known(names, columns.iter().copied()).map_err(|why| why.with_context("--tolerance"))
    }
}

impl DiffArguments {
    /// Compares both and prints the differences.
    pub fn run(&self) -> Result<(), Failure> {
        let sources = self.sources()?;
        let tolerances = self.tolerance.over(Tolerances::default());
        let mut cases = Vec::new();
        let mut missing = Vec::new();
        let [first, second] = &sources;
        if let ([(a, left)], [(b, right)]) = (&first.cases[..], &second.cases[..]) {
            let name = match (a, b) {
                (Some(a), Some(b)) if a != b => format!("{a} and {b}"),
                _ => a.as_ref().or(b.as_ref()).cloned().unwrap_or_default(),
            };
            cases.push(Case::of(&name, &TableDifference::between(left, right, &tolerances)));
        } else {
            // A table names no case.
            for (table, several) in [(first, second), (second, first)] {
                if table.cases.iter().any(|(name, _)| name.is_none()) {
                    several.only_case()?;
                }
            }
            let named = |source: &'_ SignalSource| source.cases.iter().filter_map(|(name, _)| name.clone()).collect();
            let names: [Vec<String>; 2] = [named(first), named(second)];
            for (name, (_, left)) in names[0].iter().zip(&first.cases) {
                match names[1].iter().zip(&second.cases).find(|(other, _)| *other == name) {
                    Some((_, (_, right))) => {
                        cases.push(Case::of(name, &TableDifference::between(left, right, &tolerances)));
                    }
                    None => missing.push((name.clone(), &first.name)),
                }
            }
            let only = names[1].iter().filter(|name| !names[0].contains(name));
            missing.extend(only.map(|name| (name.clone(), &second.name)));
        }
        let missing: Vec<String> =
            missing.iter().map(|(case, file)| format!("only {file} has the case {case}")).collect();
        let equal = missing.is_empty() && cases.iter().all(|case| case.equal);
        let within = missing.is_empty() && cases.iter().all(|case| case.within);
        let answer = Answer { equal, within, missing, cases };
        self.format.print(&answer, |answer| {
            let parts = answer.missing.iter().map(|line| format!("{line}\n"));
            parts.chain(answer.cases.iter().map(Case::text)).collect()
        })?;
        if within { Ok(()) } else { Err(Failure::Told) }
    }
}

impl DiffArguments {
    /// Reads both sides; leaves of each what is to be compared.
    fn sources(&self) -> Result<[SignalSource; 2], Failure> {
        let files = [&self.first, &self.second].map(|name| SignalSource::of_file(name));
        if !self.settings.is_empty() && files.iter().all(Option::is_some) {
            let why = "neither of both is a scenario, so there is nothing to set: want a scenario, or no --set";
            return Err(Failure::wrong_input(why).with_context("--set"));
        }
        let [first, second] = files;
        let or_run = |file: Option<Result<SignalSource, Failure>>, name: &str| {
            file.unwrap_or_else(|| SignalSource::of_scenario(name, &self.settings))
        };
        let mut sources = [or_run(first, &self.first)?, or_run(second, &self.second)?];
        {
            let tables = || sources.iter().flat_map(|source| source.cases.iter().map(|(_, table)| table));
            self.tolerance.check(tables())?;
            let paths = tables().flat_map(|table| table.columns.iter().map(|column| column.path.as_str()));
            self.choice.check(paths)?;
        }
        for SignalSource { name, cases } in &mut sources {
            for (_, table) in cases {
                self.choice.apply(table).map_err(|why| why.with_context(&name))?;
            }
        }
        Ok(sources)
    }
}

#[derive(JsonSchema, Serialize)]
pub struct Answer {
    /// Whether every number is equal.
    equal: bool,
    /// Whether every signal stays within its tolerance.
    within: bool,
    /// Cases that only one of both has.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    missing: Vec<String>,
    cases: Vec<Case>,
}

/// The difference of one case, as it is printed.
#[derive(JsonSchema, Serialize)]
pub struct Case {
    case: String,
    /// Whether every number is equal.
    pub equal: bool,
    /// Whether every signal stays within its tolerance.
    pub within: bool,
    /// What the comparison found, in words.
    pub sentence: String,
    /// First time of both, s.
    starts: [f64; 2],
    /// Last time of both, s.
    ends: [f64; 2],
    instants: usize,
    interpolated: usize,
    only_first: Vec<String>,
    only_second: Vec<String>,
    /// Path and units of signals whose units differ.
    units: Vec<(String, [String; 2])>,
    signals: Vec<Row>,
}

/// The difference of one signal.
#[derive(JsonSchema, Serialize)]
struct Row {
    signal: String,
    unit: String,
    /// Largest absolute value of the signal in either.
    #[serde(skip)]
    size: f64,
    tolerance: f64,
    within: bool,
    /// Where the difference is largest.
    largest: Place,
    /// Where it exceeds the tolerance first.
    #[serde(skip_serializing_if = "Option::is_none")]
    first: Option<Place>,
}

/// The values at one instant; a value that is no finite number is absent.
#[derive(JsonSchema, Serialize)]
struct Place {
    time: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    first: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    second: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    difference: Option<f64>,
    /// Number of floating-point numbers from one to the other.
    #[serde(skip_serializing_if = "Option::is_none")]
    ulps: Option<u64>,
}

impl Place {
    fn of(departure: &Departure) -> Self {
        let finite = |x: f64| Some(x).filter(|x| x.is_finite());
        Self {
            time: departure.time,
            first: finite(departure.values[0]),
            second: finite(departure.values[1]),
            difference: finite(departure.size()),
            ulps: departure.units_in_the_last_place(),
        }
    }
}

/// Size of a signal below which it is rounding, in SI units.
const ROUNDING: f64 = 1e-9;
/// Maximum number of signals in a printed table.
const MAX_ROWS: usize = 20;

impl Case {
    /// Returns the difference of a case with a name.
    pub fn of(name: &str, difference: &TableDifference) -> Self {
        let finite = |x: f64| if x.is_finite() { x } else { 0.0 };
        Self {
            case: name.into(),
            equal: difference.is_equal(),
            within: difference.is_within(),
            sentence: difference.sentence(name),
            starts: difference.starts.map(finite),
            ends: difference.ends.map(finite),
            instants: difference.instants,
            interpolated: difference.interpolated,
            only_first: difference.unmatched[0].clone(),
            only_second: difference.unmatched[1].clone(),
            units: difference.units.clone(),
            signals: difference.signals.iter().map(Row::of).collect(),
        }
    }

    /// Returns the sentence, and below it the signals that differ, the worst first.
    pub fn text(&self) -> String {
        let mut rows: Vec<&Row> = self.signals.iter().filter(|row| row.largest.difference != Some(0.0)).collect();
        if rows.is_empty() {
            return format!("{}\n", self.sentence);
        }
        // Those beyond their tolerance first, then by the share of what the signal is at most; one that is never more than
        // rounding comes last.
        let share = |row: &Row| row.largest.difference.map_or(f64::INFINITY, |x| x / row.size.max(ROUNDING));
        rows.sort_by(|a, b| a.within.cmp(&b.within).then(share(b).total_cmp(&share(a))));
        let head = ["signal", "unit", "largest difference", "at s", "tolerance", "exceeded from s"];
        let mut table = TextTable::new(head).with_words(1);
        for row in rows.iter().take(MAX_ROWS) {
            let first = row.first.as_ref().map_or_else(String::new, |first| at_most_digits(first.time, 6));
            table.row([
                row.signal.clone(),
                row.unit.clone(),
                row.largest.difference.map_or_else(|| "no number".into(), significant),
                at_most_digits(row.largest.time, 6),
                significant(row.tolerance),
                first,
            ]);
        }
        let more = match rows.len().saturating_sub(MAX_ROWS) {
            0 => String::new(),
            more => format!("and {more} more: --json lists them\n"),
        };
        format!("{}\n{table}{more}", self.sentence)
    }
}

impl Row {
    fn of(signal: &SignalDifference) -> Self {
        Self {
            signal: signal.path.clone(),
            unit: signal.unit.clone(),
            size: signal.size,
            tolerance: signal.tolerance,
            within: signal.first.is_none(),
            largest: Place::of(&signal.largest),
            first: signal.first.as_ref().map(Place::of),
        }
    }
}
