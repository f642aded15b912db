//! What happens in a run, in words.

use stillbase::query::{Queries, answer_sequence};
use stillbase::session::events::{Event, EventKind, EventLog, gestures};
use stillbase::session::scenario::Scenario;
use stillbase::session::{Edit, Run, Session, TimedEdit, replay};
use stillbase::simulation::frame::Frame;

use super::{coarse, do_it, drag, open, settle, slide};

/// What its frames tell, read afresh.
fn afresh(session: &Session) -> EventLog {
    answer_sequence(&(session.scenario().step, session.machines().clone()), session.frames())
}

fn watched(session: &Session) -> Vec<Event> {
    afresh(session).events().to_vec()
}

fn told(events: &[Event]) -> Vec<&str> {
    events.iter().map(|event| event.words.as_str()).collect()
}

/// A reactionless motion is quiet; b that turns is felt, from its first step until it is at rest again.
#[test]
fn the_base_begins_and_ceases_to_feel_the_arm() {
    let mut session = open(coarse());
    settle(&mut session);
    assert_eq!(told(&watched(&session)), ["end of motion"]);
    session.tick(20);
    do_it(&mut session, slide(2.5));
    session.end_gesture();
    settle(&mut session);
    do_it(&mut session, slide(2.4));
    session.end_gesture();
    settle(&mut session);
    session.tick(40);
    let events = watched(&session);
    let of = |words: &str| events.iter().filter(|event| event.words == words).map(|e| e.step).collect::<Vec<_>>();
    let (begins, again) = (of("the base begins to feel the arm"), of("the base feels the arm again"));
    let quiet = of("the base feels nothing again");
    assert!(begins.len() == 1 && again.len() == 1 && quiet.len() == 2, "{events:?}");
    let felt = |step: u64| !session.frames()[step as usize].is_base_unloaded();
    assert!(felt(begins[0]) && !felt(begins[0] - 1) && felt(again[0]) && !felt(again[0] - 1));
    assert!(quiet.iter().all(|step| !felt(*step) && felt(*step - 1)), "it is said of the first quiet step");
    assert!(begins[0] < quiet[0] && quiet[0] < again[0] && again[0] < quiet[1]);
}

#[test]
fn payload_limits_and_reach_are_told() {
    let mut scenario = coarse();
    (scenario.plant.payload.mass, scenario.plant.payload.from) = (0.3, 0.2);
    scenario.plant.payload.until = Some(0.6);
    let mut session = open(scenario);
    settle(&mut session);
    do_it(&mut session, drag(3.0, 0.0));
    session.end_gesture();
    settle(&mut session);
    let events = watched(&session);
    for (words, kind) in [
        ("the payload is picked up", EventKind::Note),
        ("the payload is let go", EventKind::Note),
        ("the target is outside the reactionless workspace: no b reaches it", EventKind::Beyond),
    ] {
        let event = events.iter().find(|event| event.words == words);
        assert_eq!(event.map(|event| event.kind), Some(kind), "{words} in {events:?}");
    }
    let held = events.iter().find(|event| event.words == "the payload is picked up").expect("held").step;
    assert!(session.frames()[held as usize].loaded && !session.frames()[held as usize - 1].loaded);
    // A push that drive 2 cannot hold, once for as long as it is at its limit.
    let mut session = open(Scenario { plant: Default::default(), ..coarse() });
    do_it(&mut session, Edit::Push { x: 90.0, y: 0.0 });
    session.end_gesture();
    settle(&mut session);
    let at_limit: Vec<Event> =
        watched(&session).into_iter().filter(|event| event.words.contains("torque limit")).collect();
    assert!(!at_limit.is_empty() && at_limit.len() < 4, "{at_limit:?}");
    assert!(at_limit.iter().all(|event| event.kind == EventKind::Warning));
}

/// While a hand drags, only the newest frame is read again; after any change the events are those of the frames.
#[test]
fn events_follow_a_run_that_changes() {
    let mut session = open(coarse());
    let queries = Queries::default();
    session.play();
    for i in 0..60u32 {
        match i {
            10..20 => do_it(&mut session, drag(0.5 + 0.1 * f64::from(i - 10), 0.6)),
            30 => session.end_gesture(),
            31 => session.step_by(-40),
            32 => do_it(&mut session, slide(2.6)),
            50 => session.undo().expect("an inverse"),
            _ => {}
        }
        session.tick(3);
        while !session.events(&queries, 5).is_whole {}
        let (grown, fresh) = (session.events(&queries, 0), afresh(&session));
        let kept = grown.answer().expect("just asked");
        assert_eq!((kept.events(), kept.peak()), (fresh.events(), fresh.peak()), "after {i}");
    }
}

/// A torque limit that is set in motion counts from then on, not for what was before; a recording says the same.
#[test]
fn limits_are_those_of_the_time() {
    let mut session = open(coarse());
    let queries = Queries::default();
    session.play();
    session.tick(40);
    let most = session.frames().iter().map(|frame| frame.torque[0].abs()).fold(0.0, f64::max);
    assert!(most > 0.0);
    let limits = |session: &Session| {
        let grown = session.events(&queries, usize::MAX);
        let events = grown.answer().expect("just asked").events().to_vec();
        assert_eq!(events, watched(session));
        events.into_iter().filter(|event| event.words.contains("torque limit")).collect::<Vec<_>>()
    };
    assert_eq!(limits(&session), []);
    let set = session.frame().step;
    do_it(&mut session, Edit::set("drive.1.torque_limit", 0.05 * most));
    session.end_gesture();
    session.tick(40);
    let found = limits(&session);
    assert!(!found.is_empty() && found.iter().all(|event| event.step >= set), "{found:?}");
    let mut seen = answer_sequence::<EventLog>(&Default::default(), &Default::default());
    let see = |run: &Run, frame: &Frame| seen.see(frame, (run.scenario().step, &run.scenario().machine));
    replay(&session.to_scenario(), see).expect("it runs again");
    assert_eq!(seen.events(), watched(&session));
}

#[test]
fn gestures_are_told_once_whatever_their_order() {
    let edit = |step, edit| TimedEdit { step, edit };
    let edits = [edit(900, drag(0.5, 0.6)), edit(100, slide(2.5)), edit(120, slide(2.6)), edit(700, slide(2.4))];
    let events = gestures(&edits, 0.001);
    assert_eq!(
        told(&events),
        ["slide b to 2.600 rad, within 0.020 s", "slide b to 2.400 rad", "drag target to 0.500, 0.600 m"]
    );
    assert_eq!(events.iter().map(|event| event.step).collect::<Vec<_>>(), [100, 700, 900]);
}
