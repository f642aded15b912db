//! A bar by numbers: the pin where it begins, its length and its angle, without the pointer.

use std::f64::consts::FRAC_PI_2;
use std::ops::RangeInclusive;

use egui::{Align, ComboBox, Layout, RichText, Ui};

use super::hand::typed;
use super::{Pen, SketchFacts, draw};
use crate::Command;
use crate::theme::{colour, plain};
use crate::widgets::{NumberRow, name, section};
use stillbase_mechanics::planar::unit;
use stillbase_mechanics::sketch::{BarEnd, PinId, Sketch, SketchStep};
use stillbase_picture::scene::palette::Palette;
use stillbase_picture::scene::sketching::SketchItem;

/// The bar to be added, as typed so far.
#[derive(Clone, Copy)]
struct Numbers {
    from: PinId,
    metres: f64,
    radians: f64,
}

/// Returns how a pin is called.
pub fn pin_title(sketch: &Sketch, pin: PinId) -> String {
    if pin == sketch.base { "pin B".to_owned() } else { format!("pin {}", pin.0) }
}

/// Draws the row. It begins at the chosen pin, if a pin is chosen.
pub fn show(ui: &mut Ui, facts: &SketchFacts, pen: &Pen, p: &Palette, commands: &mut Vec<Command>) {
    let sketch = &facts.sketch;
    section(ui, p, "A bar by numbers");
    let id = egui::Id::unique("bar by numbers");
    let known = ui.data(|data| data.get_temp::<Numbers>(id));
    let mut numbers = known.unwrap_or(Numbers { from: sketch.base, metres: 0.3, radians: FRAC_PI_2 });
    if let Some(SketchItem::Pin(pin)) = pen.chosen {
        numbers.from = pin;
    }
    if sketch.pin(numbers.from).is_none() {
        numbers.from = sketch.base;
    }
    let mut adds = false;
    ui.horizontal(|ui| {
        ui.label(RichText::new("from").font(plain(12.5)).color(colour(p.dim)));
        let list = ComboBox::from_id_salt("from pin").selected_text(pin_title(sketch, numbers.from)).width(90.0);
        let list = list.show_ui(ui, |ui| {
            for pin in &sketch.pins {
                ui.selectable_value(&mut numbers.from, pin.id, pin_title(sketch, pin.id));
            }
        });
        name(&list.response, "new bar from");
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let add = ui.button("add");
            name(&add, "add the new bar");
            adds = add.clicked();
        });
    });
    let row = |label, unit, speed, range: RangeInclusive<f64>| {
        let tip = "Of the bar that is added";
        NumberRow { label, unit, tip, decimals: 3, speed, slide: range.clone(), range }
    };
    row("length", "m", 1e-3, 1e-3..=100.0).show(ui, p, &mut numbers.metres);
    row("angle from x", "rad", 1e-2, -4.0..=4.0).show(ui, p, &mut numbers.radians);
    if adds {
        let to = sketch.at(numbers.from) + unit(numbers.radians) * numbers.metres;
        let (from, to) = (BarEnd::pin(numbers.from), typed(sketch, [to.re, to.im]).end());
        draw(sketch, SketchStep::Bar { from, to, name: None }, commands);
    }
    ui.data_mut(|data| data.insert_temp(id, numbers));
}
