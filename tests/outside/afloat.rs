//! Arms on bases that float move in MuJoCo as here, if only the torques of their motors are given.

use serde_json::json;
use stillbase::exchange::base_body::BaseBody;
use stillbase::exchange::cut::Cut;
use stillbase::exchange::mjcf::mjcf;
use stillbase::mechanics::planar::Vector;
use stillbase::session::replay;
use stillbase::session::scenario::Scenario;

use super::python::answers;
use crate::Test;

pub const TESTS: &[Test] = tests![torques_of_a_run_turn_the_base_alike];

const SCRIPT: &str = include_str!("afloat.py");

/// Ten seconds of each run, with no control but the torques as they were.
fn torques_of_a_run_turn_the_base_alike() {
    for (name, turns) in [("spot", 0.0), ("spot-swing", -34.921_f64.to_radians())] {
        let scenario = Scenario::builtin(name).expect("built in");
        let (machine, base) = (&scenario.machine, &scenario.base);
        let (mut torques, mut poses, mut start) = (Vec::new(), Vec::new(), Vec::new());
        replay(&scenario, |_, frame| {
            if start.is_empty() {
                start = frame.q[..machine.drives()].to_vec();
            }
            torques.push(frame.torque[..machine.drives()].to_vec());
            poses.push([frame.base.at.re, frame.base.at.im, frame.base.angle]);
        })
        .expect("it runs");
        assert!((torques.len() - 1) as f64 * scenario.step >= 10.0 - 1e-9, "{name}: {} steps", torques.len());
        let body = BaseBody { mass: base.mass, inertia: base.inertia, com: Vector::new(base.com[0], base.com[1]) };
        let model = mjcf(machine, Some(&body), &start, &Cut::default()).expect("a model");
        let asked = json!({ "model": model, "step": scenario.step, "torques": torques }).to_string();
        let found: Vec<[f64; 3]> = serde_json::from_value(answers(SCRIPT, &[asked]).remove(0)).expect("poses");
        let mut off = [0.0_f64; 3];
        for (got, want) in poses.iter().skip(2).step_by(2).zip(&found) {
            (0..3).for_each(|i| off[i] = off[i].max((got[i] - want[i]).abs()));
        }
        let last = found.last().expect("poses")[2];
        assert!(off[2] < 1e-6, "{name}: the base turns by {last} rad in MuJoCo, off by {off:?}");
        assert!(off[0].max(off[1]) < 1e-6, "{name}: the base shifts otherwise by {off:?} m");
        assert!((last - turns).abs() < 1e-5, "{name}: the base turns by {last} rad");
    }
}
