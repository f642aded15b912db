//! Room: text that does not fit ends at a word, and a narrow window still shows what it is about.

use egui::{Key, Rect, Vec2, vec2};
use egui_kittest::kittest::Queryable as _;
use stillbase::app::{Preferences, SessionCommand, ViewChange};
use stillbase::mechanics::machine;
use stillbase::picture::scene::palette::Theme;
use stillbase::session::scenario::Scenario;

use super::{Window, on_screen, session, window_liked};
use crate::Test;

pub const TESTS: &[Test] = tests![no_text_ends_in_the_middle_of_a_word, a_narrow_window_shows_ring_base_and_card];

const THEMES: [Theme; 2] = [Theme::Dark, Theme::Light];

/// The built-in scenarios, and each machine that none of them has.
fn gallery() -> Vec<Scenario> {
    let case = Scenario::builtin("case-3").expect("built in");
    let mut all: Vec<Scenario> = Scenario::builtins().cloned().collect();
    for machine in machine::builtins() {
        if !all.iter().any(|scenario| scenario.machine.name() == machine.name()) {
            all.push(Scenario { machine: machine.clone(), ..case.clone() });
        }
    }
    all
}

fn open(h: &mut Window, scenario: &Scenario) {
    h.state_mut().app_state_mut().carry_out(SessionCommand::Open(Box::new(scenario.clone())));
    h.run_steps(4);
}

/// Lines of text as their letters stand on the screen.
fn lines(h: &Window) -> Vec<String> {
    fn of(shape: &egui::Shape, all: &mut Vec<String>) {
        match shape {
            egui::Shape::Text(text) => {
                all.extend(text.galley.rows.iter().map(|row| row.glyphs.iter().map(|glyph| glyph.chr).collect()));
            }
            egui::Shape::Vec(shapes) => shapes.iter().for_each(|shape| of(shape, all)),
            _ => {}
        }
    }
    let mut all = Vec::new();
    h.output().shapes.iter().for_each(|clipped| of(&clipped.shape, &mut all));
    all
}

/// Whether a line ends in a single letter and an ellipsis.
fn ends_badly(line: &str) -> bool {
    let Some(kept) = line.trim_end().strip_suffix('…') else { return false };
    let last = kept.rsplit(char::is_whitespace).next().unwrap_or_default();
    last.chars().count() == 1 && last.chars().all(char::is_alphabetic)
}

/// Every machine and scenario of the gallery, in all sizes of a window, in both themes and with all panels.
fn no_text_ends_in_the_middle_of_a_word() {
    assert!(ends_badly("Turning moment on u…") && !ends_badly("Turning moment…") && !ends_badly("− …"));
    let sizes = [vec2(960.0, 600.0), vec2(1280.0, 800.0), vec2(1440.0, 900.0), vec2(1920.0, 1080.0)];
    let mut h = window_liked(sizes[0], &Preferences { hints: false, ..Preferences::default() });
    h.run_steps(2);
    let look = |h: &Window, name: &str, size: Vec2, seen: &mut usize| {
        let lines = lines(h);
        *seen += lines.iter().filter(|line| line.trim_end().ends_with('…')).count();
        let bad: Vec<&String> = lines.iter().filter(|line| ends_badly(line)).collect();
        assert!(bad.is_empty(), "{name} at {size}: {bad:?}");
    };
    let mut seen = 0;
    for scenario in gallery() {
        open(&mut h, &scenario);
        for size in sizes {
            h.set_size(size);
            for theme in THEMES {
                h.state_mut().app_state_mut().carry_out(ViewChange::Theme(theme));
                h.run_steps(2);
                look(&h, &scenario.name, size, &mut seen);
            }
        }
    }
    // Panels below the scene and views with panels of their own.
    for (key, name) in
        [(Key::C, "runs"), (Key::T, "tolerances"), (Key::W, "table"), (Key::D, "design"), (Key::E, "equations")]
    {
        h.key_press(key);
        for size in sizes {
            h.set_size(size);
            h.run_steps(6);
            look(&h, name, size, &mut seen);
        }
    }
    assert!(seen > 20, "what does not fit is shortened: {seen} lines");
}

/// The smallest window with a hint: the white ring, the base and the card are all in the scene, clear of one another.
fn a_narrow_window_shows_ring_base_and_card() {
    let mut hints = 0;
    for theme in THEMES {
        for scenario in gallery() {
            let mut h = window_liked(vec2(960.0, 600.0), &Preferences::default());
            h.state_mut().app_state_mut().carry_out(ViewChange::Theme(theme));
            open(&mut h, &scenario);
            h.run_steps(4);
            let scene = h.get_by_label_contains("Scene:").rect();
            assert!(scene.width() > 0.42 * 960.0, "{}: {scene}", scenario.name);
            let frame = *session(&h).frame();
            let around =
                |x: f64, y: f64, radius: f32| Rect::from_center_size(on_screen(&h, x, y), Vec2::splat(2.0 * radius));
            let ring = around(frame.target.at.re, frame.target.at.im, 12.0);
            let base = around(frame.base.at.re, frame.base.at.im, 10.0);
            let name = &scenario.name;
            let area = egui::Id::unique("hint");
            let card =
                h.ctx.memory(|memory| memory.area_rect(area)).filter(|_| h.query_by_label("No more hints").is_some());
            for (what, rect) in [("ring", ring), ("base", base)] {
                assert!(scene.contains_rect(rect), "{name}, {theme:?}: {what} {rect} in {scene}");
                if let Some(card) = card {
                    assert!(!card.intersects(rect), "{name}, {theme:?}: {what} {rect} under {card}");
                }
            }
            if let Some(card) = card {
                assert!(scene.contains_rect(card), "{name}, {theme:?}: {card} in {scene}");
                hints += 1;
            }
        }
    }
    assert!(hints > 10, "{hints} cards");
}
