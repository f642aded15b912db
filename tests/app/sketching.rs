//! A machine is drawn: a template, bars by the pointer and by numbers, drives, what is missing.

use egui::{Key, Modifiers, Pos2};
use egui_kittest::kittest::Queryable as _;
use stillbase::app::{PenTool, SessionCommand};
use stillbase::mechanics::sketch::{Sketch, Template, resolve};
use stillbase::picture::scene::palette::Theme;
use stillbase::picture::scene::views::ViewKind;

use super::{Window, drag, seen, session, window};
use crate::Test;

pub const TESTS: &[Test] = tests![
    a_template_is_chosen_by_its_picture,
    a_bar_is_drawn_follows_a_drive_and_is_undone,
    numbers_are_typed_while_a_bar_is_drawn,
    what_is_missing_is_mended_by_buttons,
    a_refused_step_is_told_at_its_pin,
    a_machine_grows_from_nothing_by_the_pointer,
];

/// A window in which a template is drawn.
fn drawing(template: Template, theme: Theme) -> Window {
    let mut h = window("case-3", theme);
    h.run_steps(2);
    h.state_mut().app_state_mut().carry_out(SessionCommand::NewDrawing(template));
    h.run_steps(6);
    h
}

fn sketch(h: &Window) -> Sketch {
    session(h).scenario().drawing()
}

/// Where a point of the drawing is on the screen.
fn at(h: &Window, x: f64, y: f64) -> Pos2 {
    seen(h, [x, y, 0.0])
}

/// Where the pin at the end of a bar is on the screen.
fn tip(h: &Window, bar: usize) -> Pos2 {
    let sketch = sketch(h);
    let place = sketch.at(sketch.bars[bar].tip);
    at(h, place.re, place.im)
}

fn click(h: &mut Window, pos: Pos2) {
    h.hover_at(pos);
    h.step();
    h.drag_at(pos);
    h.step();
    h.drop_at(pos);
    h.step();
}

fn tool(h: &mut Window, label: &str) {
    h.get_by_label(label).click();
    h.run_steps(3);
}

fn a_template_is_chosen_by_its_picture() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    h.get_by_label("Machine").click();
    h.run_steps(4);
    h.get_by_label_contains("new machine: pantograph").click();
    h.run_steps(8);
    let view_state = h.state().app_state().view_state();
    assert_eq!(view_state.view, ViewKind::Design);
    assert_eq!(view_state.pen.as_ref().map(|pen| pen.tool), Some(PenTool::Move));
    assert_eq!(sketch(&h), Template::Pantograph.sketch());
    assert_eq!(Some(&session(&h).scenario().machine), Template::Pantograph.sketch().machine().as_ref());
    assert!(session(&h).run().waiting().is_none(), "a task was made for it");
    assert!(h.query_by_label_contains("nothing: this is a machine").is_some());
    h.get_by_label("Done drawing").click();
    h.run_steps(3);
    assert!(h.state().app_state().view_state().pen.is_none());
    assert!(h.query_by_label("mass of link 1 kg").is_some(), "the table of links");
    h.get_by_label("Draw the machine").click();
    h.run_steps(3);
    assert!(h.state().app_state().view_state().pen.is_some());
}

fn a_bar_is_drawn_follows_a_drive_and_is_undone() {
    let mut h = drawing(Template::SerialOfTwo, Theme::Dark);
    let before = sketch(&h);
    tool(&mut h, "draw: bar");
    let (from, to) = (tip(&h, 1), tip(&h, 1) + egui::vec2(70.0, 40.0));
    drag(&mut h, from, to);
    h.run_steps(4);
    let drawn = sketch(&h);
    assert_eq!(drawn.bars.len(), 3);
    assert_eq!(drawn.bars[2].root, before.bars[1].tip, "it hangs on the pin where it began");
    assert!(h.query_by_label_contains("bar 3 follows no drive").is_some());
    // A click on the bar shows its card, which says its drive.
    let middle = from + 0.5 * (tip(&h, 2) - from);
    click(&mut h, middle);
    h.run_steps(3);
    h.get_by_label("drive of the bar").click();
    h.run_steps(3);
    h.get_all_by_label("drive 2").next().expect("in the list").click();
    h.run_steps(4);
    assert_eq!(sketch(&h).bars[2].drive.as_deref(), Some("2"));
    for left in [None, Some(2)] {
        h.key_press_modifiers(Modifiers::COMMAND, Key::Z);
        h.run_steps(4);
        match left {
            None => assert_eq!(sketch(&h), drawn),
            Some(bars) => assert_eq!(sketch(&h).bars.len(), bars),
        }
    }
    for _ in 0..2 {
        h.key_press_modifiers(Modifiers::COMMAND, Key::Y);
        h.run_steps(4);
    }
    assert_eq!(sketch(&h).bars[2].drive.as_deref(), Some("2"));
    egui_kittest::image_snapshot(&h.render().expect("drawn"), "sketch-dark");
}

fn numbers_are_typed_while_a_bar_is_drawn() {
    let mut h = drawing(Template::Blank, Theme::Light);
    let base = at(&h, 0.0, 0.0);
    click(&mut h, base);
    h.run_steps(2);
    h.hover_at(base + egui::vec2(60.0, -35.0));
    h.run_steps(2);
    let events = |h: &mut Window, text: &str| h.event(egui::Event::Text(text.into()));
    events(&mut h, "260");
    h.run_steps(2);
    h.key_press(Key::Tab);
    h.run_steps(2);
    events(&mut h, "-35.5");
    h.run_steps(2);
    assert!(sketch(&h).bars.is_empty(), "digits are no shortcuts");
    h.key_press(Key::Enter);
    h.run_steps(5);
    let drawn = sketch(&h);
    assert_eq!(drawn.bars.len(), 1);
    let span = drawn.span(&drawn.bars[0]);
    assert!((span.norm() - 0.26).abs() < 1e-9, "{span}");
    assert!((span.arg().to_degrees() + 35.5).abs() < 1e-9, "{span}");
    // Esc gives up a bar under way.
    click(&mut h, base);
    h.run_steps(2);
    assert!(h.state().app_state().view_state().pen.as_ref().is_some_and(|pen| pen.from.is_some()));
    h.key_press(Key::Escape);
    h.run_steps(3);
    assert!(h.state().app_state().view_state().pen.as_ref().is_some_and(|pen| pen.from.is_none()));
    assert_eq!(sketch(&h).bars.len(), 1);
}

fn what_is_missing_is_mended_by_buttons() {
    let mut h = drawing(Template::Blank, Theme::Dark);
    let mut presses = 0;
    while let Some(mend) = resolve(&sketch(&h)).missing.first().and_then(|one| one.mends.first().cloned()) {
        let before = sketch(&h);
        h.get_all_by_label(&mend.label).next().expect("a button").click();
        h.run_steps(5);
        assert_eq!(sketch(&h), before.with(&mend.step).expect("tried"));
        presses += 1;
        assert!(presses < 8, "it ends");
    }
    // Without the pointer, a bar is added by numbers.
    let before = sketch(&h);
    h.get_by_label("add the new bar").click();
    h.run_steps(5);
    let added = sketch(&h);
    assert_eq!((added.bars.len(), added.bars.last().map(|bar| bar.root)), (before.bars.len() + 1, Some(before.base)));
    h.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    h.run_steps(5);
    let machine = resolve(&sketch(&h)).machine.expect("a machine");
    assert_eq!((&session(&h).scenario().machine, machine.drives()), (&machine, 1));
}

fn a_refused_step_is_told_at_its_pin() {
    let mut h = drawing(Template::SerialOfTwo, Theme::Light);
    let before = sketch(&h);
    tool(&mut h, "draw: delete");
    let base = at(&h, 0.0, 0.0);
    click(&mut h, base);
    h.run_steps(4);
    assert_eq!(sketch(&h), before);
    assert!(h.query_all_by_label_contains("B is where the machine stands").count() >= 2, "at the pin and at the left");
    h.key_press(Key::Escape);
    h.run_steps(3);
    assert_eq!(h.query_all_by_label_contains("B is where the machine stands").count(), 0);
}

fn a_machine_grows_from_nothing_by_the_pointer() {
    let mut h = drawing(Template::Blank, Theme::Dark);
    let before = session(&h).scenario().machine.clone();
    let (base, elbow, end) = (at(&h, 0.0, 0.0), at(&h, 0.0, 0.3), at(&h, 0.2, 0.4));
    drag(&mut h, base, elbow);
    h.run_steps(4);
    drag(&mut h, elbow, end);
    h.run_steps(4);
    assert_eq!(sketch(&h).bars.len(), 2);
    assert_eq!(session(&h).scenario().machine, before, "incomplete");
    assert!(h.query_by_label_contains("stand here as soon as nothing is missing").is_some());
    tool(&mut h, "draw: motor");
    for pin in [base, elbow] {
        click(&mut h, pin);
        h.run_steps(4);
    }
    tool(&mut h, "draw: end effector");
    let pin = tip(&h, 1);
    click(&mut h, pin);
    h.run_steps(6);
    let machine = &session(&h).scenario().machine;
    assert_eq!((machine.name(), machine.drives(), machine.links().len()), ("my arm", 2, 2));
    assert!(h.query_by_label_contains("g₁, no force").is_some(), "its balance is live");
    // A pin is dragged, and the machine follows at its release.
    tool(&mut h, "draw: move");
    drag(&mut h, pin, pin + egui::vec2(24.0, 0.0));
    h.run_steps(5);
    let (old, new) = (sketch(&h), session(&h).scenario().machine.clone());
    assert_eq!(old.machine().as_ref(), Some(&new));
    assert!((tip(&h, 1) - pin).length() > 10.0);
}
