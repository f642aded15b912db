//! `stillbase simulate`

use std::borrow::Cow;
use std::io::IsTerminal;
use std::num::NonZeroU64;
use std::path::PathBuf;

use clap::Args;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Serialize, Serializer};
use stillbase_session::scenario::Scenario;
use stillbase_session::verdict::{Statements, Verdict};
use stillbase_session::{Run, WholeFrame, replay_if, signals_of_whole, with_start_edits};
use stillbase_simulation::signal_table::{SignalColumn, SignalTable};
use stillbase_simulation::signals::{Signal, row_heads};

use super::exit::print_message;
use super::failure::Failure;
use super::file_form::FileForm;
use super::in_process::{is_in_process, stop_flag, take};
use super::input::{DEFAULT_SCENARIO, Settings, scenario_of_any};
use super::output::{Format, TextTable, check_size};
use super::rows::{RowTarget, Rows};
use super::signal_choice::SignalChoice;
use super::simulate_assembly::AssemblyOutcome;
use super::strict::{Strict, run_faults};
use stillbase_settings::number::{ShortNumber, counted, fixed};

/// Run a scenario and print every signal over time, or some of them, as CSV or Parquet
#[derive(Args)]
#[command(after_help = "\
Examples:
  stillbase simulate case-1 -o case-1.csv
  stillbase simulate --every 10 --set payload.mass=0.1 | head
  stillbase simulate case-1 -o part.parquet --signals torque,moment/total --from 0.2 --to 0.8
  stillbase simulate case-3 --json")]
pub struct SimulateArguments {
    /// A built-in scenario (case-1, spacecraft …; an unknown name lists them all) or a TOML file
    #[arg(value_name = "SCENARIO", default_value = DEFAULT_SCENARIO)]
    scenario: String,
    /// Write the rows to this file, .csv or .parquet; by default CSV goes to standard output, but a terminal gets a
    /// summary instead
    #[arg(short, long, value_name = "FILE")]
    pub(super) output: Option<PathBuf>,
    /// Replace the file if it exists
    #[arg(long)]
    pub(super) force: bool,
    /// Print only every N-th step, and the last one
    #[arg(long, value_name = "N", default_value = "1", value_parser = every)]
    pub(super) every: NonZeroU64,
    #[command(flatten)]
    pub(super) choice: SignalChoice,
    #[command(flatten)]
    settings: Settings,
    #[command(flatten)]
    pub(super) strict: Strict,
    #[command(flatten)]
    pub(super) form: FileForm,
    #[command(flatten)]
    pub(super) format: Format,
}

fn every(text: &str) -> Result<NonZeroU64, String> {
    text.trim().parse().map_err(|_| "want a whole number of steps, 1 or more".into())
}

/// Results of a run.
#[derive(JsonSchema, Serialize)]
struct Outcome {
    steps: u64,
    peak_torque: Vec<f64>,
    peak_base_force: f64,
    peak_base_moment: f64,
    rms_base_force: f64,
    rms_base_moment: f64,
    /// Largest moment on the base beyond what the reaction wheel takes up, N m, if there is a wheel.
    #[serde(skip_serializing_if = "Option::is_none")]
    peak_felt_moment: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    rms_felt_moment: Option<f64>,
    #[serde(flatten)]
    old: OldNames,
    peak_tilt: f64,
    base_shift: f64,
    base_angle: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    base_angle_end: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    keeps_attitude: Option<bool>,
    #[serde(skip_serializing_if = "Option::is_none")]
    wheel_momentum: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    peak_wheel_torque: Option<f64>,
    /// Limits of momentum and torque of the wheel.
    #[serde(skip)]
    wheel_limits: [Option<f64>; 2],
    #[serde(skip_serializing_if = "Option::is_none")]
    miss: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    past_limit: Option<Past>,
    /// Limit of a drive that is exceeded by the largest factor, and that factor.
    #[serde(skip_serializing_if = "Option::is_none")]
    over: Option<(String, f64)>,
    moved: bool,
    reactionless: bool,
    #[serde(skip)]
    answer: String,
    sentence: String,
    /// Statements on machine, plan and run.
    statements: Statements,
    remarks: Vec<String>,
    audit: Columns<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    audit_failed: Option<String>,
}

/// Results once more, under older names that version 0.3 drops.
#[derive(JsonSchema, Serialize)]
struct OldNames {
    #[serde(skip_serializing_if = "Option::is_none")]
    peak_moment_past_wheel: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    rms_moment_past_wheel: Option<f64>,
    base_tilt: f64,
}

/// A relative joint angle that exceeded its limit, and by how much, rad.
#[derive(JsonSchema, Serialize)]
struct Past {
    angle: String,
    by: f64,
}

impl Outcome {
    fn of(run: &Run) -> Self {
        let last = &run.frame();
        let verdict = Verdict::of(run.scenario(), last);
        let totals = &last.totals;
        let rms_felt_moment = verdict.past_wheel.map(|_| totals.moment_rms());
        Self {
            steps: last.step,
            peak_torque: last.peaks.torque.to_vec(),
            peak_base_force: verdict.force,
            peak_base_moment: verdict.arm_moment,
            rms_base_force: totals.force_rms(),
            rms_base_moment: totals.arm_moment_rms(),
            peak_felt_moment: verdict.past_wheel,
            rms_felt_moment,
            old: OldNames {
                peak_moment_past_wheel: verdict.past_wheel,
                rms_moment_past_wheel: rms_felt_moment,
                base_tilt: totals.base_angle,
            },
            peak_tilt: verdict.tilt,
            base_shift: totals.shift,
            base_angle: totals.base_angle,
            base_angle_end: verdict.attitude.map(|attitude| attitude.end),
            keeps_attitude: verdict.attitude.map(|attitude| attitude.is_kept()),
            wheel_momentum: verdict.wheel.map(|wheel| wheel.momentum),
            peak_wheel_torque: verdict.wheel.map(|wheel| wheel.torque),
            wheel_limits: verdict.wheel.map_or([None; 2], |wheel| [wheel.momentum_limit, wheel.torque_limit]),
            miss: verdict.target_distance,
            answer: verdict.answer(),
            sentence: verdict.sentence(),
            statements: Statements::of(run, last),
            remarks: verdict.remarks().into_iter().map(|r| r.long).collect(),
            past_limit: verdict.past_limit.map(|(angle, by)| Past { angle, by }),
            over: verdict.exceeded_limit.map(|(limit, factor)| (limit.to_string(), factor)),
            moved: verdict.moved,
            reactionless: verdict.reactionless,
            audit: Columns(
                last.audit.figures(&last.peaks, &last.totals).map(|l| (l.name.to_owned(), l.value)).to_vec(),
            ),
            audit_failed: verdict.fault.map(|lamp| lamp.to_string()),
        }
    }
}

#[derive(JsonSchema, Serialize)]
pub struct Answer {
    scenario: String,
    units: Columns<&'static str>,
    time: Vec<f64>,
    signals: Columns<Vec<f64>>,
    verdict: RunOutcome,
}

/// Results of a run of one machine, or of several.
#[derive(JsonSchema, Serialize)]
#[serde(untagged)]
enum RunOutcome {
    OfMachine(Box<Outcome>),
    OfAssembly(AssemblyOutcome),
}

impl RunOutcome {
    fn of(run: &Run) -> Self {
        AssemblyOutcome::of(run).map_or_else(|| Self::OfMachine(Box::new(Outcome::of(run))), Self::OfAssembly)
    }

    fn audit_failed(&self) -> Option<String> {
        match self {
            Self::OfMachine(outcome) => outcome.audit_failed.clone(),
            Self::OfAssembly(outcome) => outcome.audit_failed.clone(),
        }
    }

    /// Returns what fails with `--strict`.
    fn faults(&self, name: &str, run: &Run) -> Vec<String> {
        match self {
            Self::OfMachine(_) => run_faults(name, &Verdict::of(run.scenario(), &run.frame())),
            Self::OfAssembly(outcome) => outcome.faults(name),
        }
    }

    /// Returns the lines of the message that rows were written.
    fn lines(&self) -> Vec<String> {
        let outcome = match self {
            Self::OfMachine(outcome) => outcome,
            Self::OfAssembly(outcome) => return outcome.lines(),
        };
        let past = outcome.peak_felt_moment;
        let first = format!(
            "{}, peak |n_B| {} N m,{} peak |f_B| {} N, reactionless: {}",
            counted(outcome.steps, "step"),
            fixed(outcome.peak_base_moment, 6),
            past.map_or_else(String::new, |n| format!(" past the wheel {} N m,", fixed(n, 6))),
            fixed(outcome.peak_base_force, 6),
            outcome.answer,
        );
        [first, outcome.statements.line()].into_iter().chain(outcome.remarks.iter().cloned()).collect()
    }

    /// Returns the summary that a terminal gets instead of rows.
    fn summary(&self, name: &str, table: &[Signal]) -> String {
        match self {
            Self::OfMachine(outcome) => summary(outcome, name, table),
            Self::OfAssembly(outcome) => outcome.summary(name, table.len()),
        }
    }
}

/// A JSON object whose keys keep their order.
pub(super) struct Columns<T>(pub(super) Vec<(String, T)>);

impl<T: JsonSchema> JsonSchema for Columns<T> {
    fn schema_name() -> Cow<'static, str> {
        format!("Columns of {}", T::schema_name()).into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "object", "additionalProperties": generator.subschema_for::<T>() })
    }
}

impl<T: Serialize> Serialize for Columns<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(path, value)| (path, value)))
    }
}

impl SimulateArguments {
    /// Simulates the scenario. Writes its signals as CSV or Parquet, or prints them as JSON, or prints a summary.
    pub fn run(&self) -> Result<(), Failure> {
        let scenario = scenario_of_any(&self.scenario, &self.settings)?;
        // The first edits may draw another machine.
        let (start, _) = with_start_edits(&scenario).map_err(|e| Failure::refused(&scenario, e))?;
        let table = self.table(&start)?;
        let to = match self.writes_csv() {
            true => Some(RowTarget::of(&self.format, &self.form, self.output.as_deref(), self.force)?),
            false => None,
        };
        let mut rows = 0_u64;
        // The CSV is begun at the first step, so that a run that cannot start prints nothing.
        let mut csv = None;
        let (mut time, mut columns) = (Vec::new(), vec![Vec::new(); table.len()]);
        // After a failure to write, the run ends.
        let mut written = Ok(());
        let stop = stop_flag();
        let fits = |last: u64| check_size(last / self.every + 2, table.len() + 1, self.format.json);
        let run = replay_if(&scenario, fits, |run, frame| {
            let is_due = frame.step % self.every == 0 || frame.step == run.last_step();
            if !is_due || !self.choice.has_time(frame.time) {
                return stop.goes_on();
            }
            rows += 1;
            let whole = WholeFrame::of(run, frame);
            let value = |signal: &Signal| whole.value(signal) + 0.0;
            if let Some(to) = &to {
                let values = [frame.time].into_iter().chain(table.iter().map(value));
                written = rows_of(&mut csv, to, &table).and_then(|csv| csv.row(values));
            }
            if self.format.json {
                time.push(frame.time);
                columns.iter_mut().zip(&table).for_each(|(column, signal)| column.push(value(signal)));
            }
            written.is_ok() && stop.goes_on()
        });
        written?;
        let run = run.map_err(|e| Failure::refused(&scenario, e))?;
        if rows == 0 {
            return Err(self.choice.no_row(run.frame().time).with_context(&scenario.name));
        }
        if let Some(csv) = csv {
            csv.finish()?;
        }
        let verdict = RunOutcome::of(&run);
        let name = scenario.name;
        let (faults, fault) = (verdict.faults(&name, &run), verdict.audit_failed());
        if !self.format.json {
            match to {
                Some(_) => verdict.lines().iter().for_each(|line| print_message(format!("{name}: {line}"))),
                None => self.format.print(&verdict, |outcome| outcome.summary(&name, &table))?,
            }
            require_audit(&name, fault)?;
            return self.strict.require(faults);
        }
        if is_in_process() {
            // Another program gets the numbers as they are.
            let named = table.iter().zip(std::mem::take(&mut columns));
            let columns = named.map(|(s, values)| SignalColumn { path: s.path.clone(), unit: s.unit.into(), values });
            let signals = SignalTable { time: std::mem::take(&mut time), columns: columns.collect() };
            take(|said| said.signals = Some(signals));
        }
        let answer = Answer {
            scenario: name.clone(),
            units: Columns(table.iter().map(|s| (s.path.clone(), s.unit)).collect()),
            time,
            signals: Columns(table.iter().map(|s| s.path.clone()).zip(columns).collect()),
            verdict,
        };
        self.format.print(&answer, |_| String::new())?;
        require_audit(&name, fault)?;
        self.strict.require(faults)
    }

    /// Whether rows are written: to a file, or without --json to standard output if it is not a terminal.
    pub(super) fn writes_csv(&self) -> bool {
        self.output.is_some() || self.form.is_given() || !(self.format.json || std::io::stdout().is_terminal())
    }

    /// Returns the signals to print.
    fn table(&self, scenario: &Scenario) -> Result<Vec<Signal>, Failure> {
        let mut all = signals_of_whole(scenario);
        self.choice.check(all.iter().map(|signal| signal.path.as_str()))?;
        all.retain(|signal| self.choice.has_signal(&signal.path));
        Ok(all)
    }
}

/// Returns the rows; the first call opens the file and writes its head.
fn rows_of<'a>(begun: &'a mut Option<Rows>, to: &RowTarget, table: &[Signal]) -> Result<&'a mut Rows, Failure> {
    match begun {
        Some(rows) => Ok(rows),
        None => Ok(begun.insert(Rows::begin(to, &row_heads(table))?)),
    }
}

/// Formats the summary that a terminal gets instead of rows.
fn summary(outcome: &Outcome, name: &str, signals: &[Signal]) -> String {
    let mut table = TextTable::new(["", "", ""]).with_words(2);
    let mut row = |name: String, value: f64, decimals: usize, unit: &str| {
        table.row([name, fixed(value, decimals), unit.into()]);
    };
    // A free base feels the moment about its own centre of mass, which n_B is not.
    let [of_pin, of_base] = match outcome.keeps_attitude {
        Some(_) => [" about the pin", " about the centre of mass of the base"],
        None => [""; 2],
    };
    for (k, torque) in outcome.peak_torque.iter().enumerate() {
        row(format!("peak |τ_{}|", k + 1), *torque, 6, "N m");
    }
    row(format!("peak |n_B|{of_pin}"), outcome.peak_base_moment, 9, "N m");
    row("root mean square of n_B".into(), outcome.rms_base_moment, 9, "N m");
    if let Some(past_wheel) = outcome.peak_felt_moment {
        row(format!("peak moment past the wheel{of_base}"), past_wheel, 9, "N m");
    }
    row("peak |f_B|".into(), outcome.peak_base_force, 9, "N");
    row("the base shifts by".into(), outcome.base_shift, 9, "m");
    row("the base turns by up to".into(), outcome.base_angle, 9, "rad");
    if let Some(end) = outcome.base_angle_end {
        row("angle of the base at the end".into(), end, 9, "rad");
    }
    if let (Some(momentum), Some(torque)) = (outcome.wheel_momentum, outcome.peak_wheel_torque) {
        let of = |limit: Option<f64>, unit: &str| match limit {
            Some(limit) => format!("of {} {unit}", ShortNumber(limit)),
            None => unit.to_owned(),
        };
        let [momentum_limit, torque_limit] = outcome.wheel_limits;
        row("peak momentum of the wheel".into(), momentum, 9, &of(momentum_limit, "N m s"));
        row("peak torque of the wheel".into(), torque, 9, &of(torque_limit, "N m"));
    }
    let shown = format!(
        "{} of {}: -o FILE.csv writes every row, a pipe gets them too\n",
        counted(outcome.steps, "step"),
        counted(signals.len(), "signal")
    );
    let lines = [outcome.sentence.clone(), outcome.statements.line()].map(|line| format!("{name}: {line}\n"));
    format!("{}\n{}\n{shown}", lines.concat(), table.to_string().trim_start())
}

/// Fails if an audit has failed: the results are printed, but cannot be trusted.
pub fn require_audit(scenario: &str, fault: Option<String>) -> Result<(), Failure> {
    match fault {
        Some(why) => Err(Failure::untrusted(scenario, why)),
        None => Ok(()),
    }
}
