//! A machine that is led by hand: on its plane, within its bounds, and at rest in the end.

use proptest::prelude::*;
use stillbase::mechanics::machine::Inertia;
use stillbase::mechanics::planar::Vector;
use stillbase::session::scenario::Scenario;
use stillbase::session::{Edit, Session};
use stillbase::simulation::frame::{Frame, Phase, Reach};

use super::{coarse, do_it, drag, gains, one_path, open, scenario, set, settle, slide};

/// A target dragged before the first step outlives a change of parameters, in motion or at rest.
#[test]
fn a_drag_at_the_start_outlives_parameters() {
    let parameters = [
        gains(500.0, 45.0),
        Edit::set("plant.payload.mass", 0.05),
        set("limits.a1", "0.1,3"),
        set("gravity", "0,-9.81"),
    ];
    for parameter in parameters {
        // At once, in motion, and at rest.
        for ticks in [0, 30, 100_000] {
            let mut session = open(coarse());
            do_it(&mut session, drag(0.6, 0.6));
            session.end_gesture();
            session.tick(ticks);
            do_it(&mut session, parameter.clone());
            assert!(session.is_dragged());
            settle(&mut session);
            let f = session.frame();
            assert_eq!(f.target.at, Vector::new(0.6, 0.6), "{parameter:?} after {ticks} ticks");
            assert!((f.q_reference[0] - f.q[0]).abs() < 0.1 && f.phase == Phase::Rest);
            one_path(&session);
        }
    }
}

/// What is set at rest holds for the whole run, whatever was set on the way.
#[test]
fn a_parameter_set_at_rest_is_the_last_word() {
    let mut session = open(coarse());
    do_it(&mut session, drag(0.6, 0.6));
    session.end_gesture();
    session.tick(20);
    do_it(&mut session, Edit::set("plant.payload.mass", 0.3));
    session.end_gesture();
    settle(&mut session);
    do_it(&mut session, Edit::set("plant.payload.mass", 0.1));
    assert_eq!(session.scenario().plant.payload.mass, 0.1);
    settle(&mut session);
    one_path(&session);
    session.undo().expect("the payload of the run");
    assert_eq!(session.scenario().plant.payload.mass, 0.3);
}

/// Widening a limit lets the machine go on to the target that it could not reach.
#[test]
fn a_target_outlives_a_change_of_the_machine() {
    let mut session = open(coarse());
    do_it(&mut session, set("limits.a2", "0.8,2.2"));
    let planes = session.run().planes().expect("three drives").clone();
    let free = planes
        .map()
        .with_limits([planes.map().limits()[0], stillbase::planning::reactionless::AngleLimit { min: 0.0, max: 3.0 }])
        .expect("limits");
    let at = free.forward([1.2, 2.6], 2.4);
    do_it(&mut session, drag(at.re, at.im));
    session.end_gesture();
    session.tick(40);
    assert!(matches!(session.frame().target.reach, Reach::Outside { .. }), "{:?}", session.frame().target);
    do_it(&mut session, set("limits.a2", "0,3"));
    settle(&mut session);
    assert_eq!(session.frame().target.reach, Reach::Inside);
    assert!((session.frame().end_effector - at).norm() < 1e-9);
    one_path(&session);
}

/// A new time while the motion runs is the motion's time.
#[test]
fn the_time_of_a_motion_can_be_set_while_it_runs() {
    let mut session = open(coarse());
    session.play();
    session.tick(100);
    do_it(&mut session, Edit::set("task.time", 2.0));
    assert!(session.is_moving());
    assert_eq!(session.length(), 2.0);
    settle(&mut session);
    assert!((session.frame().time - 2.0).abs() < 0.01, "{}", session.frame().time);
    one_path(&session);
}

/// However the target is dragged, b stands and the base feels nothing.
fn still(session: &Session) {
    let b = session.frames()[0].b;
    let limits = session.run().planes().expect("three drives").map().limits();
    for f in session.frames() {
        assert!((f.b - b).abs() < 1e-12, "b moved by {:e} at {} s", f.b - b, f.time);
        assert!(f.base_moment().abs() <= 1e-6 * f.peaks.torque_sum, "{:e} N m at {} s", f.base_moment(), f.time);
        for (a, limit) in f.a.iter().zip(limits) {
            assert!(limit.contains(*a, 1e-9), "joint angle {a} passes {limit:?} at {} s", f.time);
        }
    }
    let peaks = session.frames().last().expect("one at least").peaks;
    assert!(peaks.torque_sum > 0.1 && peaks.is_reactionless(), "{peaks:?}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, max_shrink_iters: 100, ..ProptestConfig::default() })]

    /// Inside and outside, slowly and in jumps.
    #[test]
    fn dragging_at_any_speed_is_reactionless(
        targets in prop::collection::vec(((-0.6..1.3), (-0.6..1.4), 0u64..120), 3..12),
    ) {
        let mut session = open(scenario());
        for (x, y, ticks) in targets {
            do_it(&mut session, drag(x, y));
            session.tick(ticks + 1);
        }
        session.tick(200);
        still(&session);
        for f in session.frames() {
            let [x, y] = [f.qdd.max_abs(), f.torque.max_abs()];
            prop_assert!(x.is_finite() && y < 60.0, "{} rad/s² and {} N m at {} s", x, y, f.time);
        }
    }

    /// Sliding b is felt, but never by more than D_1 times the bound.
    #[test]
    fn sliding_keeps_its_bound(
        slides in prop::collection::vec((1.8..3.2, 1u64..400), 1..5),
        bound in 0.5..4.0,
    ) {
        let mut session = open(Scenario { pose_acceleration: bound, ..scenario() });
        let d1 = Inertia::of(&session.scenario().machine).diagonal(0);
        let lambda = Inertia::of(&session.scenario().machine).lambda();
        let mut aim = 2.4;
        for (b, ticks) in slides {
            do_it(&mut session, slide(b));
            session.tick(ticks);
            aim = b;
        }
        for f in session.frames() {
            let acceleration = lambda.dot(&f.qdd);
            prop_assert!(acceleration.abs() <= bound * (1.0 + 1e-6), "{} at {} s", acceleration, f.time);
            prop_assert!((f.base_moment() + d1 * acceleration).abs() < 1e-9);
        }
        settle(&mut session);
        let end = session.frame();
        prop_assert!((end.b - aim).abs() < 1e-7 && end.b_reference == aim, "{} for {}", end.b, aim);
    }
}

/// Distance of a point from the polygons of a boundary, m.
fn off_boundary(loops: &[Vec<[f64; 2]>], p: Vector) -> f64 {
    let mut least = f64::INFINITY;
    for outline in loops {
        for (a, b) in outline.iter().zip(outline.iter().cycle().skip(1)) {
            let [a, b] = [a, b].map(|p| Vector::new(p[0], p[1]));
            let t = (((p - a) * (b - a).conj()).re / (b - a).norm_sqr().max(1e-300)).clamp(0.0, 1.0);
            least = least.min((p - (a + t * (b - a))).norm());
        }
    }
    least
}

#[test]
fn outside_the_machine_waits_at_the_nearest_point_and_b_mends_it() {
    let target = Vector::new(0.2, 1.15);
    let mut session = open(scenario());
    do_it(&mut session, drag(target.re, target.im));
    session.end_gesture();
    settle(&mut session);
    let f = *session.frame();
    let Reach::Outside { nearest, feasible_b, .. } = f.target.reach else { panic!("{:?}", f.target) };
    assert_eq!(f.target.at, target, "the handle stays under the pointer");
    assert!((f.end_effector - nearest).norm() < 1e-9, "the machine waits at the nearest point");
    let planes = session.run().planes().expect("three drives").clone();
    let loops = planes.boundary().turned(2.4);
    assert!(off_boundary(&loops, nearest) < 2e-5, "{:e} m off the boundary", off_boundary(&loops, nearest));
    // Connected along the boundary, nothing of it is nearer.
    assert!((nearest - target).norm() <= off_boundary(&loops, target) + 1e-5);
    still(&session);

    let b = feasible_b.expect("some plane serves it");
    assert!((b - 2.4).abs() > 0.01);
    do_it(&mut session, slide(b));
    settle(&mut session);
    let f = session.frame();
    assert!((f.end_effector - target).norm() < 1e-6, "{:e} m off after mending", (f.end_effector - target).norm());
    // A little less does not do.
    let short = b - 1e-3 * (b - 2.4).signum();
    assert!(planes.map().poses(target, short).is_empty(), "b = {short} would do");
    one_path(&session);
}

/// b slid past what the end effector's place allows: it is carried, with a_1 and a_2 held from there on.
#[test]
fn sliding_on_carries_the_end_effector() {
    let mut session = open(scenario());
    do_it(&mut session, drag(0.5, 0.5));
    session.end_gesture();
    settle(&mut session);
    do_it(&mut session, slide(3.4));
    settle(&mut session);
    let carried: Vec<&Frame> = session.frames().iter().filter(|f| f.target.reach == Reach::Carried).collect();
    let before: Vec<&Frame> = session.frames().iter().filter(|f| f.target.reach == Reach::Inside).collect();
    assert!(!carried.is_empty() && !before.is_empty());
    // A = (0.50, 0.50) is reached up to b = 2.9013 (`planning.json`).
    for f in &before[before.len() - 300..] {
        assert!(f.b_reference < 2.9013 + 1e-9 && f.target.at == Vector::new(0.5, 0.5));
    }
    assert!(carried[0].b_reference > 2.9013 - 1e-2 && carried[0].b_reference < 2.9013 + 2e-2);
    let (end, held) = (session.frame(), carried[carried.len() / 2]);
    assert!((end.b - 3.4).abs() < 1e-9);
    assert!((end.a[0] - held.a[0]).abs() < 1e-3 && (end.a[1] - held.a[1]).abs() < 1e-3, "{:?} {:?}", end.a, held.a);
    assert!((end.target.at - end.end_effector).norm() < 1e-6, "the target goes with it");
    one_path(&session);
}

#[test]
fn a_settled_session_stands_still() {
    let mut session = open(scenario());
    assert!(!session.is_moving(), "nobody has pressed play");
    session.tick(1000);
    assert_eq!(session.frames().len(), 1);
    settle(&mut session);
    let frames = session.frames().len();
    assert!((1001..1010).contains(&frames), "{frames}");
    session.tick(1000);
    assert!(!session.is_moving());
    assert_eq!(session.frames().len(), frames);
    // A new target wakes it, and it falls asleep again.
    do_it(&mut session, drag(0.6, 0.7));
    assert!(session.is_moving());
    session.tick(100_000);
    assert!(!session.is_moving() && session.frames().len() < frames + 4000);
    assert!((session.frame().end_effector - Vector::new(0.6, 0.7)).norm() < 1e-9);
}

#[test]
fn seeking_and_stepping() {
    let mut session = open(scenario());
    session.seek(0.25);
    assert_eq!((session.frame().step, session.frames().len()), (250, 251));
    session.step_by(-100);
    assert_eq!(session.frame().step, 150);
    session.step_by(-10_000);
    assert_eq!(session.frame().step, 0);
    session.step_by(5);
    assert_eq!(session.frame().step, 5);
    session.seek(99.0);
    assert_eq!(session.frame().step, 1000, "no further than the motion");
    session.step_by(7);
    assert_eq!(session.frame().step, 1007, "one may look beyond");
    for odd in [f64::NAN, f64::INFINITY, -1.0] {
        session.seek(odd);
        assert!(session.frame().step <= 1007);
    }
    session.step_by(i64::MIN);
    assert_eq!(session.frame().step, 0);
    assert!((session.length() - 1.007).abs() < 1e-12);
    // Shown again from the start once it has come to its end.
    settle(&mut session);
    session.play();
    assert_eq!(session.frame().step, 0);
    session.tick(10);
    assert_eq!(session.frame().step, 10);
}

/// What was set while the machine was led stays when a new path takes it back.
#[test]
fn settings_outlive_following() {
    let mut session = open(scenario());
    do_it(&mut session, drag(0.6, 0.7));
    session.tick(200);
    session.end_gesture();
    do_it(&mut session, Edit::set("plant.payload.mass", 0.3));
    session.end_gesture();
    session.tick(50);
    do_it(&mut session, Edit::set("task.shape", "line"));
    assert!(!session.is_dragged());
    assert_eq!(session.scenario().plant.payload.mass, 0.3);
    one_path(&session);
}
