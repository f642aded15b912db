//! `stillbase export`

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use schemars::JsonSchema;
use serde::Serialize;
use stillbase_session::scenario::Scenario;
use stillbase_session::{Run, arm_on_base, replay_if, with_start_edits};

use super::exit::print_message;
use super::failure::Failure;
use super::file_form::FileForm;
use super::input::{Settings, scenario};
use super::output::{Format, check_size};
use super::progress::goes_on;
use super::rows::{self, RowTarget};
use super::simulate::require_audit;
use super::strict::{Strict, run_faults};
use stillbase_session::verdict::Verdict;
use stillbase_settings::number::{counted, fixed};
use stillbase_simulation::plant::BaseKind;

/// Write a motion as CSV or Parquet at the rate of a controller: angles, rates, accelerations, feed-forward torques
///
/// Columns are t; q, qd, qdd, tau_ff of each drive; x, y of the end effector; and b. Numbers are in SI units and
/// radians, with all digits. A simulation on a moving base adds base_x, base_y, theta and their rates base_xd, base_yd,
/// thetad. Its angles q are absolute, and its x, y are in space: an encoder reads
/// q - theta. A planned reference has all of these as seen from the base. The last columns of a simulation are fx, fy, nz. These
/// are the force and moment that the machine transmits to its base, weight included. A force plate reads the same
/// (`stillbase trim`). The first row is the start and the last row the end, even if the rate does not divide the
/// duration.
#[derive(Args)]
#[command(after_help = "\
Examples:
  stillbase export case-3 --rate 500 -o case-3.csv
  stillbase export case-1 --what simulated --set plant.payload.mass=0.2 | head")]
pub struct ExportArguments {
    /// A built-in scenario or a TOML file
    #[arg(value_name = "SCENARIO")]
    scenario: String,
    /// Rows per second
    #[arg(long, value_name = "HZ", default_value = "1000", value_parser = rate)]
    rate: f64,
    /// The planned reference with the feed-forward torques of the model, or the motion of the simulated machine (its
    /// torque columns are tau1, tau2 …)
    #[arg(long, value_enum, default_value = "reference")]
    what: What,
    /// Write the rows to this file, .csv or .parquet, instead of standard output
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

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum What {
    Reference,
    Simulated,
}

/// Columns of a base that moves: place of B, angle of the base, and the rates of both.
const OF_BASE: [&str; 6] = ["base_x", "base_y", "theta", "base_xd", "base_yd", "thetad"];

/// Columns of the force and the moment about B that reach the base.
const TO_BASE: [&str; 3] = ["fx", "fy", "nz"];

/// Maximum number of rows; a request for more is probably a mistake.
const MAX_ROWS: f64 = 2e6;

fn rate(text: &str) -> Result<f64, String> {
    text.trim().parse().ok().filter(|x| (0.01..=1e6).contains(x)).ok_or_else(|| "want 0.01 to 1000000 Hz".into())
}

#[derive(JsonSchema, Serialize)]
pub struct Answer {
    scenario: String,
    what: &'static str,
    rate: f64,
    duration: f64,
    /// Time from the last row but one to the last, s.
    last_interval: f64,
    columns: Vec<String>,
    rows: Vec<Vec<f64>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    audit_failed: Option<String>,
}

impl ExportArguments {
    /// Writes the motion as CSV or Parquet.
    pub fn run(&self) -> Result<(), Failure> {
        let (format, form, file) = (&self.format, &self.form, self.output.as_deref());
        // Without a file, JSON takes the place of rows.
        let to = match file.is_none() && format.json {
            true => RowTarget::wanted(format, form, file, self.force)?,
            false => Some(RowTarget::of(format, form, file, self.force)?),
        };
        let scenario = scenario(&self.scenario, &self.settings)?;
        let name = scenario.name.clone();
        // The first edits may draw another machine.
        let drives = with_start_edits(&scenario)?.0.machine.drives();
        let (rows, duration, audit_failed, faults) = match self.what {
            What::Reference => {
                let (start, later) = with_start_edits(&scenario)?;
                if later > 0 {
                    print_message(format!(
                        "note: the reference leaves out {} after the start; --what simulated has all",
                        counted(later, "edit")
                    ));
                }
                match start.base.kind {
                    BaseKind::Fixed => {}
                    BaseKind::Compliant => print_message(
                        "note: tau_ff is of the model on a fixed base; --what simulated gives what control asks for",
                    ),
                    BaseKind::Free => print_message(
                        "note: angles, x and y are seen from the base; --what simulated has them in space, with its theta",
                    ),
                }
                let (rows, duration) = self.reference(&Run::new(&start).map_err(|e| Failure::refused(&start, e))?)?;
                (rows, duration, None, Vec::new())
            }
            What::Simulated => self.simulated(&scenario)?,
        };
        let based = self.what == What::Simulated && scenario.base.moves();
        let torque = if self.what == What::Reference { "tau_ff" } else { "tau" };
        let per_drive = ["q", "qd", "qdd", torque].into_iter();
        let columns: Vec<String> = std::iter::once("t".to_owned())
            .chain(per_drive.flat_map(|word| (1..=drives).map(move |k| format!("{word}{k}"))))
            .chain(["x", "y", "b"].map(String::from))
            .chain(OF_BASE.map(String::from).into_iter().filter(|_| based))
            .chain(TO_BASE.map(String::from).into_iter().filter(|_| self.what == What::Simulated))
            .collect();
        let last_interval = match rows.as_slice() {
            [.., before, last] => last[0] - before[0],
            _ => 0.0,
        };
        if (last_interval * self.rate - 1.0).abs() > 1e-6 && rows.len() > 1 {
            print_message(format!(
                "note: {} Hz does not divide {} s: the last row, the end, is {} ms after the one before",
                self.rate,
                fixed(duration, 6),
                fixed(1e3 * last_interval, 6)
            ));
        }
        let what = if self.what == What::Reference { "reference" } else { "simulated" };
        let answer =
            Answer { scenario: name, what, rate: self.rate, duration, last_interval, columns, rows, audit_failed };
        if let Some(to) = to {
            let mut rows = rows::Rows::begin(&to, &answer.columns)?;
            answer.rows.iter().try_for_each(|row| rows.row(row.iter().copied()))?;
            rows.finish()?;
        }
        if self.format.json {
            self.format.print(&answer, |_| String::new())?;
        }
        require_audit(&answer.scenario, answer.audit_failed)?;
        self.strict.require(faults)
    }

    /// Returns the rows of the planned motion, and its duration, s.
    fn reference(&self, run: &Run) -> Result<(Rows, f64), Failure> {
        let (motion, body) = (&run.plan().motion, arm_on_base(run.scenario()));
        let (model, whole) = (body.arm(), motion.duration());
        self.check_rows(whole)?;
        // The end adds a row unless a whole number of intervals reaches it.
        let spaces = (whole * self.rate * (1.0 - 1e-9)).ceil() as usize;
        let lambda = model.lambda();
        let row = |i: usize| {
            let t = if i == spaces { whole } else { i as f64 / self.rate };
            let r = motion.at(t);
            let (torque, _) = body.dynamics(&r.q.units(), &r.qd, &r.qdd);
            let torque = model.motors().motor_torques(&torque);
            let p = run.end_effector_at(&r.q);
            // Adding zero removes the sign of -0.
            let all = r.q.iter().chain(r.qd.iter()).chain(r.qdd.iter()).chain(torque.iter()).map(|x| x + 0.0);
            std::iter::once(t).chain(all).chain([p.re, p.im, lambda.dot(&r.q)]).collect()
        };
        Ok(((0..=spaces).map(row).collect(), whole))
    }

    /// Returns the rows of the simulated motion, its duration, s, the audit that it failed, if any, and what of the
    /// run is not good.
    fn simulated(&self, scenario: &Scenario) -> Result<(Rows, f64, Option<String>, Vec<String>), Failure> {
        let steps = 1.0 / (scenario.step * self.rate);
        let every = steps.round();
        if !(every >= 1.0 && (steps - every).abs() < 1e-6 * every) {
            let why = format!(
                "--rate {} does not divide the simulation's {:.6} steps a second: want a divisor, or another step in the \
                 scenario",
                self.rate,
                1.0 / scenario.step
            );
            return Err(Failure::wrong_input(why));
        }
        self.check_rows(scenario.duration.unwrap_or(scenario.task.time))?;
        let mut rows = Vec::new();
        let columns = 4 * scenario.machine.drives() + 4 + TO_BASE.len();
        let fits = |last: u64| check_size(last / every as u64 + 1, columns, true);
        let run = replay_if(scenario, fits, |run, f| {
            if f.step % every as u64 == 0 || f.step == run.last_step() {
                let all = f.q.iter().chain(f.qd.iter()).chain(f.qdd.iter()).chain(f.torque.iter()).map(|x| x + 0.0);
                let place = [f.base.at.re, f.base.at.im, f.base.angle];
                let rates = [f.base_velocity.re, f.base_velocity.im, f.base_rate];
                let wrench = f.wrench.total();
                let base = place.into_iter().chain(rates).map(|x| x + 0.0).filter(|_| scenario.base.moves());
                rows.push(
                    std::iter::once(f.time)
                        .chain(all)
                        .chain([f.end_effector.re, f.end_effector.im, f.b])
                        .chain(base)
                        .chain([wrench.force.re, wrench.force.im, wrench.moment].map(|x| x + 0.0))
                        .collect(),
                );
            }
            goes_on()
        })
        .map_err(|e| Failure::refused(scenario, e))?;
        let last = run.frame();
        let faults = run_faults(&scenario.name, &Verdict::of(run.scenario(), &last));
        Ok((rows, last.time, last.first_violation().map(|lamp| lamp.to_string()), faults))
    }

    fn check_rows(&self, duration: f64) -> Result<(), Failure> {
        let rows = duration * self.rate;
        match rows <= MAX_ROWS {
            true => Ok(()),
            false => Err(Failure::wrong_input(format!(
                "--rate {}: {rows:.0} rows: want at most {MAX_ROWS:.0}, a lower rate",
                self.rate
            ))),
        }
    }
}

/// One row of numbers for each instant.
type Rows = Vec<Vec<f64>>;
