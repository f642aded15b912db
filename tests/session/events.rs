//! What happens in a run, in words.

use stillbase::session::events::{Event, Kind, Watched, gestures};
use stillbase::session::scenario::Scenario;
use stillbase::session::{Edit, Session, TimedEdit};

use super::{coarse, do_it, drag, open, settle, slide};

fn watched(session: &Session) -> Vec<Event> {
    let mut watched = Watched::default();
    assert!(watched.follow(session.made(), session.frames(), session.scenario(), usize::MAX));
    watched.events().to_vec()
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
    let felt = |step: u64| !session.frames()[step as usize].base_feels_nothing();
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
        ("the payload is picked up", Kind::Note),
        ("the payload is let go", Kind::Note),
        ("the target is outside the reactionless workspace: no b reaches it", Kind::Beyond),
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
    assert!(at_limit.iter().all(|event| event.kind == Kind::Warning));
}

/// While a hand drags, only the newest frame is read again; after any change the events are those of the frames.
#[test]
fn events_follow_a_run_that_changes() {
    let mut session = open(coarse());
    let mut kept = Watched::default();
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
        while !kept.follow(session.made(), session.frames(), session.scenario(), 5) {}
        let mut fresh = Watched::default();
        assert!(fresh.follow(session.made(), session.frames(), session.scenario(), usize::MAX));
        assert_eq!((kept.events(), kept.peak()), (fresh.events(), fresh.peak()), "after {i}");
    }
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
