//! A machine is drawn: a template, bars by the pointer and by numbers, drives, what is missing.

use egui::{Key, Modifiers, Pos2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use stillbase::app::{PenChange, PenTool, SessionCommand, ViewChange};
use stillbase::mechanics::machine::PlaceOnLink;
use stillbase::mechanics::sketch::{BarEnd, Sketch, SketchStep, Template, resolve};
use stillbase::picture::scene::palette::Theme;
use stillbase::picture::scene::sketching::{DrawnArc, SketchItem};
use stillbase::picture::scene::views::ViewKind;
use stillbase::session::Edit;

use super::{Window, drag, seen, session, window};
use crate::Test;

pub const TESTS: &[Test] = tests![
    a_template_is_chosen_by_its_picture,
    a_bar_is_drawn_follows_a_drive_and_is_undone,
    numbers_are_typed_while_a_bar_is_drawn,
    what_is_missing_is_mended_by_buttons,
    a_refused_step_is_told_at_its_pin,
    a_machine_grows_from_nothing_by_the_pointer,
    a_bar_is_made_of_a_section,
    lumps_are_put_dragged_typed_and_deleted,
    typed_numbers_that_overrule_a_lump_are_told_at_once,
    an_unfinished_drawing_is_told_in_every_view,
    things_that_are_gone_are_chosen_no_more,
    limits_are_dragged_at_their_arcs_and_typed,
    a_pin_dropped_on_another_becomes_one_with_it,
    the_balance_follows_the_pin_under_the_pointer,
    a_bar_by_numbers_closes_a_loop_without_the_pointer,
    numbers_off_the_axis_are_found_in_the_design_view,
    bars_are_drawn_by_the_keyboard_alone,
    what_is_typed_near_a_pin_stands_as_typed,
    a_field_with_the_focus_is_in_view,
    commands_lead_to_the_fields_of_a_drawing,
    lengths_and_angles_of_a_drawing_are_in_mm_and_degrees,
];

/// A window in which a template is drawn.
fn drawing(template: Template, theme: Theme) -> Window {
    let mut h = window("case-3", theme);
    h.run_steps(2);
    h.state_mut().app_state_mut().carry_out(SessionCommand::NewDrawing(template));
    h.run_steps(6);
    h
}

pub(super) fn sketch(h: &Window) -> Sketch {
    session(h).scenario().drawing()
}

/// Where a point of the drawing is on the screen.
pub(super) fn at(h: &Window, x: f64, y: f64) -> Pos2 {
    seen(h, [x, y, 0.0])
}

/// Where the pin at the end of a bar is on the screen.
pub(super) fn tip(h: &Window, bar: usize) -> Pos2 {
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
    assert!(h.query_all_by_label_contains("bar 3 follows no drive").count() > 0);
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

/// Chooses a word of a list, by the label of the list.
fn choose(h: &mut Window, list: &str, word: &str) {
    h.get_by_label(list).click();
    h.run_steps(3);
    h.get_all_by_label(word).last().expect("in the list").click();
    h.run_steps(5);
}

fn a_bar_is_made_of_a_section() {
    let mut h = drawing(Template::SerialOfTwo, Theme::Dark);
    let before = sketch(&h);
    let (from, to) = (at(&h, 0.0, 0.0), tip(&h, 0));
    click(&mut h, from + 0.5 * (to - from));
    h.run_steps(3);
    assert!(h.query_by_label_contains("kg, by its parts").is_some());
    assert!(h.query_by_label_contains("hole diameter of bar 1").is_some());
    choose(&mut h, "section of bar 1", "tube");
    choose(&mut h, "material of bar 1", "steel");
    let made = sketch(&h);
    assert_eq!((made.parts.len(), made.parts[0].material.as_str()), (2, "steel"));
    let mass = made.body(&made.bars[0]).mass;
    assert_eq!(session(&h).scenario().machine.links()[0].mass, mass);
    assert!((mass - before.body(&before.bars[0]).mass).abs() > 0.01);
    choose(&mut h, "section of bar 1", "no section");
    assert!(h.query_by_label_contains("kg, by a slender bar").is_some());
    for _ in 0..3 {
        h.key_press_modifiers(Modifiers::COMMAND, Key::Z);
        h.run_steps(4);
    }
    assert_eq!(sketch(&h), before);
}

fn lumps_are_put_dragged_typed_and_deleted() {
    let mut h = drawing(Template::SerialOfTwo, Theme::Dark);
    let before = sketch(&h);
    tool(&mut h, "draw: lump");
    let (from, to) = (at(&h, 0.0, 0.0), tip(&h, 0));
    click(&mut h, from + 0.6 * (to - from));
    h.run_steps(4);
    let put = sketch(&h);
    let along = |h: &Window| {
        let sketch = sketch(h);
        (sketch.lump_at(&sketch.bars[0], &sketch.lumps[0]).0, sketch.lumps[0].across)
    };
    assert_eq!((put.lumps.len(), put.lumps[0].mass, along(&h).1), (1, 0.1, 0.0));
    assert!((along(&h).0 - 0.24).abs() < 0.01, "{:?}", along(&h));
    assert!(h.query_by_label("mass of lump 1 of bar 1 kg").is_some(), "its card");
    egui_kittest::image_snapshot(&h.render().expect("drawn"), "lump-dark");
    let heavier = put.body(&put.bars[0]).mass - before.body(&before.bars[0]).mass;
    assert!((heavier - 0.1).abs() < 1e-12, "it counts at once");
    assert_eq!(session(&h).scenario().machine.links()[0].mass, put.body(&put.bars[0]).mass);
    // Dragged off the axis; undone; onto the tip, where it stays at the pin.
    tool(&mut h, "draw: move");
    let spot = |h: &Window| {
        let sketch = sketch(h);
        let place = sketch.lump_at(&sketch.bars[0], &sketch.lumps[0]).1;
        at(h, place.re, place.im)
    };
    let held = spot(&h);
    drag(&mut h, held, held + egui::vec2(60.0, 0.0));
    h.run_steps(4);
    assert!(along(&h).1 < -0.02, "{:?}", along(&h));
    h.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    h.run_steps(4);
    assert_eq!(sketch(&h), put);
    let held = spot(&h);
    drag(&mut h, held, to + egui::vec2(3.0, 0.0));
    h.run_steps(4);
    assert_eq!(sketch(&h).lumps[0].at, PlaceOnLink::Named("tip".into()));
    super::type_into(&mut h, "mass of lump 1 of bar 1 kg", "0.4");
    assert_eq!(sketch(&h).lumps[0].mass, 0.4);
    h.get_by_label("delete lump 1 of bar 1").click_accesskit();
    h.run_steps(4);
    assert_eq!(sketch(&h).lumps, []);
    assert!(h.state().app_state().view_state().pen.as_ref().is_some_and(|pen| pen.chosen.is_none()));
}

fn typed_numbers_that_overrule_a_lump_are_told_at_once() {
    let mut h = drawing(Template::NineLinks, Theme::Light);
    let paper = session(&h).scenario().machine.clone();
    let bar = sketch(&h).bars[0].id;
    let choose = PenChange::Choose(Some(SketchItem::Bar(bar)));
    h.state_mut().app_state_mut().carry_out(ViewChange::Pen(choose));
    h.run_steps(3);
    assert!(h.query_by_label_contains("overrule its parts").is_none(), "it has no parts yet");
    h.get_by_label("add a lump to bar 1").click_accesskit();
    h.run_steps(4);
    assert_eq!(session(&h).scenario().machine.links()[0].mass, paper.links()[0].mass);
    assert!(h.query_by_label_contains("overrule its parts").is_some(), "beside the lump");
    h.get_by_label("back to the parts: bar 1").click_accesskit();
    h.run_steps(4);
    assert_eq!(session(&h).scenario().machine.links()[0].mass, 0.1);
    assert!(h.query_by_label_contains("overrule its parts").is_none());
}

fn an_unfinished_drawing_is_told_in_every_view() {
    let mut h = drawing(Template::Blank, Theme::Dark);
    let said = |h: &Window, words: &str| h.query_all_by_label_contains(words).count() > 0;
    assert!(said(&h, "machine: 3 things missing") && said(&h, "no bar yet, and 2 more"));
    assert!(!said(&h, "off balance by") && !said(&h, "holds b"), "nothing of the machine before");
    h.get_by_label("Done drawing").click();
    h.run_steps(4);
    assert!(said(&h, "machine: 3 things missing") && said(&h, "stand here as soon as it is a machine"));
    assert!(h.query_by_label("mass of link 1 kg").is_none(), "no table of the links of another machine");
    for view in [ViewKind::Design, ViewKind::Flat, ViewKind::Space, ViewKind::Joints, ViewKind::Tower] {
        h.state_mut().app_state_mut().carry_out(ViewChange::Kind(view));
        h.run_steps(4);
        assert!(said(&h, "my arm is no machine yet") && said(&h, "• no bar yet"), "{view:?}");
        let numbers = ["reactionless workspace", "N m", "b = ", "POSE CONSTANT", "drag me"];
        let texts = super::painted(&h);
        let stale = texts.iter().find(|text| numbers.iter().any(|words| text.contains(words)));
        assert_eq!(stale, None, "of the machine before, in {view:?}");
    }
    h.get_by_label("draw on").click();
    h.run_steps(4);
    assert!(h.state().app_state().view_state().pen.is_some());
}

/// After a step is undone or two pins became one, nothing that is gone is chosen.
fn things_that_are_gone_are_chosen_no_more() {
    let mut h = drawing(Template::SerialOfTwo, Theme::Dark);
    tool(&mut h, "draw: bar");
    let (from, to) = (tip(&h, 1), tip(&h, 1) + egui::vec2(70.0, 40.0));
    drag(&mut h, from, to);
    h.run_steps(4);
    tool(&mut h, "draw: move");
    let end = tip(&h, 2);
    click(&mut h, end);
    h.run_steps(3);
    let chosen = |h: &Window| h.state().app_state().view_state().pen.as_ref().and_then(|pen| pen.chosen);
    let pin = sketch(&h).bars[2].tip;
    assert_eq!(chosen(&h), Some(SketchItem::Pin(pin)));
    h.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    h.run_steps(4);
    assert_eq!((sketch(&h).bars.len(), chosen(&h)), (2, None));
}

/// Where the end of the first arc is on the screen.
fn grip(h: &Window, end: usize) -> Pos2 {
    let sketch = sketch(h);
    let arcs = DrawnArc::all(&sketch);
    let [x, y] = arcs[0].on(arcs[0].arc.range[end], 1.0);
    at(h, x, y)
}

fn limits_are_dragged_at_their_arcs_and_typed() {
    let mut h = drawing(Template::SerialOfTwo, Theme::Light);
    let before = sketch(&h);
    let limits = |h: &Window| {
        let angle = sketch(h).angles[0].clone();
        [angle.min.expect("limited"), angle.max.expect("limited")]
    };
    let [low, high] = limits(&h);
    let (from, arc) = (grip(&h, 1), DrawnArc::all(&before).remove(0));
    let [x, y] = arc.on(high - 0.5, 1.0);
    let to = at(&h, x, y);
    drag(&mut h, from, to);
    h.run_steps(5);
    let dragged = limits(&h);
    assert!((dragged[1] - (high - 0.5)).abs() < 0.03 && dragged[0] == low, "{dragged:?}");
    let degrees = dragged[1].to_degrees();
    assert!((degrees - degrees.round()).abs() < 1e-9, "{degrees}");
    assert_eq!(session(&h).scenario().machine.spec().angles[0].max, Some(dragged[1]));
    h.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    h.run_steps(5);
    assert_eq!(sketch(&h), before, "one step");
    // Without the pointer: off, and on again about the angle as it is drawn.
    h.get_by_label("no limits of drive 2 from drive 1").click();
    h.run_steps(5);
    assert_eq!((sketch(&h).angles[0].min, DrawnArc::all(&sketch(&h)).len()), (None, 0));
    h.get_by_label("limit the angle of drive 2 from drive 1").click();
    h.run_steps(5);
    let [low, high] = limits(&h);
    let now = DrawnArc::all(&sketch(&h))[0].arc.now;
    assert!(low < now && now < high && (high - low - 3.0).abs() < 0.1, "{low} {now} {high}");
    // Esc gives up a drag.
    let limited = sketch(&h);
    let (from, to) = (grip(&h, 0), grip(&h, 0) + egui::vec2(20.0, 20.0));
    h.hover_at(from);
    h.step();
    h.drag_at(from);
    h.step();
    let least = |h: &Window| {
        let node = h.get_by_label("least angle of drive 2 from drive 1 °");
        node.accesskit_node().value().expect("a number")
    };
    let was = least(&h);
    h.hover_at(to);
    h.run_steps(3);
    assert_ne!(least(&h), was, "the field follows the arc");
    h.key_press(Key::Escape);
    h.run_steps(2);
    h.drop_at(to);
    h.run_steps(4);
    assert_eq!((sketch(&h), least(&h)), (limited, was));
}

fn a_pin_dropped_on_another_becomes_one_with_it() {
    let mut h = drawing(Template::SerialOfTwo, Theme::Dark);
    tool(&mut h, "draw: bar");
    let (from, to) = (at(&h, 0.2, -0.05), at(&h, 0.3, 0.05));
    drag(&mut h, from, to);
    h.run_steps(4);
    let loose = sketch(&h);
    assert!(h.query_all_by_label_contains("bar 3 is not connected to the base").count() > 0);
    tool(&mut h, "draw: move");
    let (held, onto) = (loose.bars[2].root, loose.bars[1].tip);
    let [from, to] = [held, onto].map(|pin| at(&h, loose.at(pin).re, loose.at(pin).im));
    h.hover_at(from);
    h.step();
    h.drag_at(from);
    h.step();
    h.hover_at(to);
    h.run_steps(3);
    let pen = h.state().app_state().view_state().pen.clone().expect("drawing");
    let drag = pen.drag.expect("under way");
    assert!(matches!(drag.step, Some(SketchStep::Weld { .. })) && drag.onto.is_some(), "{drag:?}");
    assert_eq!(sketch(&h), loose, "not before the release");
    h.drop_at(to);
    h.run_steps(5);
    let welded = sketch(&h);
    assert_eq!((welded.pins.len(), welded.bars[2].root), (loose.pins.len() - 1, onto));
    h.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    h.run_steps(5);
    assert_eq!(sketch(&h), loose);
}

fn the_balance_follows_the_pin_under_the_pointer() {
    let mut h = drawing(Template::SerialOfTwo, Theme::Dark);
    h.run_steps(4);
    let reads = |h: &Window, words: &str| {
        let node = h.query_all_by_label_contains(words).next()?;
        let node = node.accesskit_node();
        node.value().or_else(|| node.label())
    };
    let row = |h: &Window| reads(h, "g₁, no force").expect("a row of the balance");
    let (before, machine) = (row(&h), session(&h).scenario().machine.clone());
    let pin = tip(&h, 0);
    h.hover_at(pin);
    h.step();
    h.drag_at(pin);
    h.step();
    h.hover_at(pin + egui::vec2(90.0, -60.0));
    h.run_steps(4);
    assert_ne!(row(&h), before, "while the pin is held");
    assert_eq!(session(&h).scenario().machine, machine, "the session waits for the release");
    let during = row(&h);
    h.drop_at(pin + egui::vec2(90.0, -60.0));
    h.run_steps(5);
    assert_eq!(row(&h), during);
    assert_ne!(session(&h).scenario().machine, machine);
}

fn a_bar_by_numbers_closes_a_loop_without_the_pointer() {
    let mut h = drawing(Template::Blank, Theme::Dark);
    let bar = |h: &mut Window, from: BarEnd, to: BarEnd| {
        let edit = Edit::Sketch(SketchStep::Bar { from, to, name: None });
        h.state_mut().app_state_mut().carry_out(SessionCommand::Edit(edit));
        h.run_steps(3);
    };
    let base = BarEnd::pin(sketch(&h).base);
    bar(&mut h, base, BarEnd::At([0.3, 0.0]));
    bar(&mut h, base, BarEnd::At([0.0, 0.3]));
    let arm = BarEnd::pin(sketch(&h).bars[0].tip);
    bar(&mut h, arm, BarEnd::At([0.3, 0.3]));
    // Its usual length and angle lead up from the pin that is chosen; here from the tip of the first arm.
    h.get_by_label("new bar from").click();
    h.run_steps(3);
    let pin = sketch(&h).bars[1].tip;
    h.get_all_by_label(&format!("pin {}", pin.0)).last().expect("in the list").click();
    h.run_steps(3);
    h.get_by_label("angle of the new bar °").click();
    h.run_steps(2);
    for key in [Key::Num0, Key::Enter] {
        h.key_press(key);
        if key == Key::Num0 {
            h.event(egui::Event::Text("0".into()));
        }
        h.run_steps(2);
    }
    h.run_steps(4);
    let closed = sketch(&h);
    assert_eq!((closed.bars.len(), closed.bars[3].tip), (4, closed.bars[2].tip), "on the pin that is there");
    assert_eq!(resolve(&closed).loops.len(), 1);
    // Without the bar, the next one begins where it began.
    h.get_by_label("add the new bar").click();
    h.run_steps(3);
    assert_eq!(sketch(&h).bars.len(), 5);
    h.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    h.run_steps(3);
    let from = h.get_by_label("new bar from").accesskit_node().value();
    assert_eq!((sketch(&h).bars.len(), from), (4, Some(format!("pin {}", closed.bars[3].tip.0))));
}

fn numbers_off_the_axis_are_found_in_the_design_view() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    h.key_press(Key::D);
    h.run_steps(5);
    for (path, label) in [
        ("link.5.com_normal", "centre of mass off the axis of link 5 m"),
        ("link.7.inertia", "inertia of link 7 kg m²"),
    ] {
        h.state_mut().app_state_mut().carry_out(ViewChange::LookUp(path.to_owned()));
        h.run_steps(4);
        assert_eq!(h.state().app_state().view_state().view, ViewKind::Design, "{path}");
        assert!(h.get_by_label(label).is_focused(), "{label}");
    }
    h.state_mut().app_state_mut().carry_out(ViewChange::LookUp("task.time".to_owned()));
    h.run_steps(4);
    assert_ne!(h.state().app_state().view_state().view, ViewKind::Design);
}

/// Types a text and ends it with a key.
fn types(h: &mut Window, text: &str, end: Key) {
    h.event(egui::Event::Text(text.into()));
    h.run_steps(2);
    h.key_press(end);
    h.run_steps(4);
}

/// Calls a command by words from its name.
fn calls(h: &mut Window, words: &str) {
    h.key_press_modifiers(Modifiers::COMMAND, Key::K);
    h.run_steps(3);
    types(h, words, Key::Enter);
}

fn bars_are_drawn_by_the_keyboard_alone() {
    let mut h = drawing(Template::Blank, Theme::Dark);
    calls(&mut h, "bar by numbers");
    assert!(h.get_by_label("length of the new bar mm").is_focused());
    types(&mut h, "300", Key::Enter);
    assert!(h.get_by_label("angle of the new bar °").is_focused());
    types(&mut h, "90", Key::Enter);
    // The next bar begins at the end of the last one.
    assert!(h.get_by_label("length of the new bar mm").is_focused());
    types(&mut h, "250", Key::Tab);
    types(&mut h, "-30", Key::Enter);
    let drawn = sketch(&h);
    assert_eq!(drawn.bars.len(), 2);
    assert_eq!((drawn.bars[0].root, drawn.bars[1].root), (drawn.base, drawn.bars[0].tip));
    let said: Vec<[f64; 2]> =
        drawn.bars.iter().map(|bar| [drawn.length(bar), drawn.span(bar).arg().to_degrees()]).collect();
    for (bar, wanted) in said.iter().zip([[0.3, 90.0], [0.25, -30.0]]) {
        assert!((bar[0] - wanted[0]).abs() < 1e-12 && (bar[1] - wanted[1]).abs() < 1e-9, "{bar:?} {wanted:?}");
    }
    // What is refused adds nothing, and keeps the number.
    types(&mut h, "1e9", Key::Tab);
    types(&mut h, "720", Key::Enter);
    assert_eq!(sketch(&h), drawn);
    // From another pin, chosen by the arrow keys.
    h.get_by_label("new bar from").focus();
    h.run_steps(2);
    h.key_press(Key::ArrowUp);
    h.run_steps(3);
    let chosen = h.state().app_state().view_state().pen.as_ref().and_then(|pen| pen.chosen);
    assert_eq!(chosen, Some(SketchItem::Pin(drawn.bars[0].tip)), "lit in the drawing");
}

fn what_is_typed_near_a_pin_stands_as_typed() {
    let mut h = drawing(Template::SerialOfTwo, Theme::Dark);
    tool(&mut h, "draw: bar");
    let before = sketch(&h);
    let (base, end) = (before.at(before.base), before.at(before.bars[1].tip));
    let away = (end - base).norm();
    let start = at(&h, base.re, base.im);
    let goal = at(&h, end.re, end.im);
    for off in [3e-4, 2e-3, 5e-3] {
        click(&mut h, start);
        h.run_steps(2);
        h.hover_at(goal);
        h.run_steps(2);
        types(&mut h, &format!("{:.1}", 1e3 * (away - off)), Key::Enter);
        let drawn = sketch(&h);
        assert_eq!(drawn.bars.len(), 3, "off by {off} m");
        let length = drawn.length(&drawn.bars[2]);
        let typed = (1e4 * (away - off)).round() * 1e-4;
        assert!((length - typed).abs() < 1e-9, "typed {typed} m, drawn {length} m");
        h.key_press_modifiers(Modifiers::COMMAND, Key::Z);
        h.run_steps(4);
        assert_eq!(sketch(&h), before);
    }
}

fn a_field_with_the_focus_is_in_view() {
    for (key, is_drawn) in [(None, true), (Some(Key::D), false)] {
        let mut h = window("case-3", Theme::Dark);
        h.run_steps(2);
        if is_drawn {
            h.state_mut().app_state_mut().carry_out(SessionCommand::NewDrawing(Template::Pantograph));
        }
        key.iter().for_each(|key| h.key_press(*key));
        h.run_steps(6);
        let mut seen = 0;
        for _ in 0..120 {
            h.key_press(Key::Tab);
            h.run_steps(24);
            let Some(rect) = focused(&h) else { continue };
            let height = h.ctx.content_rect().height();
            assert!(rect.top() >= 0.0 && rect.bottom() <= height, "{rect:?} is out of view");
            seen += 1;
        }
        assert!(seen > 60, "{seen}");
    }
}

/// Where the widget with the keyboard's focus is.
fn focused(h: &Window) -> Option<egui::Rect> {
    let id = h.ctx.memory(egui::Memory::focused)?;
    h.ctx.read_response(id).map(|response| response.rect)
}

fn commands_lead_to_the_fields_of_a_drawing() {
    let mut h = window("case-3", Theme::Light);
    h.run_steps(2);
    for (words, field) in [
        ("hang a motor", "pin of the new motor"),
        ("put the end effector", "pin of the end effector"),
        ("choose a bar or a pin", "bar or pin in the card"),
    ] {
        calls(&mut h, words);
        assert!(h.state().app_state().view_state().drawing_pen().is_some(), "{words}");
        assert!(h.get_by_label(field).is_focused(), "{words}");
        h.key_press_modifiers(Modifiers::SHIFT, Key::D);
        h.run_steps(3);
    }
}

fn lengths_and_angles_of_a_drawing_are_in_mm_and_degrees() {
    let mut h = drawing(Template::Pantograph, Theme::Light);
    let first = sketch(&h).bars[0].id;
    h.state_mut().app_state_mut().carry_out(ViewChange::Pen(PenChange::Choose(Some(SketchItem::Bar(first)))));
    h.run_steps(4);
    let shown = h.query_all_by_role(egui::accesskit::Role::SpinButton);
    let labels: Vec<String> = shown.filter_map(|field| field.accesskit_node().label()).collect();
    assert!(labels.iter().any(|label| label.ends_with(" mm")) && labels.iter().any(|label| label.ends_with(" °")));
    let other = labels.iter().find(|label| label.ends_with(" m") || label.ends_with(" rad"));
    assert_eq!(other, None);
    let step = SketchStep::MovePin { pin: sketch(&h).bars[0].tip, to: [0.12345, -0.2] };
    assert_eq!(step.title(), "move pin to 123.5, -200 mm");
}
