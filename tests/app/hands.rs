//! Everything that is seen in the scene is a handle: it says what it is, shows its place in the panel, and turns.

use egui::accesskit::Role;
use egui::{Key, Modifiers, PointerButton, Pos2, pos2, vec2};
use egui_kittest::kittest::Queryable as _;
use stillbase::app::{Message, SessionCommand, Switch, ViewChange};
use stillbase::picture::scene::options::Handle;
use stillbase::picture::scene::palette::Theme;
use stillbase::picture::scene::pointer::Pointer;
use stillbase::picture::scene::views::ViewKind;
use stillbase::session::Edit;

use super::{Window, drag, hold, on_screen, pull, seen, session, type_into, window, written};
use crate::Test;

pub const TESTS: &[Test] = tests![
    things_say_what_they_are,
    a_click_shows_the_place_in_the_panel,
    a_row_of_the_panel_lights_up_its_thing,
    a_link_that_is_dragged_turns_its_drive,
    a_link_of_four_drives_is_pulled_while_the_tip_stays,
    limits_are_arcs_with_ends_to_drag,
    a_payload_is_hung_on_and_aside,
    the_target_is_typed,
    a_link_stops_at_the_limits_and_escape_takes_it_back,
    the_right_button_offers_what_can_be_done_there,
    shift_drags_fine_and_ctrl_to_round_numbers,
    numbers_of_the_panel_are_dragged_fine_round_and_not_at_all,
    numbers_are_typed_with_units_and_arithmetic,
];

/// What is under a place on the screen.
fn under(h: &Window, at: Pos2) -> Option<Handle> {
    let scene = h.get_by_label_contains("Scene:").rect();
    let pair = |v: egui::Vec2| [f64::from(v.x), f64::from(v.y)];
    let camera = *h.state().app_state().view_state().camera();
    let pointer = Pointer { camera, size: pair(scene.size()), at: pair(at - scene.min) };
    h.state().app_state().views().under(ViewKind::Flat, &session(h).frame().into(), &pointer)
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
    h.state_mut().app_state_mut().carry_out(SessionCommand::Edit(edit));
    h.run_steps(2);
    let shown = *session(&h).frame();
    let at = h.state().app_state().stage().payload(&(&shown).into()).expect("it is held");
    let at = on_screen(&h, at.re, at.im);
    rest_on(&mut h, at);
    assert!(h.query_by_label_contains("payload, 0.3 kg").is_some());
}

fn a_click_shows_the_place_in_the_panel() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    let row = |h: &Window| h.query_by_label("link 5 mass kg").map(|row| row.rect());
    assert_eq!(row(&h), None);
    h.state_mut().app_state_mut().carry_out(ViewChange::Switch(Switch::Side, false));
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
    assert!(h.state().app_state().view_state().arrangement.now().side.shown);
    h.hover_at(place.center());
    h.run_steps(2);
    let (number, _) = link(&h, "5");
    assert_eq!(h.state().app_state().view_state().pointed.panel_object, Some(Handle::Link(number)), "and it lights up");
}

fn a_row_of_the_panel_lights_up_its_thing() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    let lit = |h: &Window| h.state().app_state().view_state().pointed.panel_object;
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

/// Where a point at a distance from the root of a link, m, comes to when the link turns by an angle, rad.
fn swung(h: &Window, link: usize, at: Pos2, by: f64) -> Pos2 {
    let frame = *session(h).frame();
    let bar = &h.state().app_state().stage().linkage().bars()[link];
    let (root, ..) = bar.pose(&frame.q.units());
    let middle = on_screen(h, root.re, root.im);
    // On the screen y points down.
    middle + egui::emath::Rot2::from_angle(-by as f32) * (at - middle)
}

fn a_link_that_is_dragged_turns_its_drive() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    for (name, drive) in [("1", 0), ("5", 1), ("9", 2)] {
        let (i, from) = link(&h, name);
        assert_eq!(h.state().app_state().stage().linkage().bars()[i].drive, drive);
        let before = session(&h).frame().q[drive];
        let undos = session(&h).undo_count();
        let to = swung(&h, i, from, 0.15);
        pull(&mut h, from, to);
        h.run_steps(60);

        let card = format!("drive {}, q", drive + 1);
        assert!(h.query_by_label_contains(&card).is_some(), "{card}");
        let f = session(&h).frame();
        assert!((f.b - 2.4).abs() < 1e-9, "b stays: {}", f.b);
        assert!(f.peaks.is_reactionless(), "the base feels nothing: {:?}", f.peaks);
        assert!((f.q[drive] - before).abs() > 0.02, "link {name} turned by {} rad", f.q[drive] - before);
        h.drop_at(to);
        h.run_steps(3);
        assert_eq!(session(&h).undo_count(), undos + 1, "one undo for link {name}");
        assert!(session(&h).undo_title().expect("a title").starts_with("turn links to"));
    }
    // Link 1 is rooted in B, which stands still: its drive follows the pointer to the pixel.
    let (i, from) = link(&h, "1");
    let before = session(&h).frame().q[0];
    let to = swung(&h, i, from, 0.2);
    drag(&mut h, from, to);
    h.run_steps(80);
    assert!((session(&h).frame().q[0] - before - 0.2).abs() < 5e-3, "{}", session(&h).frame().q[0] - before);
    let again = stillbase::session::replay(&session(&h).to_scenario(), |_, _| {}).expect("it runs");
    assert_eq!(again.frame(), session(&h).run().frame(), "the drags are in the script");
}

fn a_link_of_four_drives_is_pulled_while_the_tip_stays() {
    let mut h = window("four-drive", Theme::Dark);
    h.run_steps(2);
    let (i, from) = link(&h, "1");
    rest_on(&mut h, from);
    assert!(h.query_by_label_contains("the tip and b stay").is_some(), "the card says so");
    let (before, undos) = (*session(&h).frame(), session(&h).undo_count());
    // One way or the other is free.
    for by in [0.3, -0.3] {
        let from = link(&h, "1").1;
        let to = swung(&h, i, from, by);
        pull(&mut h, from, to);
        h.run_steps(90);
        assert!(h.query_by_label_contains("the tip stays, and b stays").is_some(), "the card says so");
        h.drop_at(to);
        h.run_steps(3);
        let f = session(&h).frame();
        assert!((f.end_effector - before.end_effector).norm() < 1e-9, "the tip stays: {}", f.end_effector);
        assert!((f.b - before.b).abs() < 1e-9);
        assert!(session(&h).undo_title().expect("a title").starts_with("pull link 1 to"));
    }
    assert_eq!(session(&h).undo_count(), undos + 2);
    let f = session(&h).frame();
    assert!(f.peaks.is_reactionless() && f.peaks.torque.iter().any(|most| *most > 0.01), "{:?}", f.peaks);
    let again = stillbase::session::replay(&session(&h).to_scenario(), |_, _| {}).expect("it runs");
    assert_eq!(again.frame(), session(&h).run().frame(), "the pulls are in the script");
}

fn a_link_stops_at_the_limits_and_escape_takes_it_back() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    let (i, from) = link(&h, "2");
    let before = *session(&h).frame();
    let to = swung(&h, i, from, 2.8);
    pull(&mut h, from, to);
    h.run_steps(150);
    let f = *session(&h).frame();
    let machine = &session(&h).scenario().machine;
    for (k, angle) in machine.angles().iter().enumerate() {
        assert!(f.a[k] > angle.limits.start() - 1e-6 && f.a[k] < angle.limits.end() + 1e-6, "a{}: {}", k + 1, f.a[k]);
    }
    assert!(h.query_all_by_label_contains("stands at its limit").next().is_some());
    assert!((f.b - before.b).abs() < 1e-9 && f.peaks.is_reactionless());
    h.key_press(Key::Escape);
    h.step();
    h.drop_at(to);
    h.run_steps(150);
    let back = session(&h).frame();
    assert!((back.end_effector - before.end_effector).norm() < 1e-6, "{} {}", back.end_effector, before.end_effector);
}

fn limits_are_arcs_with_ends_to_drag() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    let limits = |h: &Window| session(h).scenario().machine.angles()[0].limits.clone();
    let end = |h: &Window| {
        let shown = session(h).frame().into();
        let mut ends = h.state().app_state().stage().limits(&shown);
        ends.find(|end| end.handle == Handle::Limit(0, 1)).expect("a₁ has an arc").at
    };
    let at = end(&h);
    let from = seen(&h, at);
    rest_on(&mut h, from);
    assert!(h.query_by_label_contains("joint limit: greatest a₁, 3.142 rad").is_some());
    let area = |h: &Window| session(h).run().planes().expect("planes").boundary().area();
    let before = area(&h);
    // From straight to 40° less.
    let frame = *session(&h).frame();
    // The outer arm is link 5, which the tip hangs on: it points along drive 2 from the pin that it is rooted in.
    let pin = {
        let stage = h.state().app_state().stage();
        let bar = stage.linkage().bars().iter().find(|bar| bar.name == "5").expect("a link");
        let (root, _, z) = bar.pose(&frame.q.units());
        [root.re, root.im, z]
    };
    let middle = seen(&h, pin);
    let to = middle + egui::emath::Rot2::from_angle(40_f32.to_radians()) * (from - middle);
    drag(&mut h, from, to);
    h.run_steps(30);
    let greatest = limits(&h).end().to_degrees();
    assert!((greatest - 140.0).abs() < 3.0, "{greatest}");
    assert_eq!(*limits(&h).start(), 0.0, "the other end stays");
    assert!(area(&h) < before - 1e-3, "the workspace is smaller: {} of {before}", area(&h));
    assert!(session(&h).undo_title().expect("one undo").contains("a1"), "{:?}", session(&h).undo_title());
    // Turned on to its limit, link 5 would lie on the end of the arc.
    let (pin, along, on) = {
        let (f, stage) = (session(&h).frame(), h.state().app_state().stage());
        let bar = stage.linkage().bars().iter().find(|bar| bar.name == "5").expect("a link");
        let (root, along, _) = bar.pose(&f.q.units());
        (root, along, limits(&h).end() - f.a[0])
    };
    let [x, y, _] = end(&h);
    let way = stillbase::mechanics::planar::Vector::new(x - pin.re, y - pin.im) * along.conj();
    assert!((way.arg() - on).abs() < 1e-6, "{way} {on}");
}

fn a_payload_is_hung_on_and_aside() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    let load = |h: &Window| session(h).scenario().plant.payload;
    let tip = on_screen(&h, 0.5, 0.5);
    choose(&mut h, tip, "Hang a payload of 0.3 kg on it");
    assert_eq!((load(&h).mass, load(&h).offset), (0.3, [0.0; 2]));
    // Under the target it is held by its mass.
    h.run_steps(2);
    let name = written(&h, "0.3 kg");
    let side = on_screen(&h, 0.5 + 0.08, 0.5 + 0.06);
    drag(&mut h, name, side);
    h.run_steps(3);
    let at = h.state().app_state().stage().payload(&session(&h).frame().into()).expect("it hangs");
    assert!((at.re - 0.58).abs() < 3e-3 && (at.im - 0.56).abs() < 3e-3, "{at}");
    assert!((load(&h).offset[0].hypot(load(&h).offset[1]) - 0.1).abs() < 4e-3, "{:?}", load(&h).offset);
    let back = on_screen(&h, 0.503, 0.502);
    drag(&mut h, side, back);
    h.run_steps(3);
    assert_eq!(load(&h).offset, [0.0; 2], "back at the end effector");
}

fn the_target_is_typed() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    type_into(&mut h, "target x m", "55 cm");
    type_into(&mut h, "target y m", "0.5 + 0.1");
    h.run_steps(150);
    let f = session(&h).frame();
    assert!((f.end_effector.re - 0.55).abs() < 1e-4 && (f.end_effector.im - 0.6).abs() < 1e-4, "{}", f.end_effector);
    assert!((f.b - 2.4).abs() < 1e-9 && f.peaks.is_reactionless());
    type_into(&mut h, "target x m", "nan");
    assert!(h.state().app_state().view_state().status.message.as_ref().is_some_and(|message| message.is_problem));
}

/// The pointer moves with keys held, and stays down.
fn move_with(h: &mut Window, [from, to]: [Pos2; 2], modifiers: Modifiers) {
    h.event(egui::Event::ModifiersChanged(modifiers));
    let moved = |h: &mut Window, at: Pos2| {
        h.input_mut().events.push(egui::Event::PointerMoved(at));
        h.step();
    };
    moved(h, from);
    let pos = from;
    h.input_mut().events.push(egui::Event::PointerButton {
        pos,
        button: PointerButton::Primary,
        pressed: true,
        modifiers,
    });
    h.step();
    for i in 1..=10 {
        moved(h, from + (to - from) * (i as f32 / 10.0));
    }
}

/// The button comes up with the keys still held, then they are let go.
fn release(h: &mut Window, at: Pos2) {
    h.input_mut().events.push(egui::Event::PointerButton {
        pos: at,
        button: PointerButton::Primary,
        pressed: false,
        modifiers: Modifiers::NONE,
    });
    h.step();
    h.event(egui::Event::ModifiersChanged(Modifiers::NONE));
    h.run_steps(2);
}

fn shift_drags_fine_and_ctrl_to_round_numbers() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    let end = |h: &Window| session(h).scenario().task.to;
    // B by 0.1 m with Shift: a tenth of that.
    let way = [on_screen(&h, 0.55, 0.90), on_screen(&h, 0.55, 0.80)];
    move_with(&mut h, way, Modifiers::SHIFT);
    release(&mut h, way[1]);
    let [x, y] = end(&h);
    assert!((x - 0.55).abs() < 2e-3 && (y - 0.89).abs() < 2e-3, "{x} {y}");
    // With Ctrl to whole centimetres.
    let way = [on_screen(&h, x, y), on_screen(&h, 0.5832, 0.7619)];
    move_with(&mut h, way, Modifiers::CTRL);
    release(&mut h, way[1]);
    let [x, y] = end(&h);
    assert!((x - 0.58).abs() < 1e-12 && (y - 0.76).abs() < 1e-12, "{x} {y}");
    // A link to round angles of its drive, with b as it was.
    let (i, from) = link(&h, "1");
    let to = swung(&h, i, from, 0.3);
    move_with(&mut h, [from, to], Modifiers::CTRL);
    h.run_steps(60);
    let angle = session(&h).frame().q[0].to_degrees();
    assert!((angle / 5.0 - (angle / 5.0).round()).abs() < 1e-4, "{angle}");
    assert!((session(&h).frame().b - 2.4).abs() < 1e-9);
    release(&mut h, to);
}

fn numbers_of_the_panel_are_dragged_fine_round_and_not_at_all() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    let b = |h: &Window| session(h).frame().b;
    let slider = h.get_by_role_and_label(Role::Slider, "b slider").rect();
    let period = session(&h).run().planes().expect("planes").map().period();
    let per_point = period / f64::from(slider.width() - slider.height());
    // From its knob, so that pressing does not move it.
    let knob = pos2(slider.left() + 0.5 * slider.height() + (2.4 / per_point) as f32, slider.center().y);
    let way = [knob, knob + vec2(8.0, 0.0)];
    let start = b(&h);
    move_with(&mut h, way, Modifiers::SHIFT);
    let fine = b(&h) - start;
    release(&mut h, way[1]);
    let full = 8.0 * per_point;
    assert!(fine > 0.03 * full && fine < 0.3 * full, "{fine} of {full}");
    let undos = session(&h).undo_count();
    let way = [way[0], way[0] + vec2(6.0, 0.0)];
    move_with(&mut h, way, Modifiers::CTRL);
    release(&mut h, way[1]);
    let round = b(&h) / 0.05;
    assert!((round - round.round()).abs() < 1e-9, "{}", b(&h));
    assert_eq!(session(&h).undo_count(), undos + 1);
    // Esc gives a drag up, and the pointer moves nothing any more.
    let (before, undos) = (b(&h), session(&h).undo_count());
    let way = [way[1], way[1] + vec2(-12.0, 0.0)];
    move_with(&mut h, way, Modifiers::NONE);
    assert!((b(&h) - before).abs() > 1e-3, "{}", b(&h));
    h.key_press(Key::Escape);
    h.run_steps(2);
    h.hover_at(way[0] + vec2(-30.0, 0.0));
    h.run_steps(2);
    assert_eq!(b(&h), before);
    release(&mut h, way[0]);
    assert_eq!((b(&h), session(&h).undo_count()), (before, undos));
}

fn numbers_are_typed_with_units_and_arithmetic() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    let task = |h: &Window| session(h).scenario().task.clone();
    type_into(&mut h, "time T s", "1500 ms");
    assert_eq!(task(&h).time, 1.5);
    type_into(&mut h, "B x m", "1.1/2 + 0.5 cm / 1 cm");
    assert_eq!(task(&h).to[0], 0.55, "different kinds are not added");
    let Message { text: said, is_problem: bad } =
        h.state().app_state().view_state().status.message.clone().expect("it is said");
    assert!(bad && said.contains("B x") && said.contains("different kinds"), "{said}");
    type_into(&mut h, "B x m", "56 cm");
    assert!((task(&h).to[0] - 0.56).abs() < 1e-12);
    type_into(&mut h, "b rad", "135 deg + 2 deg");
    assert!((session(&h).frame().b - 137_f64.to_radians()).abs() < 1e-9, "{}", session(&h).frame().b);
    type_into(&mut h, "a₁ greatest rad", "180 deg");
    assert!((session(&h).scenario().machine.angles()[0].limits.end() - std::f64::consts::PI).abs() < 1e-12);
}

/// A click with the right button, and one on an entry of the menu that opens.
fn choose(h: &mut Window, at: Pos2, entry: &str) {
    h.hover_at(at);
    h.step();
    for pressed in [true, false] {
        let (button, modifiers) = (PointerButton::Secondary, Modifiers::NONE);
        h.event(egui::Event::PointerButton { pos: at, button, pressed, modifiers });
        h.step();
    }
    h.run_steps(3);
    h.get_by_label_contains(entry).click();
    h.run_steps(3);
}

fn the_right_button_offers_what_can_be_done_there() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    let points = |h: &Window| session(h).scenario().task.points();
    let free = on_screen(&h, 0.62, 0.70);
    choose(&mut h, free, "Add a point of the path here");
    assert_eq!(points(&h).len(), 3);
    assert!((points(&h)[1].re - 0.62).abs() < 2e-3 && (points(&h)[1].im - 0.70).abs() < 2e-3, "{:?}", points(&h));
    let at = on_screen(&h, 0.62, 0.70);
    choose(&mut h, at, "Leave point 1 out");
    assert_eq!(points(&h).len(), 2);
    let (_, at) = link(&h, "5");
    choose(&mut h, at, "Show in the panel");
    h.run_steps(30);
    assert!(h.query_by_label("link 5 mass kg").is_some());
    let free = on_screen(&h, 0.60, 0.65);
    choose(&mut h, free, "Send the target here");
    let target = session(&h).frame().target.at;
    assert!((target.re - 0.60).abs() < 2e-3 && (target.im - 0.65).abs() < 2e-3, "{target}");
}
