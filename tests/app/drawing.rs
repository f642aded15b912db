//! What a drawing shows beside its bars, and small things of its hand.

use egui::{Key, Modifiers, Pos2};
use egui_kittest::kittest::Queryable as _;
use stillbase::app::{PenChange, PenTool, Preferences, SessionCommand, Switch, ViewChange};
use stillbase::mechanics::machine::place_of;
use stillbase::mechanics::sketch::{BarEnd, Place, SketchRefusal, SketchStep, Template};
use stillbase::picture::paint::labels;
use stillbase::picture::scene::palette::Theme;
use stillbase::picture::scene::sketching::SketchItem;
use stillbase::picture::scene::views::ViewKind;
use stillbase::session::Edit;
use stillbase::session::scenario::Scenario;
use stillbase::settings::number::fixed;

use super::sketching::{at, sketch, tip};
use super::{Window, drag, on_screen, session, window, window_liked, window_of, written};
use crate::Test;

pub const TESTS: &[Test] = tests![
    counterweights_and_pins_are_seen_in_a_drawing,
    a_lump_beside_a_bar_goes_on_it,
    a_bar_chosen_in_the_list_is_deleted_and_dropped_by_keys,
    a_bar_that_leaves_the_view_takes_it_along,
    a_pin_on_a_bar_keeps_its_card,
    refusals_of_a_drawing_are_in_mm_and_degrees,
    a_machine_from_nothing_gets_a_task,
    headings_of_a_narrow_design_view_are_whole,
    the_word_on_a_balanced_machine_is_green,
    masses_of_counterweights_leave_pins_free,
];

fn drawing(template: Template) -> Window {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    h.state_mut().app_state_mut().carry_out(SessionCommand::NewDrawing(template));
    h.run_steps(6);
    h
}

fn click(h: &mut Window, pos: Pos2) {
    h.hover_at(pos);
    h.step();
    h.drag_at(pos);
    h.step();
    h.drop_at(pos);
    h.run_steps(4);
}

fn tool(h: &mut Window, tool: PenTool) {
    h.state_mut().app_state_mut().carry_out(ViewChange::Pen(PenChange::Tool(tool)));
    h.run_steps(3);
}

fn said(h: &Window, words: &str) -> bool {
    h.query_all_by_label_contains(words).count() > 0
}

fn chosen(h: &Window) -> Option<SketchItem> {
    h.state().app_state().view_state().pen.as_ref().and_then(|pen| pen.chosen)
}

/// The bare bars with the lightest counterweights, in the design view.
fn balanced() -> Window {
    let case = Scenario::builtin("nine-link-bare").expect("built in");
    let mut h = window_of(case, Theme::Dark, 900.0);
    h.run_steps(2);
    h.state_mut().app_state_mut().carry_out(ViewChange::Kind(ViewKind::Design));
    h.run_steps(4);
    for _ in 0..200 {
        if h.query_by_label("least mass").is_some() {
            break;
        }
        h.step();
    }
    h.get_by_label("least mass").click();
    h.run_steps(8);
    h
}

fn counterweights_and_pins_are_seen_in_a_drawing() {
    let mut h = balanced();
    h.state_mut().app_state_mut().carry_out(ViewChange::Switch(Switch::Sketching, true));
    h.run_steps(6);
    let drawn = sketch(&h);
    let rect = h.get_by_label_contains("Scene:").rect();
    assert!(!drawn.counterweights.is_empty());
    let placement = labels::last(&h.ctx, 0).expect("drawn");
    let mut written_down = 0;
    for weight in &drawn.counterweights {
        let bar = drawn.bars.iter().find(|bar| bar.name == weight.link).expect("drawn");
        let [_, [low, high]] = drawn.reach_of(bar, &drawn.body(bar));
        assert!((low..=high).contains(&weight.at), "its tail reaches it");
        for point in weight.outlines(16).into_iter().flatten() {
            let place = drawn.on_bar(bar, point);
            assert!(rect.contains(at(&h, place.re, place.im)), "it is in view as a whole");
        }
        let words = format!("{} kg", fixed(weight.mass, 3));
        written_down += usize::from(placement.all.iter().any(|own| own.text == words));
    }
    assert!(written_down > 0, "where there is room");
    let pin = drawn.bars[8].tip;
    let place = drawn.at(pin);
    assert!(written(&h, &format!("pin {}", pin.0)).distance(at(&h, place.re, place.im)) < 60.0);
}

fn a_lump_beside_a_bar_goes_on_it() {
    let mut h = drawing(Template::SerialOfTwo);
    tool(&mut h, PenTool::Lump);
    let (from, to) = (at(&h, 0.0, 0.0), tip(&h, 0));
    let way = (to - from).normalized();
    click(&mut h, from + 0.5 * (to - from) + 30.0 * egui::vec2(way.y, -way.x));
    let put = sketch(&h);
    assert_eq!((put.lumps.len(), put.lumps[0].link.as_str()), (1, put.bars[0].name.as_str()));
    assert!(put.lumps[0].across.abs() > 0.01, "{:?}", put.lumps[0]);
    let rect = h.get_by_label_contains("Scene:").rect();
    click(&mut h, rect.left_bottom() + egui::vec2(40.0, -60.0));
    assert_eq!(sketch(&h), put, "no bar is there");
    assert!(said(&h, "no bar is near enough to carry a lump here: want a click on a bar"));
}

fn a_bar_chosen_in_the_list_is_deleted_and_dropped_by_keys() {
    let mut h = drawing(Template::SerialOfTwo);
    let bars = |h: &Window| sketch(h).bars.len();
    let choose = |h: &mut Window| {
        h.get_by_label("bar or pin in the card").click();
        h.run_steps(3);
        h.get_all_by_label("bar 2").last().expect("in the list").click();
        h.run_steps(3);
        let id = sketch(h).bars[1].id;
        assert_eq!(chosen(h), Some(SketchItem::Bar(id)));
    };
    choose(&mut h);
    h.key_press(Key::Escape);
    h.run_steps(3);
    assert_eq!((chosen(&h), bars(&h)), (None, 2), "Esc drops the choice");
    choose(&mut h);
    h.key_press(Key::Delete);
    h.run_steps(4);
    assert_eq!((chosen(&h), bars(&h)), (None, 1), "Delete deletes");
}

fn a_bar_that_leaves_the_view_takes_it_along() {
    let mut h = drawing(Template::SerialOfTwo);
    let rect = h.get_by_label_contains("Scene:").rect();
    let from = BarEnd::pin(sketch(&h).bars[1].tip);
    let step = SketchStep::Bar { from, to: BarEnd::At([3.0, 2.0]), name: None };
    assert!(!rect.contains(at(&h, 3.0, 2.0)));
    h.state_mut().app_state_mut().carry_out(SessionCommand::Edit(Edit::Sketch(step)));
    h.run_steps(6);
    assert!(rect.contains(at(&h, 3.0, 2.0)) && rect.contains(at(&h, 0.0, 0.0)));
    // What the user has moved out of view stays there.
    h.state_mut().app_state_mut().carry_out(ViewChange::Look(stillbase::app::CameraMove::Zoom(0.05)));
    h.run_steps(4);
    let before = at(&h, 3.0, 2.0);
    tool(&mut h, PenTool::Motor);
    assert_eq!(at(&h, 3.0, 2.0), before);
}

fn a_pin_on_a_bar_keeps_its_card() {
    let mut h = drawing(Template::SerialOfTwo);
    tool(&mut h, PenTool::Bar);
    let (from, to) = (at(&h, 0.25, 0.0), at(&h, 0.35, 0.1));
    drag(&mut h, from, to);
    h.run_steps(4);
    let loose = sketch(&h);
    tool(&mut h, PenTool::Move);
    let (held, bar) = (loose.bars[2].root, loose.bars[0].clone());
    let [from, root, end] = [held, bar.root, bar.tip].map(|pin| at(&h, loose.at(pin).re, loose.at(pin).im));
    drag(&mut h, from, root + 0.5 * (end - root));
    h.run_steps(5);
    let joined = sketch(&h);
    let own = joined.bars[2].root;
    assert!(joined.bars[0].has(own) && own != held, "a pin of the bar");
    assert_eq!(chosen(&h), Some(SketchItem::Pin(own)));
    assert!(said(&h, &format!("Pin {}", own.0)));
}

fn refusals_of_a_drawing_are_in_mm_and_degrees() {
    let mut h = drawing(Template::SerialOfTwo);
    let refusal = SketchRefusal {
        what: "a width of 0.250 m, turned by 0.500 rad".into(),
        place: Place::Whole,
        want: "at most 0.010 m".into(),
        proposals: Vec::new(),
    };
    h.state_mut().app_state_mut().carry_out(ViewChange::Pen(PenChange::Refuse(refusal)));
    h.run_steps(4);
    let words = "a width of 250 mm, turned by 28.65°: want at most 10 mm";
    assert_eq!(h.query_all_by_label_contains(words).count(), 2, "at its place and at the left");
}

fn a_machine_from_nothing_gets_a_task() {
    let mut h = drawing(Template::Blank);
    let steps = |h: &Window| session(h).undo_count();
    let step = |h: &mut Window, step: SketchStep| {
        h.state_mut().app_state_mut().carry_out(SessionCommand::Edit(Edit::Sketch(step)));
        h.state_mut().app_state_mut().carry_out(SessionCommand::EndGesture);
        h.run_steps(6);
    };
    let base = sketch(&h).base;
    step(&mut h, SketchStep::Bar { from: BarEnd::pin(base), to: BarEnd::At([0.0, 0.05]), name: None });
    let elbow = sketch(&h).bars[0].tip;
    step(&mut h, SketchStep::Bar { from: BarEnd::pin(elbow), to: BarEnd::At([0.05, 0.08]), name: None });
    for turns in 0..2 {
        let drawn = sketch(&h);
        let (pin, stator) = if turns == 0 { (base, None) } else { (elbow, Some(drawn.bars[0].id)) };
        let turns = Some(drawn.bars[turns].id);
        step(&mut h, SketchStep::Motor { pin, stator, drive: None, rotor: None, turns });
    }
    let before = (session(&h).scenario().task.clone(), steps(&h));
    let pin = sketch(&h).bars[1].tip;
    step(&mut h, SketchStep::EndEffector { pin, bar: None });
    assert!(session(&h).run().waiting().is_none(), "it can do its task");
    assert_ne!(session(&h).scenario().task, before.0);
    assert_eq!(steps(&h), before.1 + 1, "one step");
    assert!(said(&h, "the machine could not do the task: one is made for it"));
    h.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    h.run_steps(6);
    assert_eq!((session(&h).scenario().task.clone(), steps(&h)), before);
    assert!(session(&h).run().unfinished().is_some());
}

fn headings_of_a_narrow_design_view_are_whole() {
    let mut h = window_liked([1000.0, 640.0], &Preferences::default());
    h.run_steps(2);
    h.state_mut().app_state_mut().carry_out(ViewChange::Kind(ViewKind::Design));
    h.run_steps(4);
    let rect = h.get_by_label("part of each link; below: the residual").rect();
    assert!(rect.right() <= 1000.0 - 14.0, "{rect:?}");
}

fn the_word_on_a_balanced_machine_is_green() {
    let h = balanced();
    assert_eq!(tones(&h, "kg added, Σ D"), [egui::Color32::from_rgb(0x4c, 0xc9, 0xa0)]);
}

fn masses_of_counterweights_leave_pins_free() {
    let h = balanced();
    let units = session(&h).frame().q.units();
    let links = session(&h).scenario().machine.resolved_links();
    let pins: Vec<Pos2> =
        links.iter().map(|link| place_of(&link.root, &units)).map(|p| on_screen(&h, p.re, p.im)).collect();
    let placement = labels::last(&h.ctx, 0).expect("drawn");
    let masses: Vec<_> = placement.all.iter().filter(|own| &*own.label.name == "design/weights/kg").collect();
    assert!(!masses.is_empty());
    for own in masses {
        assert!(!pins.iter().any(|pin| own.place.contains(*pin)), "{} lies on a pin", own.text);
    }
}

/// The colours of all texts that contain these words.
fn tones(h: &Window, words: &str) -> Vec<egui::Color32> {
    fn find(shape: &egui::Shape, words: &str, all: &mut Vec<egui::Color32>) {
        match shape {
            egui::Shape::Text(text) if text.galley.text().contains(words) => {
                let own = text.galley.job.sections.first().map(|section| section.format.color);
                all.extend(text.override_text_color.or(own));
            }
            egui::Shape::Vec(shapes) => shapes.iter().for_each(|shape| find(shape, words, all)),
            _ => {}
        }
    }
    let mut all = Vec::new();
    h.output().shapes.iter().for_each(|clipped| find(&clipped.shape, words, &mut all));
    all
}
