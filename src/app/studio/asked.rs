//! What a designer asks for: whether the balance is kept, and what counterweights are made of.

use egui::{Align, Layout, RichText, Ui};

use crate::app::command::DesignCommand;
use crate::app::theme::{bold, colour, plain};
use crate::app::widgets::{Row, heading, name, unit};
use crate::app::{Command, ViewState};
use crate::mechanics::balance::Preset;
use crate::mechanics::counterweights::MATERIALS;
use crate::mechanics::machine::{Drive, MachineSpec};
use crate::picture::numbers::signed;
use crate::picture::scene::palette::Palette;
use crate::session::design::Brief;

/// Draws it.
pub fn show(ui: &mut Ui, spec: &MachineSpec, is_balanced: bool, view_state: &ViewState, commands: &mut Vec<Command>) {
    let (links, has_weights) = (spec.links.len(), !spec.counterweights.is_empty());
    let (held, drives) = (spec.payload.mass, &spec.drives);
    let p = &view_state.palette();
    let mut brief = view_state.brief.clone();
    ui.add_space(10.0);
    keeping(ui, p, &mut brief, has_weights, is_balanced);
    if !has_weights && links == 9 {
        penalties(ui, &mut brief);
    }
    ui.add_space(8.0);
    heading(ui, p, "Counterweights are discs", "");
    ui.horizontal(|ui| {
        ui.label("material");
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let known = MATERIALS.iter().find(|(_, density)| *density == brief.disc.density);
            let shown =
                known.map_or_else(|| "another".to_owned(), |(name, density)| format!("{name}, {density} kg/m³"));
            let list = egui::ComboBox::from_id_salt("material").selected_text(shown).width(172.0).show_ui(ui, |ui| {
                for (words, density) in MATERIALS {
                    ui.selectable_value(&mut brief.disc.density, density, format!("{words}, {density} kg/m³"));
                }
            });
            name(&list.response, "material of the counterweights");
        });
    });
    let number = |label, unit, tip, decimals, range: std::ops::RangeInclusive<f64>| Row {
        label,
        unit,
        tip,
        decimals,
        speed: 0.1,
        slide: range.clone(),
        range,
    };
    let mut millimetres = 1e3 * brief.disc.thickness;
    let row = number("thickness", "mm", "Of the plate that the discs are cut from", 1, 0.5..=1000.0);
    if row.show(ui, p, &mut millimetres).changed() {
        brief.disc.thickness = 1e-3 * millimetres;
    }
    let tip = "How far behind the root of its link a counterweight may sit; otherwise as far as the link is long";
    let row = Row { speed: 0.002, ..number("behind the root", "m", tip, 3, 0.0..=100.0) };
    bounded(ui, p, &row, &mut brief.back, 0.3);
    let row = Row { speed: 0.02, ..number("heaviest", "kg", "How heavy one may be", 2, 1e-3..=1e5) };
    bounded(ui, p, &row, &mut brief.most, 5.0);
    let mut millimetres = brief.clearance.map(|clearance| 1e3 * clearance);
    let tip =
        "How far the edge of a disc stays from the middle of every pin of its link; otherwise discs may cover pins";
    let row = number("clear of pins", "mm", tip, 1, 0.0..=1000.0);
    bounded(ui, p, &row, &mut millimetres, 5.0);
    brief.clearance = millimetres.map(|x| 1e-3 * x);
    payloads(ui, p, &mut brief, held);
    rotors(ui, p, drives, &mut brief, commands);
    if brief != view_state.brief {
        commands.push(Command::Design(DesignCommand::Brief(Box::new(brief))));
    }
}

/// Ratios of rotors that may be chosen, so that those that turn the other way take what the drives give to the base.
fn rotors(ui: &mut Ui, p: &Palette, drives: &[Drive], brief: &mut Brief, commands: &mut Vec<Command>) {
    let geared = drives.iter().filter_map(|drive| Some((drive, drive.rotor.filter(|rotor| rotor.inertia > 0.0)?)));
    let mut any = false;
    for (drive, rotor) in geared {
        any = true;
        ui.horizontal(|ui| {
            let tip = "The rotor's ratio may be chosen from the first to the second; below 0 it turns the other way";
            let mut is_free = brief.ratios.contains_key(&drive.name);
            let words = format!("ratio of drive {}", drive.name);
            if ui.checkbox(&mut is_free, words).on_hover_text(tip).changed() {
                match is_free {
                    true => brief.ratios.insert(drive.name.clone(), [-4.0 * rotor.ratio.abs().max(1.0), -1.0]),
                    false => brief.ratios.remove(&drive.name),
                };
            }
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                unit(ui, p, "");
                let Some([low, high]) = brief.ratios.get_mut(&drive.name) else {
                    ui.label(RichText::new(signed(rotor.ratio, 1)).font(plain(12.0)).color(colour(p.dim)));
                    return;
                };
                let mut end = |what: &str, range: std::ops::RangeInclusive<f64>, value: &mut f64| {
                    let label = format!("{what} ratio of drive {}", drive.name);
                    let (slide, decimals, speed) = (range.clone(), 1, 0.5);
                    Row { label: &label, unit: "", tip, decimals, speed, slide, range }.number(ui, value);
                };
                end("greatest", *low..=1e4, high);
                end("least", -1e4..=*high, low);
            });
        });
    }
    if any {
        let tip = "Take the counterweights, and the ratios that may be chosen, with which Σ |D| is least: a drive whose D \
                   is 0 moves without a moment on the base";
        if ui.button(RichText::new("least momentum").font(plain(12.0))).on_hover_text(tip).clicked() {
            commands.extend([Command::Design(DesignCommand::TakeStillest), Command::EndGesture]);
        }
    }
}

/// From which payload to which the balance is to serve.
fn payloads(ui: &mut Ui, p: &Palette, brief: &mut Brief, held: f64) {
    let tip = "Counterweights leave the least worst residual over all that the end effector may hold, from the first to \
               the second; to balance one payload exactly, hold it and leave this off";
    ui.horizontal(|ui| {
        let mut is_set = brief.payload.is_some();
        if ui.checkbox(&mut is_set, "payload from, to").on_hover_text(tip).changed() {
            brief.payload = is_set.then_some([0.0, if held > 0.0 { 2.0 * held } else { 0.2 }]);
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            unit(ui, p, "kg");
            let Some([low, high]) = &mut brief.payload else {
                ui.label(RichText::new("as it is").font(plain(12.0)).color(colour(p.dim)));
                return;
            };
            let row = |label, range: std::ops::RangeInclusive<f64>| Row {
                label,
                unit: "kg",
                tip,
                decimals: 3,
                speed: 0.005,
                slide: range.clone(),
                range,
            };
            row("greatest payload", *low..=1e5).number(ui, high);
            row("least payload", 0.0..=*high).number(ui, low);
        });
    });
}

/// The lock on the balance.
fn keeping(ui: &mut Ui, p: &Palette, brief: &mut Brief, has_weights: bool, is_balanced: bool) {
    let (what, tone) = match (brief.keeps_balance, is_balanced) {
        (false, _) => ("off", p.dim),
        // As after an undo.
        (true, false) => ("from the next change on", p.reaction),
        (true, true) if has_weights => ("the counterweights follow", p.zero),
        (true, true) => ("the centres of mass follow", p.zero),
    };
    let tip = "Whatever is changed, what is free follows so that (7) and (8) hold, each as little as it can; a ticked \
               link stays";
    ui.horizontal(|ui| {
        let words = RichText::new("Keep balanced").font(bold(13.5)).color(colour(p.ink));
        let ticked = ui.checkbox(&mut brief.keeps_balance, words).on_hover_text(tip);
        name(&ticked, "Keep balanced");
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.label(RichText::new(what).font(plain(11.5)).color(colour(tone)));
        });
    });
}

/// What it costs to move the centre of mass of each link, as the paper has it.
fn penalties(ui: &mut Ui, brief: &mut Brief) {
    const PRESETS: [(Preset, &str); 3] =
        [(Preset::MinimumNorm, "all alike"), (Preset::Table1, "those of Table I"), (Preset::AsPrinted, "as printed")];
    ui.horizontal(|ui| {
        let tip = "How dear it is to move each centre of mass, Eq. (10)";
        ui.label("penalties p").on_hover_text(tip);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let shown = PRESETS.iter().find(|(preset, _)| *preset == brief.preset).map_or("", |(_, words)| *words);
            let list = egui::ComboBox::from_id_salt("penalties").selected_text(shown).width(172.0).show_ui(ui, |ui| {
                for (preset, words) in PRESETS {
                    ui.selectable_value(&mut brief.preset, preset, words);
                }
            });
            name(&list.response, "penalties on centres of mass");
        });
    });
}

/// A bound that may be left out.
fn bounded(ui: &mut Ui, p: &Palette, row: &Row<'_>, bound: &mut Option<f64>, usual: f64) {
    ui.horizontal(|ui| {
        let mut is_set = bound.is_some();
        if ui.checkbox(&mut is_set, row.label).on_hover_text(row.tip).changed() {
            *bound = is_set.then_some(usual);
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            unit(ui, p, row.unit);
            match bound {
                Some(value) => {
                    row.number(ui, value);
                }
                None => {
                    ui.label(RichText::new("any").font(plain(12.0)).color(colour(p.dim)));
                }
            }
        });
    });
}
