//! A machine that was measured in orbit: what momentum tells of it.

use egui::{Grid, Label, RichText, Ui};

use super::parts::{PROPOSAL_WIDTH, column, heads, name_cell, number_cell, rows, title, unit_cell};
use crate::theme::{colour, plain};
use crate::widgets::note;
use stillbase_picture::scene::palette::Palette;
use stillbase_settings::number::counted;
use stillbase_study::trim::{MeasuredUnknown, OrbitReport, TrimError};

/// Width of the table of numbers, points.
const NUMBERS_WIDTH_PT: f32 = 520.0;

/// Returns a text with the number of motions and rows, and the base rate that is not explained.
pub(super) fn summary(outcome: &Result<OrbitReport, TrimError>) -> String {
    let Ok(report) = outcome else { return String::new() };
    let [motions, rows] = [counted(report.motions, "motion"), counted(report.rows, "row")];
    format!("{motions}, {rows}  ·  {}", report.rate_words())
}

/// Draws the identified numbers of the machine, and what makes them doubtful.
pub(super) fn show(ui: &mut Ui, p: &Palette, outcome: &Result<OrbitReport, TrimError>) {
    let report = match outcome {
        Ok(report) => report,
        Err(why) => {
            let words = RichText::new(why.to_string()).font(plain(12.5)).color(colour(p.reaction));
            let rest = ui.available_width();
            return column(ui, "refused", rest, |ui| drop(ui.add(Label::new(words).wrap())));
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
        for words in report.untold_words().chain(report.advice.clone()) {
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
