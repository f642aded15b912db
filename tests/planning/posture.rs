//! What four drives and more do with the freedoms that a point leaves: b and the point stay in all choices.

use stillbase::mechanics::kinematics::end_effector;
use stillbase::mechanics::machine::builtin;
use stillbase::mechanics::planar::{DriveAngles, Vector};
use stillbase::planning::pose_space::PoseSpace;
use stillbase::planning::posture::{Posture, PostureWeights};
use stillbase::session::replay;
use stillbase::session::scenario::Scenario;
use stillbase::session::{Refusal, Run};

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
    let postures = PostureWeights::of(machine, &space);
    let own = poses(Posture::MidRange);
    for other in [Posture::LeastRates, Posture::Orientation, Posture::LeastTorque] {
        let Ok(_) = run(other) else { continue };
        let others = poses(other);
        for (q, other_q) in own.iter().zip(&others) {
            let [own, others] = [q, other_q].map(|q| postures.off_middle(q));
            assert!(own <= others + 1e-9, "{other:?}: {own} of {others}");
        }
    }
}

/// Along curves that end where they begin, the drives do so, too, where they can.
#[test]
fn the_drives_close_with_their_path() {
    for posture in ALL {
        let mut scenario = Scenario::builtin("four-drive").expect("built in");
        scenario.task.posture = posture;
        scenario.task.via = vec![[0.55, 0.6]];
        scenario.task.closed = true;
        let run = Run::new(&scenario).unwrap_or_else(|why| panic!("{posture:?}: {why}"));
        let path = &run.plan().motion.path;
        let gap = path.at(1.0).q.0.minus(&path.at(0.0).q.0).max_abs();
        assert!(gap < 1e-6, "{posture:?}: {gap} rad");
    }
}
