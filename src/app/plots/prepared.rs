//! The data of the plots: samples that grow with the runs on display, and the lines drawn of them.

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

/// Number of frames sampled in one repaint: a few milliseconds for ten signals.
const FRAMES_PER_REPAINT: usize = 4_000;

/// Query for the drawn lines of each plot.
pub struct Drawing;

/// The input of the drawn lines.
#[derive(Clone, PartialEq)]
pub struct Input {
    scenario: Shared<Scenario>,
    signals: Same<Vec<Signal>>,
    choice: Choice,
    pins: bool,
    samples: Grown<Samples>,
    /// Runs shown in comparison, with their indices.
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

/// Returns the time that the plots of a session can show.
pub fn extent(session: &Session) -> Extent {
    let (now, end) = (session.frame().time, session.frames().last().map_or(0.0, |f| f.time).max(session.length()));
    match session.is_led() {
        true => Extent::open_ended(session.run().planned_time(), end, now),
        false => Extent::of(end, now),
    }
}

/// Returns the drawn lines of the plots for a number of pixel columns, and whether they contain all frames.
pub fn drawn(what: &Shown<'_>, plots: &[Plot<'_>], columns: usize) -> (Arc<Vec<Drawn>>, bool) {
    let Shown { session, queries, view_state, .. } = *what;
    let wanted = wanted(plots);
    let others = laid_over(what.comparison);
    let others: Vec<(usize, Grown<Samples>)> =
        others.map(|(place, frames)| (place, queries.grow(&wanted, frames, FRAMES_PER_REPAINT))).collect();
    let samples: Grown<Samples> = queries.grow(&wanted, session.frames(), FRAMES_PER_REPAINT);
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

/// Returns the signals of the plots, without repetitions.
fn wanted(plots: &[Plot<'_>]) -> Vec<Signal> {
    let mut wanted: Vec<Signal> = Vec::new();
    for signal in plots.iter().flat_map(|plot| plot.curves.iter().map(|curve| curve.signal).chain(plot.against)) {
        if !wanted.contains(signal) {
            wanted.push(signal.clone());
        }
    }
    wanted
}

/// Returns the frames of the runs shown in comparison, with their indices.
fn laid_over(comparison: Option<&Comparison>) -> impl Iterator<Item = (usize, &Sequence<Frame>)> {
    comparison.into_iter().flat_map(Comparison::shown).map(|(place, run)| (place, &run.frames))
}
