//! What follows when a machine is changed by hand and kept balanced; counterweights as edits.

use stillbase::mechanics::balance::{Preset, design};
use stillbase::mechanics::machine::{Inertia, Machine};
use stillbase::session::design::{DesignBrief, counterweights_edit};
use stillbase::session::scenario::Scenario;
use stillbase::session::{Edit, Session};

use crate::support::random::a_chain;
use crate::support::{Noise, family_machine};

fn is_balanced(machine: &Machine) -> bool {
    let inertia = Inertia::of(machine);
    inertia.is_force_balanced() && inertia.is_invariant()
}

fn changed(machine: &Machine, edit: &Edit) -> Machine {
    match edit {
        Edit::Set { change } => machine.with_settings(change).expect("a machine"),
        edit => panic!("{edit:?}"),
    }
}

fn of(key: &str, value: f64) -> toml::Table {
    match Edit::set(key, value) {
        Edit::Set { change } => change,
        edit => panic!("{edit:?}"),
    }
}

/// Random chains, random changes one after the other: what is asked for stays as it was asked for, all else follows.
#[test]
fn what_is_changed_stays_and_the_rest_follows() {
    let mut noise = Noise::of(81);
    let brief = DesignBrief { keep_balanced: true, ..DesignBrief::default() };
    let (mut kept, mut refused) = (0, 0);
    for _ in 0..60 {
        let n = 2 + (noise.between(0.0, 3.0) as usize);
        let bare = a_chain(&mut noise, n);
        let Ok(start) = design(&bare, &vec![1.0; bare.links().len()]) else { continue };
        let mut machine = start.clone();
        for _ in 0..4 {
            let j = noise.between(0.0, machine.links().len() as f64) as usize;
            let link = &machine.links()[j];
            let (key, value): (String, f64) = match noise.between(0.0, 1.0) < 0.5 {
                true => (format!("link.{}.mass", link.name), link.mass * noise.between(0.7, 1.4)),
                false => (format!("link.{}.com", link.name), link.com + noise.between(-0.05, 0.05)),
            };
            match brief.edit(&machine, &start, &of(&key, value)) {
                Ok(edit) => {
                    machine = changed(&machine, &edit);
                    assert_eq!(machine.value(&key).and_then(|now| now.as_float()), Some(value), "{key}");
                    assert!(is_balanced(&machine), "{key} = {value}");
                    kept += 1;
                }
                Err(why) => {
                    assert!(why.contains("balance"), "{why}");
                    refused += 1;
                }
            }
        }
    }
    assert!(kept > 60, "{kept} were kept, {refused} refused");
}

/// A drag is the same wherever it went on its way.
#[test]
fn what_follows_does_not_depend_on_the_way() {
    let start = stillbase::mechanics::machine::builtin("nine-link").expect("built in");
    let brief = DesignBrief { keep_balanced: true, ..DesignBrief::default() };
    let step = |machine: &Machine, com: f64| {
        changed(machine, &brief.edit(machine, start, &of("link.1.com", com)).expect("it is kept"))
    };
    let straight = step(start, -0.24);
    let round = [-0.2, -0.3, -0.1, -0.24].iter().fold(start.clone(), |machine, com| step(&machine, *com));
    for (a, b) in straight.links().iter().zip(round.links()) {
        assert!((a.com - b.com).abs() < 1e-12, "link {}: {} and {}", a.name, a.com, b.com);
    }
    // Where other links are dear, others move: balanced all the same.
    let dear = DesignBrief { penalties: Preset::Table1, ..brief.clone() };
    let other = changed(start, &dear.edit(start, start, &of("link.1.com", -0.24)).expect("it is kept"));
    assert!(
        is_balanced(&other) && straight.links().iter().zip(other.links()).any(|(a, b)| (a.com - b.com).abs() > 1e-4)
    );
}

/// Taken, followed by what is dragged, saved, opened and undone.
#[test]
fn counterweights_are_edits_like_all_others() {
    let bare = family_machine("nine-link-bare");
    let brief = DesignBrief { behind_root: Some(0.3), ..DesignBrief::default() };
    let front = brief.front(&bare, 5).expect("it can be balanced");
    let case = Scenario::builtin("case-1").expect("built in");
    let mut session = Session::open(Scenario { machine: bare.clone(), ..case }).expect("it opens");
    for placed in [&front.points[0], &front.points[2]] {
        session.apply(counterweights_edit(session.scenario(), &placed.machine)).expect("they are taken");
        session.end_gesture();
        assert_eq!(session.scenario().machine.spec().counterweights, placed.machine.spec().counterweights);
    }
    // A number of one of them does not stand for all of them.
    session.apply(Edit::set("counterweight.1.at", -0.1)).expect("it is moved");
    session.end_gesture();
    let weights = session.scenario().machine.spec().counterweights.clone();
    assert_eq!((weights.len(), weights[0].at), (front.points[2].machine.spec().counterweights.len(), -0.1));
    let text = session.to_scenario().to_toml();
    let again = Scenario::parse(&text, "again.toml", None).expect("it can be read");
    let again = Session::open(again).expect("it opens");
    assert_eq!(again.scenario().machine.spec().counterweights, weights);
    for _ in 0..3 {
        session.undo().expect("there is something to undo");
    }
    assert_eq!(session.scenario().machine, bare);
    session.apply(Edit::set("counterweight", "default")).expect("none were there");
    assert_eq!(session.scenario().machine, bare);
}

/// However far a counterweight is dragged, the others stay where they can be: or what is in the way is named.
#[test]
fn what_follows_stays_at_its_link() {
    let bare = stillbase::mechanics::machine::builtin("space-arm").expect("built in");
    let brief = DesignBrief { keep_balanced: true, ..DesignBrief::default() };
    let start = brief.front(bare, 3).expect("it can be balanced").points[0].machine.clone();
    let (mut machine, mut kept) = (start.clone(), 0);
    for step in 0..40 {
        let at = -3.0 + 0.1 * f64::from(step);
        match brief.edit(&machine, &start, &of("counterweight.2.at", at)) {
            Ok(edit) => {
                machine = changed(&machine, &edit);
                kept += 1;
                assert!(is_balanced(&machine), "{at} m");
                for weight in &machine.spec().counterweights {
                    assert!(weight.at.abs() < 3.0 + 1e-6, "{at} m puts one at {} m", weight.at);
                    assert!(weight.mass > 1e-3, "{at} m leaves {} kg", weight.mass);
                }
            }
            Err(why) => assert!(why.contains("no balance within these limits: "), "{why}"),
        }
    }
    assert!(kept > 3, "{kept}");
}
