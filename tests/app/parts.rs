//! The parts of a link in the design view: added, changed, removed, and overruled by typed numbers.

use egui::Key;
use egui_kittest::kittest::Queryable as _;
use stillbase::mechanics::machine::{Machine, parse};
use stillbase::picture::scene::palette::Theme;
use stillbase::session::gentle_motion;
use stillbase::session::scenario::Scenario;

use super::{Window, session, type_into, window_of};
use crate::Test;

pub const TESTS: &[Test] = tests![numbers_of_parts_are_typed, parts_are_added_and_removed];

fn design(scenario: Scenario) -> Window {
    let mut h = window_of(scenario, Theme::Dark, 900.0);
    h.key_press(Key::D);
    h.run_steps(4);
    h
}

fn machine(h: &Window) -> &Machine {
    &session(h).scenario().machine
}

fn press(h: &mut Window, label: &str) {
    // The panel scrolls, so that a button may lie below its lower edge.
    h.get_by_label(label).click_accesskit();
    h.run_steps(4);
}

fn numbers_of_parts_are_typed() {
    let arm = parse(include_str!("../mechanics/parts.toml"), "parts.toml").expect("an arm");
    let mut h = design(gentle_motion(&arm).expect("a motion"));
    assert!(h.query_by_label_contains("A typed value overrules its parts.").is_some());
    type_into(&mut h, "width of part 1 m", "50 mm");
    type_into(&mut h, "mass of lump 1 kg", "300 g");
    assert_eq!((machine(&h).spec().parts[0].width, machine(&h).spec().lumps[0].mass), (Some(0.05), 0.3));
    let followed = machine(&h).spec().links[0].clone();
    assert!(followed.mass != arm.spec().links[0].mass);
    // A typed mass overrules them, and says so; the button goes back.
    type_into(&mut h, "mass of link upper kg", "2");
    assert_eq!(machine(&h).spec().links[0].mass, 2.0);
    assert!(h.query_by_label_contains("link upper: mass is typed and overrules its parts").is_some());
    press(&mut h, "link upper follows its parts");
    assert_eq!(machine(&h).spec().links[0], followed);
    h.key_press_modifiers(egui::Modifiers::COMMAND, Key::Z);
    h.run_steps(3);
    assert_eq!(machine(&h).spec().links[0].mass, 2.0);
}

fn parts_are_added_and_removed() {
    let mut h = design(Scenario::builtin("nine-link-bare").expect("built in"));
    let bare = machine(&h).clone();
    press(&mut h, "add a lump to link 1");
    press(&mut h, "add a tube to link 1");
    let spec = machine(&h).spec();
    assert_eq!((spec.lumps.len(), spec.parts.len(), spec.links[0].mass), (1, 1, bare.spec().links[0].mass));
    press(&mut h, "link 1 follows its parts");
    let all: f64 = machine(&h).part_bodies().iter().map(|part| part.body.mass).sum();
    assert!((machine(&h).spec().links[0].mass - all).abs() < 1e-12 && all > 0.1);
    press(&mut h, "remove part 1 of link 1");
    assert_eq!(machine(&h).spec().links[0].mass, 0.1);
    press(&mut h, "remove lump 1 of link 1");
    let spec = machine(&h).spec();
    assert!(spec.parts.is_empty() && spec.lumps.is_empty() && spec.links[0].mass == 0.1);
    for _ in 0..5 {
        h.key_press_modifiers(egui::Modifiers::COMMAND, Key::Z);
        h.run_steps(3);
    }
    assert_eq!(*machine(&h), bare);
}
