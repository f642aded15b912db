//! Limits of the angles of a drive, typed.

use egui::{RichText, Ui};

use super::card::NumberField;
use super::{SketchFacts, draw};
use crate::Command;
use crate::theme::{colour, plain};
use crate::widgets::name;
use stillbase_mechanics::machine::{Angle, MAX_ANGLE};
use stillbase_mechanics::sketch::SketchStep;
use stillbase_picture::scene::palette::Palette;

/// Limits that a new pair has about the angle as it is drawn, °.
const ROOM_DEG: f64 = 85.0;
/// Step to which new limits are rounded, °.
const ROUND_DEG: f64 = 5.0;

/// Draws the limits of every angle that a drive has from another.
pub fn show(ui: &mut Ui, facts: &SketchFacts, drive: &str, p: &Palette, commands: &mut Vec<Command>) {
    // While an arc is dragged, its limits are those under the pointer.
    let (sketch, shown) = (&facts.sketch, facts.shown().0);
    for angle in shown.angles.iter().filter(|angle| angle.to == drive) {
        let Angle { to, from, offset, min, max, .. } = angle;
        let set =
            |range: Option<[f64; 2]>| SketchStep::Limits { to: to.clone(), from: from.clone(), offset: *offset, range };
        let Some((low, high)) = min.zip(*max) else {
            ui.horizontal(|ui| {
                let words = format!("from drive {from}: any angle");
                ui.label(RichText::new(words).font(plain(12.5)).color(colour(p.dim)));
                let limit =
                    ui.small_button("limit it").on_hover_text("Limits that its motion keeps; drag the arc's ends");
                name(&limit, &format!("limit the angle of drive {to} from drive {from}"));
                if limit.clicked() {
                    let now = (sketch.drawn_angle(to, from).unwrap_or_default() + offset).to_degrees();
                    let round = |degrees: f64| ((degrees / ROUND_DEG).round() * ROUND_DEG).to_radians();
                    draw(sketch, set(Some([now - ROOM_DEG, now + ROOM_DEG].map(round))), commands);
                }
            });
            continue;
        };
        let ends = [("least", low, -MAX_ANGLE..=high), ("greatest", high, low..=MAX_ANGLE)];
        for (i, (word, value, range)) in ends.into_iter().enumerate() {
            let label = format!("{word} angle of drive {to} from drive {from}");
            let words = format!("{word} from drive {from}");
            let field = NumberField { label: &label, words: &words, unit: "rad", decimals: 3, speed: 0.01 };
            if let Some(new) = field.show(ui, p, value, range) {
                draw(sketch, set(Some(if i == 0 { [new, high] } else { [low, new] })), commands);
            }
        }
        let free = ui.small_button("no limits").on_hover_text("Any angle");
        name(&free, &format!("no limits of drive {to} from drive {from}"));
        if free.clicked() {
            draw(sketch, set(None), commands);
        }
    }
}
