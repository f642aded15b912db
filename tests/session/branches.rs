//! What is kept beside a run: bookmarks and branches, through undo, saving and reopening.

use stillbase::session::scenario::{Bookmark, MAX_BOOKMARKS, MAX_BRANCHES, Scenario};
use stillbase::session::{Edit, Session, replay};

use super::{coarse, do_it, drag, open, same, set, slide};

fn again(session: &Session) -> Session {
    let saved = session.to_scenario();
    let read = Scenario::parse(&saved.to_toml(), "saved", None).expect("what was saved is read");
    assert_eq!(read, saved);
    Session::open(read).expect("it opens")
}

/// Plays to the end, goes back and drags the target elsewhere.
fn forked() -> Session {
    let mut session = open(coarse());
    do_it(&mut session, drag(0.52, 0.62));
    session.end_gesture();
    session.tick(60);
    session.pause();
    session.step_by(-40);
    session.play();
    session.pause();
    do_it(&mut session, drag(0.45, 0.7));
    session.end_gesture();
    session.tick(50);
    session.pause();
    session
}

/// Undone while time runs, edits leave their branch; the bookmark before them takes only itself back.
#[test]
fn undo_of_a_bookmark_leaves_branches_alone() {
    let mut session = open(coarse());
    session.bookmark(0.0, "start").expect("room");
    do_it(&mut session, drag(0.52, 0.62));
    session.end_gesture();
    session.tick(60);
    session.pause();
    session.step_by(-40);
    session.play();
    do_it(&mut session, drag(0.45, 0.7));
    session.end_gesture();
    session.tick(50);
    assert_eq!((session.branch_count(), session.undo_count()), (1, 3));
    session.undo().expect("appended");
    session.undo().expect("appended");
    assert_eq!((session.branch_count(), session.bookmarks().len()), (1, 1));
    session.undo().expect("the bookmark");
    assert_eq!((session.branch_count(), session.bookmarks().len()), (1, 0));
    session.redo().expect("the bookmark again");
    assert_eq!((session.branch_count(), session.bookmarks().len()), (1, 1));
}

#[test]
fn bookmarks_are_undone_saved_and_found_again() {
    let mut session = open(coarse());
    session.seek(0.3);
    assert_eq!(session.bookmark(0.3, " here "), Ok(Some("here at 0.300 s".into())));
    session.seek(0.1);
    let name = session.free_name();
    session.bookmark(0.1, &name).expect("room");
    let marks = |session: &Session| session.bookmarks().to_vec();
    let mark = |time: f64, name: &str| Bookmark { time, name: name.into() };
    assert_eq!(marks(&session), [mark(0.1, "bookmark 1"), mark(0.3, "here")]);
    let frames = session.frames().to_vec();
    session.bookmark(0.3, "the worst").expect("room");
    session.bookmark(0.1, "").expect("room");
    assert_eq!(marks(&session), [mark(0.3, "the worst")]);
    assert_eq!(session.bookmark(0.2, ""), Ok(None), "there is none to take away");
    let titles: Vec<String> = session.history().map(String::from).collect();
    assert_eq!(titles, ["here at 0.300 s", "bookmark 1 at 0.100 s", "rename here to the worst", "remove bookmark 1"]);
    assert_eq!(marks(&again(&session)), marks(&session));
    for _ in 0..2 {
        session.undo().expect("nothing is made again");
    }
    assert_eq!(marks(&session), [mark(0.1, "bookmark 1"), mark(0.3, "here")]);
    session.redo().expect("again");
    assert_eq!(marks(&session), [mark(0.1, "bookmark 1"), mark(0.3, "the worst")]);
    same("the run stays", session.frames(), &frames);
    // With an edit between, each change takes back its own.
    session.apply(Edit::set("plant.payload.mass", 0.2)).expect("a payload");
    session.end_gesture();
    session.bookmark(0.2, "later").expect("room");
    for _ in 0..5 {
        session.undo().expect("it was so before");
    }
    assert!(session.bookmarks().is_empty() && session.script().is_empty() && session.undo_title().is_none());
    for _ in 0..5 {
        session.redo().expect("it was so after");
    }
    assert_eq!(marks(&session).len(), 3);
    assert_eq!(session.scenario().plant.payload.mass, 0.2);
}

/// Going on from an earlier moment keeps what is left as a branch, which can be shown, and which is undone, saved and
/// opened again with the session.
#[test]
fn what_is_left_is_a_branch() {
    let mut session = forked();
    let [fork] = &session.forks()[..] else { panic!("one branch: {:?}", session.forks()) };
    let dt = session.scenario().step;
    assert_eq!(fork.title, "drag target to 0.520, 0.620 m at 0.000 s, then left alone");
    assert!((fork.from - 20.0 * dt).abs() < 1e-9 && (fork.to - 60.0 * dt).abs() < 1e-9, "{fork:?}");
    let (left, here) = (session.branch(0).expect("a branch"), session.frames().to_vec());
    let mut frames = Vec::new();
    replay(&left, |_, frame| frames.push(*frame)).expect("it runs again");
    let undone = session.undo_count();
    session.switch_branch_while(0, &mut |_| true).expect("it is made again");
    same("the branch", session.frames(), &frames);
    assert_eq!(session.script().len(), 1);
    let back = session.forks()[0].clone();
    assert!(back.title.starts_with("drag target to 0.450, 0.700 m"), "{back:?}");
    let mut opened = again(&session);
    assert_eq!(opened.forks(), session.forks());
    for session in [&mut session, &mut opened] {
        session.switch_branch_while(0, &mut |_| true).expect("back");
        same("as it was", session.frames(), &here);
        assert_eq!(session.branch_count(), 1);
    }
    session.undo().expect("to the branch");
    same("undone", session.frames(), &frames);
    session.undo().expect("from the branch");
    assert_eq!(session.undo_count(), undone);
    same("as it was", session.frames(), &here);
    session.undo().expect("before the fork");
    assert_eq!((session.branch_count(), session.frames().len()), (0, 61), "nothing had been left then");
    session.redo().expect("the fork again");
    assert_eq!(session.branch_count(), 1);
    assert!(session.drop_branch(0).is_some_and(|said| said.starts_with("remove branch")));
    assert_eq!(session.branch_count(), 0);
    session.undo().expect("it is back");
    assert_eq!(session.branch_count(), 1);
    assert_eq!(session.drop_branch(7), None);
}

/// A planned motion that was played in part is kept whole, and the way back to the path keeps what was led by hand.
#[test]
fn plans_and_hands_are_left_whole() {
    let mut session = open(coarse());
    session.seek(0.5);
    session.seek(0.2);
    do_it(&mut session, drag(0.52, 0.62));
    session.end_gesture();
    session.tick(30);
    session.pause();
    let [plan] = &session.forks()[..] else { panic!("{:?}", session.forks()) };
    assert_eq!(plan.title, "as planned");
    assert!(
        (plan.from - 0.2).abs() < 1e-9 && (plan.to - session.run().plan().motion.duration()).abs() < 0.02,
        "{plan:?}"
    );
    session.apply(Edit::of("task", toml::Table::new())).expect("back to the path");
    assert_eq!(session.branch_count(), 2);
    assert!(session.forks()[1].title.starts_with("drag target"), "{:?}", session.forks());
}

/// A branch that does what the run does diverges from it nowhere before its end, however far the run has come.
#[test]
fn an_equal_branch_diverges_nowhere() {
    let mut session = open(coarse());
    session.play();
    session.tick(1);
    session.step_by(-1);
    for edit in [set("length.l1", "0.55"), slide(1.8), Edit::of("task", toml::Table::new())] {
        do_it(&mut session, edit);
    }
    let forks = session.forks();
    assert_eq!((forks.len(), forks[0].title.as_str()), (2, "as planned"));
    assert_eq!(forks[0].from, forks[0].to);
    session.tick(20);
    assert_eq!(session.forks(), forks);
    assert_eq!(again(&session).forks(), forks);
}

/// What was led by hand is kept where another path takes its place, once for each gesture; undo brings it back.
#[test]
fn another_path_keeps_what_was_led_by_hand() {
    let task = |keys: &str| Edit::of("task", toml::from_str(keys).expect("keys"));
    for keys in ["to = [0.54, 0.88]", "from = [0.5, 0.52]", "b = 2.45"] {
        let mut session = open(coarse());
        do_it(&mut session, drag(0.52, 0.62));
        session.end_gesture();
        session.tick(30);
        do_it(&mut session, Edit::SlideB { b: 2.5 });
        session.end_gesture();
        session.tick(30);
        session.pause();
        let led = session.frames().to_vec();
        session.apply(task(keys)).expect("another path");
        session.apply(task(keys)).expect("the same gesture");
        session.end_gesture();
        assert!(!session.is_dragged());
        let [fork] = &session.forks()[..] else { panic!("{keys}: {:?}", session.forks()) };
        assert!(fork.title.starts_with("drag target to 0.520, 0.620 m"), "{fork:?}");
        session.apply(task("time = 1.2")).expect("what is not led leaves nothing");
        session.end_gesture();
        assert_eq!((session.branch_count(), session.branch_events()), (1, (1, None)));
        session.undo().expect("the time");
        session.switch_branch_while(0, &mut |_| true).expect("it is made again");
        same(keys, session.frames(), &led);
        session.undo().expect("from the branch");
        session.undo().expect("the path");
        same("undone", session.frames(), &led);
        assert_eq!(session.branch_count(), 0);
    }
}

/// One more bookmark than there may be is refused, and nothing has changed.
#[test]
fn a_bookmark_too_many_is_refused() {
    let mut session = open(coarse());
    for i in 0..MAX_BOOKMARKS {
        session.bookmark(0.01 * i as f64, &format!("mark {i}")).expect("room");
    }
    let undone = session.undo_count();
    let why = session.bookmark(9.0, "more").expect_err("one too many");
    assert!(why.contains("take one away"), "{why}");
    assert_eq!((session.bookmarks().len(), session.undo_count()), (MAX_BOOKMARKS, undone));
}

#[test]
fn the_oldest_branch_goes_and_equal_ones_are_one() {
    let mut session = open(coarse());
    session.tick(40);
    for i in 0..MAX_BRANCHES + 3 {
        do_it(&mut session, drag(0.5 + 0.005 * i as f64, 0.6));
        session.end_gesture();
        session.tick(20);
        session.pause();
        session.step_by(-10);
        let count = session.branch_count();
        assert_eq!(count, i.min(MAX_BRANCHES));
    }
    let forks = session.forks();
    for (i, fork) in forks.iter().enumerate() {
        assert!(fork.title.starts_with("drag target to 0."), "{fork:?}");
        assert!(forks[..i].iter().all(|other| other.title != fork.title), "{forks:?}");
    }
    let (left, gone) = session.branch_events();
    assert_eq!(left as usize, MAX_BRANCHES + 2, "each is counted");
    assert!(gone.is_some_and(|title| title.starts_with("drag target to 0.50")), "the one that went is named: {gone:?}");
    let known = session.branch_count();
    session.undo().expect("one back");
    assert!(session.branch_count() <= known);
}

#[test]
fn what_cannot_be_kept_is_refused() {
    let text = open(coarse()).to_scenario().to_toml();
    for (more, part) in [
        ("[[bookmark]]\ntime = -1.0\nname = \"a\"\n", "bookmark 1: time is -1"),
        (
            "[[bookmark]]\ntime = 0.0\nname = \"a\"\n[[bookmark]]\ntime = nan\nname = \"a\"\n",
            "bookmark 2: time is not a number",
        ),
        ("[[bookmark]]\ntime = 1.0\nname = \" \"\n", "bookmark 1: name has 1 characters"),
        ("[[bookmark]]\ntime = 1.0\nname = \"a\"\nnotes = 1\n", "notes"),
        ("[[branch]]\nduration = -1.0\n", "branch 1: duration is -1"),
        ("[[branch]]\nduration = 1.0\n[[branch.edit]]\ndo = \"jump\"\nstep = 3\n", "branch 1: edit 1:"),
        ("[[branch]]\nduration = 1.0\n[[branch.edit]]\ndo = \"slide-b\"\nb = 1e9\nstep = 3\n", "branch 1: edit 1:"),
    ] {
        let error = Scenario::parse(&format!("{text}\n{more}"), "bad", None).expect_err(more).to_string();
        assert!(error.contains(part), "{part} in {error}");
    }
}
