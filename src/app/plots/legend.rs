//! The row above all plots: the names of the overlaid runs, each with a sample of its line.

use egui::{Sense, Ui, vec2};

use super::shown::DisplayContext;
use crate::compare::sample;
use crate::fit;
use crate::theme::{bold, colour, plain};
use stillbase_picture::charts::figure::{dashes, run_colour};

/// Width of a sample of a line, and least width of a run's name, points.
const SAMPLE_WIDTH_PT: f32 = 24.0;
const MIN_NAME_PT: f32 = 60.0;

/// Draws this row within `width`, points, if there are overlaid runs.
pub fn show(ui: &mut Ui, what: &DisplayContext<'_>, width: f32) {
    let Some(comparison) = what.comparison else { return };
    let shown: Vec<usize> = comparison.shown().map(|(place, _)| place).collect();
    if shown.is_empty() {
        return;
    }
    let p = what.view_state.palette();
    // The names share one row. If that would shorten them too much, the row wraps.
    let share = width / shown.len() as f32;
    let taken = SAMPLE_WIDTH_PT + 28.0;
    let room = (share - taken).max(MIN_NAME_PT);
    ui.scope(|ui| {
        ui.set_max_width(width);
        ui.spacing_mut().interact_size.y = 14.0;
        ui.horizontal_wrapped(|ui| {
            ui.spacing_mut().item_spacing = vec2(4.0, 2.0);
            for place in shown {
                let (rect, _) = ui.allocate_exact_size(vec2(SAMPLE_WIDTH_PT, 14.0), Sense::hover());
                sample(ui, rect, dashes(place).0, colour(run_colour(place, &p)));
                ui.label(egui::RichText::new(format!("{}", place + 1)).font(bold(10.5)).color(colour(p.run(place))));
                fit::label_within(ui, comparison.entries()[place].shown_title(), plain(11.0), colour(p.dim), room);
                ui.add_space(4.0);
            }
        });
        ui.add_space(2.0);
    });
}
