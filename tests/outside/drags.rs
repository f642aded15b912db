//! Drags of four drives and more against SciPy: the nearest pose, the one nearest to the middle of all ranges, and small
//! steps of least weighted norm.

use serde_json::{Value, json};
use stillbase::mechanics::machine::{Machine, to_toml};
use stillbase::mechanics::planar::{PerDrive, Vector, unit};
use stillbase::planning::pose_space::{GuidanceMode, PoseSpace};
use stillbase::planning::posture::PostureWeights;

use super::python::answers;
use crate::random::{a_pose, a_space};
use crate::{Noise, Test, count};

pub const TESTS: &[Test] = tests![scipy_finds_no_nearer_pose];

const SCRIPT: &str = concat!(include_str!("machine.py"), include_str!("drags.py"));
/// A small step, as a fraction of the reach.
const STEP: f64 = 1e-6;

/// A machine, some of whose angles turn freely or hardly at all.
fn a_machine(noise: &mut Noise, n: usize) -> (Machine, PoseSpace) {
    let (machine, _) = a_space(noise, n);
    let mut spec = machine.spec().clone();
    for angle in &mut spec.angles {
        let kind = noise.between(0.0, 1.0);
        if kind < 0.1 {
            (angle.min, angle.max) = (None, None);
        } else if kind < 0.2 {
            angle.max = angle.min.map(|min| min + 1e-5);
        }
    }
    let machine = Machine::new(spec).expect("in range");
    let space = PoseSpace::general(&machine).expect("it has a b");
    (machine, space)
}

fn a_drag(noise: &mut Noise, machine: &Machine, space: &PoseSpace) -> Value {
    let b = noise.between(0.0, space.period());
    let from = space.clamped(&a_pose(noise, space));
    let near = noise.between(0.0, 1.0);
    let there = match near {
        // Within reach, and far beyond it.
        near if near < 0.4 => space.end_effector(&space.lift(&a_pose(noise, space), b)),
        _ => noise.between(0.0, 1.3) * space.farthest() * unit(noise.between(-3.2, 3.2)),
    };
    let (a, _) = space.target_pose(there, b, &from);
    let at = space.end_effector(&space.lift(&from, b));
    let step = STEP * space.farthest() * unit(noise.between(-3.2, 3.2));
    let led = |lead: GuidanceMode| space.clone().with_guidance(lead);
    let list = |a: &PerDrive| a.to_vec();
    let two = |p: Vector| [p.re, p.im];
    let middle = led(GuidanceMode::Middle).follow(at, b, &from).expect("it is there");
    let inverse = PostureWeights::of(machine, space).least_torque().expect("regular");
    let torque = led(GuidanceMode::WeightedNorm(Box::new(inverse))).drag_to(at + step, b, &from).0;
    let energy = space.drag_to(at + step, b, &from).0;
    json!({
        "b": b, "p": two(there), "at": two(at), "step": two(step), "from": list(&from), "a": list(&a),
        "centred": list(&middle), "torque": list(&torque), "energy": list(&energy),
    })
}

/// Targets anywhere, at any b, from any pose: SciPy from many starts comes no nearer, comes no nearer to the middle
/// beside the pose that is found, and takes the same small steps.
fn scipy_finds_no_nearer_pose() {
    let mut noise = Noise::of(count("SEED", 83));
    let lines: Vec<String> = (0..count("DRAGS", 5) as usize)
        .map(|i| {
            let (machine, space) = a_machine(&mut noise, 4 + i % 5);
            let drags: Vec<Value> = (0..6).map(|_| a_drag(&mut noise, &machine, &space)).collect();
            json!({ "machine": to_toml(&machine), "drags": drags, "seed": i }).to_string()
        })
        .collect();
    let found = answers(SCRIPT, &lines);
    assert_eq!(found.len(), lines.len());
    let (mut wrong, mut reached, mut steps) = (Vec::new(), 0, 0);
    for (i, found) in found.iter().enumerate() {
        for (j, found) in found.as_array().expect("a list").iter().enumerate() {
            let number = |value: &Value| value.as_f64().expect("a number");
            let mut hold = |is_so: bool, what: &str| {
                if !is_so {
                    wrong.push(format!("{i}, {} drives, {j}: {what}: {found}", 4 + i % 5));
                }
            };
            let (off, least) = (number(&found["off"]), number(&found["least"]));
            reached += usize::from(off < 1e-8);
            hold(number(&found["past"]) < 1e-9, "past limits");
            // Another pose is taken if it is nearer by a ten-thousandth of the reach.
            hold(off < least + 1.1e-4 && (off < 1e-8 || least > 1e-8), "SciPy is nearer");
            hold(number(&found["centred"]) < 1e-9, "not at the point");
            hold(number(&found["uphill"]) < 1e-5, "not nearest to the middle");
            for off in found["steps"].as_array().expect("two").iter().filter_map(Value::as_f64) {
                steps += 1;
                hold(off < 1e-3, "another step");
            }
        }
    }
    println!("{reached} reached, {steps} steps compared, {} wrong", wrong.len());
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
