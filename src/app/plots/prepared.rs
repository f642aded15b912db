//! The data of the plots: samples that grow with the runs on display, and the lines drawn from these samples.

use std::sync::Arc;

use egui::{Context, Id};

use super::shown::DisplayContext;
use super::window;
use stillbase_picture::charts::choice::{Plot, PlotChoice};
use stillbase_picture::charts::drawn::PlotLines;
use stillbase_picture::charts::figure::LEFT_MARGIN;
use stillbase_picture::charts::range::TimeExtent;
use stillbase_picture::notation::Notation;
use stillbase_query::{ByIdentity, IncrementalAnswer, QuickQuery, QuickWork, Sequence, Shared};
use stillbase_session::Session;
use stillbase_session::scenario::Scenario;
use stillbase_simulation::frame::Frame;
use stillbase_simulation::signals::Signal;
use stillbase_study::comparison::Comparison;
use stillbase_study::samples::SignalSamples;

/// Number of frames sampled in one repaint, which takes a few milliseconds for ten signals.
const FRAMES_PER_REPAINT: usize = 4_000;

/// Query for the drawn lines of each plot.
pub struct PlotPreparation;

/// Input of the query for drawn lines.
#[derive(Clone, PartialEq)]
pub struct PlotInput {
    scenario: Shared<Scenario>,
    signals: ByIdentity<Vec<Signal>>,
    choice: PlotChoice,
    pins: bool,
    notation: Notation,
    samples: IncrementalAnswer<SignalSamples>,
    /// Runs shown in comparison, with their indices.
    others: Vec<(usize, IncrementalAnswer<SignalSamples>)>,
    shown: [f64; 2],
    columns: usize,
}

impl QuickQuery for PlotPreparation {
    type Input = PlotInput;
    type Answer = Vec<PlotLines>;

    fn answer(input: &PlotInput) -> Vec<PlotLines> {
        let PlotInput { scenario, signals, choice, pins, notation, shown, columns, .. } = input;
        let Some(samples) = input.samples.answer() else { return Vec::new() };
        let others: Vec<(usize, &SignalSamples)> =
            input.others.iter().filter_map(|(place, other)| Some((*place, &**other.answer()?))).collect();
        let plots = choice.plots(&scenario.0, &signals.0, *pins, *notation);
        plots.iter().map(|plot| PlotLines::of(plot, samples, &others, *shown, *columns, choice.statistics)).collect()
    }

    fn let_go(input: &mut PlotInput) {
        input.samples.let_go();
        input.others.iter_mut().for_each(|(_, other)| other.let_go());
    }
}

/// Returns the time range that the plots of a session can show.
pub fn extent(session: &Session) -> TimeExtent {
    let (now, end) = (session.frame().time, session.frames().last().map_or(0.0, |f| f.time).max(session.length()));
    match session.is_dragged() {
        true => TimeExtent::open_ended(session.run().planned_time(), end, now),
        false => TimeExtent::of(end, now),
    }
}

/// Key under which egui stores the width that a plot had last in the panel, pixels.
fn panel_id() -> Id {
    Id::unique("width of plots in the panel")
}

/// Returns the lines of plots for the width of the panel, points, or of the widest plot window if that is wider.
pub fn of_width(ctx: &Context, what: &DisplayContext<'_>, plots: &[Plot<'_>], width: f32) -> Arc<Vec<PlotLines>> {
    let width = (width - LEFT_MARGIN) * ctx.pixels_per_point();
    ctx.data_mut(|data| data.insert_temp(panel_id(), width));
    of_last_width(ctx, what, plots)
}

/// Returns the lines of plots for the width that the panel had last: all windows draw the same lines.
pub fn of_last_width(ctx: &Context, what: &DisplayContext<'_>, plots: &[Plot<'_>]) -> Arc<Vec<PlotLines>> {
    let panel: f32 = ctx.data(|data| data.get_temp(panel_id())).unwrap_or_default();
    let width = |plot: &Plot<'_>| {
        let [_, _, width, _] = plot.window?;
        // Screens differ in their pixels per point.
        let scale = match ctx.embed_viewports() {
            true => ctx.pixels_per_point(),
            false => ctx.input_for(window::viewport(&plot.name), |input| input.pixels_per_point),
        };
        Some((width - LEFT_MARGIN) * scale)
    };
    let widest = plots.iter().filter_map(width).fold(panel, f32::max);
    let columns = widest.clamp(16.0, 8192.0) as usize;
    let (lines, is_whole) = drawn(what, plots, columns);
    if !is_whole {
        ctx.request_repaint();
    }
    lines
}

/// Returns the drawn lines of the plots for a number of pixel columns, and whether they contain all frames.
fn drawn(what: &DisplayContext<'_>, plots: &[Plot<'_>], columns: usize) -> (Arc<Vec<PlotLines>>, bool) {
    let DisplayContext { session, queries, view_state, .. } = *what;
    let wanted = wanted(plots);
    let others = laid_over(what.comparison);
    let others: Vec<(usize, IncrementalAnswer<SignalSamples>)> =
        others.map(|(place, frames)| (place, queries.grow(&wanted, frames, FRAMES_PER_REPAINT))).collect();
    let samples: IncrementalAnswer<SignalSamples> = queries.grow(&wanted, session.frames(), FRAMES_PER_REPAINT);
    let is_whole = samples.is_whole && others.iter().all(|(_, other)| other.is_whole);
    let input = PlotInput {
        scenario: session.run().shared_scenario(),
        signals: ByIdentity(what.signals.clone()),
        choice: view_state.charts.clone(),
        pins: view_state.pins,
        notation: view_state.arrangement.notation,
        samples,
        others,
        shown: extent(session).shown(view_state.charts.range),
        columns,
    };
    (queries.ask::<QuickWork<PlotPreparation>>(&input), is_whole)
}

/// Returns the signals of the plots, without repetitions.
fn wanted(plots: &[Plot<'_>]) -> Vec<Signal> {
    let mut wanted: Vec<Signal> = Vec::new();
    for signal in plots.iter().flat_map(|plot| plot.curves.iter().chain(&plot.against)).map(|curve| curve.signal) {
        if !wanted.contains(signal) {
            wanted.push(signal.clone());
        }
    }
    wanted
}

/// Returns the signals whose curves plots show, without repetitions.
pub fn shown_signals(plots: &[Plot<'_>]) -> Vec<Signal> {
    let mut shown: Vec<Signal> = Vec::new();
    for signal in plots.iter().flat_map(|plot| plot.shown().chain(&plot.against)).map(|curve| curve.signal) {
        if !shown.contains(signal) {
            shown.push(signal.clone());
        }
    }
    shown
}

/// Returns the frames of the runs shown in comparison, with their indices.
pub fn laid_over(comparison: Option<&Comparison>) -> impl Iterator<Item = (usize, &Sequence<Frame>)> {
    comparison.into_iter().flat_map(Comparison::shown).map(|(place, run)| (place, &run.frames))
}
