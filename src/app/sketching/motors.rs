//! Motors of a drawing: where one is hung, and their rows.

use egui::{ComboBox, RichText, Ui};

use super::card::NumberField;
use super::{SketchFacts, draw, limits};
use crate::Command;
use crate::theme::{bold, colour};
use crate::widgets::{name, section};
use stillbase_mechanics::machine::Rotor;
use stillbase_mechanics::sketch::{BarId, PinId, SketchStep};
use stillbase_picture::scene::palette::Palette;

/// Returns the step that hangs a motor on a pin.
pub fn motor_at(facts: &SketchFacts, pin: PinId) -> SketchStep {
    facts.sketch.motor_at(pin, |bar| !facts.resolved.drives.contains_key(&bar))
}

/// Draws the motors: what carries the stator, the rotor and the gear.
pub fn show(ui: &mut Ui, facts: &SketchFacts, p: &Palette, commands: &mut Vec<Command>) {
    let sketch = &facts.sketch;
    if sketch.motors.is_empty() {
        return;
    }
    section(ui, p, "Motors");
    for (k, motor) in sketch.motors.iter().enumerate() {
        let drive = &motor.drive.name;
        ui.horizontal(|ui| {
            let words = RichText::new(format!("drive {drive}")).font(bold(12.5)).color(colour(p.drive(k)));
            ui.label(words);
            let title = |bar: Option<BarId>| match bar.and_then(|bar| sketch.bar(bar)) {
                Some(bar) => format!("on bar {}", bar.name),
                None => "on the base".to_owned(),
            };
            let list = ComboBox::from_id_salt(("stator", k)).selected_text(title(motor.stator)).width(96.0);
            let list = list.show_ui(ui, |ui| {
                let carriers = sketch.bars_at(motor.pin).map(|bar| Some(bar.id));
                for carrier in std::iter::once(None).chain(carriers) {
                    if ui.selectable_label(carrier == motor.stator, title(carrier)).clicked() {
                        let step = SketchStep::MoveMotor { drive: drive.clone(), pin: motor.pin, stator: carrier };
                        draw(sketch, step, commands);
                    }
                }
            });
            name(&list.response.on_hover_text("What carries the stator"), &format!("stator of drive {drive}"));
            let out = ui.small_button("remove").on_hover_text("Take the motor away; its bars follow no drive then");
            name(&out, &format!("remove motor of drive {drive}"));
            if out.clicked() {
                draw(sketch, SketchStep::DeleteMotor { drive: drive.clone() }, commands);
            }
        });
        let Rotor { inertia, ratio } = motor.drive.rotor.unwrap_or(Rotor { inertia: 0.0, ratio: 1.0 });
        let gear = |inertia: f64, ratio: f64| SketchStep::Gear { drive: drive.clone(), inertia, ratio };
        let label = format!("rotor inertia of drive {drive}");
        let field = NumberField { label: &label, words: "rotor inertia", unit: "kg m²", decimals: 7, speed: 1e-6 };
        if let Some(inertia) = field.show(ui, p, inertia, 0.0..=1e3) {
            draw(sketch, gear(inertia, ratio), commands);
        }
        let label = format!("gear ratio of drive {drive}");
        let field = NumberField { label: &label, words: "gear ratio", unit: "", decimals: 2, speed: 0.1 };
        if let Some(ratio) = field.show(ui, p, ratio, -1e4..=1e4) {
            draw(sketch, gear(inertia, ratio), commands);
        }
        limits::show(ui, facts, drive, p, commands);
    }
}
