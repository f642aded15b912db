//! [`SignalSamples`]: signals of a run over time, for drawing at any scale, and statistics.

use std::ops::Range;

use super::series::{Series, Statistics};
use stillbase_query::IncrementalQuery;
use stillbase_simulation::frame::Frame;
use stillbase_simulation::signals::Signal;

/// Samples of some signals of one run. A signal that was added later has fewer samples until it catches up.
#[derive(Clone, Debug, Default)]
pub struct SignalSamples {
    times: Vec<f64>,
    /// Series, each with the path of its signal.
    series: Vec<(String, Series)>,
    /// Signal of each series; empty if the series do not grow.
    signals: Vec<Signal>,
}

impl IncrementalQuery for SignalSamples {
    type Item = Frame;
    /// Requested signals.
    type Input = Vec<Signal>;

    fn begin(wanted: &Vec<Signal>) -> Self {
        let mut samples = Self::default();
        samples.set_input(wanted);
        samples
    }

    fn count(&self) -> usize {
        self.series.iter().map(|(_, series)| series.values().len()).fold(self.times.len(), usize::min)
    }

    fn take(&mut self, frames: &[Frame]) {
        let count = self.count();
        // A frame is large, so it is read once for all signals.
        for (place, frame) in (count..).zip(frames) {
            if self.times.len() == place {
                self.times.push(frame.time);
            }
            for (signal, (_, series)) in self.signals.iter().zip(&mut self.series) {
                if series.values().len() == place {
                    series.push(signal.value(frame));
                }
            }
        }
    }

    fn truncate(&mut self, count: usize) {
        self.times.truncate(count);
        self.series.iter_mut().for_each(|(_, series)| series.truncate(count));
    }

    /// Keeps the series of signals that are still requested.
    fn set_input(&mut self, wanted: &Vec<Signal>) {
        let mut known: Vec<(Signal, (String, Series))> =
            std::mem::take(&mut self.signals).into_iter().zip(std::mem::take(&mut self.series)).collect();
        for signal in wanted {
            let place = known.iter().position(|(known, _)| known == signal);
            let kept = place.map(|place| known.swap_remove(place).1);
            self.series.push(kept.unwrap_or_else(|| (signal.path.clone(), Series::default())));
        }
        self.signals.clone_from(wanted);
    }
}

impl SignalSamples {
    /// Builds samples from sampling times, s, and series by path. Series whose length differs from the number of times
    /// are omitted.
    pub fn of(times: Vec<f64>, signals: impl IntoIterator<Item = (String, Series)>) -> Self {
        let series = signals.into_iter().filter(|(_, series)| series.values().len() == times.len()).collect();
        Self { times, series, signals: Vec::new() }
    }

    /// Returns the samples of a signal.
    pub fn series(&self, path: &str) -> Option<&Series> {
        self.series.iter().find(|(known, _)| known == path).map(|(_, series)| series)
    }

    /// Returns the sampling times, s.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// Returns the indices of the samples in a time interval, s, both bounds included.
    pub fn within(&self, [from, to]: [f64; 2]) -> Range<usize> {
        let start = self.times.partition_point(|t| *t < from - 1e-9);
        start..self.times.partition_point(|t| *t <= to + 1e-9).max(start)
    }

    /// Returns the indices of [`within`](Self::within) and one more on each side, so that a line extends to the edges.
    fn beyond(&self, shown: [f64; 2]) -> Range<usize> {
        let range = self.within(shown);
        range.start.saturating_sub(1)..(range.end + 1).min(self.times.len())
    }

    /// Returns the line of a signal over time, reduced for drawing in `columns` columns of pixels. Each column keeps
    /// its first, smallest, largest and last sample, so that no peak is lost and the picture equals that of all
    /// samples. Columns keep their times while the interval moves.
    pub fn line(&self, path: &str, shown: [f64; 2], columns: usize) -> Vec<[f64; 2]> {
        let Some(series) = self.series(path) else { return Vec::new() };
        let range = self.beyond(shown);
        let point = |i: usize| Some([self.times[i], *series.values().get(i)?]).filter(|p| p[1].is_finite());
        if range.len() <= 4 * columns.max(1) || shown[1] <= shown[0] {
            return range.filter_map(point).collect();
        }
        let width = (shown[1] - shown[0]) / columns.max(1) as f64;
        let mut points = Vec::with_capacity(4 * columns + 8);
        let mut from = range.start;
        while from < range.end {
            let column = (self.times[from] / width).floor();
            let to = from + self.times[from..range.end].partition_point(|t| (t / width).floor() <= column).max(1);
            if let Some([least, greatest]) = series.extremes(from..to) {
                take(&mut points, [from, least, greatest, to - 1], point);
            }
            from = to;
        }
        points
    }

    /// Returns one signal against another over a time interval, reduced to about `most` points. Each block of samples
    /// keeps its first and last sample, and those where either signal is smallest or largest.
    pub fn line_against(&self, across: &str, path: &str, shown: [f64; 2], most: usize) -> Vec<[f64; 2]> {
        let (Some(x), Some(y)) = (self.series(across), self.series(path)) else { return Vec::new() };
        let range = self.within(shown);
        let point =
            |i: usize| Some([*x.values().get(i)?, *y.values().get(i)?]).filter(|p| p.iter().all(|x| x.is_finite()));
        if range.len() <= most {
            return range.filter_map(point).collect();
        }
        let size = (6 * range.len()).div_ceil(most.max(6));
        let mut points = Vec::with_capacity(most + 12);
        let mut from = range.start;
        while from < range.end {
            let to = ((from / size + 1) * size).min(range.end);
            if let (Some([a, b]), Some([c, d])) = (x.extremes(from..to), y.extremes(from..to)) {
                take(&mut points, [from, a, b, c, d, to - 1], point);
            }
            from = to;
        }
        points
    }

    /// Returns the smallest and the largest value of a signal in a time interval; `None` if no sample is finite.
    pub fn bounds(&self, path: &str, shown: [f64; 2]) -> Option<[f64; 2]> {
        let series = self.series(path)?;
        Some(series.extremes(self.within(shown))?.map(|i| series.values()[i]))
    }

    /// Returns the statistics of a signal in a time interval.
    pub fn statistics(&self, path: &str, shown: [f64; 2]) -> Option<Statistics> {
        self.series(path)?.statistics(self.within(shown))
    }
}

/// Adds points in the order of time, each once.
fn take<const N: usize>(points: &mut Vec<[f64; 2]>, mut places: [usize; N], point: impl Fn(usize) -> Option<[f64; 2]>) {
    places.sort_unstable();
    for (k, i) in places.into_iter().enumerate() {
        if k == 0 || places[k - 1] != i {
            points.extend(point(i));
        }
    }
}
