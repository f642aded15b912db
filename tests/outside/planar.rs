//! Planar MJCF as others write it comes in as what MuJoCo itself makes of it.

use nalgebra::DMatrix;
use serde_json::{Value, json};
use stillbase::exchange::import::import;
use stillbase::mechanics::dynamics::{ExternalLoads, inverse_with_wrench, mass_matrix};
use stillbase::mechanics::kinematics::end_effector;
use stillbase::mechanics::machine::{Inertia, Machine};
use stillbase::mechanics::planar::{DriveAngles, PerDrive, Vector};

use super::python::answers;
use crate::Test;

pub const TESTS: &[Test] = tests![models_of_others_come_in_as_mujoco_has_them];

const SCRIPT: &str = include_str!("planar.py");
/// Models of one run; `STILLBASE_OUTSIDE_MODELS` asks for another number.
const MODELS: u64 = 900;

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(|x| x.as_f64().expect("a number")).collect()
}

fn per_drive(value: &Value) -> PerDrive {
    PerDrive::from_slice(&numbers(value)).expect("eight at most")
}

#[track_caller]
fn near(what: &str, got: &[f64], want: &[f64], scale: f64) -> Result<(), String> {
    match got.len() == want.len() && got.iter().zip(want).all(|(a, b)| (a - b).abs() <= 1e-7 * scale) {
        true => Ok(()),
        false => Err(format!("{what}: {got:?}, MuJoCo finds {want:?} (scale {scale})")),
    }
}

fn com(machine: &Machine, e: &[Vector]) -> Vector {
    let of = |j: usize| -> Vector { machine.com_chain(j).iter().zip(e).map(|(a, e)| a * *e).sum() };
    (0..machine.links().len()).map(|j| machine.links()[j].mass * of(j)).sum::<Vector>() / machine.mass()
}

fn compare(found: &Value) -> Result<(), String> {
    let model = found["model"].as_str().expect("a model");
    let imported = import(model).map_err(|why| why.to_string())?;
    let machine = &imported.machine;
    let n = machine.drives();
    let rows: Vec<Vec<f64>> = found["to_drives"].as_array().expect("rows").iter().map(numbers).collect();
    // What turns each motor's hinge, and which of its limits there are.
    if rows.len() != n {
        return Err(format!("{n} drives, want {}", rows.len()));
    }
    let to_drives = DMatrix::from_fn(n, n, |i, j| rows[i][j]);
    let inertia = Inertia::of(machine);
    let around = ExternalLoads { gravity: machine.gravity(), ..ExternalLoads::default() };
    near("mass", &[machine.mass()], &[found["mass"].as_f64().expect("a number")], machine.mass())?;
    for (drive, want) in machine.spec().drives.iter().zip(found["torque_limits"].as_array().expect("a list")) {
        let (got, want) = (drive.torque_limit.unwrap_or(0.0), want.as_f64().unwrap_or(0.0));
        near(&format!("torque limit of {}", drive.name), &[got], &[want], want.max(1.0))?;
    }
    for state in found["states"].as_array().expect("states") {
        let moved = per_drive(&state["q"]);
        let q = PerDrive::from_fn(n, |k| imported.pose[k] + moved[k]);
        let (qd, qdd) = (per_drive(&state["qd"]), per_drive(&state["qdd"]));
        let e = DriveAngles(q).units();
        let (h, _) = mass_matrix(&inertia, &e, &qd);
        let h = to_drives.transpose() * DMatrix::from_fn(n, n, |i, j| h.get(i, j)) * &to_drives;
        let want = numbers(&state["mass_matrix"]);
        let scale = want.iter().fold(1e-3_f64, |most, x| most.max(x.abs()));
        near("H", h.transpose().as_slice(), &want, scale)?;
        let (torque, _) = inverse_with_wrench(&inertia, &e, &qd, &qdd, &around);
        let torque = to_drives.transpose() * DMatrix::from_fn(n, 1, |i, _| torque[i]);
        let want = numbers(&state["torque"]);
        let scale = want.iter().fold(scale, |most, x| most.max(x.abs()));
        near("τ", torque.as_slice(), &want, scale)?;
        let at = com(machine, &e);
        near("centre of mass", &[at.re, at.im], &numbers(&state["com"]), 1.0)?;
        let tip = end_effector(machine.end_effector(), &e);
        near("end effector", &[tip.re, tip.im], &numbers(&state["end_effector"]), 1.0)?;
        let limits = found["limits"].as_array().expect("limits");
        if machine.angles().len() != limits.len() {
            return Err(format!("{} angles, want {}", machine.angles().len(), limits.len()));
        }
        for ((angle, limit), value) in machine.angles().iter().zip(limits).zip(numbers(&state["limited"])) {
            let pair = [json!(angle.to), json!(angle.from)];
            if pair != [limit["to"].clone(), limit["from"].clone()] {
                return Err(format!("angle {}: of drives {pair:?}, want {limit}", angle.name));
            }
            near("limits", &[*angle.limits.start(), *angle.limits.end()], &numbers(&limit["range"]), 1.0)?;
            near("limited angle", &[q[angle.to] - q[angle.from] + angle.offset], &[value], 1.0)?;
        }
    }
    Ok(())
}

/// Random models in many styles: classes, units, orientations, shapes or inertias, couplings, loops, rotors.
fn models_of_others_come_in_as_mujoco_has_them() {
    let asked = std::env::var("STILLBASE_OUTSIDE_MODELS").ok().and_then(|count| count.parse().ok());
    let count: u64 = asked.unwrap_or(MODELS);
    let found = answers(SCRIPT, &(1..=count).map(|seed| seed.to_string()).collect::<Vec<_>>());
    let compiled: Vec<(usize, &Value)> = found.iter().enumerate().filter(|(_, one)| one["refused"].is_null()).collect();
    assert!(8 * compiled.len() > 7 * found.len(), "MuJoCo compiles most of them: {}", compiled.len());
    let wrong: Vec<String> = compiled
        .iter()
        .filter_map(|(i, one)| Some(format!("seed {}, {}: {}", i + 1, one["kind"], compare(one).err()?)))
        .collect();
    println!("{} models, {} compiled, {} of these wrong", found.len(), compiled.len(), wrong.len());
    if let Some(first) = compiled.iter().find(|(_, one)| compare(one).is_err()) {
        panic!("{}\n{}", wrong.join("\n"), first.1["model"].as_str().unwrap_or_default());
    }
}
