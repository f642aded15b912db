//! One path: whatever is done to a session by hand, its script replayed headless gives the very same frames.

use proptest::prelude::*;
use stillbase::mechanics::machine::{Inertia, builtin};
use stillbase::mechanics::planar::Vector;
use stillbase::session::scenario::Scenario;
use stillbase::session::{Edit, Refusal, Session, TimedEdit, replay};
use stillbase::simulation::frame::{Frame, Phase, Reach};

fn gains(kp: f64, kd: f64) -> Edit {
    Edit::SetControl { change: toml::Table::from_iter([("kp".into(), kp.into()), ("kd".into(), kd.into())]) }
}

fn scenario() -> Scenario {
    Scenario::builtin("case-3").expect("built in")
}

/// Case 3 in coarse steps, where only equality matters.
fn coarse() -> Scenario {
    Scenario { step: 0.004, ..scenario() }
}

fn open(scenario: Scenario) -> Session {
    Session::open(scenario).expect("it can start")
}

fn drag(x: f64, y: f64) -> Edit {
    Edit::DragTarget { x, y }
}

fn slide(b: f64) -> Edit {
    Edit::SlideB { b }
}

fn set(key: &str, value: &str) -> Edit {
    Edit::SetMachine { key: key.into(), value: value.into() }
}

fn do_it(session: &mut Session, edit: Edit) {
    session.apply(edit.clone()).unwrap_or_else(|e| panic!("{edit:?}: {e}"));
}

/// Until nothing moves any more, or a minute has passed.
fn settle(session: &mut Session) {
    session.play();
    session.tick((60.0 / session.scenario().step) as u64);
    assert!(!session.is_moving(), "still moving at {} s", session.frame().time);
}

/// The frames of a saved session, by way of its file.
fn replayed(session: &Session) -> Vec<Frame> {
    let saved = session.to_scenario();
    let text = saved.to_toml();
    let read = Scenario::parse(&text, "saved.toml", None).unwrap_or_else(|e| panic!("{e}\n{text}"));
    assert_eq!(read, saved, "{text}");
    let mut frames = Vec::new();
    replay(&read, |_, frame| frames.push(*frame)).unwrap_or_else(|e| panic!("{e}\n{text}"));
    frames
}

#[track_caller]
fn same(what: &str, got: &[Frame], want: &[Frame]) {
    let first = got.iter().zip(want).position(|(a, b)| a != b);
    if let Some(i) = first {
        panic!("{what}: frame {i} of {} differs:\n{:?}\n{:?}", want.len(), got[i], want[i]);
    }
    assert_eq!(got.len(), want.len(), "{what}: how many");
}

/// The session, its replay and its reopening agree frame by frame, bit by bit.
#[track_caller]
fn one_path(session: &Session) {
    if let Some(waiting) = session.run().waiting() {
        let refused = replay(&session.to_scenario(), |_, _| {}).expect_err("what waits is refused headless");
        assert_eq!(refused, waiting.why);
        let again = open(session.to_scenario());
        assert_eq!((again.frames(), again.run().waiting()), (session.frames(), Some(waiting)));
        return;
    }
    let mut frames = replayed(session);
    if session.frames().len() == 1 {
        // Nothing has run yet; the saved session covers its motion.
        frames.truncate(1);
    }
    same("replayed", &frames, session.frames());
    let mut again = open(session.to_scenario());
    let (to, done) = (session.frames().len() as i64, again.frames().len() as i64);
    again.step_by(to - 1);
    assert!(done >= to || session.script().iter().all(|e| e.step == 0), "a session that was led opens at full length");
    same("opened", &again.frames()[..to as usize], session.frames());
    assert_eq!(again.script(), session.script());
}

/// A session as its window sees it: frames, script, parameters.
fn state(session: &Session) -> (Vec<Frame>, Vec<TimedEdit>, Scenario, Frame) {
    (session.frames().to_vec(), session.script().to_vec(), session.to_scenario(), *session.frame())
}

#[test]
fn a_played_case_is_its_replay() {
    let mut session = open(scenario());
    settle(&mut session);
    one_path(&session);
    let mut frames = Vec::new();
    replay(&scenario(), |_, f| frames.push(*f)).expect("it can start");
    same("the scenario itself", session.frames(), &frames);
}

/// A long sitting: drags, slides, payload, gains, limits, gravity, poses, between ticks as irregular as a window's.
#[test]
fn a_sitting_replayed_gives_equal_frames() {
    let mut session = open(coarse());
    do_it(&mut session, Edit::SetTime { time: 0.8 });
    do_it(&mut session, Edit::PoseB { b: 2.5 });
    session.end_gesture();
    session.play();
    session.tick(37);
    for i in 0..12 {
        do_it(&mut session, drag(0.50 + 0.015 * f64::from(i), 0.55 - 0.01 * f64::from(i)));
        session.tick([1, 0, 4, 0, 0, 2, 7, 1, 0, 3, 3, 5][i as usize]);
    }
    session.end_gesture();
    do_it(&mut session, Edit::plant("payload.mass", 0.2));
    session.tick(11);
    do_it(&mut session, gains(300.0, 30.0));
    session.tick(2);
    do_it(&mut session, set("limits.a1", "0.2,2.9"));
    session.tick(13);
    do_it(&mut session, slide(2.7));
    session.tick(40);
    do_it(&mut session, set("gravity", "0,-9.81"));
    do_it(&mut session, Edit::CompareB { b: Some(4.0) });
    session.tick(5);
    do_it(&mut session, drag(1.5, 1.5));
    session.tick(90);
    session.pause();
    do_it(&mut session, Edit::PoseB { b: 2.2 });
    session.step_by(3);
    do_it(&mut session, set("link.9.mass", "0.3"));
    session.play();
    session.tick(50);
    assert!(session.frames().len() > 150 && session.script().len() > 10);
    one_path(&session);
}

/// What can happen to a session.
#[derive(Clone, Debug)]
enum Act {
    Edit(Edit),
    Tick(u64),
    Play,
    Pause,
    EndGesture,
    Undo,
    Redo,
    Seek(f64),
    StepBy(i64),
}

fn any_edit() -> impl Strategy<Value = Edit> {
    let limits = |name: &'static str| {
        (0.0..0.5, 2.5..3.1).prop_map(move |(min, max)| set(&format!("limits.{name}"), &format!("{min},{max}")))
    };
    prop_oneof![
        6 => (-0.2..1.0, -0.2..1.2).prop_map(|(x, y)| drag(x, y)),
        3 => (1.8..3.2).prop_map(slide),
        2 => (2.2..2.7).prop_map(|b| Edit::PoseB { b }),
        1 => (100.0..600.0, 10.0..50.0).prop_map(|(kp, kd)| gains(kp, kd)),
        1 => (0.0..0.5).prop_map(|mass| Edit::plant("payload.mass", mass)),
        1 => limits("a1"),
        1 => limits("a2"),
        1 => (-10.0..10.0).prop_map(|g| set("gravity", &format!("0,{g}"))),
        1 => (0.2..1.0).prop_map(|mass: f64| set("link.9.mass", &mass.to_string())),
        1 => (0.3..1.5).prop_map(|time| Edit::SetTime { time }),
        1 => prop::option::of(0.0..7.0).prop_map(|b| Edit::CompareB { b }),
        1 => Just(Edit::plant("payload.mass", f64::NAN)),
        1 => Just(set("limits.a1", "3,1")),
    ]
}

fn any_act() -> impl Strategy<Value = Act> {
    prop_oneof![
        10 => any_edit().prop_map(Act::Edit),
        8 => (0u64..30).prop_map(Act::Tick),
        3 => Just(Act::Play),
        1 => Just(Act::Pause),
        2 => Just(Act::EndGesture),
        2 => Just(Act::Undo),
        1 => Just(Act::Redo),
        1 => (0.0..0.5).prop_map(Act::Seek),
        1 => (-20i64..20).prop_map(Act::StepBy),
    ]
}

impl Act {
    /// What is refused must have left no trace.
    fn perform(&self, session: &mut Session) {
        let before = state(session);
        let done = match self {
            Self::Edit(edit) => session.apply(edit.clone()),
            Self::Undo => session.undo(),
            Self::Redo => session.redo(),
            Self::Tick(n) => {
                session.tick(*n);
                Ok(())
            }
            Self::Play => {
                session.play();
                Ok(())
            }
            Self::Pause => {
                session.pause();
                Ok(())
            }
            Self::EndGesture => {
                session.end_gesture();
                Ok(())
            }
            Self::Seek(t) => {
                session.seek(*t);
                Ok(())
            }
            Self::StepBy(n) => {
                session.step_by(*n);
                Ok(())
            }
        };
        if let Err(refusal) = done {
            assert!(!refusal.to_string().is_empty());
            assert!(state(session) == before, "{self:?} was refused ({refusal}) and has left its mark");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, max_shrink_iters: 200, ..ProptestConfig::default() })]

    #[test]
    fn any_sitting_replayed_gives_equal_frames(acts in prop::collection::vec(any_act(), 1..24)) {
        let mut session = open(coarse());
        for act in &acts {
            act.perform(&mut session);
            let waits = session.run().waiting().is_some();
            prop_assert!(waits || session.script().iter().all(|e| e.step < session.frames().len() as u64));
        }
        one_path(&session);
    }
}

/// Frames that are not there yet do not appear, those that are stay: undo and redo at rest are inverse to each other.
#[test]
fn undo_at_rest_restores_and_redo_brings_back() {
    let mut session = open(coarse());
    settle(&mut session);
    let edits = [
        Edit::plant("payload.mass", 0.3),
        gains(900.0, 60.0),
        set("limits.a2", "0.3,3"),
        drag(0.6, 0.6),
        Edit::plant("payload.mass", 0.1),
        Edit::PoseB { b: 2.3 },
        slide(2.5),
        Edit::CompareB { b: None },
        Edit::SetTime { time: 2.0 },
    ];
    let mut states = vec![state(&session)];
    for edit in edits.clone() {
        do_it(&mut session, edit);
        session.end_gesture();
        settle(&mut session);
        session.pause();
        states.push(state(&session));
    }
    for (edit, want) in edits.iter().zip(&states).rev() {
        assert_eq!(session.undo_title(), Some(edit.title().as_str()));
        session.undo().expect("it was so before");
        same(&edit.title(), session.frames(), &want.0[..session.frames().len()]);
        assert_eq!(session.script(), want.1, "{edit:?}");
        assert!(!session.is_moving(), "time stands after {edit:?} is taken back");
    }
    assert_eq!(session.undo_title(), None);
    for (edit, want) in edits.iter().zip(&states[1..]) {
        assert_eq!(session.redo_title(), Some(edit.title().as_str()));
        session.redo().expect("it was so before");
        same(&edit.title(), session.frames(), &want.0[..session.frames().len()]);
        assert_eq!(session.script(), want.1, "{edit:?}");
    }
    same("all brought back", session.frames(), &states[edits.len()].0);
    assert_eq!(session.redo_title(), None);
}

/// In motion nothing jumps: undo sends the machine back, as one more edit at the present step.
#[test]
fn undo_in_motion_appends_the_inverse() {
    let pairs = [
        (Edit::plant("payload.mass", 0.3), Edit::plant("payload.mass", "default")),
        (gains(900.0, 60.0), gains(400.0, 40.0)),
        (set("limits.a2", "0.3,3"), set("limits.a2", "0,3.141592653589793")),
        (slide(2.5), slide(2.4)),
        (Edit::CompareB { b: None }, Edit::CompareB { b: Some(5.0) }),
    ];
    for (edit, inverse) in pairs {
        let mut session = open(coarse());
        do_it(&mut session, drag(0.55, 0.6));
        session.end_gesture();
        session.tick(10);
        do_it(&mut session, edit.clone());
        session.tick(5);
        let before = session.frames().to_vec();
        session.undo().expect("an inverse");
        let script = session.script();
        assert_eq!(script.len(), 3);
        assert_eq!(script[2], TimedEdit { step: 15, edit: inverse.clone() }, "undo of {edit:?}");
        same("what was stays", &session.frames()[..15], &before[..15]);
        assert_eq!(session.frames().len(), before.len());
        session.tick(5);
        session.redo().expect("the edit again");
        assert_eq!(session.script()[3], TimedEdit { step: 20, edit: edit.clone() });
        session.tick(5);
        one_path(&session);
    }
}

/// What concerns the run as a whole is taken back as a whole, and the run goes on.
#[test]
fn undo_in_motion_of_a_pose_or_a_time_makes_the_run_again() {
    for edit in [Edit::PoseB { b: 2.5 }, Edit::SetTime { time: 1.4 }] {
        let mut session = open(coarse());
        session.play();
        session.tick(60);
        let plain = session.frames().to_vec();
        do_it(&mut session, edit.clone());
        session.end_gesture();
        let edited = session.frames().to_vec();
        assert!(edited.len() == 61 && edited[60] != plain[60]);
        session.tick(20);
        session.undo().expect("can be taken back");
        assert!(session.is_moving() && session.frames().len() == 81);
        same(&edit.title(), &session.frames()[..61], &plain);
        session.tick(20);
        session.redo().expect("can be brought back");
        assert!(session.is_moving() && session.frames().len() == 101);
        same(&edit.title(), &session.frames()[..61], &edited);
        one_path(&session);
    }
}

/// Undoing a drag in motion sends the machine back to where it was sent before.
#[test]
fn undo_of_a_drag_goes_back_to_the_last_target() {
    let mut session = open(coarse());
    do_it(&mut session, drag(0.55, 0.6));
    session.end_gesture();
    session.tick(40);
    for x in [0.4, 0.3, 0.2] {
        do_it(&mut session, drag(x, 0.8));
        session.tick(3);
    }
    session.end_gesture();
    session.undo().expect("an inverse");
    assert_eq!(session.script().last().expect("undo").edit, drag(0.55, 0.6));
    settle(&mut session);
    assert!((session.frame().tip - Vector::new(0.55, 0.6)).norm() < 1e-9);
    one_path(&session);
}

/// Undo of an edit made after scrubbing back goes to what was there, not to what came later.
#[test]
fn inverse_is_taken_where_the_edit_applies() {
    let mut session = open(coarse());
    do_it(&mut session, drag(0.55, 0.6));
    session.end_gesture();
    session.tick(60);
    do_it(&mut session, drag(0.3, 0.9));
    session.end_gesture();
    session.tick(60);
    session.seek(30.0 * 0.004);
    do_it(&mut session, drag(0.5, 0.5));
    session.end_gesture();
    session.tick(10);
    session.undo().expect("an inverse");
    assert_eq!(session.script().last().expect("undo").edit, drag(0.55, 0.6));
    one_path(&session);
}

/// A gesture is one undo, and in each step only its last word counts.
#[test]
fn a_drag_is_one_undo_and_one_edit_a_step() {
    let mut session = open(coarse());
    settle(&mut session);
    let start = state(&session);
    for i in 0..40 {
        // Several events between two ticks, some of them far outside.
        for x in [0.55, 3.0, -2.0, 0.5 - 0.005 * f64::from(i)] {
            do_it(&mut session, drag(x, 0.7));
        }
        session.tick(u64::from(i % 3 == 0));
    }
    session.end_gesture();
    let script = session.script();
    assert!(script.windows(2).all(|w| w[0].step < w[1].step), "one edit a step: {script:?}");
    assert_eq!(script.len(), 14);
    assert!(script.iter().all(|e| matches!(e.edit, Edit::DragTarget { x, .. } if (0.2..=0.5).contains(&x))));
    assert_eq!(script.last().expect("some").edit, drag(0.5 - 0.005 * 39.0, 0.7));
    one_path(&session);
    settle(&mut session);
    session.undo().expect("back to the start");
    same("one undo", session.frames(), &start.0);
    assert_eq!(session.undo_title(), None);
}

/// Two gestures in one step are two edits.
#[test]
fn gestures_do_not_join() {
    let mut session = open(coarse());
    for y in [0.6, 0.65] {
        do_it(&mut session, drag(0.5, y));
        session.end_gesture();
    }
    do_it(&mut session, slide(2.5));
    do_it(&mut session, drag(0.5, 0.7));
    assert_eq!(session.script().len(), 4);
    session.tick(20);
    one_path(&session);
}

#[test]
fn refused_edits_change_nothing() {
    let wrong = [
        drag(f64::NAN, 0.5),
        drag(0.5, f64::INFINITY),
        slide(f64::NAN),
        Edit::PoseB { b: f64::INFINITY },
        Edit::plant("payload.mass", -0.1),
        Edit::plant("payload.mass", f64::NAN),
        gains(-1.0, 10.0),
        gains(100.0, f64::NAN),
        Edit::SetTime { time: 0.0 },
        Edit::SetTime { time: f64::NAN },
        Edit::CompareB { b: Some(f64::NAN) },
        set("limits.a1", "2,1"),
        set("limits.a7", "0,1"),
        set("link.1.mass", "-3"),
        set("link.4.length", "0.7"),
        set("nonsense", "1"),
        set("payload.mass", "heavy"),
    ];
    let sittings: [fn(&mut Session); 5] = [
        |_| {},
        |s| settle(s),
        |s| {
            s.play();
            s.tick(40);
        },
        |s| {
            do_it(s, drag(0.6, 0.6));
            s.tick(40);
        },
        |s| {
            do_it(s, drag(0.6, 0.6));
            s.tick(40);
            do_it(s, slide(2.5));
            s.tick(40);
            s.seek(0.2);
        },
    ];
    for (i, sitting) in sittings.iter().enumerate() {
        let mut session = open(coarse());
        sitting(&mut session);
        let (before, undo, moving) = (state(&session), session.undo_title().map(String::from), session.is_moving());
        for edit in &wrong {
            let refusal = session.apply(edit.clone()).expect_err("refused");
            assert!(!refusal.to_string().is_empty());
            assert!(state(&session) == before, "sitting {i}: {edit:?} has left its mark");
            assert_eq!(session.undo_title(), undo.as_deref(), "sitting {i}: {edit:?}");
            assert_eq!(session.is_moving(), moving, "sitting {i}: {edit:?}");
        }
    }
}

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

/// An edit at a scrubbed instant replaces what came later, keeps what was there, and is undone as a whole.
#[test]
fn scrubbing_back_and_editing_replaces_the_later_script() {
    let mut session = open(coarse());
    do_it(&mut session, drag(0.55, 0.6));
    session.end_gesture();
    session.tick(50);
    do_it(&mut session, slide(2.5));
    session.end_gesture();
    session.tick(50);
    do_it(&mut session, drag(0.4, 0.8));
    session.end_gesture();
    settle(&mut session);
    let full = state(&session);
    assert_eq!(full.1.iter().map(|e| e.step).collect::<Vec<_>>(), [0, 50, 100]);
    // To the very step of the slide: it is on display and stays.
    session.seek(50.0 * 0.004);
    assert_eq!(session.frame().step, 50);
    do_it(&mut session, drag(0.6, 0.5));
    let edits: Vec<_> = session.script().iter().map(|e| (e.step, e.edit.clone())).collect();
    assert_eq!(edits, [(0, drag(0.55, 0.6)), (50, slide(2.5)), (50, drag(0.6, 0.5))]);
    assert_eq!(session.frames().len(), 51);
    same("what was before stays", &session.frames()[..50], &full.0[..50]);
    session.end_gesture();
    settle(&mut session);
    one_path(&session);
    session.undo().expect("all of it");
    same("undone", session.frames(), &full.0);
    assert_eq!(session.script(), full.1);
}

/// A target dragged before the first step outlives a change of parameters, in motion or at rest.
#[test]
fn a_drag_at_the_start_outlives_parameters() {
    let parameters =
        [gains(500.0, 45.0), Edit::plant("payload.mass", 0.05), set("limits.a1", "0.1,3"), set("gravity", "0,-9.81")];
    for parameter in parameters {
        // At once, in motion, and at rest.
        for ticks in [0, 30, 100_000] {
            let mut session = open(coarse());
            do_it(&mut session, drag(0.6, 0.6));
            session.end_gesture();
            session.tick(ticks);
            do_it(&mut session, parameter.clone());
            assert!(session.is_live());
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
    do_it(&mut session, Edit::plant("payload.mass", 0.3));
    session.end_gesture();
    settle(&mut session);
    do_it(&mut session, Edit::plant("payload.mass", 0.1));
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
    assert!((session.frame().tip - at).norm() < 1e-9);
    one_path(&session);
}

/// A new time while the motion runs is the motion's time.
#[test]
fn the_time_of_a_motion_can_be_set_while_it_runs() {
    let mut session = open(coarse());
    session.play();
    session.tick(100);
    do_it(&mut session, Edit::SetTime { time: 2.0 });
    assert!(session.is_moving());
    assert_eq!(session.length(), 2.0);
    settle(&mut session);
    assert!((session.frame().time - 2.0).abs() < 0.01, "{}", session.frame().time);
    one_path(&session);
}

/// A session saved before it has run covers its motion, with the time set by hand.
#[test]
fn a_session_saved_at_its_start_runs_to_the_end_of_its_motion() {
    let mut session = open(coarse());
    do_it(&mut session, Edit::SetTime { time: 1.6 });
    let frames = replayed(&session);
    assert_eq!(frames.len(), 401);
    assert_eq!(frames[400].phase, Phase::Rest);
    assert_eq!(frames[399].phase, Phase::Motion);
}

/// Another machine on the desk is one more thing to undo.
#[test]
fn switching_scenarios_is_undone() {
    let mut session = open(coarse());
    do_it(&mut session, drag(0.6, 0.6));
    session.end_gesture();
    settle(&mut session);
    let before = state(&session);
    session.switch(Scenario { step: 0.004, ..Scenario::builtin("case-1").expect("built in") }).expect("it can start");
    assert_eq!(session.scenario().name, "case-1");
    assert_eq!((session.frames().len(), session.script().len()), (1, 0));
    settle(&mut session);
    let after = state(&session);
    session.undo().expect("the scenario before");
    same("undone", session.frames(), &before.0);
    assert_eq!(session.scenario().name, "case-3");
    session.redo().expect("the other again");
    same("redone", session.frames(), &after.0);
    session.undo().expect("the scenario before");
    session.undo().expect("its drag");
    assert_eq!((session.frames().len(), session.script().len()), (1, 0));
    // What cannot start changes nothing.
    let before = state(&session);
    let mut never = scenario();
    never.task.to = [9.0, 9.0];
    assert!(session.switch(never).is_err());
    assert!(state(&session) == before);
}

/// Edits of a file need not be in order, and those beyond its duration never happen.
#[test]
fn edits_of_a_file_are_put_in_order() {
    let at = |step, edit| TimedEdit { step, edit };
    let edits = vec![at(120, slide(2.5)), at(40, drag(0.6, 0.6)), at(0, Edit::plant("payload.mass", 0.1))];
    let scrambled = Scenario { edits: edits.clone(), ..coarse() };
    let mut sorted = scrambled.clone();
    sorted.edits.sort_by_key(|e| e.step);
    let [one, two] = [&scrambled, &sorted].map(|s| {
        let mut frames = Vec::new();
        replay(s, |_, f| frames.push(*f)).expect("it can start");
        frames
    });
    same("scrambled", &one, &two);
    let mut session = open(scrambled);
    assert_eq!(session.script(), sorted.edits);
    same("opened", session.frames(), &one);
    assert_eq!(session.frame().step, 0, "shown from its start");
    session.play();
    session.tick(100_000);
    one_path(&session);
}

/// An edit that could never apply is refused, by its place in the file, in a replay and in a window alike.
#[test]
fn an_edit_after_the_end_is_refused() {
    let at = |step, edit| TimedEdit { step, edit };
    let late = Scenario { edits: vec![at(9000, slide(1.0)), at(40, drag(0.6, 0.6))], ..coarse() };
    for refusal in [replay(&late, |_, _| {}).expect_err("too late"), Session::open(late.clone()).expect_err("too late")]
    {
        let said = refusal.to_string();
        assert!(said.starts_with("the 1st [[edit]], slide b to 1.000 rad at step 9000: "), "{said}");
        assert!(said.contains("the run ends at step 250"), "{said}");
    }
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
    let Reach::Outside { nearest, mending_b, .. } = f.target.reach else { panic!("{:?}", f.target) };
    assert_eq!(f.target.at, target, "the handle stays under the pointer");
    assert!((f.tip - nearest).norm() < 1e-9, "the machine waits at the nearest point");
    let planes = session.run().planes().expect("three drives").clone();
    let loops = planes.boundary().turned(2.4);
    assert!(off_boundary(&loops, nearest) < 2e-5, "{:e} m off the boundary", off_boundary(&loops, nearest));
    // Connected along the boundary, nothing of it is nearer.
    assert!((nearest - target).norm() <= off_boundary(&loops, target) + 1e-5);
    still(&session);

    let b = mending_b.expect("some plane serves it");
    assert!((b - 2.4).abs() > 0.01);
    do_it(&mut session, slide(b));
    settle(&mut session);
    let f = session.frame();
    assert!((f.tip - target).norm() < 1e-6, "{:e} m off after mending", (f.tip - target).norm());
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
    assert!((end.target.at - end.tip).norm() < 1e-6, "the target goes with it");
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
    assert!((session.frame().tip - Vector::new(0.6, 0.7)).norm() < 1e-9);
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

/// No target, however far, and no slide, however long, breaks a frame.
#[test]
fn absurd_edits_leave_finite_frames() {
    for edit in [drag(1e6, -1e6), drag(-1e5, 0.0), drag(0.0, 0.0), slide(-900.0), slide(1e3)] {
        let mut session = open(coarse());
        do_it(&mut session, edit.clone());
        session.tick(150);
        for f in session.frames() {
            let finite = f.q.iter().chain(f.qdd.iter()).chain(f.torque.iter()).all(|x| x.is_finite());
            assert!(finite && f.b.is_finite() && f.tip.re.is_finite(), "{edit:?}: {f:?}");
        }
        one_path(&session);
    }
}

/// A scenario's own machine travels in its file, with every setting.
#[test]
fn an_inline_machine_is_saved_with_its_session() {
    let machine = builtin("nine-link").expect("built in").set("payload.mass", "0.05").expect("valid");
    let mut session = open(Scenario { machine, ..coarse() });
    do_it(&mut session, set("gravity", "0,-9.81"));
    do_it(&mut session, drag(0.55, 0.55));
    session.tick(60);
    one_path(&session);
}

/// In whatever order settings were made, the last word of each holds, and what stood between them need not be possible.
#[test]
fn the_order_of_settings_does_not_matter() {
    let task = |key: &str, value: &str| Edit::task(key, value);
    let to = |x: f64, y: f64| Edit::SetTask { change: [("to".to_owned(), vec![x, y].into())].into_iter().collect() };
    for [first, second, third] in [
        [set("drive.3.jerk_limit", "900"), task("law", "fastest-smooth"), set("drive.3.jerk_limit", "800")],
        [task("kind", "minimum-norm"), to(0.3, 1.0), task("kind", "least-reaction")],
        [set("limits.a1", "-1,3.2"), to(0.6, 0.4), set("limits.a1", "-1.2,3.2")],
    ] {
        let mut session = open(scenario());
        for edit in [first, second, third.clone()] {
            do_it(&mut session, edit);
            session.end_gesture();
        }
        assert!(session.script().iter().all(|e| e.step == 0));
        assert_eq!(session.script().last().map(|e| &e.edit), Some(&third));
        session.step_by(5);
        one_path(&session);
    }
}

/// What was set while the machine was led stays when a new path takes it back.
#[test]
fn settings_outlive_following() {
    let mut session = open(scenario());
    do_it(&mut session, drag(0.6, 0.7));
    session.tick(200);
    session.end_gesture();
    do_it(&mut session, Edit::plant("payload.mass", 0.3));
    session.end_gesture();
    session.tick(50);
    do_it(&mut session, Edit::task("shape", "line"));
    assert!(!session.is_live());
    assert_eq!(session.scenario().plant.payload.mass, 0.3);
    one_path(&session);
}

/// Tolerances are set, saved, taken back, and change no frame.
#[test]
fn tolerances_change_no_frame() {
    let mut session = Session::open(Scenario::builtin("case-1").expect("built in")).expect("it starts");
    session.seek(1.0);
    let before = session.frames().to_vec();
    let spread = toml::Value::Table(toml::Table::from_iter([("normal".into(), 0.001.into())]));
    let change = toml::Table::from_iter([("link.*.com".into(), spread), ("moment_limit".into(), 0.02.into())]);
    do_it(&mut session, Edit::SetTolerance { change: change.clone() });
    assert_eq!(session.frames(), &before[..]);
    let tolerance = &session.scenario().tolerance;
    assert_eq!((tolerance.moment_limit, tolerance.spreads.len()), (Some(0.02), 1));
    let saved = Scenario::parse(&session.to_scenario().to_toml(), "saved", None).expect("valid");
    assert_eq!(stillbase::session::settled(&saved).expect("set").0.tolerance, *tolerance);
    let wrong = Edit::SetTolerance { change: toml::Table::from_iter([("link.*.com".into(), "much".into())]) };
    assert!(session.apply(wrong).is_err());
    session.undo().expect("taken back");
    assert!(session.scenario().tolerance.is_empty());
    session.redo().expect("brought back");
    assert_eq!(session.scenario().tolerance.moment_limit, Some(0.02));
}

/// Limits of a joint within its turn, rad: wide ones and narrow ones.
fn limits() -> impl Strategy<Value = (usize, f64, f64)> {
    (1..3usize, 0.0..3.0f64, 0.05..3.0f64)
        .prop_map(|(i, from, width)| (i, from, (from + width).min(std::f64::consts::PI)))
}

fn limit((i, from, to): (usize, f64, f64)) -> Edit {
    Edit::SetMachine { key: format!("limits.a{i}"), value: format!("{from},{to}") }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, ..ProptestConfig::default() })]

    /// Joint limits always apply, at rest, under way and in the hand. A task that does not fit them waits: with the b
    /// that would do, without time, saved and opened as it is, refused headless, and whole again with wider limits.
    #[test]
    fn limits_always_apply(
        one in limits(),
        other in limits(),
        steps in 1..100u64,
        plays: bool,
        leads: bool,
    ) {
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
            prop_assert_eq!(session.frames(), &at[..], "time stands still");
            prop_assert!(session.frame().is_finite());
            prop_assert_eq!(session.apply(Edit::DragTarget { x: 0.5, y: 0.6 }), Err(waiting.why.clone()));
            prop_assert_eq!(replayed.err(), Some(waiting.why.clone()), "headless it is refused");
            let again = Session::open(Scenario::parse(&saved.to_toml(), "saved", None).expect("readable")).expect("it waits");
            prop_assert_eq!(again.run().waiting(), Some(&waiting));
            prop_assert_eq!(again.frames(), &at[..]);
        } else {
            let run = replayed.expect("what runs here runs headless");
            prop_assert_eq!(run.frame(), session.run().frame());
        }
        if session.run().waiting().is_some() || !plays {
            session.pause();
            session.undo().expect("taken back");
            session.undo().expect("taken back");
            prop_assert_eq!(session.to_scenario(), before.0);
            prop_assert!(session.frames() == &before.1[..], "the same frames");
        }
    }
}

/// Friction that no part of a step can follow.
fn blows_up(name: &str) -> Scenario {
    let mut scenario = Scenario::builtin(name).expect("built in");
    scenario.plant.friction.viscous = stillbase::simulation::plant::Each::All(1e4);
    scenario.step = 0.01;
    scenario
}

#[test]
fn a_run_that_blows_up_says_so_with_a_wheel_too() {
    for name in ["case-3", "wheel"] {
        let refusal = stillbase::session::replay(&blows_up(name), |_, _| {}).expect_err("it blows up");
        assert!(matches!(refusal, Refusal::Diverged { .. }), "{name}: {refusal}");
    }
}

#[test]
fn a_session_that_blew_up_opens_again() {
    for name in ["case-3", "wheel"] {
        let mut session = open(Scenario { step: 0.01, ..Scenario::builtin(name).expect("built in") });
        session.play();
        session.tick(20);
        let change = stillbase::settings::change::one("friction.viscous", 1e4);
        session.apply(Edit::SetPlant { change }).expect("within its range");
        session.end_gesture();
        session.tick(300);
        session.seek(1.0);
        session.step_by(50);
        let none = session.frames().iter().filter(|frame| !frame.is_finite()).count();
        assert_eq!(none, 1, "{name}: time stands still where there are no numbers");
        let again = open(session.to_scenario());
        assert!(again.frames().iter().all(|frame| frame.is_finite()));
        assert_eq!(again.frames().len() + 1, session.frames().len());
        // And what comes before can be taken back.
        session.undo().expect("taken back");
        assert!(session.frame().is_finite());
    }
}

#[test]
fn what_a_motion_is_planned_from_is_set_before_the_first_step() {
    let mut scenario = coarse();
    scenario.edits = vec![stillbase::session::TimedEdit { step: 100, edit: Edit::SetTime { time: 2.0 } }];
    let refusal = stillbase::session::replay(&scenario, |_, _| {}).expect_err("too late");
    assert!(refusal.to_string().contains("before the first step"), "{refusal}");
    let file = Scenario::parse(&scenario.to_toml(), "late.toml", None).expect_err("too late").to_string();
    assert!(file.contains("late.toml:") && file.contains("the 1st [[edit]]"), "{file}");
}
