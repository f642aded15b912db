//! A list of the pins of a drawing, from which one is chosen with or without the pointer.

use egui::{ComboBox, Ui};

use super::{PenChange, ViewChange};
use crate::Command;
use crate::widgets::{name, stepped};
use stillbase_mechanics::sketch::{PinId, Sketch};
use stillbase_picture::scene::sketching::{SketchItem, pin_title};

/// Draws the list; `field` is its name for screen readers. A pin that is chosen is lit in the drawing.
pub fn pin_list(ui: &mut Ui, sketch: &Sketch, pin: &mut PinId, field: &str, commands: &mut Vec<Command>) {
    let before = *pin;
    let list = ComboBox::from_id_salt(field).selected_text(pin_title(sketch, *pin)).width(90.0);
    let list = list.show_ui(ui, |ui| {
        for own in &sketch.pins {
            ui.selectable_value(pin, own.id, pin_title(sketch, own.id));
        }
    });
    name(&list.response, field);
    let all: Vec<PinId> = sketch.pins.iter().map(|own| own.id).collect();
    if let Some(next) = stepped(ui, &list.response, all.iter(), pin) {
        *pin = next;
    }
    if *pin != before {
        commands.push(ViewChange::Pen(PenChange::Choose(Some(SketchItem::Pin(*pin)))).into());
    }
}
