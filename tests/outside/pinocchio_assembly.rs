//! Assemblies as URDF: Pinocchio finds the same masses, end effectors, wrench at the base, torques and momentum.

use nalgebra::Vector3;
use serde_json::{Value, json};
use stillbase::exchange::cut::Cut;
use stillbase::exchange::urdf::{joint, urdf_of_assembly};
use stillbase::mechanics::assembly::{Assembly, BlockState, SpatialBase};
use stillbase::mechanics::machine::Machine;

use super::mujoco_assembly::{a_base, assemblies, loads, near, random_states, scale};
use super::python::answers;
use crate::{Noise, Test};

pub const TESTS: &[Test] = tests![every_assembly_weighs_and_pulls_the_same, blocks_turn_a_free_base_alike];

const SCRIPT: &str = include_str!("pinocchio_assembly.py");

/// Numbers of drives as those of motors: a motor on another drive turns by the difference.
fn of_motors(machine: &Machine, of: &[f64]) -> Vec<f64> {
    (0..machine.drives()).map(|k| of[k] - machine.motors().on(k).map_or(0.0, |on| of[on])).collect()
}

fn motion(assembly: &Assembly, states: &[BlockState]) -> Value {
    let each = |of: &dyn Fn(&BlockState) -> Vec<f64>| -> Vec<f64> {
        let blocks = assembly.blocks().iter().zip(states);
        blocks.flat_map(|(block, state)| of_motors(&block.machine, &of(state))).collect()
    };
    json!({
        "q": each(&|state| state.q.0.to_vec()),
        "qd": each(&|state| state.qd.to_vec()),
        "qdd": each(&|state| state.qdd.to_vec()),
    })
}

fn found(assembly: &Assembly, base: Option<&SpatialBase>, motions: &[Value]) -> Vec<Value> {
    let blocks = assembly.blocks();
    let motors = blocks.iter().flat_map(|block| {
        (0..block.machine.drives()).map(move |k| format!("{}/{}", block.name, joint(&block.machine, k)))
    });
    let gravity: [f64; 3] = if base.is_some() { [0.0; 3] } else { assembly.gravity.into() };
    let asked = json!({
        "model": urdf_of_assembly(assembly, base, &Cut::default()),
        "gravity": gravity,
        "motors": motors.collect::<Vec<_>>(),
        "blocks": blocks.iter().map(|block| &block.name).collect::<Vec<_>>(),
        "motions": motions,
    });
    let found: Vec<Value> = serde_json::from_value(answers(SCRIPT, &[asked.to_string()]).remove(0)).expect("a list");
    assert_eq!(found.len(), motions.len());
    found
}

fn every_assembly_weighs_and_pulls_the_same() {
    let mut noise = Noise::of(5);
    for assembly in assemblies(&mut noise) {
        let states: Vec<Vec<BlockState>> = (0..6).map(|_| random_states(&mut noise, &assembly)).collect();
        let motions: Vec<Value> = states.iter().map(|states| motion(&assembly, states)).collect();
        for (states, found) in states.iter().zip(&found(&assembly, None, &motions)) {
            let (name, (wrench, torques)) = (&assembly.name, loads(&assembly, states));
            let ([force, moment], scale) = (wrench, scale(&assembly, &wrench, &torques));
            near(&format!("{name}: mass"), &[assembly.mass()], &json!([found["mass"]]), assembly.mass());
            near(&format!("{name}: force"), &force, &found["force"], scale);
            near(&format!("{name}: moment"), &moment, &found["moment"], scale);
            let torques: Vec<f64> = torques.iter().flat_map(|torque| torque.to_vec()).collect();
            near(&format!("{name}: τ"), &torques, &found["torque"], scale);
            for (i, tip) in assembly.end_effectors(states).iter().take(assembly.blocks().len()).enumerate() {
                near(&format!("{name}: end effector"), tip.as_slice(), &found["tips"][i], 1.0);
            }
        }
    }
}

fn blocks_turn_a_free_base_alike() {
    let mut noise = Noise::of(6);
    for assembly in assemblies(&mut noise) {
        let base = a_base(&mut noise);
        let (mut motions, mut wanted) = (Vec::new(), Vec::new());
        for _ in 0..4 {
            let states = random_states(&mut noise, &assembly);
            let kept = Vector3::from_fn(|_, _| noise.between(-5.0, 5.0));
            let (moving, own) = (assembly.base_motion(&base, &states, &kept), assembly.momentum(&states));
            let velocity = -(moving.rate.cross(&moving.com) + own.linear / (base.mass + assembly.mass()));
            let mut one = motion(&assembly, &states);
            one["base"] = json!([velocity.as_slice(), moving.rate.as_slice()].concat());
            motions.push(one);
            wanted.push((kept, own.angular.norm() + own.linear.norm() + kept.norm()));
        }
        for (found, (angular, scale)) in found(&assembly, Some(&base), &motions).iter().zip(&wanted) {
            near(&format!("{}: p", assembly.name), &[0.0; 3], &found["linear"], *scale);
            near(&format!("{}: L", assembly.name), angular.as_slice(), &found["angular"], *scale);
        }
    }
}
