//! Parts of links in a session: every change is undone, done again, saved and replayed.

use stillbase::mechanics::machine::{BarStock, LinkNumber, Machine, PartSource, Shape, builtin, parse, to_toml};
use stillbase::mechanics::sketch::SketchStep;
use stillbase::session::scenario::Scenario;
use stillbase::session::{Edit, Session, gentle_motion, parts};
use stillbase::study::parts::LinkParts;

fn session() -> Session {
    let machine = parse(include_str!("../mechanics/parts.toml"), "parts.toml").expect("an arm");
    Session::open(gentle_motion(&machine).expect("a gentle motion")).expect("it opens")
}

#[test]
fn changes_of_parts_are_undone_done_again_and_saved() {
    changes_are_kept(session());
}

/// The same while the machine is drawn: the drawing is that machine after each change.
#[test]
fn changes_of_parts_reach_the_drawing() {
    let mut session = session();
    let name = SketchStep::Name { name: "drawn arm".into() };
    session.apply(Edit::Sketch(name)).expect("it is drawn");
    session.end_gesture();
    changes_are_kept(session);
}

fn changes_are_kept(mut session: Session) {
    let machine = |session: &Session| -> Machine { session.scenario().machine.clone() };
    let mut states = vec![machine(&session)];
    let hole = |machine: &Machine, part: usize| {
        let hole = parts::hole_of(machine, part);
        parts::change_part(machine, part, |part| part.holes.extend(hole))
    };
    let edits: [&dyn Fn(&Machine) -> Edit; 18] = [
        &|machine| hole(machine, 0),
        &|machine| hole(machine, 0),
        &|machine| parts::change_part(machine, 1, |part| part.polygon[2][1] += 0.01),
        &|machine| parts::change_part(machine, 2, |part| part.name = "slide".into()),
        &|machine| parts::change_part(machine, 2, |part| part.ends = None),
        &|machine| parts::name_lump(machine, 0, "bearing".into()),
        &|_| Edit::set("part.1.width", 0.05),
        &|_| Edit::set("part.1.from", -0.02),
        &|_| Edit::set("lump.1.mass", 0.3),
        &|_| Edit::set("link.upper.mass", 2.0),
        &|machine| parts::add_part(machine, 0, Shape::Tube),
        &|machine| parts::add_part(machine, 1, Shape::Plate),
        &|machine| parts::add_lump(machine, 0),
        &|machine| parts::change_part(machine, 1, |part| part.material = "lead".into()),
        &|machine| parts::follow_parts(machine, 0, &LinkNumber::ALL),
        &|machine| parts::remove(machine, PartSource::Part(0)),
        &|machine| parts::remove(machine, PartSource::Lump(1)),
        &|_| Edit::set("material.pom.density", 1500.0),
    ];
    for edit in edits {
        session.apply(edit(states.last().expect("a state"))).expect("it is applied");
        session.end_gesture();
        states.push(machine(&session));
        let [.., was, is] = &states[..] else { panic!("two states") };
        assert_ne!(was, is);
        if let Some(sketch) = &session.scenario().sketch {
            let drawn = sketch.machine().expect("complete");
            assert_eq!(drawn.spec().parts, is.spec().parts);
            assert_eq!((&drawn.spec().lumps, drawn.links()), (&is.spec().lumps, is.links()));
        }
        // Saved and read again, it is the same machine, in the file of a machine too.
        let saved = session.to_scenario().to_toml();
        let again = Scenario::parse(&saved, "again.toml", None).expect("its own file");
        assert_eq!(machine(&Session::open(again).expect("it opens")), *is);
        assert_eq!(parse(&to_toml(is), "again.toml").expect("its own file"), *is);
    }
    for state in states.iter().rev().skip(1) {
        session.undo().expect("undone");
        assert_eq!(machine(&session), *state);
    }
    for state in &states[1..] {
        session.redo().expect("done again");
        assert_eq!(machine(&session), *state);
    }
}

#[test]
fn a_link_that_loses_its_last_part_keeps_its_numbers() {
    let mut session = session();
    let before = session.scenario().machine.clone();
    let link = |session: &Session| session.scenario().machine.spec().links[1].clone();
    let mut own = LinkParts::of(&before, 1).expect("parts").parts.len();
    assert_eq!(own, 3);
    while let Some(all) = LinkParts::of(&session.scenario().machine, 1) {
        let was = link(&session);
        let edit = parts::remove(&session.scenario().machine, all.parts[0].source);
        session.apply(edit).expect("it is applied");
        session.end_gesture();
        own -= 1;
        let is_empty = LinkParts::of(&session.scenario().machine, 1).is_none();
        assert_eq!((is_empty, is_empty && link(&session).mass == was.mass), (own == 0, own == 0));
    }
    let bare = link(&session);
    assert!(
        LinkNumber::ALL.iter().filter(|number| **number != LinkNumber::Across).all(|number| !bare.follows(*number))
    );
    for _ in 0..3 {
        session.undo().expect("undone");
    }
    assert_eq!(session.scenario().machine, before);
}

/// A number of a bar that is cut anew makes it a part of its own, whichever way it is set; undone, it is cut anew again.
#[test]
fn a_cut_bar_that_is_changed_is_cut_no_more() {
    let bare = builtin("nine-link-bare").expect("built in");
    let stock = BarStock::default();
    let cut = bare.with_bars(&stock, &[]).expect("it is cut");
    assert!(cut.spec().parts.iter().all(|part| part.is_cut()));
    let edits: [&dyn Fn(&Machine) -> Edit; 3] =
        [&|_| Edit::set("part.1.width", 0.05), &|_| Edit::set("part.1.to", 0.7), &|machine| {
            parts::change_part(machine, 0, |part| part.material = "steel".into())
        }];
    for edit in edits {
        let mut session = Session::open(gentle_motion(&cut).expect("a gentle motion")).expect("it opens");
        session.apply(edit(&cut)).expect("it is applied");
        session.end_gesture();
        let changed = session.scenario().machine.clone();
        let own = &changed.spec().parts[0];
        assert!(!own.is_cut() && changed.spec().parts[1].is_cut(), "{own:?}");
        // Cut again, all other bars are new.
        let again = changed.with_bars(&BarStock { width: 0.02, ..stock.clone() }, &[]).expect("it is cut");
        let of_link = |machine: &Machine| machine.spec().parts.iter().find(|part| part.link == own.link).cloned();
        let (was, is) = (of_link(&changed).expect("a part"), of_link(&again).expect("a part"));
        assert_eq!((was.width, was.material), (is.width, is.material));
        assert!(again.spec().parts.iter().filter(|part| part.is_cut()).all(|part| part.width == Some(0.02)));
        session.undo().expect("undone");
        assert_eq!(session.scenario().machine, cut);
        session.redo().expect("done again");
        assert_eq!(session.scenario().machine, changed);
    }
    // The same value is no change.
    let width = cut.spec().parts[0].width.expect("a flat bar").to_string();
    assert_eq!(cut.set("part.1.width", &width).expect("in range"), cut);
}
