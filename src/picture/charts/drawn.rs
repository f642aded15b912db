//! The curves of a plot in a time interval ([`PlotLines`]), recomputed when samples, interval or choice change.

use super::axis::{self, AxisKind};
use super::choice::Plot;
use stillbase_study::samples::SignalSamples;
use stillbase_study::series::Statistics;

/// A curve's points, in the units of its plot.
#[derive(Clone, Debug, PartialEq)]
pub struct PlotLine {
    /// Index of the curve in the plot.
    pub curve: usize,
    /// Index of the overlaid run; `None` for the run of the session.
    pub run: Option<usize>,
    /// Points (x, y), where x is time, s, or the value of the signal on the horizontal axis.
    pub points: Vec<[f64; 2]>,
}

/// The curves of a plot, ready to be drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct PlotLines {
    /// Lines of overlaid runs first, then those of the session's run.
    pub lines: Vec<PlotLine>,
    /// Bounds of the horizontal axis: time, s, or the values of the signal on that axis.
    pub x: [f64; 2],
    /// Bounds of the vertical axis.
    pub y: [f64; 2],
    /// Bounds of the vertical axis that show all values.
    pub all: [f64; 2],
    /// Limits of the curves, each drawn at plus and minus this value, with the index of its curve. A limit much larger
    /// than all values is left out.
    pub limits: Vec<(usize, f64)>,
    /// Statistics of each curve of the plot; empty unless requested.
    pub statistics: Vec<Option<Statistics>>,
}

impl PlotLines {
    /// Computes the curves of a plot.
    ///
    /// * `samples`: the run of the session.
    /// * `others`: overlaid runs with their indices.
    /// * `shown`: time interval, s.
    /// * `columns`: width, pixels.
    /// * `statistics`: whether statistics are computed.
    pub fn of(
        plot: &Plot<'_>,
        samples: &SignalSamples,
        others: &[(usize, &SignalSamples)],
        shown: [f64; 2],
        columns: usize,
        statistics: bool,
    ) -> Self {
        let runs = others.iter().map(|(i, run)| (Some(*i), *run)).chain([(None, samples)]);
        let mut drawn =
            Self { lines: Vec::new(), x: shown, y: EMPTY, all: EMPTY, limits: Vec::new(), statistics: Vec::new() };
        let mut across = [f64::INFINITY, f64::NEG_INFINITY];
        for (run, samples) in runs {
            for (i, curve) in plot.curves.iter().enumerate().filter(|(_, curve)| curve.on) {
                let (path, factor) = (&curve.signal.path, curve.scale);
                if let Some(bounds) = samples.bounds(path, shown) {
                    widen(&mut drawn.y, bounds.map(|y| factor * y));
                }
                let mut points = match &plot.against {
                    None => samples.line(path, shown, columns),
                    Some(against) => {
                        if let Some(bounds) = samples.bounds(&against.signal.path, shown) {
                            widen(&mut across, bounds.map(|x| against.scale * x));
                        }
                        let mut points = samples.line_against(&against.signal.path, path, shown, 4 * columns);
                        points.iter_mut().for_each(|[x, _]| *x *= against.scale);
                        points
                    }
                };
                points.iter_mut().for_each(|[_, y]| *y *= factor);
                drawn.lines.push(PlotLine { curve: i, run, points });
            }
        }
        if statistics {
            let of = |path: &str| samples.statistics(path, shown);
            let scaled = |s: Statistics, factor: f64| Statistics {
                least: factor * s.least,
                greatest: factor * s.greatest,
                mean: factor * s.mean,
                rms: factor * s.rms,
                ..s
            };
            let curves = plot.curves.iter();
            drawn.statistics = curves.map(|c| of(&c.signal.path).map(|s| scaled(s, c.scale))).collect();
        }
        let largest = drawn.y[0].abs().max(drawn.y[1].abs());
        for (i, curve) in plot.curves.iter().enumerate().filter(|(_, curve)| curve.on && plot.against.is_none()) {
            let limit = curve.signal.limit.map(|limit| curve.scale * limit);
            if let Some(limit) = limit.filter(|limit| shows_limit(*limit, largest)) {
                widen(&mut drawn.y, [-limit, limit]);
                drawn.limits.push((i, limit));
            }
        }
        drawn.all = rounded_bounds(plot, drawn.y);
        drawn.y = plot.values.unwrap_or(drawn.all);
        if let Some(against) = plot.against {
            drawn.x = with_margin(across, against.scale * axis::floor(against.signal));
        }
        drawn
    }

    /// Returns the resolution to which values are written: finer than the eye can resolve on the vertical axis.
    pub fn finest(&self) -> f64 {
        2e-4 * (self.y[1] - self.y[0])
    }
}

/// A limit is drawn if it is at most this multiple of the largest value, so that curves do not become flat.
const LIMIT_SHOWN_BELOW: f64 = 2.0;

/// Returns whether a limit is drawn beside curves whose largest absolute value is `largest`.
pub fn shows_limit(limit: f64, largest: f64) -> bool {
    largest.is_finite() && limit <= LIMIT_SHOWN_BELOW * largest
}

/// Bounds of an empty set of values.
const EMPTY: [f64; 2] = [f64::INFINITY, f64::NEG_INFINITY];

fn widen(bounds: &mut [f64; 2], [low, high]: [f64; 2]) {
    *bounds = [bounds[0].min(low), bounds[1].max(high)];
}

/// Returns rounded bounds of values, with a margin.
fn rounded_bounds(plot: &Plot<'_>, [low, high]: [f64; 2]) -> [f64; 2] {
    let mut chart = plot.chart;
    if plot.added_by_user {
        // A plot that the user added follows its curves; its axis is at least 0.1 % of the largest value long.
        let most = low.abs().max(high.abs());
        let floor = plot.shown().fold(0.0_f64, |floor, curve| floor.max(curve.scale * axis::floor(curve.signal)));
        let floor = if most.is_finite() { floor.max(1e-3 * most) } else { floor };
        chart.min_range = if floor > 0.0 { floor } else { 1.0 };
        chart.axis = AxisKind::of(plot.shown().map(|curve| curve.signal));
    }
    let [low, high] = chart.range(low, high);
    let margin = 0.06 * (high - low);
    [low - margin, high + margin]
}

/// Returns bounds widened by a margin, at least `floor` apart.
fn with_margin([low, high]: [f64; 2], floor: f64) -> [f64; 2] {
    if !(low.is_finite() && high.is_finite()) {
        return [0.0, 1.0];
    }
    let least = floor.max(1e-9 * low.abs().max(high.abs())).max(1e-12);
    let margin = (0.06 * (high - low)).max(0.5 * (least - (high - low)));
    [low - margin, high + margin]
}
