//! `stillbase simulate` of a scenario of several machines on one base.

use schemars::JsonSchema;
use serde::Serialize;
use stillbase_session::assembly::{
    AssemblyBase, AssemblyRun, AssemblyScenario, AssemblySignal, AssemblyVerdict, assembly_signals,
};
use stillbase_settings::number::{counted, fixed};

use super::exit::print_message;
use super::failure::Failure;
use super::in_process::stop_flag;
use super::output::{TextTable, check_size};
use super::progress::check;
use super::rows::{RowTarget, Rows};
use super::simulate::{Columns, SimulateArguments};

/// Results of a run of an assembly.
#[derive(JsonSchema, Serialize)]
pub struct AssemblyOutcome {
    steps: u64,
    /// Peaks of the force on a fixed base from motion, x, y, z, N.
    #[serde(skip_serializing_if = "Option::is_none")]
    peak_force: Option<[f64; 3]>,
    /// Peaks of the moment on a fixed base about its origin from motion, x, y, z, N m.
    #[serde(skip_serializing_if = "Option::is_none")]
    peak_moment: Option<[f64; 3]>,
    /// Whether each component of the force is silent.
    #[serde(skip_serializing_if = "Option::is_none")]
    silent_force: Option<[bool; 3]>,
    /// Whether each component of the moment is silent.
    #[serde(skip_serializing_if = "Option::is_none")]
    silent_moment: Option<[bool; 3]>,
    /// Largest angle by which a free base turns, rad.
    #[serde(skip_serializing_if = "Option::is_none")]
    base_angle: Option<f64>,
    /// The same at the end, rad.
    #[serde(skip_serializing_if = "Option::is_none")]
    base_angle_end: Option<f64>,
    pub sentence: String,
}

/// Answer of a run of an assembly.
#[derive(JsonSchema, Serialize)]
pub struct AssemblyAnswer {
    scenario: String,
    units: Columns<&'static str>,
    time: Vec<f64>,
    signals: Columns<Vec<f64>>,
    verdict: AssemblyOutcome,
}

impl AssemblyOutcome {
    /// Returns the results of a run.
    pub fn of(scenario: &AssemblyScenario, verdict: &AssemblyVerdict) -> Self {
        let three = |from: usize| std::array::from_fn(|i| verdict.peaks[from + i]);
        let (is_fixed, silent) = (scenario.base == AssemblyBase::Fixed, verdict.silent());
        let each = |from: usize| std::array::from_fn(|i| silent[from + i]);
        let sentence = verdict.sentence(is_fixed);
        Self {
            steps: verdict.steps,
            peak_force: is_fixed.then(|| three(0)),
            peak_moment: is_fixed.then(|| three(3)),
            silent_force: is_fixed.then(|| each(0)),
            silent_moment: is_fixed.then(|| each(3)),
            base_angle: (!is_fixed).then_some(verdict.turn[0]),
            base_angle_end: (!is_fixed).then_some(verdict.turn[1]),
            sentence,
        }
    }
}

/// Returns why the task of a block cannot be planned, with what would do: keys get the name of the block.
pub fn refused(scenario: &AssemblyScenario, block: usize, why: stillbase_session::Refusal) -> Failure {
    let name = &scenario.assembly.blocks()[block].name;
    Failure::refused(&scenario.tasks[block].scenario, why).of_block(name)
}

impl SimulateArguments {
    /// Simulates a scenario of an assembly as [`run`](Self::run) does one of a machine.
    pub(super) fn run_assembly(&self, scenario: &AssemblyScenario) -> Result<(), Failure> {
        let run = AssemblyRun::new(scenario).map_err(|(block, why)| refused(scenario, block, why))?;
        let mut table = assembly_signals(&run);
        self.choice.check(table.iter().map(|signal| signal.path.as_str()))?;
        table.retain(|signal| self.choice.has_signal(&signal.path));
        let to = match self.writes_csv() {
            true => Some(RowTarget::of(&self.format, &self.form, self.output.as_deref(), self.force)?),
            false => None,
        };
        let last = last_step(&run)?;
        check_size(last / self.every + 2, table.len() + 1, self.format.json)?;
        let head = || -> Vec<String> {
            let own = table.iter().map(|signal| format!("{} {}", signal.path, signal.unit));
            ["time s".to_owned()].into_iter().chain(own).collect()
        };
        let mut rows = to.map(|to| Rows::begin(&to, &head())).transpose()?;
        let (mut count, mut written) = (0_u64, Ok(()));
        let (mut time, mut columns) = (Vec::new(), vec![Vec::new(); table.len()]);
        let value = |signal: &AssemblySignal, frame: &_| signal.value(frame) + 0.0;
        let stop = stop_flag();
        let verdict = run.run(|frame| {
            let is_due = frame.step % self.every == 0 || frame.step == last;
            if is_due && self.choice.has_time(frame.time) {
                count += 1;
                if let Some(rows) = &mut rows {
                    written = rows.row([frame.time].into_iter().chain(table.iter().map(|of| value(of, frame))));
                }
                if self.format.json {
                    time.push(frame.time);
                    columns.iter_mut().zip(&table).for_each(|(column, of)| column.push(value(of, frame)));
                }
            }
            written.is_ok() && stop.goes_on()
        });
        check()?;
        written?;
        if count == 0 {
            return Err(self.choice.no_row(last as f64 * scenario.step).with_context(&scenario.name));
        }
        let is_written = rows.is_some();
        rows.map(Rows::finish).transpose()?;
        let outcome = AssemblyOutcome::of(scenario, &verdict);
        let faults = reactions(scenario, &outcome);
        let name = &scenario.name;
        if self.format.json {
            let answer = AssemblyAnswer {
                scenario: name.clone(),
                units: Columns(table.iter().map(|of| (of.path.clone(), of.unit)).collect()),
                time,
                signals: Columns(table.iter().map(|of| of.path.clone()).zip(columns).collect()),
                verdict: outcome,
            };
            self.format.print(&answer, |_| String::new())?;
        } else if is_written {
            print_message(format!("{name}: {}, {}", counted(outcome.steps, "step"), outcome.sentence));
        } else {
            self.format.print(&outcome, |outcome| summary(outcome, name, table.len()))?;
        }
        self.strict.require(faults)
    }
}

/// Returns the number of the last step.
///
/// # Errors
/// If there are more than are simulated.
pub fn last_step(run: &AssemblyRun) -> Result<u64, Failure> {
    run.steps().ok_or_else(|| {
        let name = &run.scenario().name;
        Failure::wrong_input(format!("{name}: more than 100000000 steps: want a larger step, or a shorter duration"))
    })
}

/// Returns what fails with `--strict`.
pub fn reactions(scenario: &AssemblyScenario, outcome: &AssemblyOutcome) -> Vec<String> {
    let silent = outcome.silent_force.into_iter().chain(outcome.silent_moment).flatten().all(|is_so| is_so);
    let kept = outcome.base_angle.is_none_or(|angle| angle <= 1e-6);
    if silent && kept { Vec::new() } else { vec![format!("{}: {}", scenario.name, outcome.sentence)] }
}

fn summary(outcome: &AssemblyOutcome, name: &str, signals: usize) -> String {
    let mut table = TextTable::new(["", "", ""]).with_words(2);
    let peaks = [(outcome.peak_force, "N"), (outcome.peak_moment, "N m")];
    let all = peaks.into_iter().flat_map(|(three, unit)| three.into_iter().flatten().map(move |peak| (peak, unit)));
    for (component, (peak, unit)) in AssemblyVerdict::COMPONENTS.iter().zip(all) {
        table.row([format!("peak |{component}|"), fixed(peak, 9), unit.into()]);
    }
    let turns =
        [("the base turns by up to", outcome.base_angle), ("turn of the base at the end", outcome.base_angle_end)];
    for (what, turn) in turns {
        if let Some(turn) = turn {
            table.row([what.to_owned(), fixed(turn, 9), "rad".into()]);
        }
    }
    format!(
        "{name}: {}\n\n{}\n{} of {}: -o FILE.csv writes every row, a pipe gets them too\n",
        outcome.sentence,
        table.to_string().trim_start(),
        counted(outcome.steps, "step"),
        counted(signals, "signal")
    )
}
