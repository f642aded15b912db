//! What a bar is made of: the section of its first bar-like part, its material, and what it weighs.

use egui::{ComboBox, Label, RichText, Ui};

use super::card::NumberField;
use super::{SketchFacts, draw};
use crate::Command;
use crate::theme::{colour, plain};
use crate::widgets::name;
use stillbase_mechanics::machine::{LinkNumber, Part, Shape};
use stillbase_mechanics::sketch::{Bar, Body, SketchStep};
use stillbase_picture::numbers::signed;
use stillbase_picture::scene::palette::Palette;
use stillbase_session::parts::{materials_beside, new_part, set_length};
use stillbase_study::parts;

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
                    let section = new_part(&bar.name, shape, sketch.length(bar));
                    draw(sketch, with(Some(sketch.drawn_over(bar, &section))), commands);
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
    if let Some((i, diameter)) = first.and_then(|i| Some((i, own[i].holes.first()?.diameter))) {
        let label = format!("hole diameter of bar {}", bar.name);
        let field = NumberField { label: &label, words: "holes for pins Ø", unit: "m", decimals: 4, speed: 5e-4 };
        if let Some(new) = field.show(ui, p, diameter, 1e-4..=WIDEST_M) {
            let mut part = own[i].clone();
            part.holes.iter_mut().filter(|hole| hole.diameter == diameter).for_each(|hole| hole.diameter = new);
            draw(sketch, with(Some(part)), commands);
        }
    }
}

/// Says what the bar weighs, and by what.
pub fn weight(ui: &mut Ui, facts: &SketchFacts, bar: &Bar, p: &Palette, commands: &mut Vec<Command>) {
    let sketch = facts.shown().0;
    let body = sketch.body(sketch.bar(bar.id).unwrap_or(bar));
    let of = match (typed(bar).is_empty(), sketch.has_parts(&bar.name)) {
        (false, _) => "typed numbers",
        (true, true) => "its parts",
        (true, false) => "a slender bar",
    };
    let words = format!("{} kg, by {of}", signed(body.mass, 3));
    ui.label(RichText::new(words).font(plain(12.0)).color(colour(p.ink)));
    overruled(ui, facts, bar, p, commands);
}

/// Returns the numbers of a bar that are typed.
fn typed(bar: &Bar) -> Vec<LinkNumber> {
    bar.body.iter().flat_map(Body::typed_numbers).collect()
}

/// Says which typed numbers overrule the parts of a bar, with the button that lets them follow again; nothing if none
/// does.
pub fn overruled(ui: &mut Ui, facts: &SketchFacts, bar: &Bar, p: &Palette, commands: &mut Vec<Command>) {
    let typed = typed(bar);
    if typed.is_empty() {
        return;
    }
    let has_parts = facts.sketch.has_parts(&bar.name);
    if let Some(words) = parts::overruled(&typed).filter(|_| has_parts) {
        let words = RichText::new(format!("bar {}: {words}", bar.name)).font(plain(11.5)).color(colour(p.amber));
        ui.add(Label::new(words).wrap());
    }
    let words = if has_parts { "back to the parts" } else { "back to a slender bar" };
    let back = ui.small_button(words).on_hover_text("Its mass follows from what it is made of again");
    name(&back, &format!("{words}: bar {}", bar.name));
    if back.clicked() {
        let body = bar.body.and_then(|body| body.freed());
        draw(&facts.sketch, SketchStep::Mass { bar: bar.id, body, per_metre: bar.per_metre }, commands);
    }
}
