//! Pinocchio opens the models that are written for it and finds the same mass matrix, weight, torques and reactions.

use serde_json::{Value, json};
use stillbase::exchange::cut::Cut;
use stillbase::exchange::import::import;
use stillbase::exchange::urdf::{joint, urdf};
use stillbase::mechanics::dynamics::{ExternalLoads, inverse_with_wrench, mass_matrix};
use stillbase::mechanics::kinematics::end_effector;
use stillbase::mechanics::machine::{Inertia, Machine, builtins};
use stillbase::mechanics::planar::{DriveAngles, PerDrive, Vector};

use super::python::answers;
use crate::arms::{THREE, TWO};
use crate::random::{a_chain, a_machine};
use crate::{Noise, Test};

pub const TESTS: &[Test] = tests![every_machine_weighs_and_pulls_the_same, arms_of_others_come_in_as_they_are];

const SCRIPT: &str = include_str!("pinocchio.py");

/// A state of motion.
struct Motion {
    q: PerDrive,
    qd: PerDrive,
    qdd: PerDrive,
}

/// What is asked of a model whose motors have these joints, each 1 or −1 where it counts the other way, and whose drives
/// are at `pose` where all joints are at 0.
fn asked(machine: &Machine, model: &str, motors: &[(String, f64)], pose: &[f64], motions: &[Motion]) -> String {
    let n = machine.drives();
    let rows = |k: usize| -> Vec<f64> {
        (0..n)
            .map(|l| match l {
                l if l == k => motors[k].1,
                l if machine.motors().on(k) == Some(l) => -motors[k].1,
                _ => 0.0,
            })
            .collect()
    };
    let one = |m: &Motion| {
        let q: Vec<f64> = (0..n).map(|k| m.q[k] - pose[k]).collect();
        json!({ "q": q, "qd": m.qd[..n], "qdd": m.qdd[..n] })
    };
    let motions: Vec<Value> = motions.iter().map(one).collect();
    let from_drives: Vec<Vec<f64>> = (0..n).map(rows).collect();
    json!({
        "model": model,
        "end": if model.contains("\"end_effector\"") { "end_effector" } else if model.contains("tool0") { "tool0" } else { "tcp" },
        "gravity": machine.spec().gravity,
        "motors": motors.iter().map(|(joint, _)| joint).collect::<Vec<_>>(),
        "motors_from_drives": from_drives,
        "knows_followers": model.contains("name=\"end_effector\"") && model.contains("drive_"),
        "motions": motions,
    })
    .to_string()
}

#[track_caller]
fn near(what: &str, got: &[f64], want: &Value, scale: f64) {
    let want: Vec<f64> = match want {
        Value::Array(list) => list.iter().map(|x| x.as_f64().expect("a number")).collect(),
        one => vec![one.as_f64().unwrap_or_else(|| panic!("{what}: no number"))],
    };
    assert_eq!(got.len(), want.len(), "{what}");
    for (got, want) in got.iter().zip(&want) {
        assert!((got - want).abs() <= 1e-9 * scale, "{what}: {got}, Pinocchio finds {want} (scale {scale})");
    }
}

fn largest(list: &[f64]) -> f64 {
    list.iter().fold(0.0_f64, |most, x| most.max(x.abs()))
}

fn compare(machine: &Machine, motion: &Motion, found: &Value) {
    let (n, inertia, e) = (machine.drives(), Inertia::of(machine), DriveAngles(motion.q).units());
    let around = ExternalLoads { gravity: machine.gravity(), ..ExternalLoads::default() };
    let (h, _) = mass_matrix(&inertia, &e, &motion.qd);
    let (torque, wrench) = inverse_with_wrench(&inertia, &e, &motion.qd, &motion.qdd, &around);
    let still = PerDrive::from_fn(n, |_| 0.0);
    let (weight, _) = inverse_with_wrench(&inertia, &e, &still, &still, &around);
    let rows: Vec<f64> = (0..n * n).map(|i| h.get(i / n, i % n)).collect();
    let (name, total) = (machine.name(), wrench.total());
    let size = machine.resolved_links().iter().map(|part| part.length).sum::<f64>();
    near(&format!("{name}: H"), &rows, &found["mass_matrix"], largest(&rows));
    if !found["reduced"].is_null() {
        near(&format!("{name}: H with its own followers"), &rows, &found["reduced"], largest(&rows));
    }
    near(&format!("{name}: M"), &[machine.mass()], &found["mass"], machine.mass());
    let heavy = machine.mass() * machine.gravity().norm() * size;
    near(&format!("{name}: weight"), &weight[..n], &found["weight"], heavy.max(1e-3));
    near(&format!("{name}: τ"), &torque[..n], &found["torque"], largest(&torque[..n]).max(heavy));
    let force = [total.force.re, total.force.im];
    // Gears make the motion of a rotor fast; what it does to the base cancels.
    let scale = largest(&[force[0], force[1], total.moment]).max(machine.mass()).max(largest(&torque[..n]));
    near(&format!("{name}: f_B"), &force, &found["force"], scale);
    near(&format!("{name}: n_B"), &[total.moment], &found["moment"], scale);
    let tip = end_effector(machine.end_effector(), &e);
    near(&format!("{name}: end effector"), &[tip.re, tip.im], &found["end_effector"], size);
    let mut com = Vector::new(0.0, 0.0);
    for (j, link) in machine.links().iter().enumerate() {
        let at: Vector = machine.com_chain(j).iter().zip(&e).map(|(a, e)| a * *e).sum();
        let known = &found["links"][format!("link_{}", link.name)];
        let known = if known.is_null() { &found["links"][&link.name] } else { known };
        near(&format!("{name}: link {}", link.name), &[at.re, at.im], known, size);
        com += link.mass * at;
    }
    com += machine.spec().payload.mass * machine.payload_chain().iter().zip(&e).map(|(a, e)| a * *e).sum::<Vector>();
    com /= machine.mass();
    near(&format!("{name}: centre of mass"), &[com.re, com.im], &found["com"], size);
}

/// Those that come along, with discs, a payload and gravity too, and random trees and chains with motors anywhere.
fn every_machine_weighs_and_pulls_the_same() {
    let mut noise = Noise::of(1);
    let mut machines = Vec::new();
    for machine in builtins() {
        machines.push(machine.clone());
        let mut spec = machine.spec().clone();
        spec.gravity = [1.3, -9.7];
        spec.payload = toml::from_str("mass = 0.4\ninertia = 0.003\noffset = [0.03, -0.02]").expect("a payload");
        for link in &spec.links {
            let (mass, at, radius) = (noise.between(0.1, 3.0), noise.between(-0.3, 0.3), noise.between(0.0, 0.1));
            let link = link.name.clone();
            spec.counterweights.push(stillbase::mechanics::machine::Counterweight {
                link,
                mass,
                at,
                across: 0.5 * at,
                radius,
                ..Default::default()
            });
        }
        machines.push(Machine::new(spec).expect("a machine"));
    }
    machines.extend((0..40).map(|_| a_machine(&mut noise)));
    machines.extend((0..24).map(|i| a_chain(&mut noise, 1 + i % 8)));
    let mut motions = Vec::new();
    for machine in &machines {
        let mut one = |most: f64| PerDrive::from_fn(machine.drives(), |_| noise.between(-most, most));
        motions.push((0..10).map(|_| Motion { q: one(3.0), qd: one(3.0), qdd: one(20.0) }).collect::<Vec<_>>());
    }
    let line = |(machine, motions): (&Machine, &Vec<Motion>)| {
        let joints: Vec<(String, f64)> = (0..machine.drives()).map(|k| (joint(machine, k), 1.0)).collect();
        asked(machine, &urdf(machine, None, &Cut::default()), &joints, &vec![0.0; machine.drives()], motions)
    };
    let lines: Vec<String> = machines.iter().zip(&motions).map(line).collect();
    let found = answers(SCRIPT, &lines);
    assert_eq!(found.len(), machines.len());
    for ((machine, motions), found) in machines.iter().zip(&motions).zip(&found) {
        let found = found.as_array().expect("a list");
        assert_eq!(found.len(), motions.len());
        motions.iter().zip(found).for_each(|(motion, found)| compare(machine, motion, found));
    }
}

/// Arms in relative angles, as others write them, and what Pinocchio makes of the very same file.
fn arms_of_others_come_in_as_they_are() {
    let mut noise = Noise::of(2);
    for (text, joints, is_flat) in [
        (TWO, &[("shoulder", 1.0), ("elbow", 1.0)][..], true),
        (THREE, &[("j1", 1.0), ("j2", 1.0), ("j3", -1.0)], false),
    ] {
        let found = import(text).expect("an arm");
        let (n, pose) = (found.machine.drives(), found.pose);
        let machine = match is_flat {
            true => found.machine.set("gravity", "0.4,-9.6").expect("in range"),
            false => found.machine,
        };
        let names = machine.spec().drives.iter().map(|drive| drive.name.as_str());
        assert!(names.eq(joints.iter().map(|(joint, _)| *joint)), "{joints:?}");
        let joints: Vec<(String, f64)> = joints.iter().map(|(joint, sign)| ((*joint).to_owned(), *sign)).collect();
        let mut one = |most: f64| PerDrive::from_fn(n, |_| noise.between(-most, most));
        let motions: Vec<Motion> = (0..20).map(|_| Motion { q: one(3.0), qd: one(3.0), qdd: one(20.0) }).collect();
        let found = answers(SCRIPT, &[asked(&machine, text, &joints, &pose, &motions)]);
        for (motion, found) in motions.iter().zip(found[0].as_array().expect("a list")) {
            if is_flat {
                compare(&machine, motion, found);
            }
            let (h, _) = mass_matrix(&Inertia::of(&machine), &DriveAngles(motion.q).units(), &motion.qd);
            let rows: Vec<f64> = (0..n * n).map(|i| h.get(i / n, i % n)).collect();
            near(&format!("{}: H", machine.name()), &rows, &found["mass_matrix"], largest(&rows));
        }
    }
}
