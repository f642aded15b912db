//! A machine that is drawn in a session: each step is an edit, undone, saved and replayed.

use proptest::prelude::*;
use stillbase::mechanics::machine::builtin;
use stillbase::mechanics::sketch::{BarEnd, BarId, PinId, Sketch, SketchStep, Template, resolve};
use stillbase::session::scenario::Scenario;
use stillbase::session::verdict::{Statements, StatusLight};
use stillbase::session::{Edit, Refusal, Session, replay};

use super::sitting::any_sketch;
use super::{coarse, drag, one_path, open, replayed, set, settle};

fn draw(session: &mut Session, step: SketchStep) {
    session.apply(Edit::Sketch(step.clone())).unwrap_or_else(|why| panic!("{step:?}: {why}"));
    session.end_gesture();
}

fn bar(from: BarEnd, to: BarEnd) -> SketchStep {
    SketchStep::Bar { from, to, name: None }
}

fn sketch(session: &Session) -> &Sketch {
    session.scenario().sketch.as_ref().expect("drawn")
}

#[test]
fn a_machine_grows_from_nothing() {
    let mut session = open(coarse());
    let start = session.to_scenario().to_toml();
    let before = session.scenario().machine.clone();
    let motor = |pin: u32, stator: Option<u32>, turns: u32| SketchStep::Motor {
        pin: PinId(pin),
        stator: stator.map(BarId),
        drive: None,
        rotor: None,
        turns: Some(BarId(turns)),
    };
    let steps = [
        SketchStep::New { template: Template::Blank },
        bar(BarEnd::pin(PinId(0)), BarEnd::At([0.0, 0.5])),
        motor(0, None, 2),
        bar(BarEnd::pin(PinId(1)), BarEnd::At([0.4, 0.5])),
        motor(1, Some(2), 4),
        SketchStep::EndEffector { pin: PinId(3), bar: None },
    ];
    for step in &steps[..5] {
        draw(&mut session, step.clone());
        // While it is incomplete, the machine is the one before.
        assert!(session.scenario().machine == before || resolve(sketch(&session)).machine.is_some());
    }
    assert!(!resolve(sketch(&session)).missing.is_empty());
    draw(&mut session, steps[5].clone());
    let machine = session.scenario().machine.clone();
    assert_eq!((machine.name(), machine.drives(), machine.links().len()), ("my arm", 2, 2));
    assert_eq!(Some(&machine), resolve(sketch(&session)).machine.as_ref());
    // Saved, read again, and made again from the edits alone.
    let saved = session.to_scenario();
    let text = saved.to_toml();
    assert!(text.contains("do = \"sketch\"\ndraw = \"bar\""), "{text}");
    assert_eq!(Scenario::parse(&text, "saved.toml", None).expect("a scenario"), saved);
    one_path(&session);
    assert_eq!(open(saved).scenario(), session.scenario());
    // What a person would have written.
    let text = stillbase::mechanics::machine::to_toml(&machine);
    assert!(text.contains("length = 0.4\n") && text.contains("on = \"1\"") && text.contains("at = \"tip\""), "{text}");
    let end = session.to_scenario().to_toml();
    for _ in &steps {
        session.undo().expect("it was so before");
    }
    assert_eq!(session.to_scenario().to_toml(), start);
    for _ in &steps {
        session.redo().expect("it was so before");
    }
    assert_eq!(session.to_scenario().to_toml(), end);
}

#[test]
fn a_scenario_with_a_drawing_is_a_file() {
    let mut scenario = coarse();
    scenario.sketch = Some(Template::Pantograph.sketch());
    let text = scenario.to_toml();
    assert!(text.contains("[[sketch.bar]]"), "{text}");
    assert_eq!(Scenario::parse(&text, "drawn.toml", None).expect("a scenario"), scenario);
    let refused = |from: &str, to: &str| {
        assert!(text.contains(from), "{from} in {text}");
        Scenario::parse(&text.replace(from, to), "drawn.toml", None).expect_err("refused").to_string()
    };
    let message = refused("root = 0", "root = 77");
    assert!(message.starts_with("drawn.toml:") && message.contains("no pin with the number 77"), "{message}");
    assert!(refused("root = 0", "rot = 0").contains("no key \"rot\""));
    assert!(refused("next = ", "next = 1 # ").contains("not its own"));
}

/// Settings of the machine reach its drawing, and steps of drawing keep them.
#[test]
fn settings_and_drawing_go_together() {
    let mut session = open(coarse());
    let one = session.scenario().drawing().bars[0].clone();
    draw(&mut session, SketchStep::Gear { drive: "1".into(), inertia: 1e-5, ratio: 20.0 });
    for (key, value) in [("link.5.mass", "0.9"), ("length.l1", "0.52"), ("payload.mass", "0.2"), ("limits.a1", "0.1,3")]
    {
        session.apply(set(key, value)).expect("in range");
        session.end_gesture();
        let drawn = resolve(sketch(&session)).machine.expect("complete");
        assert_eq!(drawn.resolved_links(), session.scenario().machine.resolved_links(), "{key}");
        assert_eq!(drawn.links(), session.scenario().machine.links(), "{key}");
        assert_eq!(drawn.spec().angles, session.scenario().machine.spec().angles, "{key}");
    }
    assert_eq!(sketch(&session).bars[0].id, one.id, "identities stay");
    draw(&mut session, SketchStep::NameBar { bar: one.id, name: "arm".into() });
    let machine = &session.scenario().machine;
    assert_eq!((machine.links()[0].name.as_str(), machine.links()[4].mass), ("arm", 0.9));
    assert_eq!((machine.spec().lengths["l1"], machine.spec().payload.mass), (0.52, 0.2));
    assert_eq!(machine.spec().drives[0].rotor.map(|rotor| rotor.ratio), Some(20.0));
    one_path(&session);
}

/// A refused step says why and changes nothing; after the first step of the run none is taken from a file.
#[test]
fn a_refused_step_changes_nothing() {
    let mut session = open(coarse());
    let before = session.to_scenario();
    let why = session.apply(Edit::Sketch(SketchStep::DeletePin { pin: PinId(0) })).expect_err("refused");
    assert!(why.to_string().contains("B is where the machine stands"), "{why}");
    assert_eq!(session.to_scenario(), before);
    let mut text = before.to_toml();
    text += "\n[[edit]]\nstep = 3\ndo = \"sketch\"\ndraw = \"name\"\nname = \"x\"\n";
    let why = Scenario::parse(&text, "late.toml", None).expect_err("late").to_string();
    assert!(why.contains("drawing can change only before the first step"), "{why}");
    let unknown = text.replace("draw = \"name\"", "draw = \"wish\"");
    assert!(Scenario::parse(&unknown, "late.toml", None).expect_err("unknown").to_string().contains("wish"));
}

/// A machine that has been dragged goes back to its path when it is drawn anew.
#[test]
fn drawing_a_dragged_machine_begins_again() {
    let mut session = open(coarse());
    session.apply(drag(0.5, 0.6)).expect("inside");
    session.end_gesture();
    settle(&mut session);
    session.pause();
    let first = session.scenario().drawing().bars[8].id;
    draw(&mut session, SketchStep::Length { bar: first, metres: 0.32 });
    assert!(!session.is_dragged() && session.frames().len() == 1);
    assert!((session.scenario().machine.resolved_links()[8].length - 0.32).abs() < 1e-12);
    assert_ne!(&session.scenario().machine, builtin("nine-link").expect("built in"));
    replayed(&session);
    session.undo().expect("the drag again");
    assert!(session.is_dragged());
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, max_shrink_iters: 100, ..ProptestConfig::default() })]

    /// Undo and redo of any steps give the same bytes, and a file gives the same session.
    #[test]
    fn any_steps_are_undone_and_redone(edits in prop::collection::vec(any_sketch(), 1..14)) {
        let mut session = open(coarse());
        let mut states = vec![session.to_scenario().to_toml()];
        for edit in edits {
            if session.apply(edit).is_ok() {
                session.end_gesture();
                states.push(session.to_scenario().to_toml());
            }
        }
        let last = states.len() - 1;
        for want in states[..last].iter().rev() {
            session.undo().expect("it was so before");
            prop_assert_eq!(&session.to_scenario().to_toml(), want);
        }
        for want in &states[1..] {
            session.redo().expect("it was so before");
            prop_assert_eq!(&session.to_scenario().to_toml(), want);
        }
        let read = Scenario::parse(&states[last], "saved.toml", None).expect("a scenario");
        let again = open(read);
        prop_assert_eq!(again.scenario(), session.scenario());
    }
}

/// While a drawing lacks something, the run waits for it, and nothing is said of the machine before.
#[test]
fn an_unfinished_drawing_is_not_judged_by_the_machine_before() {
    let mut session = open(coarse());
    draw(&mut session, SketchStep::New { template: Template::Blank });
    draw(&mut session, bar(BarEnd::pin(PinId(0)), BarEnd::At([0.3, 0.2])));
    let unfinished = session.run().unfinished().expect("a bar alone").clone();
    assert_eq!(unfinished.missing, ["no motor turns bar 1 yet", "no end effector yet"]);
    assert_eq!(unfinished.drawing, "my arm");
    let statements = Statements::of(session.run(), session.frame());
    assert!(statements.named().iter().all(|(_, one)| one.outcome == StatusLight::Open), "{statements:?}");
    assert_eq!(statements.line(), "machine: 2 things missing · plan: none yet · run: none yet");
    assert!(statements.machine.why.contains("no motor turns bar 1 yet; no end effector yet"), "{statements:?}");
    // It moves by no means, and no recording is made of it.
    session.play();
    assert!(!session.is_moving());
    assert!(
        session
            .apply(drag(0.5, 0.6))
            .expect_err("it waits")
            .to_string()
            .contains("no motor turns bar 1 yet, and 1 more")
    );
    let saved = session.to_scenario();
    let why = replay(&saved, |_, _| ()).map(drop).expect_err("no machine");
    assert!(matches!(why, Refusal::Unfinished(_)), "{why}");
    // It is opened as it was left, from its edits or as a scenario with a drawing.
    assert_eq!(open(saved).run().unfinished(), Some(&unfinished));
    let plain = Scenario { sketch: session.scenario().sketch.clone(), ..coarse() };
    assert_eq!(open(plain).run().unfinished(), Some(&unfinished));
    // Once nothing is missing, it is judged by itself.
    for _ in 0..2 {
        let mend = resolve(sketch(&session)).missing[0].mends[0].step.clone();
        draw(&mut session, mend);
    }
    assert_eq!(session.run().unfinished(), None);
    let statements = Statements::of(session.run(), session.frame());
    assert!(statements.machine.words.starts_with("off balance by"), "{statements:?}");
}

/// A machine that is drawn from nothing has no task of its own: one is made for it, with the step that ends its drawing.
/// A task that a person has set stays, and the run waits.
#[test]
fn a_machine_drawn_from_nothing_gets_a_task_and_keeps_that_of_its_user() {
    for is_set in [false, true] {
        let mut session = open(coarse());
        draw(&mut session, SketchStep::New { template: Template::Blank });
        if is_set {
            session.apply(set("task.to", "0.5,0.7")).expect("it is a place");
            session.end_gesture();
        }
        draw(&mut session, bar(BarEnd::pin(PinId(0)), BarEnd::At([0.0, 0.05])));
        draw(&mut session, bar(BarEnd::pin(PinId(1)), BarEnd::At([0.04, 0.08])));
        let motor = |pin: u32, stator: Option<u32>, turns: u32| SketchStep::Motor {
            pin: PinId(pin),
            stator: stator.map(BarId),
            drive: None,
            rotor: None,
            turns: Some(BarId(turns)),
        };
        let [first, second] = [0, 1].map(|i| sketch(&session).bars[i].clone());
        draw(&mut session, motor(0, None, first.id.0));
        draw(&mut session, motor(first.tip.0, Some(first.id.0), second.id.0));
        let (before, count) = (session.scenario().task.clone(), session.undo_count());
        draw(&mut session, SketchStep::EndEffector { pin: second.tip, bar: None });
        assert_eq!(session.run().unfinished(), None);
        assert_eq!(session.undo_count(), count + 1, "one step");
        if is_set {
            assert_eq!(session.scenario().task, before);
            assert!(session.run().waiting().is_some(), "it is the task of the user");
            continue;
        }
        let made = session.scenario().task.clone();
        assert!(made != before && session.run().waiting().is_none());
        assert_eq!(session.undo_title(), Some("place end effector, with a task made for it"));
        assert_eq!(open(session.to_scenario()).scenario(), session.scenario(), "it is saved");
        session.undo().expect("it was so before");
        assert_eq!(session.scenario().task, before);
        session.redo().expect("it was so before");
        assert_eq!(session.scenario().task, made);
        // The task that was made follows the machine as it grows shorter.
        draw(&mut session, SketchStep::Length { bar: first.id, metres: 0.005 });
        assert!(session.run().waiting().is_none(), "a task for the shorter arm");
    }
}

#[test]
fn what_is_switched_is_told_in_words() {
    assert_eq!(Edit::set("design.as_cut", true).title(), "set links are flat bars, as they are cut: yes");
    assert_eq!(Edit::set("task.closed", false).title(), "set back to A: no");
}
