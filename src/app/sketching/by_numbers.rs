//! A drawing by numbers and names, without the pointer: a bar from a pin, by its length and angle; a motor and the end
//! effector on a pin.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::ops::RangeInclusive;

use egui::{Align, Key, Layout, Response, RichText, Ui};

use super::hand::typed;
use super::motors::motor_at;
use super::pin_list::pin_list;
use super::{Pen, SketchFacts, draw, fields};
use crate::Command;
use crate::focus;
use crate::theme::{colour, plain};
use crate::widgets::{NumberRow, has_refused, name, section, unit as write_unit};
use stillbase_mechanics::planar::unit;
use stillbase_mechanics::sketch::{BarEnd, PinId, Sketch, SketchStep};
use stillbase_picture::scene::palette::Palette;
use stillbase_picture::scene::sketching::SketchItem;

/// Length of the first bar, and the longest one, m.
const FIRST_M: f64 = 0.3;
const LONGEST_M: f64 = 100.0;
/// Shortest bar, m.
const SHORTEST_M: f64 = 1e-3;

/// What is to be added, as chosen and typed so far.
#[derive(Clone, Copy)]
struct Numbers {
    from: PinId,
    /// Where the bar before began, if the pin goes at its end.
    before: PinId,
    metres: f64,
    radians: f64,
    motor: PinId,
    /// What was chosen in the drawing when the pins were taken from there.
    chosen: Option<SketchItem>,
}

impl Numbers {
    /// Returns the numbers so far, on pins that exist. A pin that has just been chosen in the drawing is taken.
    fn of(known: Option<Self>, sketch: &Sketch, pen: &Pen) -> Self {
        let base = sketch.base;
        let first = Self { from: base, before: base, metres: FIRST_M, radians: FRAC_PI_2, motor: base, chosen: None };
        let mut own = known.unwrap_or(first);
        if let Some(SketchItem::Pin(pin)) = pen.chosen.filter(|_| pen.chosen != own.chosen) {
            (own.from, own.motor) = (pin, pin);
        }
        own.chosen = pen.chosen;
        if sketch.pin(own.from).is_none() {
            own.from = own.before;
        }
        for pin in [&mut own.from, &mut own.before, &mut own.motor] {
            if sketch.pin(*pin).is_none() {
                *pin = base;
            }
        }
        own
    }
}

/// Draws the rows.
pub fn show(ui: &mut Ui, facts: &SketchFacts, pen: &Pen, p: &Palette, commands: &mut Vec<Command>) {
    let id = egui::Id::unique("bar by numbers");
    let known = ui.data(|data| data.get_temp::<Numbers>(id));
    let mut numbers = Numbers::of(known, &facts.sketch, pen);
    section(ui, p, "A bar by numbers");
    bar(ui, &facts.sketch, p, &mut numbers, commands);
    section(ui, p, "Motor and end effector");
    at_pins(ui, facts, p, &mut numbers, commands);
    ui.data_mut(|data| data.insert_temp(id, numbers));
}

/// Draws a row: what it is about on the left, fields and buttons on the right.
fn row<T>(ui: &mut Ui, p: &Palette, words: &str, add: impl FnOnce(&mut Ui) -> T) -> T {
    ui.horizontal(|ui| {
        ui.label(RichText::new(words).font(plain(12.5)).color(colour(p.dim)));
        ui.with_layout(Layout::right_to_left(Align::Center), add).inner
    })
    .inner
}

/// Draws the numbers of a bar in the order in which a person thinks. Enter in the last of them adds the bar; the next
/// one then begins at its end.
fn bar(ui: &mut Ui, sketch: &Sketch, p: &Palette, numbers: &mut Numbers, commands: &mut Vec<Command>) {
    row(ui, p, "from", |ui| {
        numbers.from = pin_list(ui, sketch, Some(numbers.from), fields::BAR_FROM, commands).unwrap_or(numbers.from);
    });
    let mut number = |words, label, (own_unit, decimals), speed, range: RangeInclusive<f64>, value: &mut f64| {
        let tip = "Of the bar that is added; Enter goes on";
        let field = NumberRow { label, unit: own_unit, tip, decimals, speed, slide: range.clone(), range };
        row(ui, p, words, |ui| {
            write_unit(ui, p, own_unit);
            field.number(ui, value)
        })
    };
    let length = number("length", fields::BAR_LENGTH, ("m", 4), 1e-3, SHORTEST_M..=LONGEST_M, &mut numbers.metres);
    let angle = number("angle from x", fields::BAR_ANGLE, ("rad", 3), 1e-2, -TAU..=TAU, &mut numbers.radians);
    let add = row(ui, p, "Enter adds it", |ui| {
        let add = ui.button("add");
        name(&add, "add the new bar");
        add
    });
    let enters =
        |field: &Response| field.lost_focus() && ui.input(|i| i.key_pressed(Key::Enter)) && !has_refused(ui.ctx());
    if enters(&length) {
        focus::ask(ui.ctx(), fields::BAR_ANGLE);
    }
    let by_keys = enters(&angle);
    if by_keys || add.clicked() {
        let to = sketch.at(numbers.from) + unit(numbers.radians) * numbers.metres;
        let (from, to) = (BarEnd::pin(numbers.from), typed(sketch, [to.re, to.im]).end());
        let step = SketchStep::Bar { from, to, name: None };
        if let Ok(next) = sketch.with(&step)
            && let Some(bar) = next.bars.last()
        {
            numbers.before = numbers.from;
            numbers.from = if bar.root == numbers.from { bar.tip } else { bar.root };
        }
        draw(sketch, step, commands);
        if by_keys || add.has_focus() {
            focus::ask(ui.ctx(), fields::BAR_LENGTH);
        }
    }
}

/// Draws the rows of the next motor and of the end effector, each with its pin.
fn at_pins(ui: &mut Ui, facts: &SketchFacts, p: &Palette, numbers: &mut Numbers, commands: &mut Vec<Command>) {
    let sketch = &facts.sketch;
    ui.horizontal(|ui| {
        ui.label(RichText::new("motor on").font(plain(12.5)).color(colour(p.dim)));
        let chosen = pin_list(ui, sketch, Some(numbers.motor), fields::MOTOR_PIN, commands);
        numbers.motor = chosen.unwrap_or(numbers.motor);
        let hang = ui.button("hang").on_hover_text("A motor there turns the bar that follows no drive yet");
        name(&hang, "hang a motor on the pin");
        if hang.clicked() {
            draw(sketch, motor_at(facts, numbers.motor), commands);
            if hang.has_focus() {
                focus::ask(ui.ctx(), fields::MOTOR_PIN);
            }
        }
    });
    ui.horizontal(|ui| {
        ui.label(RichText::new("end effector on").font(plain(12.5)).color(colour(p.dim)));
        let present = sketch.end_effector.as_ref().map(|end| end.pin);
        if let Some(pin) = pin_list(ui, sketch, present, fields::END_PIN, commands) {
            draw(sketch, SketchStep::EndEffector { pin, bar: None }, commands);
        }
    });
}
