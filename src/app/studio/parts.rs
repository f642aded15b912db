//! The parts of the chosen link: what each brings, its numbers, and buttons that add and remove parts.

use egui::{Align, Button, Layout, Response, RichText, Ui};

use super::part_shape;
use super::table::{ROW_HEIGHT_PT, cell, head};
use crate::theme::{colour, plain};
use crate::widgets::{NumberRow, name, section, send, undoable_edit};
use crate::{Command, fit, notation};
use stillbase_mechanics::machine::{Machine, PartSource, Shape};
use stillbase_picture::numbers::signed;
use stillbase_picture::scene::palette::Palette;
use stillbase_session::{Edit, parts};
use stillbase_study::parts::{LinkPart, LinkParts, PartNumber, PartRow};

/// Widths of the column of names and of a column of numbers, points.
const NAME_WIDTH_PT: f32 = 126.0;
const NUMBER_WIDTH_PT: f32 = 49.0;
/// Widths of the name of a number and of the number, points.
const WORD_WIDTH_PT: f32 = 72.0;
const VALUE_WIDTH_PT: f32 = 62.0;

/// Shapes of parts, by the words of their buttons.
const SHAPES: [(&str, Shape); 4] =
    [("bar", Shape::Flat), ("tube", Shape::Tube), ("profile", Shape::Profile), ("plate", Shape::Plate)];

/// Draws the table of the parts of a link, counted from 0, with what overrules them.
pub fn show(ui: &mut Ui, machine: &Machine, link: usize, p: &Palette, commands: &mut Vec<Command>) {
    let own = &machine.spec().links[link].name;
    section(ui, p, &format!("parts of link {own}"));
    if let Some(all) = LinkParts::of(machine, link) {
        ui.horizontal(|ui| {
            cell(ui, NAME_WIDTH_PT, Align::Min, |_| ());
            for words in ["kg", "at m", "across m"] {
                cell(ui, NUMBER_WIDTH_PT, Align::Max, |ui| head(ui, p, words));
            }
        });
        for part in &all.parts {
            row(ui, &part.row, p.ink, |ui| {
                let button = small(ui, "×", &format!("remove {} of link {own}", label_of(part)), p);
                if button.on_hover_text("Remove it").clicked() {
                    undoable_edit(commands, parts::remove(machine, part.source));
                }
            });
            numbers(ui, machine, part, p, commands);
            part_shape::show(ui, machine, part.source, p, commands);
        }
        row(ui, &all.sum, p.dim, |_| ());
        overruled(ui, machine, &all, p, commands);
    }
    ui.horizontal_wrapped(|ui| {
        for (word, shape) in SHAPES {
            let part = small(ui, &format!("+ {word}"), &format!("add a {word} to link {own}"), p);
            if part.on_hover_text("Add it from the root to the tip").clicked() {
                undoable_edit(commands, parts::add_part(machine, link, shape));
            }
        }
        let lump = small(ui, "+ lump", &format!("add a lump to link {own}"), p);
        if lump.on_hover_text("A motor, a bearing, screws: a mass that no design takes off").clicked() {
            undoable_edit(commands, parts::add_lump(machine, link));
        }
    });
}

/// Draws what a part brings, and a button behind it.
fn row(ui: &mut Ui, row: &PartRow, tone: [f32; 4], button: impl FnOnce(&mut Ui)) {
    let unit = |metres: f64| {
        let shown = notation::of(ui.ctx()).shown_unit("m");
        shown.map_or_else(|| signed(metres, 4), |unit| signed(unit.factor * metres, unit.decimals(4)))
    };
    let texts = [signed(row.mass, 3), unit(row.at), unit(row.across)];
    ui.horizontal(|ui| {
        cell(ui, NAME_WIDTH_PT, Align::Min, |ui| fit::label(ui, &row.name, plain(12.0), colour(tone)));
        for text in texts {
            cell(ui, NUMBER_WIDTH_PT, Align::Max, |ui| {
                ui.label(RichText::new(text).font(plain(12.0)).color(colour(tone)));
            });
        }
        button(ui);
    });
}

/// Draws the numbers of a part that can be set, two in a line, and the choice of its material.
fn numbers(ui: &mut Ui, machine: &Machine, part: &LinkPart, p: &Palette, commands: &mut Vec<Command>) {
    for pair in part.numbers.chunks(2) {
        ui.horizontal(|ui| {
            for PartNumber { path, word, value } in pair {
                let label = format!("{word} of {}", label_of(part));
                let row = NumberRow::of(&label, path).with(if *word == "inertia" { 6 } else { 4 }, 0.001);
                let mut value = *value;
                cell(ui, WORD_WIDTH_PT, Align::Min, |ui| head(ui, p, &format!("{word} {}", row.unit)));
                let response = cell(ui, VALUE_WIDTH_PT, Align::Max, |ui| row.number(ui, &mut value));
                send(commands, &[response], || Edit::set(path, value));
            }
            if pair.len() == 1 {
                material(ui, machine, part, commands);
            }
        });
    }
    if part.numbers.len().is_multiple_of(2) {
        material(ui, machine, part, commands);
    }
    ui.add_space(4.0);
}

/// Draws the choice of the material of a part; a lump has none.
fn material(ui: &mut Ui, machine: &Machine, part: &LinkPart, commands: &mut Vec<Command>) {
    let PartSource::Part(i) = part.source else { return };
    let list = egui::ComboBox::from_id_salt(("material", i)).selected_text(&part.material).width(96.0);
    let list = list.show_ui(ui, |ui| {
        for material in parts::materials(machine) {
            if ui.selectable_label(material == part.material, material).clicked() && material != part.material {
                undoable_edit(commands, parts::change_part(machine, i, |part| material.clone_into(&mut part.material)));
            }
        }
    });
    name(&list.response, &format!("material of {}", label_of(part)));
}

/// Draws which typed numbers overrule the parts, and the button that lets them follow again.
fn overruled(ui: &mut Ui, machine: &Machine, all: &LinkParts, p: &Palette, commands: &mut Vec<Command>) {
    let Some(words) = all.overruled() else {
        ui.label(RichText::new("A typed value overrules its parts.").font(plain(11.0)).color(colour(p.dim)));
        return;
    };
    ui.label(RichText::new(words).font(plain(11.5)).color(colour(p.amber)));
    ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
        let back = small(ui, "back to the parts", &format!("link {} follows its parts", all.sum.link), p);
        if back.on_hover_text("Mass, centre of mass and inertia follow from the parts again").clicked() {
            undoable_edit(commands, parts::follow_parts(machine, all.link, &all.typed));
        }
    });
}

fn small(ui: &mut Ui, words: &str, label: &str, p: &Palette) -> Response {
    let text = RichText::new(words).font(plain(12.0)).color(colour(p.amber));
    let response = ui.add(Button::new(text).min_size(egui::vec2(0.0, ROW_HEIGHT_PT - 4.0)));
    name(&response, label);
    response
}

/// Returns how a part is called for screen readers: its kind and number.
fn label_of(part: &LinkPart) -> String {
    match part.source {
        PartSource::Part(i) => format!("part {}", i + 1),
        PartSource::Lump(i) => format!("lump {}", i + 1),
    }
}
