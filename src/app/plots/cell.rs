//! One plot: its header, its curves, and their statistics.

use egui::Ui;

use super::header::STATISTICS_HEIGHT;
use super::shown::{self, DisplayContext};
use super::{curve, header, hover};
use crate::Command;
use stillbase_picture::charts::choice::Plot;
use stillbase_picture::charts::drawn::PlotLines;
use stillbase_picture::charts::figure::PlotContext;
use stillbase_picture::scene::palette::Palette;
use stillbase_simulation::frame::Frame;

/// Minimum height of a plot, points.
const MIN_HEIGHT_PT: f32 = 60.0;

/// The frames that all plots show.
pub struct Frames<'a> {
    newest: &'a Frame,
    now: &'a Frame,
    mark: Option<&'a Frame>,
    hover: Option<&'a Frame>,
}

impl<'a> Frames<'a> {
    /// Returns the frames at the instant on display, at the second cursor and under the pointer.
    pub fn of(ui: &Ui, what: &DisplayContext<'a>) -> Self {
        let (session, now) = (what.session, what.session.frame());
        Self {
            newest: session.frames().last().unwrap_or(now),
            now,
            mark: what.view_state.mark.map(|time| shown::instant(session, time)),
            hover: hover::instant(ui, session),
        }
    }

    /// Returns the context in which plots are drawn.
    pub fn look<'b>(&'b self, palette: &'b Palette) -> PlotContext<'b> {
        PlotContext { palette, peaks: &self.newest.peaks, now: self.now, mark: self.mark, hover: self.hover }
    }
}

/// Draws a plot of a height, points. With `None`, for a plot in a window, it fills the window and shows no title.
/// Returns the time under the pointer, s, if the pointer is over the plot.
pub fn show(
    ui: &mut Ui,
    what: &DisplayContext<'_>,
    plot: &Plot<'_>,
    drawn: &PlotLines,
    look: &PlotContext<'_>,
    height: Option<f32>,
    commands: &mut Vec<Command>,
) -> Option<f64> {
    header::show(ui, plot, drawn, look, height.is_some(), commands);
    let has_statistics = what.view_state.charts.statistics;
    let rows = if has_statistics { plot.shown().count() } else { 0 };
    let below = (STATISTICS_HEIGHT + ui.spacing().item_spacing.y) * rows as f32;
    let height = height.unwrap_or_else(|| (ui.available_height() - below).max(MIN_HEIGHT_PT));
    let over = curve::show(ui, what, plot, drawn, look, height, commands);
    if has_statistics {
        header::statistics(ui, plot, drawn, look);
    }
    over
}
