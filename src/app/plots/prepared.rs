//! What plots show: samples that grow with the runs on display, and what is drawn of them.

use std::sync::Arc;

use super::shown::Shown;
use crate::picture::charts::choice::{Choice, Plot};
use crate::picture::charts::drawn::Drawn;
use crate::picture::charts::range::Extent;
use crate::query::{Grown, Quick, Same, Sequence, Shared, Whole};
use crate::session::Session;
use crate::session::scenario::Scenario;
use crate::simulation::frame::Frame;
use crate::simulation::signals::Signal;
use crate::study::comparison::Comparison;
use crate::study::samples::Samples;

/// Frames taken up in one repaint: of ten signals they take a few milliseconds.
const AT_ONCE: usize = 4_000;

/// What is drawn of each plot.
pub struct Drawing;

/// All that the drawn lines depend on.
#[derive(Clone, PartialEq)]
pub struct Input {
    scenario: Shared<Scenario>,
    signals: Same<Vec<Signal>>,
    choice: Choice,
    pins: bool,
    samples: Grown<Samples>,
    /// Runs that are laid over, with their places.
    others: Vec<(usize, Grown<Samples>)>,
    shown: [f64; 2],
    columns: usize,
}

impl Quick for Drawing {
    type Input = Input;
    type Answer = Vec<Drawn>;

    fn answer(input: &Input) -> Vec<Drawn> {
        let Input { scenario, signals, choice, pins, shown, columns, .. } = input;
        let Some(samples) = input.samples.answer() else { return Vec::new() };
        let others: Vec<(usize, &Samples)> =
            input.others.iter().filter_map(|(place, other)| Some((*place, &**other.answer()?))).collect();
        let plots = choice.plots(&scenario.0, &signals.0, *pins);
        plots.iter().map(|plot| Drawn::of(plot, samples, &others, *shown, *columns, choice.statistics)).collect()
    }

    fn let_go(input: &mut Input) {
        input.samples.let_go();
        input.others.iter_mut().for_each(|(_, other)| other.let_go());
    }
}

/// How much time there is to show of a session.
pub fn extent(session: &Session) -> Extent {
    let (now, end) = (session.frame().time, session.frames().last().map_or(0.0, |f| f.time).max(session.length()));
    match session.is_led() {
        true => Extent::open_ended(session.run().planned_time(), end, now),
        false => Extent::of(end, now),
    }
}

/// What is drawn in so many columns of pixels, with its plots; whether all frames are in it.
pub fn drawn(what: &Shown<'_>, plots: &[Plot<'_>], columns: usize) -> (Arc<Vec<Drawn>>, bool) {
    let Shown { session, queries, view_state, .. } = *what;
    let wanted = wanted(plots);
    let others = laid_over(what.comparison);
    let others: Vec<(usize, Grown<Samples>)> =
        others.map(|(place, frames)| (place, queries.grow(&wanted, frames, AT_ONCE))).collect();
    let samples: Grown<Samples> = queries.grow(&wanted, session.frames(), AT_ONCE);
    let is_whole = samples.is_whole && others.iter().all(|(_, other)| other.is_whole);
    let input = Input {
        scenario: session.run().shared_scenario(),
        signals: Same(what.signals.clone()),
        choice: view_state.charts.clone(),
        pins: view_state.pins,
        samples,
        others,
        shown: extent(session).shown(view_state.charts.range),
        columns,
    };
    (queries.ask::<Whole<Drawing>>(&input), is_whole)
}

/// The signals of plots, each once.
fn wanted(plots: &[Plot<'_>]) -> Vec<Signal> {
    let mut wanted: Vec<Signal> = Vec::new();
    for signal in plots.iter().flat_map(|plot| plot.curves.iter().map(|curve| curve.signal).chain(plot.against)) {
        if !wanted.contains(signal) {
            wanted.push(signal.clone());
        }
    }
    wanted
}

/// The frames of runs that are laid over, with their places.
fn laid_over(comparison: Option<&Comparison>) -> impl Iterator<Item = (usize, &Sequence<Frame>)> {
    comparison.into_iter().flat_map(Comparison::shown).map(|(place, run)| (place, &run.frames))
}
