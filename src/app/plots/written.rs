//! Export of a plot to a file.

use super::prepared::{PlotPreparation, extent, laid_over, shown_signals};
use super::shown::DisplayContext;
use crate::PlotFile;
use stillbase_picture::charts::choice::Plot;
use stillbase_picture::charts::drawn::PlotLines;
use stillbase_picture::charts::figure::{Figure, PlotContext};
use stillbase_picture::charts::legend::run_names;
use stillbase_picture::scene::palette::Palette;
use stillbase_query::{QuickWork, answer_sequence};
use stillbase_simulation::signals::Signal;
use stillbase_study::samples::SignalSamples;

/// Width and height of a picture of a plot, points.
const PICTURE_SIZE_PT: [f32; 2] = [720.0, 320.0];

/// Computes the content of a file.
type Content = Box<dyn FnOnce() -> Result<Vec<u8>, String> + Send>;

/// Returns the function that computes the file of a plot; it is run in the background, since it may take long.
///
/// # Errors
/// If the plot does not exist any more.
pub fn written(what: &DisplayContext<'_>, name: &str, file: PlotFile) -> Result<Content, String> {
    let DisplayContext { session, signals, view_state, .. } = *what;
    let plots = view_state.plots(session.scenario(), signals);
    let lines = what.queries.last::<QuickWork<PlotPreparation>>().unwrap_or_default();
    let found = plots.iter().zip(&*lines).find(|(plot, _)| plot.name == name);
    let Some((plot, drawn)) = found else {
        return Err(format!("there is no plot {name} any more: choose one that is shown"));
    };
    let newest = session.frames().last().unwrap_or(session.frame());
    let mark = view_state.mark.map(|time| super::shown::instant(session, time));
    let palette = view_state.palette();
    let look = PlotContext { palette: &palette, peaks: &newest.peaks, now: session.frame(), mark, hover: None };
    let figure = Figure::of(plot, drawn, PICTURE_SIZE_PT, &look, &run_names(what.comparison));
    Ok(match file {
        PlotFile::Csv => {
            let range = extent(session).shown(view_state.charts.range);
            let (signals, frames) = (columns(plot), session.frames().clone());
            Box::new(move || Ok(answer_sequence::<SignalSamples>(&signals, &frames).csv(range).into_bytes()))
        }
        PlotFile::Picture(form) => Box::new(move || form.of_figure(figure)),
    })
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

/// Returns the signals whose values a plot shows.
pub fn columns(plot: &Plot<'_>) -> Vec<Signal> {
    plot.against.iter().chain(plot.shown()).map(|curve| curve.signal.clone()).collect()
}
