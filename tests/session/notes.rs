//! Notes: kept beside a run through undo, saving and reopening; and what is refused.

use stillbase::session::scenario::{MAX_NOTE, MAX_NOTES, Note, NoteTime, PathPoint, Scenario, SnapPoint};
use stillbase::session::{Edit, Session};

use super::{coarse, do_it, drag, open, same};

fn note(text: &str, point: Option<SnapPoint>, time: NoteTime) -> Note {
    Note { text: text.into(), point, time }
}

fn pin() -> Option<SnapPoint> {
    Some(SnapPoint::Pin(vec!["1".into(), "5".into()]))
}

/// One note of each kind of point and time.
fn every_kind() -> Vec<Note> {
    let points = [
        None,
        Some(SnapPoint::EndEffector),
        Some(SnapPoint::Target),
        Some(SnapPoint::CentreOfMass),
        Some(SnapPoint::BasePin),
        pin(),
        Some(SnapPoint::PathPoint(PathPoint::Start)),
        Some(SnapPoint::PathPoint(PathPoint::Via(2))),
        Some(SnapPoint::PathPoint(PathPoint::End)),
        Some(SnapPoint::Place([0.25, -0.1])),
    ];
    let times = [NoteTime::At(0.4), NoteTime::Always, NoteTime::Between([0.2, 0.6])];
    let text = |i: usize| format!("note {i}: \"±0.1 m\", β");
    let kinds = points.into_iter().enumerate();
    kinds.map(|(i, point)| note(&text(i), point, times[i % times.len()])).collect()
}

/// Saved, read and opened again.
fn again(session: &Session) -> Session {
    let saved = session.to_scenario();
    let read = Scenario::parse(&saved.to_toml(), "saved", None).expect("what was saved is read");
    assert_eq!(read, saved);
    Session::open(read).expect("it opens")
}

#[test]
fn notes_are_undone_saved_and_found_again() {
    let mut session = open(coarse());
    session.tick(40);
    session.pause();
    let frames = session.frames().to_vec();
    for note in every_kind() {
        session.write_note(None, note).expect("room");
    }
    assert_eq!(session.notes(), every_kind());
    assert_eq!(again(&session).notes(), every_kind());
    let first = note("  here ", pin(), NoteTime::At(0.1));
    assert_eq!(session.write_note(Some(0), first.clone()), Ok(Some("change note: here".into())));
    assert_eq!(session.notes()[0], Note { text: "here".into(), ..first.clone() }, "spaces around it are dropped");
    assert_eq!(session.write_note(Some(0), first), Ok(None), "it is so already");
    let count = session.notes().len();
    assert_eq!(session.remove_note(count), None, "there is none");
    assert_eq!(session.remove_note(0), Some("remove note: here".into()));
    assert_eq!(session.notes(), &every_kind()[1..]);
    session.undo().expect("the removal");
    session.undo().expect("the change");
    assert_eq!(session.notes(), every_kind());
    session.redo().expect("the change");
    assert_eq!(session.notes()[0].text, "here");
    same("the run stays", session.frames(), &frames);
    // With an edit between, each change takes back its own.
    session.apply(Edit::set("plant.payload.mass", 0.2)).expect("a payload");
    session.end_gesture();
    session.bookmark(0.1, "mark").expect("room");
    session.remove_note(0);
    session.undo().expect("the note");
    assert_eq!((session.notes().len(), session.bookmarks().len()), (count, 1));
    session.undo().expect("the bookmark");
    assert_eq!((session.notes().len(), session.bookmarks().len()), (count, 0));
    while session.undo_title().is_some() {
        session.undo().expect("it was so before");
    }
    assert!(session.notes().is_empty());
}

/// The course of the run that is left keeps no notes of its own: those of the session stay.
#[test]
fn notes_stay_when_the_run_takes_another_course() {
    let mut session = open(coarse());
    do_it(&mut session, drag(0.52, 0.62));
    session.end_gesture();
    session.tick(60);
    session.pause();
    session.step_by(-40);
    session.write_note(None, note("it parts here", None, NoteTime::At(0.08))).expect("room");
    session.play();
    do_it(&mut session, drag(0.45, 0.7));
    session.end_gesture();
    session.tick(20);
    assert_eq!(session.branch_count(), 1);
    session.switch_branch_while(0, &mut |_| true).expect("it is shown");
    assert_eq!(session.notes().len(), 1);
    assert_eq!(again(&session).notes(), session.notes());
}

#[test]
fn a_note_is_shown_at_its_time() {
    let shown = |time: NoteTime, now: f64| note("a", pin(), time).is_shown_at(now);
    assert!(shown(NoteTime::Always, 0.0) && shown(NoteTime::Always, 9.0));
    assert!(shown(NoteTime::At(0.4), 0.4) && shown(NoteTime::At(0.4), 0.45) && !shown(NoteTime::At(0.4), 0.46));
    let between = NoteTime::Between([0.2, 0.6]);
    assert!([0.2, 0.4, 0.6].into_iter().all(|now| shown(between, now)));
    assert!(!shown(between, 0.19) && !shown(between, 0.61));
}

/// What is refused is no change.
#[test]
fn a_wrong_note_is_refused_and_changes_nothing() {
    let mut session = open(coarse());
    session.write_note(None, note("kept", pin(), NoteTime::Always)).expect("room");
    let wrong = [
        (note("   ", pin(), NoteTime::Always), "text has 0 characters: want 1 to 120"),
        (note(&"a".repeat(MAX_NOTE + 1), pin(), NoteTime::Always), "text has 121 characters"),
        (note("bell\u{7}", pin(), NoteTime::Always), "the control character U+0007: want printable"),
        (note("two\nlines", pin(), NoteTime::Always), "the control character U+000A"),
        (note("turned \u{202e}", pin(), NoteTime::Always), "the control character U+202E"),
        (note("nowhere", None, NoteTime::Always), "want on, pin or at, or a time"),
        (note("early", None, NoteTime::At(-0.1)), "time is -0.1: want a number from 0"),
        (note("backwards", None, NoteTime::Between([0.5, 0.4])), "until is 0.4: want at least time, 0.5 s"),
        (note("never", None, NoteTime::Between([0.5, f64::NAN])), "until is not a number"),
        (note("far", Some(SnapPoint::Place([1e9, 0.0])), NoteTime::Always), "at is 1e9"),
        (note("no", Some(SnapPoint::Pin(vec!["1".into(), "99".into()])), NoteTime::Always), "names link \"99\""),
        (note("no", Some(SnapPoint::Pin(Vec::new())), NoteTime::Always), "pin names 0 links"),
    ];
    for (wrong, part) in wrong {
        for known in [None, Some(0)] {
            let why = session.write_note(known, wrong.clone()).expect_err(part);
            assert!(why.contains(part), "{part} in {why}");
        }
    }
    assert_eq!((session.notes().len(), session.undo_count()), (1, 1));
    for i in 1..MAX_NOTES {
        session.write_note(None, note(&format!("note {i}"), pin(), NoteTime::Always)).expect("room");
    }
    let why = session.write_note(None, note("more", pin(), NoteTime::Always)).expect_err("one too many");
    assert!(why.contains("there are 100 notes: remove one first"), "{why}");
    assert!(session.write_note(Some(3), note("other", pin(), NoteTime::Always)).is_ok(), "a change needs no room");
    assert_eq!(again(&session).notes().len(), MAX_NOTES);
}

#[test]
fn a_file_with_a_wrong_note_is_refused() {
    let text = open(coarse()).to_scenario().to_toml();
    let good = "[[note]]\ntext = \"a\"\non = \"A\"\n";
    for (more, part) in [
        ("[[note]]\ntext = \"\"\non = \"A\"\n".to_owned(), "note 1: text has 0 characters"),
        (
            format!("{good}[[note]]\ntext = \"a\\u0007\"\non = \"A\"\n"),
            "note 2: text holds the control character U+0007",
        ),
        (format!("{good}[[note]]\ntext = \"a\"\n"), "note 2: a note sticks to something"),
        (
            "[[note]]\ntext = \"a\"\non = \"elbow\"\n".into(),
            "on is \"elbow\": want end effector, target, centre of mass",
        ),
        ("[[note]]\ntext = \"a\"\non = \"0\"\n".into(), "on is \"0\""),
        ("[[note]]\ntext = \"a\"\non = \"A\"\nat = [0.0, 0.0]\n".into(), "want only one of on, pin and at"),
        ("[[note]]\ntext = \"a\"\npin = [\"1\", \"12\"]\n".into(), "pin names link \"12\": this machine has 1, 2, 3"),
        ("[[note]]\ntext = \"a\"\nat = [0.0, nan]\n".into(), "note 1: at is not a number"),
        ("[[note]]\ntext = \"a\"\nuntil = 1.0\n".into(), "until stands without time"),
        ("[[note]]\ntext = \"a\"\ntime = inf\n".into(), "note 1: time is"),
        ("[[note]]\ntext = \"a\"\ntime = 0.1\nname = \"b\"\n".into(), "name"),
        ("[[note]]\non = \"A\"\n".into(), "text"),
        (good.repeat(MAX_NOTES + 1), "want at most 100 notes"),
    ] {
        let error = Scenario::parse(&format!("{text}\n{more}"), "bad", None).expect_err(&more).to_string();
        assert!(error.contains(part) && error.contains("bad"), "{part} in {error}");
    }
    let line = text.lines().count() + 2;
    let wrong = format!("{text}\n[[note]]\ntext = \"a\"\n");
    let error = Scenario::parse(&wrong, "bad", None).expect_err("it sticks to nothing").to_string();
    assert!(error.starts_with(&format!("bad:{line}:")), "{error}");
}
