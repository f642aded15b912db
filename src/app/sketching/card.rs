//! The card of the chosen bar or pin.

use std::f64::consts::TAU;
use std::ops::RangeInclusive;

use egui::{Align, ComboBox, Id, Layout, RichText, TextEdit, Ui};

use super::motors::motor_at;
use super::{PenChange, SketchFacts, draw, lump, section};
use crate::theme::{bold, colour, plain};
use crate::widgets::{NumberRow, name};
use crate::{Command, ViewChange};
use stillbase_mechanics::planar::Vector;
use stillbase_mechanics::sketch::{Bar, PinId, SketchStep};
use stillbase_picture::scene::palette::Palette;
use stillbase_picture::scene::sketching::SketchItem;

/// Longest bar, m, and greatest coordinate of a pin, m.
const LONGEST_M: f64 = 100.0;

/// A number that is one step when its drag ends, or when it has been typed.
pub struct NumberField<'a> {
    /// Name for screen readers.
    pub label: &'a str,
    /// Name in the panel.
    pub words: &'a str,
    pub unit: &'a str,
    pub decimals: usize,
    /// Change by a drag of one point.
    pub speed: f64,
}

impl NumberField<'_> {
    /// Draws it with its name and its unit; returns the new value at the end of a change.
    pub fn show(&self, ui: &mut Ui, p: &Palette, value: f64, range: RangeInclusive<f64>) -> Option<f64> {
        let id = ui.scope_id().with(self.label);
        ui.horizontal(|ui| {
            ui.label(RichText::new(self.words).font(plain(12.5)).color(colour(p.dim)));
            let end = Layout::right_to_left(Align::Center);
            ui.with_layout(end, |ui| {
                crate::widgets::unit(ui, p, self.unit);
                self.number(ui, id, value, range)
            })
            .inner
        })
        .inner
    }

    /// Draws the number alone; returns the new value at the end of a change. The value is kept under `id` meanwhile.
    pub fn number(&self, ui: &mut Ui, id: Id, value: f64, range: RangeInclusive<f64>) -> Option<f64> {
        let mut now = ui.data(|data| data.get_temp::<f64>(id)).unwrap_or(value);
        let row = NumberRow {
            label: self.label,
            unit: self.unit,
            tip: "",
            decimals: self.decimals,
            speed: self.speed,
            slide: range.clone(),
            range,
        };
        let response = row.number(ui, &mut now);
        if response.dragged() {
            ui.data_mut(|data| data.insert_temp(id, now));
            return None;
        }
        ui.data_mut(|data| data.remove_temp::<f64>(id));
        ((response.changed() || response.drag_stopped()) && now != value).then_some(now)
    }
}

/// Draws the card of the chosen thing, if it exists.
pub fn show(ui: &mut Ui, facts: &SketchFacts, chosen: SketchItem, p: &Palette, commands: &mut Vec<Command>) {
    match chosen {
        SketchItem::Bar(id) => {
            if let Some(bar) = facts.sketch.bar(id) {
                of_bar(ui, facts, bar, p, commands);
            }
        }
        SketchItem::Pin(id) if facts.sketch.pin(id).is_some() => of_pin(ui, facts, id, p, commands),
        SketchItem::Lump(id, number) => {
            if let Some(bar) = facts.sketch.bar(id) {
                lump::show(ui, facts, (bar, number), p, commands);
            }
        }
        SketchItem::Pin(_) | SketchItem::Limit(..) => {}
    }
}

fn of_bar(ui: &mut Ui, facts: &SketchFacts, bar: &Bar, p: &Palette, commands: &mut Vec<Command>) {
    let (sketch, id) = (&facts.sketch, bar.id);
    let own = facts.resolved.drives.get(&id);
    ui.horizontal(|ui| {
        ui.label(RichText::new(format!("Bar {}", bar.name)).font(bold(14.0)));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| follows(ui, facts, bar, commands));
    });
    let words = match (own, &bar.drive) {
        (Some(follow), Some(_)) => format!("follows drive {}", follow.drive),
        (Some(follow), None) => format!("follows drive {}: a parallelogram says so", follow.drive),
        (None, _) => "follows no drive yet".to_owned(),
    };
    ui.label(RichText::new(words).font(plain(11.5)).color(colour(p.dim)));
    // While something is dragged, length and angle are those under the pointer.
    let (shown, now) = (facts.shown().0, facts.shown().0.bar(id).unwrap_or(bar));
    let label = format!("length of bar {}", bar.name);
    let field = NumberField { label: &label, words: "length", unit: "m", decimals: 4, speed: 1e-3 };
    if let Some(metres) = field.show(ui, p, shown.length(now), 1e-3..=LONGEST_M) {
        draw(sketch, SketchStep::Length { bar: id, metres }, commands);
    }
    let label = format!("angle of bar {}", bar.name);
    let field = NumberField { label: &label, words: "angle from x", unit: "rad", decimals: 3, speed: 5e-3 };
    if let Some(radians) = field.show(ui, p, shown.span(now).arg(), -TAU..=TAU) {
        draw(sketch, SketchStep::Angle { bar: id, radians }, commands);
    }
    renamed(ui, &format!("name of bar {}", bar.name), &bar.name, p, |name| {
        draw(sketch, SketchStep::NameBar { bar: id, name }, commands);
    });
    section::show(ui, facts, bar, p, commands);
    lump::of_bar(ui, facts, bar, p, commands);
    section::weight(ui, facts, bar, p, commands);
    ui.horizontal_wrapped(|ui| {
        let split = SketchStep::Split { bar: id, along: 0.5 * sketch.length(bar) };
        for (words, tip, step) in [
            ("split in the middle", "Two bars, which a pin joins", split),
            ("delete", "Delete the bar (Delete)", SketchStep::DeleteBar { bar: id }),
        ] {
            let button = ui.button(words).on_hover_text(tip);
            name(&button, &format!("{words}: bar {}", bar.name));
            if button.clicked() {
                draw(sketch, step, commands);
            }
        }
        for (other, words) in joins(facts, bar) {
            if ui.button(&words).on_hover_text("One bar of two that share a pin and a line").clicked() {
                draw(sketch, SketchStep::Join { bar: id, with: other }, commands);
            }
        }
    });
}

/// Returns the bars that can become part of a bar.
fn joins(facts: &SketchFacts, bar: &Bar) -> Vec<(stillbase_mechanics::sketch::BarId, String)> {
    let others = facts.sketch.bars.iter().filter(|other| other.id != bar.id);
    let fits = |other: &&Bar| facts.sketch.with(&SketchStep::Join { bar: bar.id, with: other.id }).is_ok();
    others.filter(fits).map(|other| (other.id, format!("one with bar {}", other.name))).collect()
}

/// Draws the list of drives that a bar can follow.
fn follows(ui: &mut Ui, facts: &SketchFacts, bar: &Bar, commands: &mut Vec<Command>) {
    let sketch = &facts.sketch;
    let own = facts.resolved.drives.get(&bar.id).map(|follow| follow.drive.as_str());
    let shown = own.map_or_else(|| "no drive".to_owned(), |drive| format!("drive {drive}"));
    let list = ComboBox::from_id_salt("follows").selected_text(shown).width(86.0).show_ui(ui, |ui| {
        let follow = |drive: Option<String>| SketchStep::Follow { bar: bar.id, drive };
        if ui.selectable_label(own.is_none(), "no drive").clicked() {
            draw(sketch, follow(None), commands);
        }
        for motor in &sketch.motors {
            let drive = &motor.drive.name;
            if ui.selectable_label(own == Some(drive), format!("drive {drive}")).clicked() {
                draw(sketch, follow(Some(drive.clone())), commands);
            }
        }
        if ui.selectable_label(false, "a new drive").clicked()
            && let Some(step) = sketch.motor_for(bar.id)
        {
            draw(sketch, step, commands);
        }
    });
    name(&list.response.on_hover_text("The drive to whose arm the bar stays parallel"), "drive of the bar");
}

fn of_pin(ui: &mut Ui, facts: &SketchFacts, id: PinId, p: &Palette, commands: &mut Vec<Command>) {
    let sketch = &facts.sketch;
    let is_base = id == sketch.base;
    let title = if is_base { "Pin B, on the base".to_owned() } else { format!("Pin {}", id.0) };
    ui.label(RichText::new(title).font(bold(14.0)));
    let bars: Vec<&str> = sketch.bars_at(id).map(|bar| bar.name.as_str()).collect();
    let words = match bars.as_slice() {
        [] => "on no bar yet".to_owned(),
        [one] => format!("on bar {one}"),
        many => format!("joins bars {}", many.join(", ")),
    };
    ui.label(RichText::new(words).font(plain(11.5)).color(colour(p.dim)));
    // While the pin is dragged, its place is that of the pointer.
    let at = facts.shown().0.pin(id).map_or_else(|| sketch.at(id), |pin| Vector::new(pin.at[0], pin.at[1]));
    for (axis, value) in [("x", at.re), ("y", at.im)] {
        let label = format!("{axis} of pin {}", id.0);
        let field = NumberField { label: &label, words: axis, unit: "m", decimals: 4, speed: 1e-3 };
        if let Some(new) = field.show(ui, p, value, -LONGEST_M..=LONGEST_M) {
            let to = if axis == "x" { [new, at.im] } else { [at.re, new] };
            draw(sketch, SketchStep::MovePin { pin: id, to }, commands);
        }
    }
    ui.horizontal_wrapped(|ui| {
        let mut button = |words: &str, step: SketchStep| {
            if ui.button(words).clicked() {
                draw(sketch, step, commands);
            }
        };
        button("hang a motor", motor_at(facts, id));
        if !is_base {
            button("take as end effector", SketchStep::EndEffector { pin: id, bar: None });
            button("delete", SketchStep::DeletePin { pin: id });
        }
    });
    if ui.small_button("close").clicked() {
        commands.push(ViewChange::Pen(PenChange::Choose(None)).into());
    }
}

/// Draws a field for a name; calls `rename` when another has been typed.
pub fn renamed(ui: &mut Ui, label: &str, now: &str, p: &Palette, rename: impl FnOnce(String)) {
    let id = ui.scope_id().with(label);
    let mut text = ui.data(|data| data.get_temp::<String>(id)).unwrap_or_else(|| now.to_owned());
    let field = ui
        .horizontal(|ui| {
            ui.label(RichText::new("name").font(plain(12.5)).color(colour(p.dim)));
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                ui.add(TextEdit::singleline(&mut text).desired_width(120.0))
            })
            .inner
        })
        .inner;
    name(&field, label);
    if field.has_focus() {
        ui.data_mut(|data| data.insert_temp(id, text));
        return;
    }
    ui.data_mut(|data| data.remove_temp::<String>(id));
    let text = text.trim();
    if field.lost_focus() && text != now && !text.is_empty() {
        rename(text.to_owned());
    }
}
