//! SciPy's least squares find the same numbers of balance from the same measurement.

use serde_json::{Value, json};
use stillbase::mechanics::dynamics::{ExternalLoads, base_wrench};
use stillbase::mechanics::machine::{Inertia, Machine, builtin};
use stillbase::mechanics::planar::{DriveAngles, PerDrive, Vector};
use stillbase::study::trim::{MeasuredMotion, MeasurementSet, Regressor, fit};

use super::python::answers;
use crate::Test;

pub const TESTS: &[Test] = tests![scipy_finds_the_same];

const SCRIPT: &str = include_str!("trim.py");

/// Numbers that look random and are the same each time, from −1 to 1.
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

fn measured(machine: &Machine, noise: &mut Noise) -> MeasurementSet {
    let (inertia, n) = (Inertia::of(machine), machine.drives());
    let around = ExternalLoads { gravity: machine.gravity(), force: Vector::default() };
    let motion = |noise: &mut Noise| {
        let waves: Vec<[f64; 3]> =
            (0..n).map(|_| [0.4 + 0.2 * noise.next(), 5.0 + 3.0 * noise.next(), 3.0 * noise.next()]).collect();
        let mut motion = MeasuredMotion::default();
        for i in 0..250 {
            let t = 0.01 * f64::from(i);
            let each = |f: &dyn Fn(&[f64; 3]) -> f64| PerDrive::from_fn(n, |k| f(&waves[k]));
            let q = each(&|[a, w, p]| p + a * (w * t).sin());
            let qd = each(&|[a, w, _]| a * w * (w * t).cos());
            let qdd = each(&|[a, w, _]| -a * w * w * (w * t).sin());
            let wrench = base_wrench(&inertia, &DriveAngles(q).units(), &qd, &qdd, &around).total();
            motion.t.push(t);
            motion.q.push(q);
            motion.qd.push(qd);
            motion.qdd.push(qdd);
            motion.force.push(wrench.force + Vector::new(noise.next(), noise.next()));
            motion.moment.push(wrench.moment + 0.1 * noise.next());
        }
        motion
    };
    MeasurementSet { motions: (0..3).map(|_| motion(noise)).collect() }
}

fn asked(machine: &Machine, recording: &MeasurementSet) -> Value {
    let list = |all: &[PerDrive]| all.iter().map(|x| x.to_vec()).collect::<Vec<_>>();
    let motion = |m: &MeasuredMotion| {
        let force: Vec<[f64; 2]> = m.force.iter().map(|f| [f.re, f.im]).collect();
        json!({ "t": m.t, "q": list(&m.q), "qd": list(&m.qd), "qdd": list(&m.qdd), "force": force, "moment": m.moment })
    };
    let motions: Vec<Value> = recording.motions.iter().map(motion).collect();
    json!({ "gravity": machine.spec().gravity, "motions": motions })
}

fn scipy_finds_the_same() {
    let mut noise = Noise(7);
    let still = ["two-drive", "nine-link", "four-drive"].map(|name| builtin(name).expect("built in").clone());
    let heavy = still.clone().map(|machine| machine.set("gravity", "1.5,-9.81").expect("a machine"));
    let machines: Vec<Machine> = still.into_iter().chain(heavy).collect();
    let recordings: Vec<MeasurementSet> = machines.iter().map(|machine| measured(machine, &mut noise)).collect();
    let lines: Vec<String> = machines.iter().zip(&recordings).map(|(m, r)| asked(m, r).to_string()).collect();
    let theirs = answers(SCRIPT, &lines);
    assert_eq!(theirs.len(), machines.len());
    for ((machine, recording), theirs) in machines.iter().zip(&recordings).zip(theirs) {
        let ours = fit(machine, &Regressor::of(machine, recording, false).expect("rows")).expect("a fit");
        let found = theirs["found"].as_array().expect("a list");
        assert_eq!(found.len(), ours.numbers.unknowns.count());
        // Weights, which both find from what is left, matter with weight only, and end within a thousandth.
        let part = if machine.gravity() == Vector::default() { 1e-6 } else { 1e-3 };
        for (i, theirs) in found.iter().enumerate() {
            let off = (ours.numbers.measured[i] - theirs.as_f64().expect("a number")).abs();
            assert!(
                ours.numbers.identifiable[i] && off < part * ours.numbers.half_width(i),
                "{} {i}: {off:e}",
                machine.name()
            );
        }
        for (ours, theirs) in ours.noise.iter().zip(theirs["sigma"].as_array().expect("two")) {
            assert!((ours / theirs.as_f64().expect("a number") - 1.0).abs() < 1e-3);
        }
    }
}
