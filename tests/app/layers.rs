//! The layers of the links in the design view: whether bars meet, and heights that are used.

use egui::Key;
use egui_kittest::kittest::Queryable as _;
use stillbase::exchange::cut::Cut;
use stillbase::mechanics::machine::{Machine, parse};
use stillbase::picture::scene::palette::Theme;
use stillbase::query::ByIdentity;
use stillbase::session::scenario::Scenario;
use stillbase::session::{Run, for_machine};
use stillbase::study::layers::{LayersRequest, find_layers};

use super::{Window, session, window_of};
use crate::Test;

pub const TESTS: &[Test] = tests![
    heights_of_layers_are_used_and_taken_back,
    a_machine_without_an_order_says_who_meets,
    heights_that_do_not_fit_any_more_are_told,
    heights_are_used_from_the_list_of_commands,
    a_machine_with_heights_is_drawn_as_it_is_cut,
    a_link_with_a_plate_is_drawn_with_its_outline,
];

fn design(case: &str) -> Window {
    let mut h = window_of(Scenario::builtin(case).expect("built in"), Theme::Dark, 900.0);
    h.key_press(Key::D);
    h.run_steps(4);
    h
}

fn heights(h: &Window) -> Vec<f64> {
    session(h).scenario().machine.spec().links.iter().map(|link| link.axial).collect()
}

fn heights_of_layers_are_used_and_taken_back() {
    let mut h = design("two-drive");
    assert!(h.query_by_label("no bar meets another").is_some());
    assert!(h.query_by_label_contains("Layers from the top: link 3 in layer 2").is_some());
    h.get_by_label("Use the heights of the layers").click_accesskit();
    h.run_steps(4);
    assert_eq!(heights(&h), [0.0, 0.007, 0.014, 0.007]);
    assert!(h.query_by_label("Use the heights of the layers").is_none());
    assert!(h.query_by_label_contains("The machine has these heights.").is_some());
    h.key_press_modifiers(egui::Modifiers::COMMAND, Key::Z);
    h.run_steps(4);
    assert_eq!(heights(&h), [0.0; 4]);
}

fn a_machine_without_an_order_says_who_meets() {
    let mut h = design("case-3");
    assert!(h.query_by_label("no bar meets another along the task").is_some());
    let why = "Elsewhere within the joint limits: no order of links 2, 3, 4, 6 keeps bars apart: link 4 meets axis of the base";
    assert!(h.query_by_label_contains(why).is_some());
    h.get_by_label("Use the heights of the layers").click_accesskit();
    h.run_steps(4);
    assert!(heights(&h).iter().any(|height| *height > 0.0));
    assert!(h.query_by_label_contains("least clearance").is_some());
}

/// Returns two-drive with its links at heights, m.
fn at_heights(heights: [f64; 4]) -> Scenario {
    let mut scenario = Scenario::builtin("two-drive").expect("built in");
    let mut spec = scenario.machine.spec().clone();
    for (link, height) in spec.links.iter_mut().zip(heights) {
        link.axial = height;
    }
    scenario.machine = Machine::new(spec).expect("a machine");
    scenario
}

fn heights_that_do_not_fit_any_more_are_told() {
    let told = |h: &Window| h.query_by_label_contains("do not fit any more").is_some();
    let design = |scenario| {
        let mut h = window_of(scenario, Theme::Dark, 900.0);
        h.key_press(Key::D);
        h.run_steps(4);
        h
    };
    assert!(!told(&design(at_heights([0.0, 0.007, 0.014, 0.007]))));
    assert!(!told(&design(at_heights([0.0; 4]))), "a machine without heights has none that fit");
    let mut h = design(at_heights([0.0, 0.007, 0.010, 0.007]));
    assert!(told(&h));
    assert!(h.query_by_label_contains("link 2 meets link 3 at heights from 0.0070 m to 0.0100 m").is_some());
    h.get_by_label("Use the heights of the layers").click_accesskit();
    h.run_steps(4);
    assert!(!told(&h));
}

fn heights_are_used_from_the_list_of_commands() {
    let mut h = window_of(at_heights([0.0; 4]), Theme::Dark, 900.0);
    h.key_press_modifiers(egui::Modifiers::COMMAND, Key::K);
    h.run_steps(4);
    h.event(egui::Event::Text("heights of the layers".into()));
    h.run_steps(4);
    h.key_press(Key::Enter);
    h.run_steps(6);
    assert_eq!(heights(&h), [0.0, 0.007, 0.014, 0.007]);
}

/// Nine links stacked so that none meets another along case 3, in 3D.
fn a_machine_with_heights_is_drawn_as_it_is_cut() {
    let mut scenario = Scenario::builtin("case-3").expect("built in");
    let run = Run::new(&scenario).expect("it runs");
    let machine = scenario.machine.clone();
    let motion = Some(ByIdentity(run.plan().motion.clone()));
    let request = LayersRequest { machine, cut: Cut::default(), motion, along_task: true };
    scenario.machine = find_layers(&request).expect("an order").machine;
    let mut h = window_of(scenario, Theme::Dark, 800.0);
    h.key_press(Key::V);
    h.run_steps(4);
    h.snapshot("cut-heights-dark-3d");
}

/// The machine of the guide that has bars, a plate, pipes and a motor, from above.
fn a_link_with_a_plate_is_drawn_with_its_outline() {
    let (_, rest) = include_str!("../../src/guide/files.md").split_once("```toml made-arm.toml\n").expect("a machine");
    let (text, _) = rest.split_once("```").expect("its end");
    let machine = parse(text, "made-arm.toml").expect("a machine");
    let scenario = for_machine(&Scenario::builtin("two-drive").expect("built in"), &machine);
    let mut h = window_of(scenario, Theme::Light, 800.0);
    h.run_steps(4);
    h.snapshot("cut-plate-light");
}
