//! Assemblies in space: MuJoCo finds the same wrench at the base, the same torques and the same momentum.

use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use serde_json::{Value, json};
use stillbase::exchange::cut::Cut;
use stillbase::exchange::mjcf::{mjcf_of_assembly, qpos_of_assembly};
use stillbase::files::assembly_scenario;
use stillbase::mechanics::assembly::{
    Assembly, Attitude, BaseState, BlockState, Compliance, Momentum, MovingBase, SpatialBase, builtin_assemblies,
};
use stillbase::mechanics::planar::{DriveAngles, PerDrive};
use stillbase::session::assembly::{AssemblyBase, AssemblyFrame, AssemblyScenario, FreeBase};
use stillbase::session::scenario::ScenarioError;

use super::python::answers;
use crate::random::an_assembly;
use crate::{Noise, Test};

pub const TESTS: &[Test] = tests![
    every_assembly_pulls_the_same_at_the_base,
    blocks_turn_a_free_base_alike,
    a_base_that_moves_takes_the_same,
    silent_runs_are_silent_in_mujoco,
    torques_move_the_blocks_alike,
];

const SCRIPT: &str = include_str!("mujoco_assembly.py");

fn poses(states: &[BlockState]) -> Vec<Vec<f64>> {
    states.iter().map(|state| state.q.0.to_vec()).collect()
}

/// The joints of the model in a pose; with a base that floats the first seven are its own.
fn qpos(assembly: &Assembly, base: Option<&SpatialBase>, poses: &[Vec<f64>]) -> Vec<f64> {
    let poses: Vec<&[f64]> = poses.iter().map(Vec::as_slice).collect();
    qpos_of_assembly(assembly, base, &poses).expect("a pose")
}

/// How each hinge turns with each drive: hinges follow the drives in proportion.
fn columns(assembly: &Assembly) -> Vec<Vec<f64>> {
    let still: Vec<Vec<f64>> = assembly.blocks().iter().map(|block| vec![0.0; block.machine.drives()]).collect();
    let mut all = Vec::new();
    for (i, block) in assembly.blocks().iter().enumerate() {
        for k in 0..block.machine.drives() {
            let mut turned = still.clone();
            turned[i][k] = 1.0;
            let pair = [&turned, &still].map(|poses| qpos(assembly, None, poses));
            all.push(pair[0].iter().zip(&pair[1]).map(|(a, b)| a - b).collect());
        }
    }
    all
}

/// How the base moves: joints, velocity in space and rate in its axes, then the rates of both.
type OfBase = ([f64; 7], [Vector3<f64>; 2], [Vector3<f64>; 2]);

struct Asked<'a> {
    assembly: &'a Assembly,
    base: Option<&'a SpatialBase>,
    columns: Vec<Vec<f64>>,
    motions: Vec<Value>,
}

impl<'a> Asked<'a> {
    fn of(assembly: &'a Assembly, base: Option<&'a SpatialBase>) -> Self {
        Self { assembly, base, columns: columns(assembly), motions: Vec::new() }
    }

    /// How hinges turn if drives do.
    fn hinges(&self, of: impl Fn(&BlockState) -> PerDrive, states: &[BlockState]) -> Vec<f64> {
        let all: Vec<f64> = states.iter().flat_map(|state| of(state).to_vec()).collect();
        let one = |i: usize| self.columns.iter().zip(&all).map(|(column, x)| column[i] * x).sum();
        (0..self.columns[0].len()).map(one).collect()
    }

    fn motion(&mut self, states: &[BlockState], of_base: Option<&OfBase>) {
        let states = &states[..self.assembly.blocks().len()];
        let mut at = qpos(self.assembly, self.base, &poses(states));
        let [mut rates, mut accelerations] =
            [self.hinges(|state| state.qd, states), self.hinges(|state| state.qdd, states)];
        if let Some((place, moves, pulls)) = of_base {
            at[..7].copy_from_slice(place);
            rates = moves.iter().flatten().copied().chain(rates).collect();
            accelerations = pulls.iter().flatten().copied().chain(accelerations).collect();
        }
        self.motions.push(json!({ "qpos": at, "qvel": rates, "qacc": accelerations }));
    }

    fn line(&self, start: &[BlockState]) -> Value {
        let poses = poses(&start[..self.assembly.blocks().len()]);
        let poses: Vec<&[f64]> = poses.iter().map(Vec::as_slice).collect();
        let blocks: Vec<&str> = self.assembly.blocks().iter().map(|block| block.name.as_str()).collect();
        let model = mjcf_of_assembly(self.assembly, self.base, &poses, &Cut::default()).expect("a model");
        json!({ "model": model, "columns": self.columns, "motions": self.motions, "blocks": blocks })
    }

    /// What MuJoCo finds of all motions.
    fn found(&self, start: &[BlockState]) -> Vec<Value> {
        let found = answers(SCRIPT, &[self.line(start).to_string()]).remove(0);
        let found: Vec<Value> = serde_json::from_value(found).expect("a list");
        assert_eq!(found.len(), self.motions.len());
        found
    }
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(|x| x.as_f64().expect("a number")).collect()
}

#[track_caller]
pub fn near(what: &str, got: &[f64], want: &Value, scale: f64) {
    let want = numbers(want);
    assert_eq!(got.len(), want.len(), "{what}");
    let off = got.iter().zip(&want).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
    assert!(off <= 1e-9 * scale, "{what}: {got:?}, found {want:?} (scale {scale})");
}

/// Our force and moment at the base, and the torque of each motor.
pub fn loads(assembly: &Assembly, states: &[BlockState]) -> ([[f64; 3]; 2], Vec<PerDrive>) {
    let mut torques = vec![PerDrive::zeros(0); assembly.blocks().len()];
    let wrench = assembly.loads(states, |i, of| torques[i] = of.torque).total();
    ([wrench.force.into(), wrench.moment.into()], torques)
}

/// What wrenches and torques are compared with: the largest number of the wrench, Σ|τ| or the mass.
pub fn scale(assembly: &Assembly, wrench: &[[f64; 3]; 2], torques: &[PerDrive]) -> f64 {
    let total: f64 = torques.iter().flat_map(|torque| torque.iter()).map(|x| x.abs()).sum();
    wrench.as_flattened().iter().fold(total.max(assembly.mass()), |most, x| most.max(x.abs()))
}

/// Torques that turn each drive against the base: a motor turns what carries it back.
fn against_base(assembly: &Assembly, torques: &[PerDrive]) -> Vec<f64> {
    let mut all = Vec::new();
    for (block, torque) in assembly.blocks().iter().zip(torques) {
        let drives = block.machine.drives();
        let back =
            |k: usize| (0..drives).filter(|l| block.machine.motors().on(*l) == Some(k)).map(|l| torque[l]).sum::<f64>();
        all.extend((0..drives).map(|k| torque[k] - back(k)));
    }
    all
}

fn compare(name: &str, assembly: &Assembly, states: &[BlockState], found: &Value) {
    let (wrench, torques) = loads(assembly, states);
    let ([force, moment], scale) = (wrench, scale(assembly, &wrench, &torques));
    near(&format!("{name}: joined"), &[0.0, 0.0], &json!([found["open"], found["moves"]]), 1.0);
    near(&format!("{name}: force"), &force, &found["force"], scale);
    near(&format!("{name}: moment"), &moment, &found["moment"], scale);
    near(&format!("{name}: τ"), &against_base(assembly, &torques), &found["torque"], scale);
    for (i, tip) in assembly.end_effectors(states).iter().take(assembly.blocks().len()).enumerate() {
        near(&format!("{name}: end effector"), tip.as_slice(), &found["tips"][i], 1.0);
    }
}

pub fn random_states(noise: &mut Noise, assembly: &Assembly) -> Vec<BlockState> {
    let one = |n: usize, noise: &mut Noise| {
        let mut any = |most: f64| PerDrive::from_fn(n, |_| noise.between(-most, most));
        BlockState { q: DriveAngles(any(3.0)), qd: any(3.0), qdd: any(20.0) }
    };
    assembly.blocks().iter().map(|block| one(block.machine.drives(), noise)).collect()
}

/// Those that come along, under gravity too, and random ones with heights, payloads and rotors, some of them carried.
pub fn assemblies(noise: &mut Noise) -> Vec<Assembly> {
    let mut all: Vec<Assembly> = builtin_assemblies().to_vec();
    all.extend(builtin_assemblies().iter().map(|own| {
        let mut heavy = own.clone();
        heavy.set_gravity([1.3, -4.0, -9.0]).expect("in range");
        heavy
    }));
    all.extend((0..24).map(|_| an_assembly(noise)));
    assert!(all.iter().filter(|own| own.blocks().iter().any(|block| block.mount.on.is_some())).count() > 10);
    all
}

fn every_assembly_pulls_the_same_at_the_base() {
    let mut noise = Noise::of(3);
    for assembly in assemblies(&mut noise) {
        let states: Vec<Vec<BlockState>> = (0..8).map(|_| random_states(&mut noise, &assembly)).collect();
        let mut asked = Asked::of(&assembly, None);
        states.iter().for_each(|states| asked.motion(states, None));
        let found = asked.found(&states[0]);
        states.iter().zip(&found).for_each(|(states, found)| compare(&assembly.name, &assembly, states, found));
    }
}

/// A base in space, some at an angle to its axes.
pub fn a_base(noise: &mut Noise) -> SpatialBase {
    let turn = UnitQuaternion::from_scaled_axis(Vector3::from_fn(|_, _| noise.between(-1.0, 1.0)));
    let axes = turn.to_rotation_matrix().into_inner();
    let own = Matrix3::from_diagonal(&Vector3::from_fn(|_, _| noise.between(2.0, 3.0)));
    let com = Vector3::from_fn(|_, _| noise.between(-0.3, 0.3));
    SpatialBase { mass: noise.between(5.0, 50.0), com, inertia: axes * own * axes.transpose() }
}

/// The rate that we find leaves the momentum in space that it was found for.
fn blocks_turn_a_free_base_alike() {
    let mut noise = Noise::of(4);
    for assembly in assemblies(&mut noise) {
        let base = a_base(&mut noise);
        let states: Vec<Vec<BlockState>> = (0..4).map(|_| random_states(&mut noise, &assembly)).collect();
        let (mut asked, mut wanted) = (Asked::of(&assembly, Some(&base)), Vec::new());
        for states in &states {
            let mut any = |most: f64| Vector3::from_fn(|_, _| noise.between(-most, most));
            let (turn, place, kept) = (UnitQuaternion::from_scaled_axis(any(2.0)), any(1.0), any(5.0));
            let (motion, own) = (assembly.base_motion(&base, states, &kept), assembly.momentum(states));
            let seen = own.linear / (base.mass + assembly.mass());
            let velocity = turn * -(motion.rate.cross(&motion.com) + seen);
            let joints = [place.x, place.y, place.z, turn.w, turn.i, turn.j, turn.k];
            asked.motion(states, Some(&(joints, [velocity, motion.rate], [Vector3::zeros(); 2])));
            wanted.push((turn * kept, own.angular.norm() + own.linear.norm() + kept.norm()));
        }
        for (found, (angular, scale)) in asked.found(&states[0]).iter().zip(&wanted) {
            near(&format!("{}: p", assembly.name), &[0.0; 3], &found["linear"], *scale);
            near(&format!("{}: L", assembly.name), angular.as_slice(), &found["angular"], *scale);
        }
    }
}

/// Force and moment that a base itself needs to move so, about its origin and in its axes.
fn needed(base: &SpatialBase, moving: &MovingBase) -> [Vector3<f64>; 2] {
    let MovingBase { rate, acceleration, angular_acceleration, .. } = moving;
    let pull = acceleration + angular_acceleration.cross(&base.com) + rate.cross(&rate.cross(&base.com));
    let force = base.mass * pull;
    let turning = base.inertia * angular_acceleration + rate.cross(&(base.inertia * rate));
    [force, turning + base.com.cross(&force)]
}

/// On a base that moves in any way, floats or sits on springs: torques of the motors, and what moves base and blocks.
fn a_base_that_moves_takes_the_same() {
    let mut noise = Noise::of(5);
    let mut sensed = 0;
    for assembly in assemblies(&mut noise) {
        let base = a_base(&mut noise);
        let (mut asked, mut wanted) = (Asked::of(&assembly, Some(&base)), Vec::new());
        let first = random_states(&mut noise, &assembly);
        for kind in 0..6 {
            let states = random_states(&mut noise, &assembly);
            let mut any = |most: f64| Vector3::from_fn(|_, _| noise.between(-most, most));
            let (turn, place) = (UnitQuaternion::from_scaled_axis(any(1.5)), any(0.5));
            let seen = turn.inverse();
            let mut gravity = seen * assembly.gravity;
            let held = Compliance::diagonal([4e3, 5e3, 6e3, 500.0, 600.0, 700.0], [40.0; 6]).expect("springs");
            let at = BaseState { place, attitude: Attitude(turn), velocity: any(1.0), rate: any(1.0) };
            // The model falls with what it stands on, so that the last one has to be held against its weight.
            let (moving, outside) = match kind {
                0 | 1 => {
                    let kept = Momentum { linear: any(20.0), angular: any(5.0) };
                    let mut moving = assembly.floating_motion(&base, &states, &kept);
                    moving.acceleration += gravity;
                    (moving, Some([Vector3::zeros(); 2]))
                }
                2 | 3 => {
                    let mount = held.wrench(&at);
                    let moving = assembly.compliant_motion(&base, &held, &at, &states);
                    (moving, Some([mount.force, seen * mount.moment]))
                }
                _ => {
                    let (acceleration, angular_acceleration) = (any(9.0), any(9.0));
                    (MovingBase { acceleration, angular_acceleration, ..at.moving() }, None)
                }
            };
            let joints = [place.x, place.y, place.z, turn.w, turn.i, turn.j, turn.k];
            let pulls = [turn * moving.acceleration, moving.angular_acceleration];
            asked.motion(&states, Some(&(joints, [turn * moving.velocity, moving.rate], pulls)));
            let mut torques = vec![PerDrive::zeros(0); states.len()];
            let loads = assembly.loads_on(&moving, &gravity, &states, |i, of| torques[i] = of.torque).total();
            let [force, moment] = needed(&base, &moving);
            gravity *= base.mass;
            let own = [turn * (force - gravity - loads.force), moment - base.com.cross(&gravity) - loads.moment];
            let scale = loads.force.norm() + loads.moment.norm() + force.norm() + moment.norm() + assembly.mass();
            if let Some(outside) = outside {
                (0..2).for_each(|i| assert!((own[i] - outside[i]).norm() < 1e-9 * scale, "{own:?} {outside:?}"));
            }
            wanted.push((own, loads, against_base(&assembly, &torques), scale));
        }
        // The transverse inertia of rotors, which no body can be without, is taken off the base and felt at the sensor.
        let rotors =
            assembly.blocks().iter().any(|block| block.machine.spec().drives.iter().any(|own| own.rotor.is_some()));
        for (found, ([force, moment], loads, torques, scale)) in asked.found(&first).iter().zip(&wanted) {
            let six: Vec<f64> = force.iter().chain(moment).copied().collect();
            near(&format!("{}: base", assembly.name), &six, &found["on_base"], *scale);
            near(&format!("{}: τ", assembly.name), torques, &found["torque"], *scale);
            if !rotors {
                near("force", loads.force.as_slice(), &found["force"], *scale);
                near("moment", loads.moment.as_slice(), &found["moment"], *scale);
                sensed += 1;
            }
        }
    }
    assert!(sensed > 10, "{sensed}");
}

fn run(name: &str) -> (AssemblyScenario, Vec<AssemblyFrame>) {
    let scenario = assembly_scenario::<ScenarioError>(name, &toml::Table::new(), Ok).expect("valid").expect("built in");
    let mut frames = Vec::new();
    let see = |frame: &AssemblyFrame| {
        frames.push(frame.clone());
        true
    };
    scenario.run(see).expect("a run");
    (scenario, frames)
}

/// What reaches the base in the scenarios that come along, at sensors that are not ours.
fn silent_runs_are_silent_in_mujoco() {
    for (name, is_silent) in [("wrist-across", true), ("off-its-pin", false)] {
        let (run, frames) = run(name);
        let assembly = &run.assembly;
        let frames: Vec<&AssemblyFrame> = frames.iter().step_by(10).collect();
        let mut asked = Asked::of(assembly, None);
        frames.iter().for_each(|frame| asked.motion(&frame.states, None));
        let found = asked.found(&frames[0].states);
        let (mut peak, mut scale) = (0.0_f64, 0.0_f64);
        for (frame, found) in frames.iter().zip(&found) {
            compare(name, assembly, &frame.states, found);
            let six = [&found["force"], &found["moment"]].map(numbers).concat();
            peak = six.iter().fold(peak, |most, x| most.max(x.abs()));
            scale = scale.max(frame.torques.iter().flat_map(|torque| torque.iter()).map(|x| x.abs()).sum());
        }
        assert_eq!(peak < 1e-10 * scale, is_silent, "{name}: {peak} of {scale}");
    }
    let (run, frames) = run("arm-against-arm");
    let AssemblyBase::Free(FreeBase { body: base, .. }) = &run.base else { panic!("it floats") };
    let mut asked = Asked::of(&run.assembly, Some(base));
    let frames: Vec<&AssemblyFrame> = frames.iter().step_by(10).collect();
    for AssemblyFrame { states, attitude, origin, rate, .. } in &frames {
        let [w, x, y, z] = attitude.components();
        // A base that does not turn moves with its arms.
        let seen = run.assembly.momentum(states).linear / (base.mass + run.assembly.mass());
        let joints = [origin.x, origin.y, origin.z, w, x, y, z];
        asked.motion(states, Some(&(joints, [-(attitude.0 * seen), *rate], [Vector3::zeros(); 2])));
    }
    for found in asked.found(&frames[0].states) {
        near("arm-against-arm: p", &[0.0; 3], &found["linear"], 1.0);
        near("arm-against-arm: L", &[0.0; 3], &found["angular"], 1.0);
    }
}

/// The torques of a run alone lead all end effectors where they go here.
fn torques_move_the_blocks_alike() {
    let (run, frames) = run("wrist-across");
    let (assembly, step) = (&run.assembly, run.step);
    let asked = Asked::of(assembly, None);
    let mut line = asked.line(&frames[0].states);
    let blocks = assembly.blocks().len();
    let torques: Vec<Vec<f64>> = (frames.iter())
        .map(|frame| frame.torques[..blocks].iter().flat_map(|torque| torque.to_vec()).collect())
        .collect();
    line["qvel"] = json!(asked.hinges(|state| state.qd, &frames[0].states[..blocks]));
    line["torques"] = json!(torques);
    line["step"] = json!(step);
    let found = answers(SCRIPT, &[line.to_string()]).remove(0);
    let ways = found["tips"].as_array().expect("a list");
    assert!(ways.len() > 900, "{}", ways.len());
    let mut off = 0.0_f64;
    for (frame, tips) in frames.iter().skip(2).step_by(2).zip(ways) {
        for (tip, found) in frame.tips.iter().take(blocks).zip(tips.as_array().expect("a list")) {
            off = off.max((tip - Vector3::from_vec(numbers(found))).norm());
        }
    }
    let (reaction, torque) = (
        found["reaction"].as_f64().expect("a number"),
        torques.iter().map(|all| all.iter().map(|x| x.abs()).sum()).fold(0.0, f64::max),
    );
    assert!(
        off < 1e-6 && reaction < 1e-4 * torque,
        "off by {off} m; {reaction} N or N m reach the base, of {torque} N m"
    );
}
