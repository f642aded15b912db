//! A measured machine, and the change that balances it.

use egui::{Grid, Label, RichText, Ui};

use super::assess::TableAction;
use super::parts::{PROPOSAL_WIDTH, TableView, column, heads, name_cell, number_cell, rows, take, title, unit_cell};
use crate::Command;
use crate::theme::{colour, plain};
use crate::widgets::note;
use stillbase_picture::numbers::signed;
use stillbase_picture::scene::palette::Palette;
use stillbase_settings::number::{counted, fixed_or_scientific as rounded};
use stillbase_study::trim::{NoTrim, Number, ParameterChange, TrimOutcome, TrimReport, TrimResult};

/// Width of the table of numbers, points.
const NUMBERS_WIDTH_PT: f32 = 470.0;

/// Returns a text with the number of motions and rows, and the rms of the measured reactions and of their unexplained
/// part.
pub(super) fn summary(trimmed: &TrimOutcome) -> String {
    let Ok(TrimResult { report, .. }) = &trimmed.outcome else { return String::new() };
    let [motions, rows] = [counted(report.motions, "motion"), counted(report.rows, "row")];
    let part = |i: usize, unit: &str| {
        format!("{} {unit} rms, not explained {}", rounded(report.size[i], 4), rounded(report.noise[i], 4))
    };
    format!("{motions}, {rows}  ·  force {}  ·  moment {}", part(0, "N"), part(1, "N m"))
}

/// Draws the identified balance of the machine, and the change that balances it.
pub(super) fn show(
    ui: &mut Ui,
    p: &Palette,
    shown: &TableView<'_>,
    trimmed: &TrimOutcome,
    commands: &mut Vec<Command>,
) {
    let found = match &trimmed.outcome {
        Ok(found) => found,
        Err(why) => {
            let rest = ui.available_width();
            return column(ui, "refused", rest, |ui| refused(ui, p, why, shown, commands));
        }
    };
    column(ui, "numbers", NUMBERS_WIDTH_PT, |ui| numbers(ui, p, &found.report));
    let rest = ui.available_width().max(PROPOSAL_WIDTH);
    column(ui, "change", rest, |ui| {
        change(ui, p, shown, found, commands);
        if let Some(noise) = trimmed.angle_noise {
            let share = 100.0 * noise;
            note(
                ui,
                p,
                &format!(
                    "Noise of the angles is {share:.0} % of their accelerations: what is found may be off; faster motions or finer encoders help."
                ),
            );
        }
        if let Some(doubt) = &trimmed.doubt {
            note(ui, p, &doubt.to_string());
        }
        for words in found.report.untold_words().chain(found.report.next.words()) {
            note(ui, p, &words);
        }
    });
}

/// Shows why a measurement has no result, with a button that takes doubtful columns as they are.
pub(super) fn refused(ui: &mut Ui, p: &Palette, why: &NoTrim, shown: &TableView<'_>, commands: &mut Vec<Command>) {
    ui.add(Label::new(RichText::new(why.to_string()).font(plain(12.5)).color(colour(p.reaction))).wrap());
    let is_doubted = matches!(why, NoTrim::Doubted(_));
    let tip = "Takes the columns as they are: they are right";
    if is_doubted && ui.button("Take the columns as they are").on_hover_text(tip).clicked() {
        shown.ask(commands, |options| options.as_given = true);
    }
}

fn numbers(ui: &mut Ui, p: &Palette, report: &TrimReport) {
    rows(ui);
    Grid::new("balance").num_columns(6).spacing([14.0, 3.0]).min_col_width(0.0).show(ui, |ui| {
        heads(ui, p, &["machine", "measured", "± 95 %", "after the change"]);
        for Number { unknown, residual, .. } in &report.numbers {
            let tone = name_cell(ui, p, unknown);
            number_cell(ui, Some(unknown.nominal), p.ink);
            number_cell(ui, unknown.measured, tone);
            number_cell(ui, unknown.half_width, p.dim);
            number_cell(ui, *residual, p.ink);
            unit_cell(ui, p, unknown.unit);
        }
    });
}

fn change(ui: &mut Ui, p: &Palette, shown: &TableView<'_>, found: &TrimResult, commands: &mut Vec<Command>) {
    let TrimResult { report, correction, .. } = found;
    let ink = |ui: &mut Ui, words: &str, tone| {
        ui.add(Label::new(RichText::new(words).font(plain(12.5)).color(colour(tone))).wrap());
    };
    let changes: Vec<&ParameterChange> = report.changed().collect();
    let [head, rest] = match correction {
        Err(_) => ["Nothing mends it", ""],
        Ok(_) if changes.is_empty() => ["No change", ""],
        Ok(_) => ["Least change", "to 0.1 g and 0.1 mm"],
    };
    title(ui, p, head, rest);
    ui.horizontal_wrapped(|ui| {
        if correction.is_ok() && !changes.is_empty() {
            let tip = "The machine of the session becomes the measured one with this change: one step to undo";
            take(ui, "Take the change", tip, shown, TableAction::Change, commands);
        }
        let tip = "The machine of the session becomes the measured one as it stands: one step to undo";
        take(ui, "Take as measured", tip, shown, TableAction::Measured, commands);
    });
    match correction {
        Err(why) => ink(ui, &why.to_string(), p.reaction),
        Ok(_) if changes.is_empty() => ink(ui, &report.why_no_change(), p.ink),
        Ok(_) => {
            rows(ui);
            Grid::new("changes").num_columns(2).spacing([14.0, 3.0]).min_col_width(0.0).show(ui, |ui| {
                for ParameterChange { key, from, to, unit, .. } in &changes {
                    let unit = if *unit == "kg" { "g" } else { "mm" };
                    let [from, to] = [from, to].map(|x| signed(1e3 * x, 1));
                    ui.label(RichText::new(key).font(plain(12.5)));
                    ui.label(RichText::new(format!("{from} → {to} {unit}")).font(plain(12.5)));
                    ui.end_row();
                }
            });
            if let Some(gain) = &report.worth {
                note(ui, p, &format!("Over these motions it lowers {}.", gain.worth.words()));
            }
        }
    }
    ui.add_space(4.0);
}
