//! [`JointExtremes`]: extremes over a run of the pin forces, of the distance to change points, and of the moments that
//! tilt the base.

use schemars::JsonSchema;
use serde::Serialize;

use stillbase_mechanics::joint_forces::{AxialMoments, Joints, JointsError, MAX_FRAME_PINS, Pin, PinPeak};
use stillbase_mechanics::machine::{Inertia, Machine};
use stillbase_mechanics::planar::cross;
use stillbase_simulation::frame::Frame;

/// An extreme value and its time.
#[derive(Clone, Copy, Debug, PartialEq, JsonSchema, Serialize)]
pub struct Extreme {
    /// The value.
    pub value: f64,
    /// Time, s.
    pub time: f64,
}

impl Extreme {
    fn include(seen: &mut Option<Self>, value: f64, time: f64, better: fn(f64, f64) -> bool) {
        if seen.is_none_or(|s| better(value, s.value)) {
            *seen = Some(Self { value, time });
        }
    }
}

/// Load of a pin over a run.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct PinLoad {
    /// Name of the pin.
    pub name: String,
    /// First body that it connects: `base` or a link.
    pub from: String,
    /// Second body, a link.
    pub to: String,
    /// Largest force, N.
    pub peak: f64,
    /// Time of the largest force, s.
    pub time: f64,
    /// Mean force, N.
    pub mean: f64,
    /// Number of steps at a change point, which peak and mean omit.
    pub undefined_steps: u64,
}

/// Two drives whose closed loops, such as parallelograms, become flat where the drives align.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct Transmission {
    /// Names of the drives.
    pub drives: [String; 2],
    /// Pins that close the parallelograms of these two drives.
    pub closures: Vec<String>,
    /// Smallest |sin(q_k − q_l)|; 0 if a change point is passed.
    pub least: f64,
    /// Transmission angle at that time, rad.
    pub angle: f64,
    /// Time of the smallest value, s.
    pub time: f64,
    /// Number of change points passed between consecutive steps.
    pub passed: u64,
}

/// Moments that tilt the base.
#[derive(Clone, Copy, Debug, PartialEq, JsonSchema, Serialize)]
pub struct TiltExtremes {
    /// Whether all heights are zero, so that the planar model has no tilting moments.
    pub flat: bool,
    /// Largest |n_x|, N m.
    pub x: Extreme,
    /// Largest |n_y|, N m.
    pub y: Extreme,
    /// Largest magnitude of the part that comes from motion alone, N m.
    pub motion: Extreme,
    /// Largest |s_k − z̄ g_k|, kg m²: the height-weighted first moment, relative to the height z̄ of the centre of
    /// mass. If it is 0, no motion tilts the base.
    pub residual: f64,
}

/// Loads of the joints over a run.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct JointReport {
    /// Name of the scenario.
    pub scenario: String,
    /// Number of steps.
    pub steps: u64,
    /// Loads of the recorded pins.
    pub pins: Vec<PinLoad>,
    /// Pin with the largest force.
    pub worst: String,
    /// Pairs of drives whose closed loops become flat where the drives align.
    pub transmission: Vec<Transmission>,
    /// Moments that tilt the base.
    pub tilt: TiltExtremes,
    /// The first audit that failed, in words.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub audit_failed: Option<String>,
}

/// sin(q_k − q_l) of two drives over a run.
#[derive(Clone, Copy, Debug, Default)]
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

/// Collects the extremes of the joint loads of a machine, frame by frame.
#[derive(Clone, Debug)]
pub struct JointExtremes {
    machine: Machine,
    joints: Joints,
    seen: Vec<PinPeak>,
    pairs: Vec<Sine>,
    tilt: [Option<Extreme>; 3],
}

impl JointExtremes {
    /// Returns a collector without frames.
    ///
    /// # Errors
    /// Fails if the forces in the joints cannot be determined.
    pub fn of(machine: Machine) -> Result<Self, JointsError> {
        let joints = Joints::of(&machine)?;
        let pairs = vec![Sine::default(); Inertia::pairs(machine.drives()).count()];
        let seen = vec![PinPeak::default(); joints.pins().len().min(MAX_FRAME_PINS)];
        Ok(Self { machine, joints, seen, pairs, tilt: [None; 3] })
    }

    /// Returns the pins whose loads are recorded.
    pub fn pins(&self) -> &[Pin] {
        &self.joints.pins()[..self.seen.len()]
    }

    /// Returns the number of pins that are not recorded.
    pub fn left_out(&self) -> usize {
        self.joints.pins().len() - self.seen.len()
    }

    /// Includes a frame of a run of the machine.
    pub fn include(&mut self, frame: &Frame) {
        let (t, e) = (frame.time, frame.q.units());
        for (i, pin) in self.seen.iter_mut().enumerate() {
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

    /// Returns the report up to the last frame of a run; `scenario` is the name.
    pub fn report(&self, scenario: &str, last: &Frame) -> JointReport {
        let (machine, joints) = (&self.machine, &self.joints);
        let axial = AxialMoments::of(machine);
        let link = |j: usize| machine.links()[j].name.clone();
        let pin = |(pin, seen): (&Pin, &PinPeak)| PinLoad {
            name: pin.name.clone(),
            from: pin.from.map_or("base".into(), link),
            to: link(pin.to),
            peak: seen.force,
            time: seen.time,
            mean: seen.mean,
            undefined_steps: seen.undefined,
        };
        let pins: Vec<PinLoad> = joints.pins().iter().zip(&self.seen).map(pin).collect();
        let none = Extreme { value: 0.0, time: 0.0 };
        // A loop of three drives may become flat by the alignment of any two of them.
        let other_loops = joints.pins().len() > machine.links().len() + joints.parallelograms().len();
        let pair = |((k, l), sine): ((usize, usize), &Sine)| {
            let seen = sine.least.unwrap_or(none);
            let closures = joints.parallelograms().iter().filter(|p| p.drives == (k, l));
            let closures: Vec<String> = closures.map(|p| p.name.clone()).collect();
            // Two links in series form no loop that could become flat.
            (!closures.is_empty() || other_loops).then(|| Transmission {
                drives: [k, l].map(|k| machine.spec().drives[k].name.clone()),
                closures,
                least: seen.value,
                angle: seen.value.min(1.0).asin(),
                time: seen.time,
                passed: sine.passed,
            })
        };
        let [x, y, motion] = self.tilt.map(|seen| seen.unwrap_or(none));
        JointReport {
            scenario: scenario.into(),
            steps: last.step,
            worst: pins.iter().max_by(|a, b| a.peak.total_cmp(&b.peak)).map_or(String::new(), |p| p.name.clone()),
            pins,
            transmission: Inertia::pairs(machine.drives()).zip(&self.pairs).filter_map(pair).collect(),
            tilt: TiltExtremes { flat: axial.is_flat(), x, y, motion, residual: axial.residual() },
            audit_failed: last.first_violation().map(|lamp| lamp.to_string()),
        }
    }
}
