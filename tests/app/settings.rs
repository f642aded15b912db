//! All settings: by plain names, in the user's units, in the panel and in a window of their own.

use egui::accesskit::Role;
use egui::{Key, vec2};
use egui_kittest::kittest::Queryable as _;
use stillbase::app::{Switch, ViewChange};
use stillbase::picture::notation::{AngleUnit, LengthUnit, Notation};
use stillbase::picture::scene::palette::Theme;

use super::{Window, session, window};
use crate::Test;

pub const TESTS: &[Test] = tests![all_settings_have_a_window, settings_are_in_the_users_units];

fn opened(size: egui::Vec2) -> Window {
    let mut h = window("case-3", Theme::Dark);
    h.set_size(size);
    h.run_steps(2);
    h.state_mut().app_state_mut().carry_out(ViewChange::Switch(Switch::Settings, true));
    h.run_steps(4);
    h
}

fn value(h: &Window, key: &str) -> String {
    h.get_by_role_and_label(Role::TextInput, key).value().unwrap_or_default()
}

fn seek(h: &mut Window, text: &str) {
    let field = h.get_by_role_and_label(Role::TextInput, "Search the settings");
    field.focus();
    h.run_steps(2);
    h.key_press_modifiers(egui::Modifiers::COMMAND, Key::A);
    h.event(egui::Event::Text(text.into()));
    h.run_steps(3);
}

fn write(h: &mut Window, key: &str, text: &str) {
    h.get_by_role_and_label(Role::TextInput, key).focus();
    h.run_steps(2);
    h.key_press_modifiers(egui::Modifiers::COMMAND, Key::A);
    h.event(egui::Event::Text(text.into()));
    h.run_steps(2);
    h.key_press(Key::Enter);
    h.run_steps(6);
}

fn all_settings_have_a_window() {
    let mut h = opened(vec2(1920.0, 1080.0));
    let place = |h: &Window, key: &str| h.get_by_role_and_label(Role::TextInput, key).rect();
    // In columns: the first settings of a part stand beside one another.
    let [first, law] = ["task.kind", "task.law"].map(|key| place(&h, key));
    assert!(law.left() > first.right() + 200.0, "{first} and {law}");
    assert!(h.query_by_label("duration from A to B").is_some() && h.query_by_label("key task.time").is_some());
    seek(&mut h, "mass of link 9");
    assert_eq!(h.query_all_by_label("mass of link 9").count(), 3, "of the machine, its true one, and its bounds");
    write(&mut h, "link.9.mass", "0.5");
    let mass = session(&h).scenario().value("link.9.mass").and_then(|value| value.as_float());
    assert_eq!(mass, Some(0.5));
    seek(&mut h, "cheese");
    assert!(h.query_by_label("no setting contains this").is_some());
    h.get_by_label("POSE CONSTANT").click();
    h.run_steps(2);
    h.key_press(Key::Escape);
    h.run_steps(2);
    h.key_press(Key::Escape);
    h.run_steps(3);
    assert!(h.query_by_label("Search the settings").is_none(), "Esc closes it");
    // The smallest window has one column, and all of it is in view.
    let h = opened(vec2(960.0, 600.0));
    let rect = h.get_by_label("Search the settings").rect();
    assert!(rect.left() > 0.0 && rect.right() < 960.0 && rect.width() > 280.0, "{rect}");
}

fn settings_are_in_the_users_units() {
    let mut h = opened(vec2(1440.0, 900.0));
    seek(&mut h, "task.b");
    let before = session(&h).scenario().task.b;
    assert_eq!(value(&h, "task.b"), "2.4");
    let notation = Notation { angle: AngleUnit::Degrees, length: LengthUnit::Millimetres, ..Notation::default() };
    h.state_mut().app_state_mut().carry_out(ViewChange::Notation(notation));
    h.run_steps(3);
    assert_eq!(value(&h, "task.b"), "137.509871");
    // Left as it stands, it keeps the digits that are not shown.
    h.get_by_role_and_label(Role::TextInput, "task.b").focus();
    h.run_steps(2);
    h.key_press(Key::Enter);
    h.run_steps(2);
    assert_eq!(session(&h).scenario().task.b, before);
    seek(&mut h, "task.to");
    assert_eq!(value(&h, "task.to"), "550,900");
    write(&mut h, "task.to", "540, 0.9 m");
    let points = session(&h).scenario().task.points();
    let last = points.last().expect("B");
    assert!((last.re - 0.54).abs() < 1e-12 && (last.im - 0.9).abs() < 1e-12, "{last}");
}
