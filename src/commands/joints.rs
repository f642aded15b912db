//! `stillbase joints`

use std::path::PathBuf;

use clap::Args;
use serde::Serialize;
use stillbase::mechanics::joint_forces::{AxialMoments, Joints, KEPT, Pin, PinPeak};
use stillbase::mechanics::machine::{Inertia, Machine};
use stillbase::mechanics::planar::cross;
use stillbase::session::replay_if;
use stillbase::simulation::frame::Frame;

use super::csv_file::Csv;
use super::exit::say;
use super::failure::Failure;
use super::input::{DEFAULT_SCENARIO, Settings, scenario};
use super::output::{Format, Table, check_output, check_size};
use super::simulate::trusted;
use stillbase::settings::number::{counted, fixed, shown};

/// Say what every pin and bearing carries over a run, how near change points come, and what tilts the base
#[derive(Args)]
#[command(after_help = "\
Examples:
  stillbase joints case-3
  stillbase joints case-1 --set gravity=0,-9.81 -o pins.csv
  stillbase joints case-3 --set link.5.axial=0.02 --json")]
pub struct JointsCommand {
    /// A built-in scenario (case-1, spacecraft …; an unknown name lists them all) or a TOML file
    #[arg(value_name = "SCENARIO", default_value = DEFAULT_SCENARIO)]
    scenario: String,
    /// Write the force of every pin over time to this file, as CSV: x and y in base axes, of the first link on the
    /// second
    #[arg(short, long, value_name = "FILE.csv")]
    output: Option<PathBuf>,
    /// Replace the file if it exists
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    settings: Settings,
    #[command(flatten)]
    format: Format,
}

/// The largest or least of something, and when.
#[derive(Clone, Copy, Serialize)]
struct Extreme {
    value: f64,
    time: f64,
}

impl Extreme {
    fn include(seen: &mut Option<Self>, value: f64, time: f64, better: fn(f64, f64) -> bool) {
        if seen.is_none_or(|s| better(value, s.value)) {
            *seen = Some(Self { value, time });
        }
    }
}

#[derive(Serialize)]
struct PinAnswer {
    name: String,
    /// `base` or a link.
    from: String,
    to: String,
    /// N.
    peak: f64,
    /// s.
    time: f64,
    /// N.
    mean: f64,
    /// Steps at a change point, which peak and mean leave out.
    undefined_steps: u64,
}

/// Two drives whose parallelograms, or other loops, lie flat where they line up.
#[derive(Serialize)]
struct Pair {
    drives: [String; 2],
    /// Pins that close parallelograms of these two drives.
    closures: Vec<String>,
    /// Least |sin(q_k − q_l)|: 0 where a change point is passed.
    least: f64,
    /// The transmission angle there, rad.
    angle: f64,
    /// s.
    time: f64,
    /// Change points passed between two steps.
    passed: u64,
}

#[derive(Serialize)]
struct TiltAnswer {
    /// Whether all heights are zero, so that the plane model knows of no tilting.
    flat: bool,
    /// |n_x|, N m.
    x: Extreme,
    /// |n_y|, N m.
    y: Extreme,
    /// The same of the part that comes from motion alone, N m.
    motion: Extreme,
    /// Largest weighted first moment about the height of the centre of mass, kg m²: 0 where no motion tilts.
    residual: f64,
}

#[derive(Serialize)]
struct Answer {
    scenario: String,
    steps: u64,
    pins: Vec<PinAnswer>,
    worst: String,
    transmission: Vec<Pair>,
    tilt: TiltAnswer,
    #[serde(skip_serializing_if = "Option::is_none")]
    audit_failed: Option<String>,
}

/// sin(q_k − q_l) of two drives over a run.
#[derive(Clone, Copy, Default)]
struct Sine {
    last: Option<Extreme>,
    least: Option<Extreme>,
    passed: u64,
}

impl Sine {
    fn include(&mut self, sine: f64, time: f64) {
        Extreme::include(&mut self.least, sine.abs(), time, |a, b| a < b);
        if let Some(last) = self.last.filter(|last| last.value * sine < 0.0) {
            let zero = last.time + (time - last.time) * last.value / (last.value - sine);
            Extreme::include(&mut self.least, 0.0, zero, |a, b| a < b);
            self.passed += 1;
        }
        self.last = Some(Extreme { value: sine, time });
    }
}

/// What a run is asked about.
struct Extremes {
    pins: Vec<PinPeak>,
    pairs: Vec<Sine>,
    tilt: [Option<Extreme>; 3],
}

impl Extremes {
    fn new(pins: usize, pairs: usize) -> Self {
        Self { pins: vec![PinPeak::default(); pins], pairs: vec![Sine::default(); pairs], tilt: [None; 3] }
    }

    fn include(&mut self, frame: &Frame) {
        let (t, e) = (frame.time, frame.q.units());
        for (i, pin) in self.pins.iter_mut().enumerate() {
            pin.include(t, frame.inside.pin(i));
        }
        for ((k, l), pair) in Inertia::pairs(frame.q.len()).zip(&mut self.pairs) {
            pair.include(cross(e[k], e[l]), t);
        }
        let (tilt, motion) = (frame.inside.tilt.total(), frame.inside.tilt.motion);
        for (seen, value) in self.tilt.iter_mut().zip([tilt.re.abs(), tilt.im.abs(), motion.norm()]) {
            Extreme::include(seen, value, t, |a, b| a > b);
        }
    }
}

impl JointsCommand {
    /// Runs the scenario and prints what it finds.
    pub fn run(&self) -> Result<(), Failure> {
        let scenario = scenario(&self.scenario, &self.settings)?;
        let machine = scenario.plant.machine(&scenario.machine)?;
        let joints = Joints::of(&machine).map_err(|e| Failure::from(e).of(machine.name()))?;
        let pins = &joints.pins()[..joints.pins().len().min(KEPT)];
        if pins.len() < joints.pins().len() {
            say(format!("a run keeps the first {KEPT} of {} pins; the others are left out", joints.pins().len()));
        }
        if let Some(file) = &self.output {
            check_output(file, self.force, &["csv"])?;
        }
        let n = machine.drives();
        let mut totals = Extremes::new(pins.len(), Inertia::pairs(n).count());
        let (mut csv, mut written) = (None, Ok(()));
        let columns = if self.output.is_some() { 2 * pins.len() + 3 } else { 0 };
        let run = replay_if(
            &scenario,
            |last| check_size(last + 1, columns, false),
            |_, frame| {
                totals.include(frame);
                if self.output.is_some() && written.is_ok() {
                    written = self.csv(&mut csv, pins).and_then(|csv| csv.row(row(frame, pins.len())));
                }
            },
        )
        .map_err(|e| Failure::from(e).of(&scenario.name))?;
        written?;
        if let Some(csv) = csv {
            csv.finish()?;
        }
        let answer = answer(&scenario.name, &run.frame(), &machine, &joints, &totals);
        self.format.print(&answer, human)?;
        trusted(&answer.scenario, answer.audit_failed)
    }

    fn csv<'a>(&self, begun: &'a mut Option<Csv>, pins: &[Pin]) -> Result<&'a mut Csv, Failure> {
        match begun {
            Some(csv) => Ok(csv),
            None => {
                let axes = |pin: &Pin| ["x", "y"].map(|axis| format!("{} {axis} N", pin.name));
                let head = ["time s".to_string()].into_iter().chain(pins.iter().flat_map(axes));
                let head = head.chain(["tilt x N m", "tilt y N m"].map(String::from));
                Ok(begun.insert(Csv::begin(self.output.as_deref(), self.force, head)?))
            }
        }
    }
}

/// Time, forces, tilt; cells at a change point stay empty.
fn row(frame: &Frame, pins: usize) -> impl Iterator<Item = Option<f64>> {
    let forces = (0..pins).flat_map(|i| {
        let force = frame.inside.pin(i);
        [force.map(|f| f.re), force.map(|f| f.im)]
    });
    let tilt = frame.inside.tilt.total();
    [Some(frame.time)].into_iter().chain(forces).chain([Some(tilt.re), Some(tilt.im)])
}

fn answer(scenario: &str, last: &Frame, machine: &Machine, joints: &Joints, totals: &Extremes) -> Answer {
    let axial = AxialMoments::of(machine);
    let link = |j: usize| machine.links()[j].name.clone();
    let pin = |(pin, seen): (&Pin, &PinPeak)| PinAnswer {
        name: pin.name.clone(),
        from: pin.from.map_or("base".into(), link),
        to: link(pin.to),
        peak: seen.force,
        time: seen.time,
        mean: seen.mean,
        undefined_steps: seen.undefined,
    };
    let pins: Vec<PinAnswer> = joints.pins().iter().zip(&totals.pins).map(pin).collect();
    let none = Extreme { value: 0.0, time: 0.0 };
    // A loop of three drives may lie flat by any pair of them.
    let other_loops = joints.pins().len() > machine.links().len() + joints.parallelograms().len();
    let pair = |((k, l), sine): ((usize, usize), &Sine)| {
        let seen = sine.least.unwrap_or(none);
        let closures = joints.parallelograms().iter().filter(|p| p.drives == (k, l));
        let closures: Vec<String> = closures.map(|p| p.name.clone()).collect();
        // No loop lies flat where two links in series line up.
        (!closures.is_empty() || other_loops).then(|| Pair {
            drives: [k, l].map(|k| machine.spec().drives[k].name.clone()),
            closures,
            least: seen.value,
            angle: seen.value.min(1.0).asin(),
            time: seen.time,
            passed: sine.passed,
        })
    };
    let [x, y, motion] = totals.tilt.map(|seen| seen.unwrap_or(none));
    Answer {
        scenario: scenario.into(),
        steps: last.step,
        worst: pins.iter().max_by(|a, b| a.peak.total_cmp(&b.peak)).map_or(String::new(), |p| p.name.clone()),
        pins,
        transmission: Inertia::pairs(machine.drives()).zip(&totals.pairs).filter_map(pair).collect(),
        tilt: TiltAnswer { flat: axial.is_flat(), x, y, motion, residual: axial.residual() },
        audit_failed: last.fault().map(|lamp| lamp.to_string()),
    }
}

fn human(answer: &Answer) -> String {
    let mut pins = Table::new(["pin", "on link", "peak N", "at s", "mean N"]);
    let mut undefined = 0;
    for pin in &answer.pins {
        pins.row([pin.name.clone(), pin.to.clone(), shown(pin.peak, 3), fixed(pin.time, 3), shown(pin.mean, 3)]);
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
        let mut pairs = Table::new(["drives", "least |sin|", "angle rad", "at s", "closed by"]).with_words(4);
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
    let mut tilts = Table::new(["tilting moment", "peak N m", "at s"]);
    for (name, peak) in [("about x", tilt.x), ("about y", tilt.y), ("from motion", tilt.motion)] {
        tilts.row([name.into(), fixed(peak.value, 6), fixed(peak.time, 3)]);
    }
    text + &format!(
        "\n{tilts}\nlargest |Σ m (z − z_CM) a| {:.1e} kg m²: what no force balance removes\n",
        tilt.residual
    )
}
