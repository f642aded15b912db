//! An arm without b that a hand leads at zero angular momentum.

use std::sync::Arc;

use proptest::prelude::*;
use stillbase::mechanics::planar::{DriveAngles, PerDrive, Pose2, Vector};
use stillbase::planning::Reference;
use stillbase::planning::following::{Barrier, MomentumFollower};
use stillbase::planning::off_plane::momentum::{MomentumModel, TipFrame};
use stillbase::planning::off_plane::null_space;
use stillbase::planning::pose_space::Reach;
use stillbase::session::scenario::Scenario;
use stillbase::session::{Edit, Run};
use stillbase::simulation::frame::Phase;

const STEP: f64 = 1e-3;

/// The arm of the scenario `spot` beside its base, and its pose of A.
fn arm(scenario: &Scenario) -> (Arc<MomentumModel>, DriveAngles) {
    let q = Run::new(scenario).expect("plans").plan().motion.at(0.0).q;
    let inertia = stillbase::mechanics::machine::Inertia::of(&scenario.machine);
    (Arc::new(MomentumModel::floating(&inertia, &scenario.base.body(), TipFrame::Space, &q)), q)
}

fn spot() -> Scenario {
    Scenario::builtin("spot").expect("built in")
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// Rates are the derivatives of angles and accelerations those of rates, and the momentum ends; wherever it is led.
    #[test]
    fn a_led_arm_moves_smoothly_and_without_momentum(
        targets in prop::collection::vec([-0.9..0.9f64, -0.9..0.9f64], 1..4), rates in [-0.4..0.4f64, -0.4..0.4f64, -0.4..0.4f64],
        pose in [-2.0..2.0f64, -2.0..2.0f64],
    ) {
        let scenario = spot();
        let (_, q) = arm(&scenario);
        let q = DriveAngles(PerDrive::from([q[0], q[0] + pose[0], q[0] + pose[0] + pose[1]]));
        let inertia = stillbase::mechanics::machine::Inertia::of(&scenario.machine);
        let model = Arc::new(MomentumModel::floating(&inertia, &scenario.base.body(), TipFrame::Space, &q));
        // Far from where rates of zero momentum grow without bound.
        let along = |v: Vector| null_space::rates(&model, &q, v, 0.0).map_or(f64::INFINITY, |rates| rates.max_abs());
        prop_assume!(along(Vector::new(1.0, 0.0)).max(along(Vector::new(0.0, 1.0))) * model.reach() < 8.0);
        let from = Reference { q, qd: PerDrive::from(rates), qdd: PerDrive::zeros(3) };
        let mut follower = MomentumFollower::new(model.clone(), &scenario.machine, Pose2::default(), STEP, &from);
        // It takes over at the rates that the arm has.
        prop_assert!(follower.reference(0.0).qd.minus(&from.qd).max_abs() < 1e-9);
        for target in targets {
            follower.set_target(Vector::new(target[0], target[1]));
            for i in 0..1200 {
                let [before, now, after] = [0.0, 0.5 * STEP, STEP].map(|t| follower.reference(t));
                let speed = 1.0 + now.qd.max_abs() + now.qdd.max_abs();
                let slope = after.q.0.minus(&before.q.0).scaled(1.0 / STEP);
                prop_assert!(slope.minus(&now.qd).max_abs() < 1e-4 * speed * speed, "{slope:?} {now:?}");
                let bend = after.qd.minus(&before.qd).scaled(1.0 / STEP);
                prop_assert!(bend.minus(&now.qdd).max_abs() < 3e-3 * speed * speed * speed, "at {i}: {:?} {:?} {:?} {:?}", before.qd, now, after.qd, follower);
                let momentum = model.coefficients(&now.q.units()).dot(&now.qd);
                prop_assert!(i < 310 || momentum.abs() < 1e-13, "{momentum}");
                follower.advance();
                let next = follower.reference(0.0);
                prop_assert!(next.q.0.minus(&after.q.0).max_abs() < 1e-12);
                // It stops at once only before a barrier to which the momentum left drives it.
                let is_lost = i < 310 && matches!(follower.target().reach, Reach::Stopped { .. });
                prop_assert!(is_lost || next.qd.minus(&after.qd).max_abs() < 1e-3, "{next:?} {after:?}");
            }
            let place = model.place(&follower.reference(0.0).q);
            match follower.target().reach {
                Reach::Inside => {}
                Reach::Stopped { nearest, .. } => prop_assert!((place - nearest).norm() < 1e-9),
                other => prop_assert!(false, "{other:?}"),
            }
        }
    }
}

#[test]
fn a_hand_leads_an_arm_without_b_and_its_base_does_not_turn() {
    let mut session = Run::new(&spot()).expect("plans");
    assert!(session.can_be_led());
    let a = session.frame().end_effector;
    let to = a + Vector::new(0.15, 0.05);
    session.apply(&Edit::DragTarget { x: to.re, y: to.im }).expect("is led");
    (0..6000).for_each(|_| session.advance());
    let frame = session.frame();
    assert!((frame.end_effector - to).norm() < 1e-9 && frame.phase == Phase::Rest, "{:?}", frame.end_effector);
    assert!(frame.totals.base_angle < 1e-10 && frame.base.at.norm() > 1e-3, "{}", frame.totals.base_angle);
    assert!(frame.first_violation().is_none(), "{:?}", frame.first_violation());
    // Far out it waits, and says before what.
    session.apply(&Edit::DragTarget { x: 3.0, y: 0.0 }).expect("is led");
    (0..8000).for_each(|_| session.advance());
    let frame = session.frame();
    let Reach::Stopped { nearest, why } = frame.target.reach else { panic!("{:?}", frame.target) };
    assert!((frame.end_effector - nearest).norm() < 1e-6 && frame.phase == Phase::Rest);
    assert!(matches!(why, Barrier::Singular(_)), "{why}");
    assert!(frame.totals.base_angle < 1e-9, "{}", frame.totals.base_angle);
    // It may be led back the way that it came.
    session.apply(&Edit::DragTarget { x: to.re, y: to.im }).expect("is led");
    (0..9000).for_each(|_| session.advance());
    assert!((session.frame().end_effector - to).norm() < 1e-9, "{:?}", session.frame().target);
}

/// A limit that the arm meets is named as such.
#[test]
fn a_led_arm_stops_before_a_limit() {
    let scenario = spot();
    let (model, q) = arm(&scenario);
    let bent = q[1] - q[0];
    let angle = format!(
        "[[angle]]\nname = \"elbow\"\nfrom = \"shoulder\"\nto = \"elbow\"\nmin = {}\nmax = {}\n",
        bent - 0.2,
        bent + 0.2
    );
    let text = include_str!("../../assets/machines/spot.toml");
    let machine = stillbase::mechanics::machine::parse(&format!("{text}\n{angle}"), "limited").expect("valid");
    let from = Reference { q, qd: PerDrive::zeros(3), qdd: PerDrive::zeros(3) };
    let mut follower = MomentumFollower::new(model.clone(), &machine, Pose2::default(), STEP, &from);
    let a = model.place(&q);
    follower.set_target(a * 0.6);
    let mut least = f64::INFINITY;
    for _ in 0..4000 {
        follower.advance();
        let q = follower.reference(0.0).q;
        least = least.min(0.2 - (q[1] - q[0] - bent).abs());
    }
    assert!(least > -1e-9, "{least}");
    let Reach::Stopped { why, .. } = follower.target().reach else { panic!("{:?}", follower.target()) };
    assert_eq!((why, least < 1e-3), (Barrier::Limit(0), true), "{why} {least}");
}
