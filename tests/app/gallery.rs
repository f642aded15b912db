//! The built-in machines as pictures to choose from.

use egui::{Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use stillbase::app::AppState;
use stillbase::app::window::{App, Clock};
use stillbase::mechanics::machine;
use stillbase::picture::scene::palette::Theme;
use stillbase::session::scenario::Scenario;

use super::screen::{Screen, whole};
use super::{Window, session};
use crate::Test;

pub const TESTS: &[Test] =
    tests![a_machine_is_chosen_by_its_picture, arrows_lead_from_machine_to_machine, the_gallery_fits_a_small_window];

fn window(size: [f32; 2], theme: Theme) -> Window {
    let app_state = AppState::new(Scenario::builtin("case-3").expect("built in"), theme).expect("it starts");
    Harness::builder()
        .with_size(size)
        .with_step_dt(0.02)
        .renderer(Screen::new())
        .build_ui_state(whole, App::new(app_state, Clock::Fixed(0.02)))
}

fn open(h: &mut Window) {
    h.run_steps(2);
    h.get_by_label("Machine").click();
    h.run_steps(4);
}

/// Every machine has its picture, its drives and its two sentences; a click on one opens it with its task.
fn a_machine_is_chosen_by_its_picture() {
    for (theme, word) in [(Theme::Dark, "dark"), (Theme::Light, "light")] {
        let mut h = window([1440.0, 900.0], theme);
        open(&mut h);
        for machine in machine::builtins() {
            let drives = format!("{}, {} drives", machine.name(), machine.drives());
            let card = h.query_all_by_label_contains(&drives).next().unwrap_or_else(|| panic!("{drives}"));
            let said = card.accesskit_node().label().unwrap_or_default();
            let summary = &machine.spec().summary;
            assert!(said.ends_with(summary.as_str()), "{said}");
            assert!(summary.matches(". ").count() == 1 && summary.ends_with('.'), "two sentences: {summary}");
        }
        egui_kittest::image_snapshot(&h.render().expect("drawn"), format!("gallery-{word}"));
        h.get_by_label_contains("four-drive, 4 drives").click();
        h.run_steps(4);
        assert_eq!((session(&h).scenario().name.as_str(), session(&h).scenario().machine.drives()), ("four-drive", 4));
        assert!(h.query_by_label_contains("scara, 2 drives").is_none(), "the list closes");
    }
}

/// The machine on display has the keyboard when the list opens; arrows go on from it, Enter chooses.
fn arrows_lead_from_machine_to_machine() {
    let mut h = window([1440.0, 900.0], Theme::Dark);
    open(&mut h);
    let focused = |h: &Window, label: &str| h.get_by_label_contains(label).accesskit_node().is_focused();
    assert!(focused(&h, "nine-link, 3 drives"));
    let at = session(&h).frame().target.at;
    for (key, label) in [(Key::ArrowDown, "serial-3r, 3"), (Key::ArrowRight, "nine-link-geared, 3")] {
        h.key_press(key);
        h.run_steps(3);
        assert!(focused(&h, label), "{key:?}: {label}");
    }
    assert_eq!(session(&h).frame().target.at, at, "arrows were for the list");
    h.key_press_modifiers(Modifiers::NONE, Key::Enter);
    h.run_steps(4);
    assert_eq!(session(&h).scenario().name, "nine-link-geared");
}

/// What a small window has no room for is scrolled into view, not cut off at its edges.
fn the_gallery_fits_a_small_window() {
    let size = [960.0, 600.0];
    let mut h = window(size, Theme::Light);
    open(&mut h);
    let whole = egui::Rect::from_min_size(egui::Pos2::ZERO, size.into());
    for label in ["nine-link, 3", "nine-link-table-1, 3", "two-drive, 2"] {
        assert!(whole.contains_rect(h.get_by_label_contains(label).rect()), "{label}");
    }
    egui_kittest::image_snapshot(&h.render().expect("drawn"), "gallery-small");
    for _ in 0..2 {
        h.key_press(Key::ArrowDown);
        h.run_steps(20);
    }
    let last = h.get_by_label_contains("counter-rotating, 2");
    assert!(last.accesskit_node().is_focused() && whole.contains_rect(last.rect()), "{}", last.rect());
}
