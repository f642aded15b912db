//! Which time plots show, and how it is moved: [`Extent`].

use serde::{Deserialize, Serialize};

/// The longest stretch of time that is shown unasked, s.
const WINDOW: f64 = 12.0;
/// The shortest of those of a run whose end is not known, s.
const OPEN_WINDOW: f64 = 4.0;
/// The shortest that is shown at all, s.
const SHORTEST: f64 = 1e-5;

/// How much time there is to show.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Extent {
    /// From the start to the end of the run, s.
    pub whole: [f64; 2],
    /// What is shown unasked, s: all of a short run, of a long one what lies around the present instant.
    pub usual: [f64; 2],
}

impl Extent {
    /// Of a run that ends at a time and of which an instant is shown, both s.
    pub fn of(end: f64, now: f64) -> Self {
        Self::within(WINDOW, end, now)
    }

    /// Of a run whose end is not known, up to which a time has passed, and of which an instant is shown; `planned` is how
    /// long it was to take; all s. Unasked a stretch of one length is shown, so that curves move on and are not squeezed.
    pub fn open_ended(planned: f64, end: f64, now: f64) -> Self {
        let window = planned.clamp(OPEN_WINDOW, WINDOW);
        Self::within(window, end.max(window), now)
    }

    fn within(window: f64, end: f64, now: f64) -> Self {
        let end = end.max(SHORTEST);
        let to = end.min((now + 0.5 * window).max(window));
        Self { whole: [0.0, end], usual: [(to - window).max(0.0), to] }
    }

    /// What is shown where a person chose a range, or none.
    pub fn shown(&self, chosen: Option<[f64; 2]>) -> [f64; 2] {
        let [from, to] = chosen.unwrap_or(self.usual);
        // A range that was chosen of a longer run.
        if from < self.whole[1] && to > from { [from, to] } else { self.usual }
    }

    /// Whether a range shows all there is.
    pub fn is_all(&self, [from, to]: [f64; 2]) -> bool {
        from <= self.whole[0] + 1e-9 && to >= self.whole[1] - 1e-9
    }

    /// The choice that shows all; a second time, the usual one.
    pub fn all(&self, chosen: Option<[f64; 2]>) -> Option<[f64; 2]> {
        (chosen != Some(self.whole) && self.usual != self.whole).then_some(self.whole)
    }

    /// A choice a few times as close, `factor` of them, about a time that stays where it is.
    pub fn zoomed(&self, shown: [f64; 2], about: f64, factor: f64) -> Option<[f64; 2]> {
        let (now, most) = (shown[1] - shown[0], self.whole[1] - self.whole[0]);
        let length = (now / factor.max(1e-6)).clamp(SHORTEST.min(most), most);
        if length >= most * (1.0 - 1e-9) {
            return (self.usual != self.whole).then_some(self.whole);
        }
        let share = ((about - shown[0]) / now).clamp(0.0, 1.0);
        let from = about.clamp(shown[0], shown[1]) - share * length;
        Some(self.inside([from, from + length]))
    }

    /// A choice that is moved by a time, s, as far as there is something to show.
    pub fn panned(&self, [from, to]: [f64; 2], by: f64) -> [f64; 2] {
        self.inside([from + by, to + by])
    }

    /// The choice from one time to another, in whichever order, s; none where they are too close to mean it.
    pub fn between(&self, a: f64, b: f64) -> Option<[f64; 2]> {
        let [from, to] = [a.min(b).max(self.whole[0]), a.max(b).min(self.whole[1])];
        (to - from >= SHORTEST).then_some([from, to])
    }

    fn inside(&self, [from, to]: [f64; 2]) -> [f64; 2] {
        let length = to - from;
        let from = from.min(self.whole[1] - length).max(self.whole[0]);
        [from, from + length]
    }
}
