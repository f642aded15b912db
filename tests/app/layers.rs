//! The layers of the links in the design view: whether bars meet, and heights that are used.

use egui::Key;
use egui_kittest::kittest::Queryable as _;
use stillbase::picture::scene::palette::Theme;
use stillbase::session::scenario::Scenario;

use super::{Window, session, window_of};
use crate::Test;

pub const TESTS: &[Test] = tests![heights_of_layers_are_used_and_taken_back, a_machine_without_an_order_says_who_meets];

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
