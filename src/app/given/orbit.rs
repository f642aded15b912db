//! A machine that was measured in orbit: what momentum tells of it.

use egui::{Grid, Label, RichText, Ui};

use super::measured::refused;
use super::parts::{PROPOSAL_WIDTH, TableView, column, heads, name_cell, number_cell, rows, title, unit_cell};
use crate::Command;
use crate::theme::{colour, plain};
use crate::widgets::note;
use stillbase_picture::scene::palette::Palette;
use stillbase_settings::number::counted;
use stillbase_study::trim::{MeasuredUnknown, OrbitOutcome, OrbitReport};

/// Width of the table of numbers, points.
const NUMBERS_WIDTH_PT: f32 = 520.0;

/// Returns a text with the number of motions and rows, and the base rate that is not explained.
pub(super) fn summary(trimmed: &OrbitOutcome) -> String {
    let Ok(report) = &trimmed.outcome else { return String::new() };
    let [motions, rows] = [counted(report.motions, "motion"), counted(report.rows, "row")];
    format!("{motions}, {rows}  ·  {}", report.rate_words())
}

/// Draws the identified numbers of the machine, and what makes them doubtful.
pub(super) fn show(
    ui: &mut Ui,
    p: &Palette,
    shown: &TableView<'_>,
    trimmed: &OrbitOutcome,
    commands: &mut Vec<Command>,
) {
    let report = match &trimmed.outcome {
        Ok(report) => report,
        Err(why) => {
            let rest = ui.available_width();
            return column(ui, "refused", rest, |ui| refused(ui, p, why, shown, commands));
        }
    };
    column(ui, "numbers", NUMBERS_WIDTH_PT, |ui| numbers(ui, p, report));
    let rest = ui.available_width().max(PROPOSAL_WIDTH);
    column(ui, "doubts", rest, |ui| {
        let count = |is: fn(&MeasuredUnknown) -> bool| report.numbers.iter().filter(|number| is(number)).count();
        let head = match (count(|number| number.off), count(|number| number.identifiable)) {
            (_, 0) => "Nothing is told apart".into(),
            (0, _) => "Nothing is shown to be off".into(),
            (off, _) => format!("{} off", counted(off, "number")),
        };
        title(ui, p, &head, "in orbit");
        for words in report.doubts() {
            ui.add(Label::new(RichText::new(words).font(plain(12.5)).color(colour(p.reaction))).wrap());
        }
        let doubt = trimmed.doubt.iter().map(|doubt| doubt.to_string());
        for words in doubt.chain(report.untold_words()).chain(report.advice.clone()).chain(report.next.words()) {
            note(ui, p, &words);
        }
    });
}

fn numbers(ui: &mut Ui, p: &Palette, report: &OrbitReport) {
    rows(ui);
    Grid::new("orbit").num_columns(6).spacing([14.0, 3.0]).min_col_width(0.0).show(ui, |ui| {
        heads(ui, p, &["machine", "measured", "± 95 %", "± if known is 1 % off"]);
        for number in &report.numbers {
            let tone = name_cell(ui, p, number);
            number_cell(ui, Some(number.nominal), p.ink);
            number_cell(ui, number.measured, tone);
            number_cell(ui, number.half_width, p.dim);
            number_cell(ui, number.per_percent, p.dim);
            unit_cell(ui, p, number.unit);
        }
    });
}
