//! The panel at the bottom for an open table. For a given motion it shows the nearest reactionless one; for a measured
//! machine, the change that balances it.

pub(super) mod assess;
mod measured;
mod motion;
mod orbit;
mod parts;

use std::path::Path;

use egui::{Align, ComboBox, Frame, Label, Layout, Margin, Panel, RichText, ScrollArea, Ui};

use super::fit;
use super::theme::{bold, colour, plain};
use super::widgets::{NumberRow, name, note, unit};
use super::{Command, FileDialog, GuidePage, Switch, ViewChange, ViewState, guide};
use assess::{TableAssessment, TableContent};
pub(super) use parts::TableView;
use parts::{column, worded};
use stillbase_picture::scene::palette::Palette;
use stillbase_study::advice::Advice;
use stillbase_study::import::PreservedPath;
use stillbase_study::trim::OrbitReport;

/// Default and minimum height of the panel, points.
const DEFAULT_HEIGHT_PT: f32 = 268.0;
const MIN_HEIGHT_PT: f32 = 150.0;
/// Width of the column of options, points.
const OPTIONS_WIDTH_PT: f32 = 250.0;

/// Returns the title line: file name and content of the table.
fn summary(shown: &TableView<'_>) -> String {
    let name = |file: &Path| file.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let more = shown.table.more.iter().map(|(file, _)| file);
    let files = [&shown.table.file].into_iter().chain(more).map(|file| name(file)).collect::<Vec<_>>().join(", ");
    let held = match shown.answer {
        Some(Ok(TableAssessment::Motion { motion, .. })) => motion::summary(motion),
        Some(Ok(TableAssessment::Measured(trimmed))) => measured::summary(trimmed),
        Some(Ok(TableAssessment::Orbit(report))) => orbit::summary(report),
        Some(Err(_)) => String::new(),
        None => "reading it …".into(),
    };
    [files, held].into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join("  ·  ")
}

/// Draws this panel.
pub(super) fn show(ui: &mut Ui, shown: TableView<'_>, view_state: &ViewState, commands: &mut Vec<Command>) {
    let p = view_state.palette();
    let frame = Frame::new().inner_margin(Margin { left: 16, right: 16, top: 8, bottom: 8 });
    let height = DEFAULT_HEIGHT_PT.min(0.45 * ui.available_height());
    let most = (0.7 * ui.available_height()).max(MIN_HEIGHT_PT);
    Panel::bottom("given").default_size(height).size_range(MIN_HEIGHT_PT..=most).resizable(true).frame(frame).show(
        ui,
        |ui| {
            let is_measurement = shown.content() == Some(TableContent::Measurement);
            ui.horizontal(|ui| {
                let title = match shown.content() {
                    Some(TableContent::Measurement) => "Measured machine",
                    Some(TableContent::Drives | TableContent::Tip) => "Given motion",
                    None => "Table",
                };
                ui.label(RichText::new(title).font(bold(13.5)));
                let page = match shown.content() {
                    Some(TableContent::Measurement) => GuidePage::Trim,
                    _ => GuidePage::OwnMotion,
                };
                guide::button(ui, &p, title, page, commands);
                ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                    if ui.button("Close").on_hover_text("What was taken from it stays").clicked() {
                        commands.push(ViewChange::Switch(Switch::Table, false).into());
                    }
                    let tip = "Another file of this measurement, with other motions";
                    if is_measurement && ui.button("Add…").on_hover_text(tip).clicked() {
                        commands.push(ViewChange::Dialog(Some(FileDialog::adding())).into());
                    }
                    if ui.button("Open…").on_hover_text("Another table, or a session (Ctrl O)").clicked() {
                        commands.push(ViewChange::Dialog(Some(FileDialog::opening())).into());
                    }
                    ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                        fit::label(ui, &summary(&shown), plain(11.5), colour(p.dim));
                    });
                });
            });
            ui.add_space(2.0);
            ScrollArea::horizontal().auto_shrink([false, false]).show(ui, |ui| {
                ui.horizontal_top(|ui| {
                    column(ui, "asked", OPTIONS_WIDTH_PT, |ui| options_column(ui, &p, &shown, commands));
                    let rest = ui.available_width();
                    match shown.answer {
                        None => {}
                        Some(Err(why)) => column(ui, "refused", rest, |ui| refused(ui, &p, why)),
                        Some(Ok(TableAssessment::Motion { motion, unwrapped, imported })) => {
                            motion::show(ui, &p, &shown, motion, unwrapped, imported, commands);
                        }
                        Some(Ok(TableAssessment::Measured(trimmed))) => {
                            measured::show(ui, &p, &shown, trimmed, commands)
                        }
                        Some(Ok(TableAssessment::Orbit(report))) => orbit::show(ui, &p, &shown, report, commands),
                    }
                });
            });
        },
    );
}

/// Shows why a table cannot be read.
fn refused(ui: &mut Ui, p: &Palette, why: &Advice) {
    let words = RichText::new(worded(why)).font(plain(12.5)).color(colour(p.reaction));
    ui.add(Label::new(words).wrap());
}

/// Draws the options for reading and assessing the table.
fn options_column(ui: &mut Ui, p: &Palette, shown: &TableView<'_>, commands: &mut Vec<Command>) {
    let (options, content) = (&shown.table.options, shown.content());
    let choices = [
        (None, "as its columns say"),
        (Some(TableContent::Drives), "a motion of the drives"),
        (Some(TableContent::Tip), "a motion of the end effector"),
        (Some(TableContent::Measurement), "a measurement of the base"),
    ];
    choice(ui, "read", "What the table is taken for", &choices, options.content, |to| {
        shown.ask(commands, |options| options.content = to);
    });
    if content == Some(TableContent::Measurement) {
        let is_in_orbit = matches!(shown.answer, Some(Ok(TableAssessment::Orbit(_))));
        let tip = "Ignores measured rates and accelerations, and computes both from the angles";
        if !is_in_orbit {
            switch(ui, "from the angles alone", tip, options.angles_only, |on| {
                shown.ask(commands, |options| options.angles_only = on);
            });
        }
        let tip = "Takes the columns as they are, even where another sign, order or unit explains them far better";
        switch(ui, "columns as they are", tip, options.as_given, |on| {
            shown.ask(commands, |options| options.as_given = on);
        });
        if is_in_orbit {
            note(ui, p, OrbitReport::KNOWN_WORDS);
            note(ui, p, "The base is that of the session. Nothing is changed: no counterweight can be moved up there.");
        } else {
            note(
                ui,
                p,
                "Only what the design view leaves free may change: counterweights that are there, or new ones.",
            );
        }
        return;
    }
    if content == Some(TableContent::Drives) {
        let keeps = [
            (None, "what is nearest"),
            (Some(PreservedPath::Tip), "the end effector's motion"),
            (Some(PreservedPath::Joints), "the joint angles"),
        ];
        choice(ui, "keep", "What the proposal keeps of the motion", &keeps, options.keep, |to| {
            shown.ask(commands, |options| options.keep = to);
        });
    }
    let row = NumberRow {
        tip: "The proposal stays on this plane",
        ..NumberRow::of("on the plane b", "task.b").with(3, 0.002)
    };
    let usual = shown.proposed_b().unwrap_or_default();
    optional(ui, p, &row, options.b, usual, |to| shown.ask(commands, |options| options.b = to));
    let tip = "Smooths the samples without delay: half of the amplitude is left at this frequency";
    let row = NumberRow {
        tip,
        unit: "Hz",
        range: 0.01..=1e5,
        slide: 0.01..=1e5,
        ..NumberRow::of("smoothed at", "").with(1, 0.2)
    };
    optional(ui, p, &row, options.smoothing, 20.0, |to| shown.ask(commands, |options| options.smoothing = to));
    let tip = "Lets the spline through the samples bridge gaps in time";
    switch(ui, "bridge gaps", tip, options.gaps, |on| shown.ask(commands, |options| options.gaps = on));
}

/// Draws a label and a list to choose from.
fn choice<T: Copy + PartialEq>(ui: &mut Ui, label: &str, tip: &str, choices: &[(T, &str)], now: T, to: impl FnOnce(T)) {
    let mut taken = None;
    ui.horizontal(|ui| {
        ui.label(label).on_hover_text(tip);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let words = choices.iter().find(|(it, _)| *it == now).map_or("", |(_, words)| words);
            let list = ComboBox::from_id_salt(label).selected_text(words).width(168.0).show_ui(ui, |ui| {
                for (it, words) in choices {
                    if ui.selectable_label(*it == now, *words).clicked() && *it != now {
                        taken = Some(*it);
                    }
                }
            });
            name(&list.response.on_hover_text(tip), label);
        });
    });
    if let Some(taken) = taken {
        to(taken);
    }
}

fn switch(ui: &mut Ui, label: &str, tip: &str, now: bool, to: impl FnOnce(bool)) {
    let mut on = now;
    if ui.checkbox(&mut on, label).on_hover_text(tip).changed() {
        to(on);
    }
}

/// Draws a number with a check box; while the box is not ticked, the program chooses the number.
fn optional(ui: &mut Ui, p: &Palette, row: &NumberRow<'_>, now: Option<f64>, usual: f64, to: impl FnOnce(Option<f64>)) {
    let (mut is_set, mut value) = (now.is_some(), now.unwrap_or(usual));
    let mut changed = false;
    ui.horizontal(|ui| {
        changed = ui.checkbox(&mut is_set, row.label).on_hover_text(row.tip).changed();
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            if is_set {
                unit(ui, p, row.unit);
                changed |= row.number(ui, &mut value).changed();
            }
        });
    });
    if changed {
        to(is_set.then_some(value));
    }
}
