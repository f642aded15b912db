//! Limits of joints apply whatever the task, and a task that does not fit them waits.

use proptest::prelude::*;
use stillbase::session::scenario::Scenario;
use stillbase::session::verdict::Verdict;
use stillbase::session::{Edit, Refusal, Session, replay};

use super::{coarse, do_it, open, set, state};

/// Within limits in which A or B cannot be reached the run waits, and says by the point what b would do.
#[test]
fn a_task_that_cannot_be_waits_by_its_point() {
    let mut session = open(coarse());
    let before = state(&session);
    do_it(&mut session, set("limits.a1", "0,0.5"));
    let refusal = session.run().waiting().expect("A needs a1 = 2.03").why.clone();
    assert!(matches!(refusal, Refusal::Unreachable { ref point, .. } if point == "A"), "{refusal}");
    session.undo().expect("as it was");
    do_it(&mut session, set("limits.a2", "0.8,2.0"));
    let words = session.run().waiting().expect("B needs a2 = 2.05").why.to_string();
    session.undo().expect("as it was");
    assert!(
        words.contains("B (0.550, 0.900) m is outside") && words.contains("want b from 2.2158 to 2.3740"),
        "{words}"
    );
    assert!(state(&session) == before);
}

/// Limits of a joint within its turn, rad: wide ones and narrow ones.
fn limits() -> impl Strategy<Value = (usize, f64, f64)> {
    (1..3usize, 0.0..3.0f64, 0.05..3.0f64)
        .prop_map(|(i, from, width)| (i, from, (from + width).min(std::f64::consts::PI)))
}

fn limit((i, from, to): (usize, f64, f64)) -> Edit {
    Edit::set(&format!("limits.a{i}"), vec![from, to])
}

/// A session in which both limits are set at some step, playing or not, led by hand or not.
fn apply(
    one: (usize, f64, f64),
    other: (usize, f64, f64),
    steps: u64,
    plays: bool,
    leads: bool,
) -> Result<(), TestCaseError> {
    let mut session = open(coarse());
    session.play();
    session.tick(steps);
    if leads {
        session.apply(Edit::DragTarget { x: 0.52, y: 0.7 }).expect("any place");
        session.end_gesture();
        session.tick(25);
    }
    if !plays {
        session.pause();
    }
    let before = (session.to_scenario(), session.frames().to_vec());
    for set in [one, other] {
        session.apply(limit(set)).expect("limits always apply");
        session.end_gesture();
        let now = session.scenario().machine.angles()[set.0 - 1].limits.clone();
        prop_assert_eq!((*now.start(), *now.end()), (set.1, set.2));
    }
    let saved = session.to_scenario();
    let replayed = stillbase::session::replay(&saved, |_, _| {});
    if let Some(waiting) = session.run().waiting().cloned() {
        prop_assert!(!leads, "whoever leads goes on");
        let (b, planes) = (session.scenario().task.b, session.run().planes().expect("planes").clone());
        let points = session.scenario().task.points();
        for (i, p) in points.iter().enumerate() {
            let served = !planes.map().poses(*p, b).is_empty();
            prop_assert_eq!(served, waiting.points.iter().all(|(n, _)| *n != i));
        }
        for (i, would_do) in &waiting.points {
            if let Some(b) = would_do {
                prop_assert!(!planes.map().poses(points[*i], b.value()).is_empty(), "{} at {}", i, b);
            }
        }
        let at = session.frames().to_vec();
        session.play();
        session.tick(50);
        session.step_by(5);
        session.seek(0.5);
        prop_assert_eq!(&session.frames().to_vec(), &at, "time stands still");
        prop_assert!(session.frame().is_finite());
        prop_assert_eq!(session.apply(Edit::DragTarget { x: 0.5, y: 0.6 }), Err(waiting.why.clone()));
        prop_assert_eq!(replayed.err(), Some(waiting.why.clone()), "headless it is refused");
        let again =
            Session::open(Scenario::parse(&saved.to_toml(), "saved", None).expect("readable")).expect("it waits");
        prop_assert_eq!(again.run().waiting(), Some(&waiting));
        prop_assert_eq!(&again.frames().to_vec(), &at);
    } else {
        let run = replayed.expect("what runs here runs headless");
        prop_assert_eq!(run.frame(), session.run().frame());
    }
    if session.run().waiting().is_some() || !plays {
        session.pause();
        session.undo().expect("taken back");
        session.undo().expect("taken back");
        prop_assert_eq!(session.to_scenario(), before.0);
        prop_assert!(*session.frames() == before.1, "the same frames");
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// Joint limits always apply, at rest, under way and in the hand. A task that does not fit them waits: with the b
    /// that would do, without time, saved and opened as it is, refused headless, and whole again with wider limits. Three
    /// hundred: each takes a tenth of a second in a debug build. A thousand are in the long test.
    #[test]
    fn limits_always_apply(
        one in limits(),
        other in limits(),
        steps in 1..100u64,
        plays: bool,
        leads: bool,
    ) {
        apply(one, other, steps, plays, leads)?;
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn limits_always_apply_often(
        one in limits(),
        other in limits(),
        steps in 1..100u64,
        plays: bool,
        leads: bool,
    ) {
        apply(one, other, steps, plays, leads)?;
    }
}

/// A motor on another drive turns at the rate between both, in the plan as in the run.
#[test]
fn limits_are_those_of_motors_that_sit_on_other_drives() {
    for (key, limit) in [("speed_limit", 0.5), ("acceleration_limit", 0.1)] {
        let mut arm = Scenario::builtin("spot").expect("built in").clone();
        arm.machine = arm.machine.set(&format!("drive.elbow.{key}"), &limit.to_string()).expect("a limit");
        let run = replay(&arm, |_, _| {}).expect("it runs");
        let (planned, by) = run.plan().forecast.exceeded_limit.expect("the plan is past it");
        let (found, factor) = Verdict::of(run.scenario(), &run.frame()).exceeded_limit.expect("so is the run");
        assert_eq!(planned, found);
        assert!((factor / by - 1.0).abs() < 1e-3, "{key}: {factor} is not {by}");
    }
}
