//! Undo and redo: of every kind of edit, at rest and in motion.

use stillbase::mechanics::planar::Vector;
use stillbase::session::scenario::{Scenario, Task};
use stillbase::session::{Edit, TimedEdit};

use super::{coarse, do_it, drag, gains, one_path, open, same, scenario, set, settle, slide, state};

/// History says which points of the path were moved, from where and to where, a drag as one move.
#[test]
fn history_says_which_points_moved() {
    let mut session = open(scenario());
    let task = |session: &stillbase::session::Session| session.scenario().task.clone();
    let mut said = Vec::new();
    for change in [
        |task: &Task| task.moving(1, Vector::new(0.56, 0.9)),
        |task: &Task| task.adding(Vector::new(0.58, 0.7)),
        |task: &Task| task.advancing(1),
        |task: &Task| task.removing(0),
        |task: &Task| task.moving(0, Vector::new(0.5, 0.52)),
    ] {
        let change = change(&task(&session)).expect("points");
        do_it(&mut session, Edit::of("task", change));
        session.end_gesture();
        said.push(session.undo_title().expect("done").to_owned());
    }
    assert_eq!(
        said,
        [
            "move B from 0.550, 0.900 to 0.560, 0.900 m",
            "add point 1 at 0.580, 0.700 m",
            "visit 1 before A",
            "leave out point A at 0.580, 0.700 m",
            "move A from 0.500, 0.500 to 0.500, 0.520 m",
        ]
    );
    for x in [0.51, 0.52, 0.53] {
        let change = task(&session).moving(0, Vector::new(x, 0.52)).expect("points");
        do_it(&mut session, Edit::of("task", change));
    }
    assert_eq!(session.undo_title(), Some("move A from 0.500, 0.520 to 0.530, 0.520 m"));
}

/// Frames that are not there yet do not appear, those that are stay: undo and redo at rest are inverse to each other.
#[test]
fn undo_at_rest_restores_and_redo_brings_back() {
    let mut session = open(coarse());
    settle(&mut session);
    let edits = [
        Edit::set("plant.payload.mass", 0.3),
        gains(900.0, 60.0),
        set("limits.a2", "0.3,3"),
        drag(0.6, 0.6),
        Edit::set("plant.payload.mass", 0.1),
        Edit::PoseB { b: 2.3 },
        slide(2.5),
        Edit::set("compare_b", "default"),
        Edit::set("task.time", 2.0),
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
        assert_eq!(*session.script(), want.1, "{edit:?}");
        assert!(!session.is_moving(), "time stands after {edit:?} is taken back");
    }
    assert_eq!(session.undo_title(), None);
    for (edit, want) in edits.iter().zip(&states[1..]) {
        assert_eq!(session.redo_title(), Some(edit.title().as_str()));
        session.redo().expect("it was so before");
        same(&edit.title(), session.frames(), &want.0[..session.frames().len()]);
        assert_eq!(*session.script(), want.1, "{edit:?}");
    }
    same("all brought back", session.frames(), &states[edits.len()].0);
    assert_eq!(session.redo_title(), None);
}

/// In motion nothing jumps: undo sends the machine back, as one more edit at the present step.
#[test]
fn undo_in_motion_appends_the_inverse() {
    let pairs = [
        (Edit::set("plant.payload.mass", 0.3), Edit::set("plant.payload", "default")),
        (gains(900.0, 60.0), gains(400.0, 40.0)),
        (set("limits.a2", "0.3,3"), set("limits.a2", "0,3.141592653589793")),
        (slide(2.5), slide(2.4)),
        (Edit::set("compare_b", "default"), Edit::set("compare_b", 5.0)),
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
        same("what was stays", session.frames().iter().take(15), &before[..15]);
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
    for edit in [Edit::PoseB { b: 2.5 }, Edit::set("task.time", 1.4)] {
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
        same(&edit.title(), session.frames().iter().take(61), &plain);
        session.tick(20);
        session.redo().expect("can be brought back");
        assert!(session.is_moving() && session.frames().len() == 101);
        same(&edit.title(), session.frames().iter().take(61), &edited);
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
    assert!((session.frame().end_effector - Vector::new(0.55, 0.6)).norm() < 1e-9);
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
    let script = session.script().to_vec();
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
    same("what was before stays", session.frames().iter().take(50), &full.0[..50]);
    session.end_gesture();
    settle(&mut session);
    one_path(&session);
    session.undo().expect("all of it");
    same("undone", session.frames(), &full.0);
    assert_eq!(*session.script(), full.1);
}

/// Another machine in the window is one more thing to undo.
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

/// A change of many settings, as a machine that is cut, is told by its lists and the number of the others.
#[test]
fn a_change_of_many_settings_has_a_short_title() {
    let numbers = (1..=9).map(|link| format!("{link} = {{ mass = 0.5, com = 0.1 }}")).collect::<Vec<_>>().join(", ");
    let text = format!(
        "link = {{ {numbers} }}\ncounterweight = [{{ link = \"1\", mass = 0.5, at = -0.1 }}]\n\
         lump = [{{ link = \"1\", mass = 0.5, at = 0.1 }}]\n"
    );
    let edit = Edit::Set { change: text.parse().expect("TOML") };
    let title = edit.title();
    assert!(title.starts_with("set counterweights to 0.50 kg on 1 link, one lump, "), "{title}");
    assert!(title.ends_with(" and 17 more") && title.len() < 100, "{title}");
}
