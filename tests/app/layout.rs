//! How the window is laid out: everything in view, clear of what lies over the scene, in any size.

use egui::{Key, Rect, vec2};
use egui_kittest::kittest::Queryable as _;
use stillbase::app::{Command, Preferences, SessionCommand};
use stillbase::picture::scene::views::ViewKind;
use stillbase::session::Edit;

use super::{Window, drag, seen, session, window_liked};
use crate::Test;

pub const TESTS: &[Test] = tests![
    everything_is_seen_beside_what_lies_over_it,
    the_hand_keeps_its_view,
    layouts_have_their_panels,
    panels_change_sides,
    history_is_a_list_to_jump_in,
];

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
        let mut h = window_liked(size, &Preferences::default());
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
        // The design view has panels of its own.
        h.get_by_label(ViewKind::Flat.name()).click();
        h.run_steps(3);
        let plots = h.get_by_label_contains("Torque over time").rect().width();
        let share = plots / size[0];
        assert!((0.17..0.29).contains(&share), "plots grow with the window: {share} of {}", size[0]);
    }
}

/// What a hand has moved stays as it is when the window changes; what was not moved shows everything again.
fn the_hand_keeps_its_view() {
    let mut h = window_liked([1440.0, 900.0], &Preferences { hints: false, ..Preferences::default() });
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

/// Layouts by key: each has its panels, keeps what a hand changes of them, and is there again at the next start.
fn layouts_have_their_panels() {
    let size = [1440.0, 900.0];
    let mut h = window_liked(size, &Preferences { hints: false, ..Preferences::default() });
    h.run_steps(3);
    let settings = |h: &Window| h.query_by_label("POSE CONSTANT").is_some();
    let compares = |h: &Window| h.state().app_state().comparison().is_some();
    // Plots may stand in columns: what counts is the width of all.
    let plots = |h: &Window| size[0] - scene(h).right();
    let explored = plots(&h);
    let press = |h: &mut Window, key: Key| {
        h.key_press(key);
        h.run_steps(4);
    };
    press(&mut h, Key::Num6);
    assert!(!settings(&h) && compares(&h) && plots(&h) > 1.4 * explored, "{} after {explored}", plots(&h));
    press(&mut h, Key::Num8);
    assert!(settings(&h));
    let liked = h.state().app_state().preferences(size);
    press(&mut h, Key::Num5);
    assert!(settings(&h) && !compares(&h) && plots(&h) == explored);
    press(&mut h, Key::Num6);
    assert!(settings(&h) && compares(&h), "as it was left");
    press(&mut h, Key::Num6);
    assert!(!settings(&h) && compares(&h), "again: as it is at first");
    let mut again = window_liked(size, &liked);
    again.run_steps(4);
    assert!(settings(&again) && compares(&again) && plots(&again) > 1.4 * explored, "at the next start");
    // The scene alone; what counts is beside the machine.
    press(&mut h, Key::Num7);
    assert!(!settings(&h) && !compares(&h) && h.query_by_label("Search commands").is_none());
    assert_eq!(scene(&h).size(), vec2(1440.0, 900.0));
    let number = h.get_by_label("0.00 N m").rect();
    assert!(number.height() > 50.0 && !number.intersects(bounds(&h)), "{number} beside {}", bounds(&h));
    press(&mut h, Key::Escape);
    assert!(settings(&h) && h.query_by_label("Search commands").is_some(), "Esc leads back");
}

/// Settings and plots change sides by key and from the menu, and that is remembered.
fn panels_change_sides() {
    let size = [1440.0, 900.0];
    let mut h = window_liked(size, &Preferences { hints: false, ..Preferences::default() });
    h.run_steps(3);
    h.key_press(Key::Num4);
    h.run_steps(4);
    let swapped = |h: &Window| {
        let settings = h.get_by_label("POSE CONSTANT").rect();
        let plots = h.get_by_label_contains("Torque over time").rect();
        (settings.left() > scene(h).right() && plots.right() < scene(h).left(), plots.left() > scene(h).right())
    };
    assert_eq!(swapped(&h), (true, false));
    let mut again = window_liked(size, &h.state().app_state().preferences(size));
    again.run_steps(3);
    assert_eq!(swapped(&again), (true, false), "at the next start");
    again.get_by_label("layout").click();
    again.run_steps(4);
    again.get_by_label("Settings on the right").click();
    again.run_steps(4);
    assert_eq!(swapped(&again), (false, true));
    again.get_by_label("layout").click();
    again.run_steps(4);
    again.get_by_label("Compare").click();
    again.run_steps(4);
    assert!(again.state().app_state().comparison().is_some());
}

/// What was done stands in a list: a click goes back to it or on to it, and what was undone stays in the list.
fn history_is_a_list_to_jump_in() {
    let mut h = window_liked([1440.0, 900.0], &Preferences { hints: false, ..Preferences::default() });
    h.run_steps(3);
    for b in [2.3, 2.5, 2.6] {
        for command in
            [Command::Session(SessionCommand::Edit(Edit::PoseB { b })), Command::Session(SessionCommand::EndGesture)]
        {
            h.state_mut().app_state_mut().carry_out(command);
        }
    }
    h.key_press(Key::H);
    h.run_steps(4);
    assert!(h.query_by_label("Go to 0: as it was opened").is_some());
    assert!(h.query_by_label_contains("present state").is_some_and(|line| line.rect().top() > 0.0));
    h.get_by_label_contains("Go to 1:").click();
    h.run_steps(4);
    assert!((session(&h).frame().b - 2.3).abs() < 1e-9 && session(&h).undo_count() == 1);
    assert_eq!(h.query_all_by_label_contains(", undone").count(), 2);
    h.get_by_label_contains("Go to 3:").click();
    h.run_steps(4);
    assert!((session(&h).frame().b - 2.6).abs() < 1e-9 && session(&h).undo_count() == 3);
    h.get_by_label("Go to 0: as it was opened").click();
    h.run_steps(4);
    assert!((session(&h).frame().b - 2.4).abs() < 1e-9 && session(&h).undo_title().is_none());
    h.key_press(Key::Escape);
    h.run_steps(4);
    assert!(h.query_by_label_contains("Go to 0").is_none(), "Esc closes it");
    h.get_by_label("history").click();
    h.run_steps(4);
    assert!(h.query_by_label("Go to 0: as it was opened, the present state").is_some());
}
