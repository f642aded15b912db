//! A list of the pins of a drawing, from which one is chosen with or without the pointer.

use egui::{ComboBox, Ui};

use super::{PenChange, ViewChange};
use crate::Command;
use crate::widgets::{name, stepped};
use stillbase_mechanics::sketch::{PinId, Sketch};
use stillbase_picture::scene::sketching::{SketchItem, pin_title};

/// Draws the list with its present pin, if there is one; `field` is its name for screen readers. Returns the pin that is
/// chosen instead; it is lit in the drawing.
pub fn pin_list(
    ui: &mut Ui,
    sketch: &Sketch,
    present: Option<PinId>,
    field: &str,
    commands: &mut Vec<Command>,
) -> Option<PinId> {
    let mut pin = present;
    let title = present.map_or_else(|| "no pin yet".into(), |pin| pin_title(sketch, pin));
    let list = ComboBox::from_id_salt(field).selected_text(title).width(90.0).show_ui(ui, |ui| {
        for own in &sketch.pins {
            ui.selectable_value(&mut pin, Some(own.id), pin_title(sketch, own.id));
        }
    });
    name(&list.response, field);
    let all: Vec<PinId> = sketch.pins.iter().map(|own| own.id).collect();
    if let Some(next) = stepped(ui, &list.response, all.iter(), &pin.unwrap_or(sketch.base)) {
        pin = Some(next);
    }
    let chosen = pin.filter(|_| pin != present)?;
    commands.push(ViewChange::Pen(PenChange::Choose(Some(SketchItem::Pin(chosen)))).into());
    Some(chosen)
}
