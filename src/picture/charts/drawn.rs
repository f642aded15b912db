//! What a plot's curves come to in a range of time: [`Drawn`], made when samples, range or choice change.

use super::choice::Plot;
use crate::study::samples::Samples;
use crate::study::series::Statistics;

/// A curve's points, in the units of its plot.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// Which of the plot's curves.
    pub curve: usize,
    /// Which run is laid over; none for the session's own.
    pub run: Option<usize>,
    /// Over time, s, or over the other signal.
    pub points: Vec<[f64; 2]>,
}

/// The curves of a plot, ready to be drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawn {
    /// Runs that are laid over first, then the session's own.
    pub lines: Vec<Line>,
    /// What it spans: time, s, or the values of the other signal.
    pub x: [f64; 2],
    /// What its values span.
    pub y: [f64; 2],
    /// What they span where all of them are shown.
    pub all: [f64; 2],
    /// What each curve comes to, if that is asked for; as many as the plot has curves.
    pub statistics: Vec<Option<Statistics>>,
}

impl Drawn {
    /// Of a plot, in so many columns of pixels.
    pub fn of(
        plot: &Plot<'_>,
        samples: &Samples,
        others: &[(usize, &Samples)],
        shown: [f64; 2],
        columns: usize,
        statistics: bool,
    ) -> Self {
        let runs = others.iter().map(|(i, run)| (Some(*i), *run)).chain([(None, samples)]);
        let mut drawn = Self { lines: Vec::new(), x: shown, y: NONE, all: NONE, statistics: Vec::new() };
        let mut across = [f64::INFINITY, f64::NEG_INFINITY];
        for (run, samples) in runs {
            for (i, curve) in plot.curves.iter().enumerate().filter(|(_, curve)| curve.on) {
                let (path, times) = (&curve.signal.path, curve.times);
                if let Some(bounds) = samples.bounds(path, shown) {
                    widen(&mut drawn.y, bounds.map(|y| times * y));
                }
                let mut points = match plot.against {
                    None => samples.line(path, shown, columns),
                    Some(against) => {
                        if let Some(bounds) = samples.bounds(&against.path, shown) {
                            widen(&mut across, bounds);
                        }
                        samples.line_against(&against.path, path, shown, 4 * columns)
                    }
                };
                points.iter_mut().for_each(|[_, y]| *y *= times);
                drawn.lines.push(Line { curve: i, run, points });
            }
        }
        if statistics {
            let of = |path: &str| samples.statistics(path, shown);
            let scaled = |s: Statistics, times: f64| Statistics {
                least: times * s.least,
                greatest: times * s.greatest,
                mean: times * s.mean,
                rms: times * s.rms,
                ..s
            };
            let curves = plot.curves.iter();
            drawn.statistics = curves.map(|c| of(&c.signal.path).map(|s| scaled(s, c.times))).collect();
        }
        drawn.all = room(plot, drawn.y);
        drawn.y = plot.values.unwrap_or(drawn.all);
        if plot.against.is_some() {
            drawn.x = apart(across);
        }
        drawn
    }

    /// The smallest difference of its values that is told apart in words: less than can be seen.
    pub fn finest(&self) -> f64 {
        2e-4 * (self.y[1] - self.y[0])
    }
}

/// Of no values.
const NONE: [f64; 2] = [f64::INFINITY, f64::NEG_INFINITY];

fn widen(bounds: &mut [f64; 2], [low, high]: [f64; 2]) {
    *bounds = [bounds[0].min(low), bounds[1].max(high)];
}

/// Rounded bounds about values, with some room.
fn room(plot: &Plot<'_>, [low, high]: [f64; 2]) -> [f64; 2] {
    let mut chart = plot.chart;
    if chart.least == 0.0 {
        // A signal of one's own is as small as it is.
        let most = low.abs().max(high.abs());
        chart.least = if most.is_finite() && most > 0.0 { 1e-3 * most } else { 1.0 };
    }
    let [low, high] = chart.range(low, high);
    let margin = 0.06 * (high - low);
    [low - margin, high + margin]
}

/// Bounds with some room.
fn apart([low, high]: [f64; 2]) -> [f64; 2] {
    if !(low.is_finite() && high.is_finite()) {
        return [0.0, 1.0];
    }
    let margin = (0.06 * (high - low)).max(1e-9 * low.abs().max(high.abs())).max(1e-12);
    [low - margin, high + margin]
}
