//! What a bar is made of: the section of its first bar-like part, its material, and what it weighs.

use egui::{ComboBox, RichText, Ui};

use super::card::NumberField;
use super::{SketchFacts, draw};
use crate::Command;
use crate::theme::{colour, plain};
use crate::widgets::name;
use stillbase_mechanics::machine::{Part, Shape};
use stillbase_mechanics::sketch::{Bar, SketchStep};
use stillbase_picture::numbers::signed;
use stillbase_picture::scene::palette::Palette;
use stillbase_session::parts::{materials_beside, new_part, set_length};

/// Sections of a bar, by their words.
const SECTIONS: [(&str, Shape); 3] = [("flat bar", Shape::Flat), ("tube", Shape::Tube), ("profile", Shape::Profile)];
/// Greatest width or wall, m.
const WIDEST_M: f64 = 1.0;

/// Draws the section of a bar.
pub fn show(ui: &mut Ui, facts: &SketchFacts, bar: &Bar, p: &Palette, commands: &mut Vec<Command>) {
    let sketch = &facts.sketch;
    let own: Vec<Part> = sketch.parts.iter().filter(|part| part.link == bar.name).cloned().collect();
    let lumps: Vec<_> = sketch.lumps.iter().filter(|lump| lump.link == bar.name).cloned().collect();
    let is_bar = |part: &Part| part.shape != Shape::Plate;
    let first = own.iter().position(is_bar);
    let made = |parts: Vec<Part>| SketchStep::Parts { bar: bar.id, parts, lumps: lumps.clone() };
    let with = |part: Option<Part>| {
        let mut parts = own.clone();
        match (first, part) {
            (Some(i), Some(part)) => parts[i] = part,
            (Some(i), None) => _ = parts.remove(i),
            (None, part) => parts.extend(part),
        }
        made(parts)
    };
    let tone = colour(p.dim);
    ui.horizontal(|ui| {
        ui.label(RichText::new("made of").font(plain(12.5)).color(tone));
        let word = |shape: Shape| SECTIONS.iter().find(|(_, own)| *own == shape).map_or("plate", |(word, _)| word);
        let shown = first.map_or("no section", |i| word(own[i].shape));
        let list = ComboBox::from_id_salt("section").selected_text(shown).width(84.0).show_ui(ui, |ui| {
            if ui.selectable_label(first.is_none(), "no section").clicked() && first.is_some() {
                draw(sketch, with(None), commands);
            }
            for (word, shape) in SECTIONS {
                let is_own = first.is_some_and(|i| own[i].shape == shape);
                if ui.selectable_label(is_own, word).clicked() && !is_own {
                    draw(sketch, with(Some(new_part(&bar.name, shape, sketch.length(bar)))), commands);
                }
            }
        });
        let tip = "Its mass follows from section and material; without one, from its length alone";
        name(&list.response.on_hover_text(tip), &format!("section of bar {}", bar.name));
        let Some(i) = first else { return };
        let list = ComboBox::from_id_salt("stock").selected_text(&own[i].material).width(84.0).show_ui(ui, |ui| {
            for material in materials_beside(&sketch.materials) {
                if ui.selectable_label(material == own[i].material, material).clicked() {
                    draw(sketch, with(Some(Part { material: material.to_owned(), ..own[i].clone() })), commands);
                }
            }
        });
        name(&list.response, &format!("material of bar {}", bar.name));
    });
    if let Some(i) = first {
        for (word, metres) in own[i].lengths().into_iter().filter_map(|(word, metres)| Some((word, metres?))) {
            let label = format!("{word} of bar {}", bar.name);
            let field = NumberField { label: &label, words: word, unit: "m", decimals: 4, speed: 5e-4 };
            if let Some(new) = field.show(ui, p, metres, 1e-4..=WIDEST_M) {
                let mut part = own[i].clone();
                set_length(&mut part, word, new);
                draw(sketch, with(Some(part)), commands);
            }
        }
    }
    weight(ui, facts, bar, p, commands);
}

/// Says what the bar weighs, and by what.
fn weight(ui: &mut Ui, facts: &SketchFacts, bar: &Bar, p: &Palette, commands: &mut Vec<Command>) {
    let sketch = &facts.sketch;
    let body = sketch.body(bar);
    let of = match (bar.body.is_some(), sketch.has_parts(&bar.name)) {
        (true, _) => "typed numbers",
        (false, true) => "its parts",
        (false, false) => "a slender bar",
    };
    ui.horizontal_wrapped(|ui| {
        let words = format!("{} kg, by {of}", signed(body.mass, 3));
        ui.label(RichText::new(words).font(plain(12.0)).color(colour(p.ink)));
        if bar.body.is_some() {
            let words = if sketch.has_parts(&bar.name) { "back to the parts" } else { "back to a slender bar" };
            let back = ui.small_button(words).on_hover_text("Its mass follows from what it is made of again");
            name(&back, &format!("{words}: bar {}", bar.name));
            if back.clicked() {
                let step = SketchStep::Mass { bar: bar.id, body: None, per_metre: bar.per_metre };
                draw(sketch, step, commands);
            }
        }
    });
}
