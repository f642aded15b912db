//! MuJoCo opens the models that are written for it and finds the same mass matrix, torques and reactions.

use serde_json::{Value, json};
use stillbase::exchange::cut::Cut;
use stillbase::exchange::mjcf::{hinges, middle, mjcf};
use stillbase::mechanics::dynamics::{ExternalLoads, inverse_with_wrench, mass_matrix};
use stillbase::mechanics::kinematics::end_effector;
use stillbase::mechanics::machine::{Counterweight, Inertia, Machine, builtins};
use stillbase::mechanics::planar::{DriveAngles, PerDrive};
use stillbase::session::replay;
use stillbase::session::scenario::Scenario;

use super::python::answers;
use crate::Test;

pub const TESTS: &[Test] = tests![every_machine_weighs_and_pulls_the_same, case_3_is_silent_at_the_base];

const SCRIPT: &str = include_str!("mujoco.py");

/// Numbers that look random and are the same each time.
struct Noise(u64);

impl Noise {
    /// From −1 to 1.
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// A state of motion.
struct Motion {
    q: PerDrive,
    qd: PerDrive,
    qdd: PerDrive,
}

fn per_drive(machine: &Machine, values: impl FnMut(usize) -> f64) -> PerDrive {
    let values: Vec<f64> = (0..machine.drives()).map(values).collect();
    PerDrive::from_slice(&values).expect("eight at most")
}

/// How each hinge turns with each drive: hinges follow the drives in proportion.
fn columns(machine: &Machine) -> Vec<Vec<f64>> {
    let q = vec![0.0; machine.drives()];
    let still = hinges(machine, &q).expect("a pose");
    let one = |k: usize| {
        let mut q = q.clone();
        q[k] = 1.0;
        let turned = hinges(machine, &q).expect("a pose");
        turned.iter().zip(&still).map(|(a, b)| a - b).collect()
    };
    (0..machine.drives()).map(one).collect()
}

fn asked(machine: &Machine, motions: &[Motion]) -> String {
    let columns = columns(machine);
    let rates = |x: &PerDrive| -> Vec<f64> {
        (0..columns[0].len()).map(|i| columns.iter().zip(x.iter()).map(|(column, x)| column[i] * x).sum()).collect()
    };
    let n = machine.drives();
    let motions: Vec<Value> = motions
        .iter()
        .map(|motion| {
            let qpos = hinges(machine, &motion.q[..n]).expect("a pose");
            json!({ "qpos": qpos, "qvel": rates(&motion.qd), "qacc": rates(&motion.qdd) })
        })
        .collect();
    let model = mjcf(machine, None, &middle(machine), &Cut::default()).expect("a model");
    json!({ "model": model, "columns": columns, "motions": motions }).to_string()
}

#[track_caller]
fn near(what: &str, got: &[f64], want: &Value, scale: f64) {
    let want: Vec<f64> = match want {
        Value::Array(list) => list.iter().map(|x| x.as_f64().expect("a number")).collect(),
        one => vec![one.as_f64().expect("a number")],
    };
    assert_eq!(got.len(), want.len(), "{what}");
    for (got, want) in got.iter().zip(&want) {
        assert!((got - want).abs() <= 1e-6 * scale, "{what}: {got}, MuJoCo finds {want} (scale {scale})");
    }
}

fn compare(machine: &Machine, motion: &Motion, found: &Value) {
    let (n, inertia, e) = (machine.drives(), Inertia::of(machine), DriveAngles(motion.q).units());
    let around = ExternalLoads { gravity: machine.gravity(), ..ExternalLoads::default() };
    let (h, _) = mass_matrix(&inertia, &e, &motion.qd);
    let (torque, wrench) = inverse_with_wrench(&inertia, &e, &motion.qd, &motion.qdd, &around);
    let rows: Vec<f64> = (0..n * n).map(|i| h.get(i / n, i % n)).collect();
    let largest = |list: &[f64]| list.iter().fold(1.0_f64, |most, x| most.max(x.abs()));
    let (name, total) = (machine.name(), wrench.total());
    near(&format!("{name}: pins are closed"), &[0.0], &found["open"], 1.0);
    near(&format!("{name}: pins stay closed"), &[0.0], &found["moves"], 1.0);
    near(&format!("{name}: H"), &rows, &found["mass_matrix"], largest(&rows));
    near(&format!("{name}: τ"), &torque[..n], &found["torque"], largest(&torque[..n]));
    let force = [total.force.re, total.force.im];
    let scale = largest(&[force[0], force[1], total.moment]).max(machine.mass());
    near(&format!("{name}: f_B"), &force, &found["force"], scale);
    near(&format!("{name}: n_B"), &[total.moment], &found["moment"], scale);
    let tip = end_effector(machine.end_effector(), &e);
    near(&format!("{name}: end effector"), &[tip.re, tip.im], &found["end_effector"], 1.0);
}

/// As they are, and off balance, with a payload, under gravity.
fn every_machine_weighs_and_pulls_the_same() {
    let mut noise = Noise(1);
    let mut machines = Vec::new();
    for machine in builtins() {
        machines.push(machine.clone());
        let mut other = machine.set("gravity", "1.3,-9.7").expect("in range");
        for link in machine.links() {
            let key = |what: &str| format!("link.{}.{what}", link.name);
            let mass = (link.mass * (1.0 + 0.5 * noise.next())).to_string();
            let (com, normal) = ((link.com + 0.05 * noise.next()).to_string(), (0.05 * noise.next()).to_string());
            other = other.set(&key("mass"), &mass).and_then(|m| m.set(&key("com"), &com)).expect("in range");
            other = other.set(&key("com_normal"), &normal).expect("in range");
        }
        let payload = [("payload.mass", "0.4"), ("payload.inertia", "0.003"), ("payload.offset", "0.03,-0.02")];
        let mut spec = other.set_all(payload).expect("in range").spec().clone();
        let link = spec.links[0].name.clone();
        spec.counterweights.push(Counterweight {
            link,
            mass: 1.5,
            at: -0.1,
            across: 0.04,
            radius: 0.05,
            ..Default::default()
        });
        machines.push(Machine::new(spec).expect("a machine"));
    }
    let motions: Vec<Vec<Motion>> = machines
        .iter()
        .map(|machine| {
            let middle = middle(machine);
            let one = |_| Motion {
                q: per_drive(machine, |k| middle[k] + 0.5 * noise.next()),
                qd: per_drive(machine, |_| 3.0 * noise.next()),
                qdd: per_drive(machine, |_| 20.0 * noise.next()),
            };
            (0..20).map(one).collect()
        })
        .collect();
    let lines: Vec<String> = machines.iter().zip(&motions).map(|(machine, motions)| asked(machine, motions)).collect();
    let found = answers(SCRIPT, &lines);
    assert_eq!(found.len(), machines.len());
    for ((machine, motions), found) in machines.iter().zip(&motions).zip(&found) {
        let found = found.as_array().expect("a list");
        assert_eq!(found.len(), motions.len());
        motions.iter().zip(found).for_each(|(motion, found)| compare(machine, motion, found));
    }
}

/// What the paper promises, at a sensor that is not ours.
fn case_3_is_silent_at_the_base() {
    for (case, is_silent) in [("case-3", true), ("case-1", false)] {
        let scenario = Scenario::builtin(case).expect("built in");
        let mut motions = Vec::new();
        replay(&scenario, |_, frame| motions.push(Motion { q: frame.q.0, qd: frame.qd, qdd: frame.qdd }))
            .expect("it runs");
        let motions: Vec<Motion> = motions.into_iter().step_by(10).collect();
        assert!(motions.len() > 20);
        let found = answers(SCRIPT, &[asked(&scenario.machine, &motions)]);
        let moments = found[0].as_array().expect("a list").iter().map(|one| one["moment"].as_f64().expect("a number"));
        let most = moments.fold(0.0_f64, |most, moment| most.max(moment.abs()));
        match is_silent {
            true => assert!(most < 1e-9, "{case}: {most} N m"),
            false => assert!((most - 1.0891).abs() < 1e-3, "{case}: {most} N m"),
        }
    }
}
