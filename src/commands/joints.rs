//! `stillbase joints`

use std::path::PathBuf;

use clap::Args;
use stillbase_mechanics::joint_forces::Pin;
use stillbase_session::replay_if;
use stillbase_simulation::frame::Frame;
use stillbase_study::joint_extremes::{JointExtremes, JointReport};

use super::exit::print_message;
use super::failure::Failure;
use super::file_form::FileForm;
use super::input::{DEFAULT_SCENARIO, Settings, scenario};
use super::output::{Format, TextTable, check_size};
use super::progress::goes_on;
use super::rows::{RowTarget, Rows};
use super::simulate::require_audit;
use super::strict::{Strict, run_faults};
use stillbase_session::verdict::Verdict;
use stillbase_settings::number::{counted, fixed, fixed_or_scientific};

/// Print the forces on all pins and bearings over a run, how near it comes to change points, and the tilting moment
#[derive(Args)]
#[command(after_help = "\
Examples:
  stillbase joints case-3
  stillbase joints case-1 --set gravity=0,-9.81 -o pins.csv
  stillbase joints case-3 --set link.5.axial=0.02 --json")]
pub struct JointsArguments {
    /// A built-in scenario (case-1, spacecraft …; an unknown name lists them all) or a TOML file
    #[arg(value_name = "SCENARIO", default_value = DEFAULT_SCENARIO)]
    scenario: String,
    /// Write the force on every pin over time to this file, .csv or .parquet. The first link exerts it on the second; x and y are in
    /// base axes
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

impl JointsArguments {
    /// Runs the scenario and prints the extremes of pin forces, transmission and tilt.
    pub fn run(&self) -> Result<(), Failure> {
        let scenario = scenario(&self.scenario, &self.settings)?;
        let machine = scenario.plant.machine(&scenario.machine)?;
        let name = machine.name().to_owned();
        let mut extremes = JointExtremes::of(machine).map_err(|e| Failure::from(e).with_context(name))?;
        let pins = extremes.pins().to_vec();
        if extremes.left_out() > 0 {
            let all = pins.len() + extremes.left_out();
            print_message(format!("a run keeps the first {} of {all} pins; the others are left out", pins.len()));
        }
        let to = RowTarget::wanted(&self.format, &self.form, self.output.as_deref(), self.force)?;
        let (mut csv, mut written) = (None, Ok(()));
        let columns = if to.is_some() { 2 * pins.len() + 5 } else { 0 };
        let run = replay_if(
            &scenario,
            |last| check_size(last + 1, columns, false),
            |_, frame| {
                extremes.include(frame);
                if let Some(to) = &to {
                    written = rows_of(&mut csv, to, &pins).and_then(|csv| csv.row(row(frame, pins.len())));
                }
                written.is_ok() && goes_on()
            },
        );
        written?;
        let run = run.map_err(|e| Failure::refused(&scenario, e))?;
        if let Some(csv) = csv {
            csv.finish()?;
        }
        let answer = extremes.report(&scenario.name, &run.frame());
        self.format.print(&answer, human)?;
        require_audit(&answer.scenario, answer.audit_failed)?;
        self.strict.require(run_faults(&answer.scenario, &Verdict::of(run.scenario(), &run.frame())))
    }
}

/// Returns the rows; the first call opens the file and writes its head.
fn rows_of<'a>(begun: &'a mut Option<Rows>, to: &RowTarget, pins: &[Pin]) -> Result<&'a mut Rows, Failure> {
    match begun {
        Some(csv) => Ok(csv),
        None => {
            let axes = |pin: &Pin| ["x", "y"].map(|axis| format!("{} {axis} N", pin.name));
            let head = ["time s".to_string()].into_iter().chain(pins.iter().flat_map(axes));
            // Older names stay beside newer ones until version 0.3.
            let tilt = ["tilt/x N m", "tilt/y N m", "tilt x N m", "tilt y N m"];
            let head: Vec<String> = head.chain(tilt.map(String::from)).collect();
            Ok(begun.insert(Rows::begin(to, &head)?))
        }
    }
}

/// Returns a row of time, forces and tilt; cells at a change point are empty.
fn row(frame: &Frame, pins: usize) -> impl Iterator<Item = Option<f64>> {
    let forces = (0..pins).flat_map(|i| {
        let force = frame.inside.pin(i);
        [force.map(|f| f.re), force.map(|f| f.im)]
    });
    let tilt = frame.inside.tilt.total();
    let tilt = [Some(tilt.re), Some(tilt.im)];
    [Some(frame.time)].into_iter().chain(forces).chain(tilt).chain(tilt)
}

fn human(answer: &JointReport) -> String {
    let mut pins = TextTable::new(["pin", "on link", "peak N", "at s", "mean N"]);
    let mut undefined = 0;
    for pin in &answer.pins {
        pins.row([
            pin.name.clone(),
            pin.to.clone(),
            fixed_or_scientific(pin.peak, 3),
            fixed(pin.time, 3),
            fixed_or_scientific(pin.mean, 3),
        ]);
        undefined = undefined.max(pin.undefined_steps);
    }
    let mut text = format!(
        "{}, {}; the pin that carries most is {}\n\n",
        answer.scenario,
        counted(answer.steps, "step"),
        answer.worst
    );
    text += &pins.to_string();
    if undefined > 0 {
        text += &format!(
            "\nat a change point forces are undefined: peak and mean leave out {} there\n",
            counted(undefined, "step")
        );
    }
    if !answer.transmission.is_empty() {
        let mut pairs = TextTable::new(["drives", "least |sin|", "angle rad", "at s", "closed by"]).with_words(4);
        for pair in &answer.transmission {
            let closures = if pair.closures.is_empty() { "none".into() } else { pair.closures.join(", ") };
            let (least, angle) = (fixed(pair.least, 6), fixed(pair.angle, 6));
            pairs.row([pair.drives.join(", "), least, angle, fixed(pair.time, 3), closures]);
        }
        text += &format!("\n{pairs}");
        let passed: u64 = answer.transmission.iter().map(|p| p.passed).sum();
        if passed > 0 {
            let (points, peaks) = if passed == 1 { ("change point", "it") } else { ("change points", "them") };
            text += &format!(
                "\n{passed} {points} passed between steps: near {peaks} forces grow without bound, so peaks depend on the step\n"
            );
        }
    }
    let tilt = &answer.tilt;
    if tilt.flat {
        return text
            + "\ntilting moment   not in the model: all axial offsets are zero; --set link.NAME.axial=0.02 (m) tells \
               at what height a link lies\n";
    }
    let mut tilts = TextTable::new(["tilting moment", "peak N m", "at s"]);
    for (name, peak) in [("about x", tilt.x), ("about y", tilt.y), ("from motion", tilt.motion)] {
        tilts.row([name.into(), fixed(peak.value, 6), fixed(peak.time, 3)]);
    }
    text + &format!(
        "\n{tilts}\nlargest |Σ m (z − z_CM) a| {:.1e} kg m²: what no force balance removes\n",
        tilt.residual
    )
}
