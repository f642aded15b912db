//! What friction in the pins does to the forces that they carry, against nine rigid bodies with the couples.

use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;
use proptest::test_runner::TestRunner;
use stillbase::mechanics::dynamics::ExternalLoads;
use stillbase::mechanics::joint_forces::Joints;
use stillbase::mechanics::kinematics::least_transmission;
use stillbase::mechanics::planar::{DriveAngles, PerDrive};
use stillbase::session::replay;
use stillbase::session::scenario::Scenario;
use stillbase::simulation::frame::Frame;
use stillbase::simulation::plant::{DriveValues, Friction};

use crate::mechanics::nine_body::{Answer, DRIVE, NineBody};
use crate::support::{any_body, body_of, close, machine_of, three};

/// Pairs of drives.
const PAIRS: [(usize, usize); 3] = [(0, 1), (0, 2), (1, 2)];

/// Which pair the two links of each of the twelve pins follow, and whether the second follows the pair's second.
fn pairs(body: &NineBody) -> [Option<(usize, f64)>; 12] {
    body.pins().map(|pin| {
        let (from, to) = (DRIVE[pin.from?], DRIVE[pin.to]);
        let pair = PAIRS.iter().position(|p| *p == (from.min(to), from.max(to)))?;
        Some((pair, if from < to { 1.0 } else { -1.0 }))
    })
}

/// Couples of the twelve pins for a torque of each pair, against q̇_l − q̇_k, in each of its pins.
fn couples(body: &NineBody, each: [f64; 3]) -> [f64; 12] {
    pairs(body).map(|pair| pair.map_or(0.0, |(p, sign)| sign * each[p]))
}

fn all(answer: &Answer) -> Vec<f64> {
    answer.pins.concat()
}

type Motion = ([f64; 3], [f64; 3], [f64; 3]);

fn any_motion() -> impl Strategy<Value = Motion> {
    let three = |x: f64| prop::array::uniform3(-x..x);
    (three(6.0), three(4.0), three(12.0))
        .prop_filter("near a change point", |(q, ..)| least_transmission(&DriveAngles::from(*q).units(), 3) > 0.02)
}

/// Any couples in the pins and in the bearings of any machine in any motion: forces, torques and moment of 27
/// equations.
fn couples_are_in_the_balance(cases: u32) {
    let given = (any_body(), any_motion(), prop::array::uniform3(-3.0..3.0), prop::array::uniform3(-3.0..3.0));
    let check = |(body, (q, qd, qdd), each, bearing): (NineBody, Motion, [f64; 3], [f64; 3])| {
        let machine = machine_of(&body);
        let joints = Joints::of(&machine).expect("determinate");
        let around = ExternalLoads { gravity: machine.gravity(), ..ExternalLoads::default() };
        let couple = |from: usize, to: usize| {
            let pair = PAIRS.iter().position(|p| *p == (from.min(to), from.max(to))).expect("two drives");
            if from < to { each[pair] } else { -each[pair] }
        };
        let forces = joints.forces_with(&DriveAngles::from(q).units(), &qd.into(), &qdd.into(), &around, couple);
        let mut taken = couples(&body, each);
        // Friction in the bearings: the motors feel it, no pin does.
        taken[..3].copy_from_slice(&bearing);
        let twin = body.solve_rubbing(q, qd, qdd, taken);
        let pins: Vec<f64> = forces.bounded().iter().flat_map(|f| [f.re, f.im]).collect();
        close("pins", &pins, &all(&twin), 1e-9);
        let torque = forces.torque().expect("defined");
        close("torque", &PerDrive::from_fn(3, |k| torque[k] + bearing[k]), &twin.torque, 1e-9);
        let scale = torque.max_abs().max(1.0);
        close("n_B", &[-torque.iter().sum::<f64>()], &[twin.base_moment], 1e-9 * scale);
        Ok(())
    };
    let config = ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(cases) };
    TestRunner::new(config).run(&given, check).unwrap_or_else(|e| panic!("{e}"));
}

#[test]
fn couples_of_a_thousand_machines() {
    couples_are_in_the_balance(1000);
}

#[test]
#[ignore = "long: a hundred thousand machines, minutes in a debug build"]
fn couples_of_a_hundred_thousand_machines() {
    couples_are_in_the_balance(100_000);
}

/// A machine on its way, with friction of every kind.
#[derive(Clone, Debug)]
struct Way {
    case: &'static str,
    gravity: [f64; 2],
    friction: Friction,
}

fn any_way() -> impl Strategy<Value = Way> {
    // A third each: none, little, so much that contacts stick.
    let amount = |most: f64| prop_oneof![Just(0.0), 0.0..0.1 * most, 0.0..most];
    let friction = (amount(0.4), amount(0.4), amount(0.1), amount(0.2)).prop_map(
        |(viscous, coulomb, pin_viscous, pin_coulomb)| Friction {
            viscous: DriveValues::All(viscous),
            coulomb: DriveValues::All(coulomb),
            pin_viscous,
            pin_coulomb,
        },
    );
    let gravity = prop_oneof![Just([0.0; 2]), prop::array::uniform2(-9.0..9.0)];
    let case = prop_oneof![Just("case-1"), Just("case-2"), Just("case-3")];
    (case, gravity, friction).prop_map(|(case, gravity, friction)| Way { case, gravity, friction })
}

/// One frame of a run: the couples of pins that slide are those of the law; what Coulomb friction takes in pairs that
/// stick, or have only just begun to slide, is unknown: one number each, within its bound, that has to explain the
/// torques and all twelve pins.
fn check_frame(body: &NineBody, friction: &Friction, frame: &Frame) {
    let (q, qd, qdd) = (three(&frame.q.0), three(&frame.qd), three(&frame.qdd));
    let slide = PAIRS.map(|(k, l)| qd[l] - qd[k]);
    let stuck: Vec<usize> = (0..3).filter(|p| friction.pin_coulomb > 0.0 && slide[*p].abs() < 1e-6).collect();
    let law = |p: usize| {
        let dry = if stuck.contains(&p) || slide[p] == 0.0 { 0.0 } else { slide[p].signum() };
        friction.pin_viscous * slide[p] + friction.pin_coulomb * dry
    };
    let rows = |answer: &Answer| [all(answer), answer.torque.to_vec()].concat();
    let of = |each: [f64; 3]| DVector::from_vec(rows(&body.solve_rubbing(q, qd, qdd, couples(body, each))));
    let known = of([0, 1, 2].map(law));
    let pins: Vec<f64> = (0..12)
        .flat_map(|i| {
            let f = frame.inside.pin(i).expect("off the change points");
            [f.re, f.im]
        })
        .collect();
    let net = (0..3).map(|k| frame.torque[k] - frame.friction[k]);
    let want = DVector::from_iterator(27, pins.into_iter().chain(net));
    let scale = want.amax().max(1.0);
    let mut left = &want - &known;
    if !stuck.is_empty() {
        let still = of([0.0; 3]);
        let columns = DMatrix::from_fn(27, stuck.len(), |_, _| 0.0);
        let columns = stuck.iter().enumerate().fold(columns, |mut m, (c, p)| {
            let mut one = [0.0; 3];
            one[*p] = 1.0;
            m.set_column(c, &(of(one) - &still));
            m
        });
        let held = columns.clone().svd(true, true).solve(&left, 1e-12).expect("a solution");
        for held in held.iter() {
            assert!(held.abs() <= friction.pin_coulomb * (1.0 + 1e-6) + 1e-9, "{held} of {}", friction.pin_coulomb);
        }
        left -= columns * held;
    }
    assert!(
        left.amax() < 1e-7 * scale,
        "{} of {scale} at {} s, stuck {stuck:?}, sliding {slide:?}: {left}",
        left.amax(),
        frame.time
    );
}

fn pins_of_runs(cases: u32) {
    let check = |way: Way| {
        let mut scenario = Scenario::builtin(way.case).expect("built in");
        let [x, y] = way.gravity;
        scenario.machine = scenario.machine.set("gravity", &format!("{x},{y}")).expect("valid");
        scenario.plant.friction = way.friction;
        scenario.duration = Some(0.4);
        let body = body_of(&scenario.machine);
        replay(&scenario, |_, frame| {
            if frame.step % 57 == 5 && frame.transmission > 0.02 {
                check_frame(&body, &way.friction, frame);
            }
        })
        .expect("runs");
        Ok(())
    };
    let config = ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(cases) };
    TestRunner::new(config).run(&any_way(), check).unwrap_or_else(|e| panic!("{e}"));
}

/// Sliding, sticking, and both at once, in gravity and without.
#[test]
fn pins_of_forty_runs() {
    pins_of_runs(40);
}

#[test]
#[ignore = "long: five thousand runs, minutes in a debug build"]
fn pins_of_five_thousand_runs() {
    pins_of_runs(5000);
}

/// The figure that was wrong: by how many newtons forces without the couples are off.
#[test]
fn friction_changes_what_pins_carry_by_newtons() {
    let mut scenario = Scenario::builtin("case-3").expect("built in");
    scenario.plant.friction.pin_viscous = 0.05;
    let joints = Joints::of(&scenario.machine).expect("determinate");
    let (mut most, mut off) = (0.0_f64, 0.0_f64);
    replay(&scenario, |_, f| {
        let free = joints.forces(&f.q.units(), &f.qd, &f.qdd, &ExternalLoads::default());
        for (i, free) in free.bounded().iter().enumerate() {
            let rubbing = f.inside.pin(i).expect("off the change points");
            (most, off) = (most.max(rubbing.norm()), off.max((rubbing - free).norm()));
        }
    })
    .expect("runs");
    assert!(most > 4.5 && off > 1.5, "{off} N of {most} N");
}
