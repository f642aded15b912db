//! What four drives and more do with the freedoms that a point leaves: b and the point stay in all choices.

use proptest::prelude::*;
use stillbase::mechanics::kinematics::end_effector;
use stillbase::mechanics::machine::{Inertia, Machine, builtin};
use stillbase::mechanics::planar::{DriveAngles, PerDrive, Vector};
use stillbase::planning::pose_space::PoseSpace;
use stillbase::planning::posture::{Posture, Postures};
use stillbase::session::replay;
use stillbase::session::scenario::Scenario;
use stillbase::session::{Refusal, Run};

use crate::support::family_machine;

const ALL: [Posture; 4] = [Posture::LeastRates, Posture::Orientation, Posture::LeastTorque, Posture::MidRange];

fn run(posture: Posture) -> Result<Run, Refusal> {
    let mut scenario = Scenario::builtin("four-drive").expect("built in");
    scenario.task.posture = posture;
    Run::new(&scenario)
}

/// Poses along the plan of a choice, at even shares of its path.
fn poses(posture: Posture) -> Vec<DriveAngles> {
    let run = run(posture).unwrap_or_else(|why| panic!("{posture:?}: {why}"));
    (0..=200).map(|i| run.plan().motion.path.at(f64::from(i) / 200.0).q).collect()
}

#[test]
fn every_choice_keeps_the_line_and_b() {
    let scenario = Scenario::builtin("four-drive").expect("built in");
    let space = PoseSpace::of(&scenario.machine).expect("balanced");
    let [from, to] = [scenario.task.from, scenario.task.to].map(|[x, y]| Vector::new(x, y));
    for posture in ALL {
        for (i, q) in poses(posture).iter().enumerate() {
            assert!((space.b(q) - scenario.task.b).abs() < 1e-9, "{posture:?}: {}", space.b(q));
            let p = end_effector(scenario.machine.end_effector(), &q.units());
            let on = from + i as f64 / 200.0 * (to - from);
            assert!((p - on).norm() < 1e-9, "{posture:?}: {p} beside {on}");
        }
        let mut scenario = scenario.clone();
        scenario.task.posture = posture;
        let again = Scenario::parse(&scenario.to_toml(), "posture.toml", None).expect("it is written and read");
        assert_eq!(again.task.posture, posture);
        let run = replay(&again, |_, _| {}).unwrap_or_else(|why| panic!("{posture:?}: {why}"));
        assert!(run.frame().peaks.is_reactionless(), "{posture:?}");
    }
}

#[test]
fn the_last_link_keeps_its_orientation() {
    let of = |posture| -> f64 {
        let poses = poses(posture);
        poses.iter().map(|q| (q[3] - poses[0][3]).abs()).fold(0.0, f64::max)
    };
    assert!(of(Posture::Orientation) < 1e-9, "{}", of(Posture::Orientation));
    assert!(of(Posture::LeastRates) > 1e-2, "another choice turns it: {}", of(Posture::LeastRates));
}

#[test]
fn joints_stay_near_the_middle_of_their_ranges() {
    let machine = builtin("four-drive").expect("built in");
    let space = PoseSpace::of(machine).expect("balanced");
    let postures = Postures::of(machine, &space, Posture::MidRange);
    let room = |q: &DriveAngles| -> f64 {
        let shares = space.joints().iter().map(|joint| {
            let ([low, high], a) = (joint.limits(), joint.of(q));
            (a - low).min(high - a) / (high - low)
        });
        shares.fold(f64::INFINITY, f64::min)
    };
    let own = poses(Posture::MidRange);
    let least = |poses: &[DriveAngles]| poses.iter().map(room).fold(f64::INFINITY, f64::min);
    for other in [Posture::LeastRates, Posture::Orientation, Posture::LeastTorque] {
        let Ok(_) = run(other) else { continue };
        let others = poses(other);
        for (q, other_q) in own.iter().zip(&others) {
            let [own, others] = [q, other_q].map(|q| postures.off_middle(q));
            assert!(own <= others + 1e-9, "{other:?}: {own} of {others}");
        }
        assert!(least(&own) > least(&others), "{other:?}: {} of {}", least(&own), least(&others));
    }
}

fn torques(machine: &Machine, q: &PerDrive) -> f64 {
    let inertia = Inertia::of(machine);
    let n = machine.drives();
    let turned = PerDrive::from_fn(n, |k| (0..n).map(|l| inertia.constant(k, l) * q[l]).sum());
    inertia.motors().torques(&turned).iter().map(|torque| torque * torque).sum::<f64>().sqrt()
}

proptest! {
    /// At every pose, in every direction: what it takes to set a motion up.
    #[test]
    fn least_torque_is_least(a in prop::array::uniform3(0.1..0.9), b in -3.0..3.0, turn in 0.0..6.3) {
        for machine in [builtin("four-drive").expect("built in"), &family_machine("four-drive-balanced")] {
            let space = PoseSpace::of(machine).expect("balanced");
            let angle = |i: usize| {
                let [low, high] = space.joints()[i].limits();
                low + a[i] * (high - low)
            };
            let q = space.lift(&[angle(0), angle(1), angle(2)], b);
            let v = Vector::new(f64::cos(turn), f64::sin(turn));
            let of = |posture| Postures::of(machine, &space, posture).rates(&q, v).map(|rates| torques(machine, &rates));
            let Some(least) = of(Posture::LeastTorque) else { continue };
            for other in [Posture::LeastRates, Posture::Orientation, Posture::MidRange] {
                let Some(torque) = of(other) else { continue };
                prop_assert!(least <= torque * (1.0 + 1e-7), "{other:?}: {least} of {torque}");
            }
        }
    }
}
