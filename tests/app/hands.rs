//! Everything that is seen in the scene is a handle: it says what it is, shows its place in the panel, and turns.

use egui::Pos2;
use egui_kittest::kittest::Queryable as _;
use stillbase::app::Command;
use stillbase::picture::scene::options::Handle;
use stillbase::picture::scene::palette::Theme;
use stillbase::picture::scene::pointer::Pointer;
use stillbase::picture::scene::views::ViewKind;
use stillbase::session::Edit;

use super::{Window, hold, on_screen, seen, session, window};
use crate::Test;

pub const TESTS: &[Test] =
    tests![things_say_what_they_are, a_click_shows_the_place_in_the_panel, a_row_of_the_panel_lights_up_its_thing,];

/// What is under a place on the screen.
fn under(h: &Window, at: Pos2) -> Option<Handle> {
    let scene = h.get_by_label_contains("Scene:").rect();
    let pair = |v: egui::Vec2| [f64::from(v.x), f64::from(v.y)];
    let camera = *h.state().app_state().view_state().camera();
    let pointer = Pointer { camera, size: pair(scene.size()), at: pair(at - scene.min) };
    h.state().app_state().views().under(ViewKind::Flat, session(h).frame(), &pointer)
}

/// Where a link is seen alone.
fn link(h: &Window, name: &str) -> (usize, Pos2) {
    let frame = *session(h).frame();
    let stage = h.state().app_state().stage();
    let (i, bar) = stage.linkage().bars().iter().enumerate().find(|(_, bar)| bar.name == name).expect("a link");
    let [from, to] = bar.ends(&frame.q.units());
    let at = |t: f64| seen(h, [0, 1, 2].map(|j| from[j] + t * (to[j] - from[j])));
    let all = (2..19).rev().map(|k| at(f64::from(k) / 20.0));
    (i, all.into_iter().find(|at| under(h, *at) == Some(Handle::Link(i))).expect("it is seen somewhere"))
}

fn rest_on(h: &mut Window, at: Pos2) {
    h.hover_at(at);
    h.run_steps(40);
}

fn things_say_what_they_are() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    let (_, on_link) = link(&h, "5");
    let around = (0..24).map(|i| f64::from(i) * 0.26).map(|turn| on_screen(&h, 0.06 * turn.cos(), 0.06 * turn.sin()));
    let base = around.into_iter().find(|at| under(&h, *at) == Some(Handle::Base)).expect("between the links");
    let cards = [
        (on_link, "link 5, turned by drive 2, 0.70 kg"),
        (on_screen(&h, 0.5, 0.5), "target at 0.500, 0.500 m"),
        (on_screen(&h, 0.55, 0.9), "point B of the path, 0.550, 0.900 m"),
        (base, "base, fixed"),
    ];
    for (at, words) in cards {
        rest_on(&mut h, at);
        assert!(h.query_by_label_contains(words).is_some(), "{words}");
    }
    // A payload beside the tip; the target covers one without an offset.
    hold(&mut h);
    let edit = Edit::set("plant.payload.offset", vec![0.1, 0.0]);
    h.state_mut().app_state_mut().carry_out(Command::Edit(edit));
    h.run_steps(2);
    let shown = *session(&h).frame();
    let at = h.state().app_state().stage().payload(&shown).expect("it is held");
    let at = on_screen(&h, at.re, at.im);
    rest_on(&mut h, at);
    assert!(h.query_by_label_contains("payload, 0.3 kg").is_some());
}

fn a_click_shows_the_place_in_the_panel() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    let row = |h: &Window| h.query_by_label("link 5 mass kg").map(|row| row.rect());
    assert_eq!(row(&h), None);
    h.state_mut().app_state_mut().carry_out(Command::Side(false));
    h.run_steps(2);
    let (_, at) = link(&h, "5");
    h.hover_at(at);
    h.step();
    h.drag_at(at);
    h.drop_at(at);
    h.run_steps(30);
    let place = row(&h).expect("its rows are there");
    assert!(place.top() > 40.0 && place.bottom() < 790.0, "they are seen: {place:?}");
    assert!(session(&h).script().is_empty(), "to look changes nothing");
    assert!(h.state().app_state().view_state().side.shown);
    h.hover_at(place.center());
    h.run_steps(2);
    let (number, _) = link(&h, "5");
    assert_eq!(h.state().app_state().view_state().lit, Some(Handle::Link(number)), "and it lights up");
}

fn a_row_of_the_panel_lights_up_its_thing() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    let lit = |h: &Window| h.state().app_state().view_state().lit;
    assert_eq!(lit(&h), None);
    let row = h.get_by_label("B x m").rect().center();
    h.hover_at(row);
    h.run_steps(2);
    assert_eq!(lit(&h), Some(Handle::Waypoint(1)));
    h.hover_at(on_screen(&h, 0.2, 0.95));
    h.run_steps(2);
    assert_eq!(lit(&h), None);
    // By the keyboard too.
    h.get_by_label("A x m").focus();
    h.run_steps(2);
    assert_eq!(lit(&h), Some(Handle::Waypoint(0)));
}
