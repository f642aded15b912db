//! The time interval that plots show, with zoom and pan: [`TimeExtent`].

use serde::{Deserialize, Serialize};

/// Maximum length of the default interval, s.
const MAX_USUAL_S: f64 = 12.0;
/// Minimum length of the default interval of a run whose end is unknown, s.
const MIN_OPEN_USUAL_S: f64 = 4.0;
/// Minimum length of any interval, s.
const MIN_LENGTH_S: f64 = 1e-5;

/// The time intervals of a run. A choice of `None` means the default interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TimeExtent {
    /// Interval from the start to the end of the run, s.
    pub whole: [f64; 2],
    /// Interval shown by default, s: all of a short run, or the surroundings of the displayed instant of a long run.
    #[serde(rename = "usual")]
    pub default: [f64; 2],
}

impl TimeExtent {
    /// Returns the intervals of a run that ends at `end`; `now` is the displayed instant, both s.
    pub fn of(end: f64, now: f64) -> Self {
        Self::within(MAX_USUAL_S, end, now)
    }

    /// Returns the intervals of a run whose end is unknown. `planned` is the planned duration, `end` the time that has
    /// passed and `now` the displayed instant, all s. The default interval has a constant length, so that curves scroll
    /// instead of shrinking.
    pub fn open_ended(planned: f64, end: f64, now: f64) -> Self {
        let window = planned.clamp(MIN_OPEN_USUAL_S, MAX_USUAL_S);
        Self::within(window, end.max(window), now)
    }

    fn within(window: f64, end: f64, now: f64) -> Self {
        let end = end.max(MIN_LENGTH_S);
        let to = end.min((now + 0.5 * window).max(window));
        Self { whole: [0.0, end], default: [(to - window).max(0.0), to] }
    }

    /// Returns the interval to show for a choice of the user.
    pub fn shown(&self, chosen: Option<[f64; 2]>) -> [f64; 2] {
        let [from, to] = chosen.unwrap_or(self.default);
        // An interval chosen for a longer run may lie beyond the end.
        if from < self.whole[1] && to > from { [from, to] } else { self.default }
    }

    /// Whether an interval contains the whole run.
    pub fn is_all(&self, [from, to]: [f64; 2]) -> bool {
        from <= self.whole[0] + 1e-9 && to >= self.whole[1] - 1e-9
    }

    /// Toggles between the whole run and the default interval; returns the new choice.
    pub fn all(&self, chosen: Option<[f64; 2]>) -> Option<[f64; 2]> {
        (chosen != Some(self.whole) && self.default != self.whole).then_some(self.whole)
    }

    /// Returns the choice that magnifies the interval `shown` by `factor`; the time `about`, s, keeps its place on the
    /// axis.
    pub fn zoomed(&self, shown: [f64; 2], about: f64, factor: f64) -> Option<[f64; 2]> {
        let (now, most) = (shown[1] - shown[0], self.whole[1] - self.whole[0]);
        let length = (now / factor.max(1e-6)).clamp(MIN_LENGTH_S.min(most), most);
        if length >= most * (1.0 - 1e-9) {
            return (self.default != self.whole).then_some(self.whole);
        }
        let share = ((about - shown[0]) / now).clamp(0.0, 1.0);
        let from = about.clamp(shown[0], shown[1]) - share * length;
        Some(self.inside([from, from + length]))
    }

    /// Returns an interval shifted by a time, s, and limited to the run.
    pub fn panned(&self, [from, to]: [f64; 2], by: f64) -> [f64; 2] {
        self.inside([from + by, to + by])
    }

    /// Returns the interval between two times, s, in any order; `None` if they are closer than the minimum length.
    pub fn between(&self, a: f64, b: f64) -> Option<[f64; 2]> {
        let [from, to] = [a.min(b).max(self.whole[0]), a.max(b).min(self.whole[1])];
        (to - from >= MIN_LENGTH_S).then_some([from, to])
    }

    fn inside(&self, [from, to]: [f64; 2]) -> [f64; 2] {
        let length = to - from;
        let from = from.min(self.whole[1] - length).max(self.whole[0]);
        [from, from + length]
    }
}
