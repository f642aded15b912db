//! Export of a plot to a file.

use super::prepared::{PlotPreparation, extent, laid_over, shown_signals};
use super::shown::DisplayContext;
use crate::ViewState;
use crate::export::ValuesOrder;
use stillbase_picture::charts::choice::Plot;
use stillbase_picture::charts::drawn::PlotLines;
use stillbase_picture::charts::figure::{Figure, PlotContext};
use stillbase_picture::charts::legend::run_names;
use stillbase_picture::scene::palette::Palette;
use stillbase_query::{QuickWork, answer_sequence};
use stillbase_session::Session;
use stillbase_study::samples::SignalSamples;

/// Width and height of a picture of a plot, points.
const PICTURE_SIZE_PT: [f32; 2] = [720.0, 320.0];

/// Returns the drawing of a plot.
///
/// # Errors
/// If the plot does not exist any more.
pub fn figure(what: &DisplayContext<'_>, name: &str) -> Result<Figure, String> {
    let DisplayContext { session, signals, view_state, .. } = *what;
    let plots = view_state.plots(session.scenario(), signals);
    let lines = what.queries.last::<QuickWork<PlotPreparation>>().unwrap_or_default();
    let found = plots.iter().zip(&*lines).find(|(plot, _)| plot.name == name);
    let (plot, drawn) = found.ok_or_else(|| no_plot(name))?;
    let newest = session.frames().last().unwrap_or(session.frame());
    let mark = view_state.mark.map(|time| super::shown::instant(session, time));
    let palette = view_state.palette();
    let look = PlotContext { palette: &palette, peaks: &newest.peaks, now: session.frame(), mark, hover: None };
    Ok(Figure::of(plot, drawn, PICTURE_SIZE_PT, &look, &run_names(what.comparison)))
}

/// Says that a plot does not exist any more.
pub fn no_plot(name: &str) -> String {
    format!("there is no plot {name} any more: choose one that is shown")
}

/// Returns drawings of all plots on display, of a size in points and in the colours of `palette`. They show `times`, s,
/// with the cursors of the window. They do not name overlaid runs.
pub fn figures(what: &DisplayContext<'_>, times: [f64; 2], size: [f32; 2], palette: &Palette) -> Vec<Figure> {
    let DisplayContext { session, signals, view_state, .. } = *what;
    let plots = view_state.plots(session.scenario(), signals);
    let shown = shown_signals(&plots);
    let samples: SignalSamples = answer_sequence(&shown, session.frames());
    let others: Vec<(usize, SignalSamples)> =
        laid_over(what.comparison).map(|(place, frames)| (place, answer_sequence(&shown, frames))).collect();
    let others: Vec<(usize, &SignalSamples)> = others.iter().map(|(place, samples)| (*place, samples)).collect();
    let newest = session.frames().last().unwrap_or(session.frame());
    let mark = view_state.mark.map(|time| super::shown::instant(session, time));
    let look = PlotContext { palette, peaks: &newest.peaks, now: session.frame(), mark, hover: None };
    let drawn = |plot: &Plot<'_>| PlotLines::of(plot, &samples, &others, times, size[0] as usize, false);
    plots.iter().map(|plot| Figure::of(plot, &drawn(plot), size, &look, &[])).collect()
}

/// Returns the values of a plot within the time range on display, as they are written.
pub fn values(session: &Session, view_state: &ViewState, plot: &Plot<'_>) -> ValuesOrder {
    let shown = plot.against.iter().chain(plot.shown());
    let times = extent(session).shown(view_state.charts.range);
    ValuesOrder { signals: shown.map(|curve| curve.signal.clone()).collect(), times }
}
