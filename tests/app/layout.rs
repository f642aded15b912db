//! How the window is laid out: everything in view, clear of what lies over the scene, in any size.

use egui::{Key, Rect, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use stillbase::app::window::{App, Clock};
use stillbase::app::{AppState, Preferences};
use stillbase::picture::scene::palette::Theme;
use stillbase::picture::scene::views::ViewKind;
use stillbase::session::scenario::Scenario;

use super::screen::Screen;
use super::{Window, drag, seen, session};
use crate::Test;

pub const TESTS: &[Test] = tests![everything_is_seen_beside_what_lies_over_it, the_hand_keeps_its_view];

fn window(size: [f32; 2], liked: &Preferences) -> Window {
    let scenario = Scenario::builtin("case-3").expect("built in");
    let app_state = AppState::new(scenario, Theme::Dark).expect("it starts").with_preferences(liked);
    Harness::builder()
        .with_size(size)
        .with_step_dt(0.02)
        .renderer(Screen::new())
        .build_eframe(move |cc| App::new(cc, app_state, Clock::Fixed(0.02)).expect("kittest draws with wgpu"))
}

fn scene(h: &Window) -> Rect {
    h.get_by_label_contains("Scene:").rect()
}

/// Left, top, right and bottom of all that is to be seen.
fn bounds(h: &Window) -> Rect {
    let app_state = h.state().app_state();
    let content = app_state.views().content(app_state.view_state().view, session(h).frame(), &[]);
    Rect::from_points(&content.first.iter().map(|point| seen(h, *point)).collect::<Vec<_>>())
}

/// Every view, in windows from the smallest to a very large one: all of it is in the scene and fills it, and none of it
/// is under the hint.
fn everything_is_seen_beside_what_lies_over_it() {
    for size in [[960.0, 600.0], [1440.0, 900.0], [2560.0, 1440.0]] {
        let mut h = window(size, &Preferences::default());
        h.run_steps(4);
        let hint = h.get_by_label("Drag the white ring.").rect();
        let (all, scene_rect) = (bounds(&h), scene(&h));
        assert!(scene_rect.contains_rect(all) && all.bottom() < hint.top(), "{all} in {scene_rect} over {hint}");
        h.key_press(Key::Escape);
        h.run_steps(3);
        assert!(h.query_by_label("Drag the white ring.").is_none());
        for view in ViewKind::ALL {
            h.get_by_label(view.name()).click();
            h.run_steps(3);
            h.key_press(Key::F);
            h.run_steps(3);
            let (all, scene_rect) = (bounds(&h), scene(&h));
            assert!(scene_rect.contains_rect(all), "{}: {all} in {scene_rect}", view.name());
            let fills = (all.width() / scene_rect.width()).max(all.height() / scene_rect.height());
            assert!(fills > 0.7, "{}: {fills} of {scene_rect}", view.name());
        }
        let plots = h.get_by_label_contains("Torque over time").rect().width();
        let share = plots / size[0];
        assert!((0.17..0.29).contains(&share), "plots grow with the window: {share} of {}", size[0]);
    }
}

/// What a hand has moved stays as it is when the window changes; what was not moved shows everything again.
fn the_hand_keeps_its_view() {
    let mut h = window([1440.0, 900.0], &Preferences { hints: false, ..Preferences::default() });
    h.run_steps(3);
    let camera = |h: &Window| *h.state().app_state().view_state().camera();
    let before = camera(&h);
    h.set_size(vec2(1000.0, 900.0));
    h.run_steps(3);
    assert!(camera(&h) != before && scene(&h).contains_rect(bounds(&h)), "framed again");
    let from = scene(&h).left_bottom() + vec2(40.0, -60.0);
    drag(&mut h, from, from + vec2(60.0, 0.0));
    let moved = camera(&h);
    h.set_size(vec2(1440.0, 900.0));
    h.run_steps(3);
    assert_eq!(camera(&h), moved);
    h.key_press(Key::F);
    h.run_steps(3);
    assert_eq!(camera(&h), before, "F shows everything again");
}
