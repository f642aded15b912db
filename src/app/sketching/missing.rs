//! What a drawing still lacks, with a button for each way to mend it.

use egui::{Button, Frame, Label, RichText, Ui};

use super::{SketchFacts, draw};
use crate::theme::{colour, plain};
use crate::widgets::{name, section};
use crate::{Command, notation};
use stillbase_picture::scene::palette::Palette;

/// Most buttons for one thing.
const MOST_MENDS: usize = 3;

/// Most pins that a bar runs over and does not join.
const MOST_CROSSINGS: usize = 4;

/// Draws the list; nothing if nothing is missing.
pub fn show(ui: &mut Ui, facts: &SketchFacts, p: &Palette, commands: &mut Vec<Command>) {
    section(ui, p, "Still missing");
    if facts.resolved.missing.is_empty() {
        let words = RichText::new("nothing: this is a machine").font(plain(12.5)).color(colour(p.zero));
        ui.label(words);
    }
    let crossings = facts.resolved.crossings.iter().take(MOST_CROSSINGS);
    for one in facts.resolved.missing.iter().chain(crossings) {
        Frame::new().fill(colour(p.background)).corner_radius(6).inner_margin(8).show(ui, |ui| {
            ui.set_width(ui.available_width());
            let text = RichText::new(notation::sentence(ui.ctx(), &format!("• {}", one.text)))
                .font(plain(12.5))
                .color(colour(p.ink));
            ui.add(Label::new(text).wrap());
            ui.horizontal_wrapped(|ui| {
                for mend in one.mends.iter().take(MOST_MENDS) {
                    let words = RichText::new(&mend.label).font(plain(12.0)).color(colour(p.amber));
                    let button = ui.add(Button::new(words).wrap());
                    name(&button, &mend.label);
                    if button.clicked() {
                        draw(&facts.sketch, mend.step.clone(), commands);
                    }
                }
            });
        });
    }
}
