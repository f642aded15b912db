//! Tests of `src/session`: scenarios, edits, undo, replay and the verdict.

mod afloat;
mod any_drives;
mod around;
mod assembly;
mod assembly_bases;
mod assembly_words;
mod bounds;
mod branches;
mod cases;
mod command_line;
mod design;
mod events;
mod faults;
mod hand;
mod hand_over;
mod led_blocks;
mod limits;
mod machine_file;
mod notes;
mod parts;
mod proposals;
mod replay;
mod settings;
mod shared_task;
mod sitting;
mod sketch;
mod smooth;
mod tip_path;
mod undo;
mod verdict;
mod ways;

use stillbase::session::scenario::Scenario;
use stillbase::session::{Edit, Session, TimedEdit, replay};
use stillbase::simulation::frame::Frame;

fn gains(kp: f64, kd: f64) -> Edit {
    Edit::of("control", toml::Table::from_iter([("kp".into(), kp.into()), ("kd".into(), kd.into())]))
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
    // As floating-point numbers, in which machines hold them.
    let numbers: Option<Vec<f64>> = value.split(',').map(|x| x.parse().ok()).collect();
    match numbers.as_deref() {
        Some(&[one]) => Edit::set(key, one),
        Some(several) => Edit::set(key, several.to_vec()),
        None => Edit::set(key, value),
    }
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
fn same<'a>(what: &str, got: impl IntoIterator<Item = &'a Frame>, want: impl IntoIterator<Item = &'a Frame>) {
    let (got, want): (Vec<&Frame>, Vec<&Frame>) = (got.into_iter().collect(), want.into_iter().collect());
    let first = got.iter().zip(&want).position(|(a, b)| a != b);
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
    same("opened", again.frames().iter().take(to as usize), session.frames());
    assert_eq!(again.script(), session.script());
}

/// A session as its window sees it: frames, script, parameters.
fn state(session: &Session) -> (Vec<Frame>, Vec<TimedEdit>, Scenario, Frame) {
    (session.frames().to_vec(), session.script().to_vec(), session.to_scenario(), *session.frame())
}
