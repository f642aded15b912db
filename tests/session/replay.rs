//! Whatever is done to a session, its script replayed without a window gives the very same frames.

use stillbase::mechanics::machine::builtin;
use stillbase::session::scenario::Scenario;
use stillbase::session::{Edit, Refusal, Session, TimedEdit, replay};
use stillbase::simulation::frame::Phase;

use super::{coarse, do_it, drag, gains, one_path, open, replayed, same, scenario, set, settle, slide, state};

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
    do_it(&mut session, Edit::set("task.time", 0.8));
    do_it(&mut session, Edit::PoseB { b: 2.5 });
    session.end_gesture();
    session.play();
    session.tick(37);
    for i in 0..12 {
        do_it(&mut session, drag(0.50 + 0.015 * f64::from(i), 0.55 - 0.01 * f64::from(i)));
        session.tick([1, 0, 4, 0, 0, 2, 7, 1, 0, 3, 3, 5][i as usize]);
    }
    session.end_gesture();
    do_it(&mut session, Edit::set("plant.payload.mass", 0.2));
    session.tick(11);
    do_it(&mut session, gains(300.0, 30.0));
    session.tick(2);
    do_it(&mut session, set("limits.a1", "0.2,2.9"));
    session.tick(13);
    do_it(&mut session, slide(2.7));
    session.tick(40);
    do_it(&mut session, set("gravity", "0,-9.81"));
    do_it(&mut session, Edit::set("compare_b", 4.0));
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

#[test]
fn refused_edits_change_nothing() {
    let wrong = [
        drag(f64::NAN, 0.5),
        drag(0.5, f64::INFINITY),
        slide(f64::NAN),
        Edit::PoseB { b: f64::INFINITY },
        Edit::set("plant.payload.mass", -0.1),
        Edit::set("plant.payload.mass", f64::NAN),
        gains(-1.0, 10.0),
        gains(100.0, f64::NAN),
        Edit::set("task.time", 0.0),
        Edit::set("task.time", f64::NAN),
        Edit::set("compare_b", f64::NAN),
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

/// A session saved before it has run covers its motion, with the time set by hand.
#[test]
fn a_session_saved_at_its_start_runs_to_the_end_of_its_motion() {
    let mut session = open(coarse());
    do_it(&mut session, Edit::set("task.time", 1.6));
    let frames = replayed(&session);
    assert_eq!(frames.len(), 401);
    assert_eq!(frames[400].phase, Phase::Rest);
    assert_eq!(frames[399].phase, Phase::Motion);
}

/// Edits of a file need not be in order, and those beyond its duration never happen.
#[test]
fn edits_of_a_file_are_put_in_order() {
    let at = |step, edit| TimedEdit { step, edit };
    let edits = vec![at(120, slide(2.5)), at(40, drag(0.6, 0.6)), at(0, Edit::set("plant.payload.mass", 0.1))];
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
    assert_eq!(*session.script(), sorted.edits);
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

#[test]
fn what_a_motion_is_planned_from_is_set_before_the_first_step() {
    let mut scenario = coarse();
    scenario.edits = vec![stillbase::session::TimedEdit { step: 100, edit: Edit::set("task.time", 2.0) }];
    let refusal = stillbase::session::replay(&scenario, |_, _| {}).expect_err("too late");
    assert!(refusal.to_string().contains("before the first step"), "{refusal}");
    let file = Scenario::parse(&scenario.to_toml(), "late.toml", None).expect_err("too late").to_string();
    assert!(file.contains("late.toml:") && file.contains("the 1st [[edit]]"), "{file}");
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
            assert!(finite && f.b.is_finite() && f.end_effector.re.is_finite(), "{edit:?}: {f:?}");
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
    let task = |key: &str, value: &str| Edit::set(&format!("task.{key}"), value);
    let to = |x: f64, y: f64| Edit::of("task", [("to".to_owned(), vec![x, y].into())].into_iter().collect());
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

/// Tolerances are set, saved, taken back, and change no frame.
#[test]
fn tolerances_change_no_frame() {
    let mut session = Session::open(Scenario::builtin("case-1").expect("built in")).expect("it starts");
    session.seek(1.0);
    let before = session.frames().to_vec();
    let spread = toml::Value::Table(toml::Table::from_iter([("normal".into(), 0.001.into())]));
    let change = toml::Table::from_iter([("link.*.com".into(), spread), ("moment_limit".into(), 0.02.into())]);
    do_it(&mut session, Edit::of("tolerance", change.clone()));
    assert_eq!(session.frames().to_vec(), before);
    let tolerance = &session.scenario().tolerance;
    assert_eq!((tolerance.moment_limit, tolerance.spreads.len()), (Some(0.02), 1));
    let saved = Scenario::parse(&session.to_scenario().to_toml(), "saved", None).expect("valid");
    assert_eq!(stillbase::session::with_start_edits(&saved).expect("set").0.tolerance, *tolerance);
    let wrong = Edit::of("tolerance", toml::Table::from_iter([("link.*.com".into(), "much".into())]));
    assert!(session.apply(wrong).is_err());
    session.undo().expect("taken back");
    assert!(session.scenario().tolerance.is_empty());
    session.redo().expect("brought back");
    assert_eq!(session.scenario().tolerance.moment_limit, Some(0.02));
}

/// Friction that no part of a step can follow.
fn blows_up(name: &str) -> Scenario {
    let mut scenario = Scenario::builtin(name).expect("built in");
    scenario.plant.friction.viscous = stillbase::simulation::plant::DriveValues::All(1e4);
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
        let change = stillbase::settings::change::single_change("friction.viscous", 1e4);
        session.apply(Edit::of("plant", change)).expect("within its range");
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
