//! [`BSet`]: pose constants as intervals within a period.

use super::plane::SLACK;

/// Intervals that come as near as this are one, rad: rounding.
const TOUCH: f64 = 1e-11;

/// A set of pose constants: disjoint closed intervals on the circle of b.
#[derive(Clone, Debug, PartialEq)]
pub struct BSet {
    /// [b_min, b_max] in order, rad: b_min in [0, period), b_max ≥ b_min may exceed it; the whole circle is [0,
    /// period].
    pub intervals: Vec<[f64; 2]>,
    /// Circumference of the circle, 2π Σλ, rad.
    pub period: f64,
}

impl BSet {
    /// A union of intervals [low, high], wherever on the real line they lie.
    pub(in crate::planning) fn union(mut parts: Vec<[f64; 2]>, period: f64) -> Self {
        for part in &mut parts {
            let width = (part[1] - part[0]).min(period);
            part[0] = wrap(part[0], period);
            part[1] = part[0] + width;
        }
        parts.sort_unstable_by(|s, t| s[0].total_cmp(&t[0]));
        let mut intervals: Vec<[f64; 2]> = Vec::new();
        for part in parts {
            match intervals.last_mut() {
                Some(last) if part[0] <= last[1] + TOUCH => last[1] = last[1].max(part[1]),
                _ => intervals.push(part),
            }
        }
        // The last may run past the seam, into the first.
        if let Some(mut last) = intervals.pop() {
            let past = |first: &[f64; 2], last: [f64; 2]| first[0] + period <= last[1] + TOUCH;
            let mut swallowed = 0;
            while intervals.get(swallowed).is_some_and(|first| past(first, last)) {
                last[1] = last[1].max(intervals[swallowed][1] + period);
                swallowed += 1;
            }
            intervals.drain(..swallowed);
            intervals.push(if last[1] - last[0] >= period - TOUCH { [0.0, period] } else { last });
        }
        Self { intervals, period }
    }

    /// Whether no b is left.
    pub fn is_empty(&self) -> bool {
        self.intervals.is_empty()
    }

    /// The b that all sets have in common; they must be of one period. No sets have nothing in common.
    pub fn overlap(sets: &[Self]) -> Self {
        let Some((first, others)) = sets.split_first() else {
            return Self { intervals: Vec::new(), period: 0.0 };
        };
        let period = first.period;
        others.iter().fold(first.clone(), |common, set| {
            let mut parts = Vec::new();
            for s in &common.intervals {
                for t in &set.intervals {
                    // Both begin in [0, period) and end before 2 period.
                    for turn in [-period, 0.0, period] {
                        let part = [s[0].max(t[0] + turn), s[1].min(t[1] + turn)];
                        if part[0] <= part[1] {
                            parts.push(part);
                        }
                    }
                }
            }
            Self::union(parts, period)
        })
    }

    /// Whether a b lies in the set, whole turns and [`SLACK`] aside.
    pub fn contains(&self, b: f64) -> bool {
        self.intervals.iter().any(|[low, high]| {
            let past = wrap(b - low, self.period);
            past <= high - low + SLACK || past >= self.period - SLACK
        })
    }

    /// The same set with each interval lifted by whole periods to where it is nearest to b.
    #[must_use]
    pub fn near(&self, b: f64) -> Self {
        let lift = |[low, high]: [f64; 2]| {
            let turns = self.period * ((b - 0.5 * (low + high)) / self.period).round();
            [low + turns, high + turns]
        };
        Self { intervals: self.intervals.iter().map(|i| lift(*i)).collect(), period: self.period }
    }

    /// b moved towards the middle of the interval of the set that it lies in or beside, by a share of the way: what a
    /// pose at an end of an interval needs where rounding takes it away.
    pub fn inwards(&self, b: f64, share: f64) -> f64 {
        let middles = self.near(b).intervals.into_iter().map(|[low, high]| (0.5 * (low + high), 0.5 * (high - low)));
        let nearest = middles.min_by(|x, y| ((x.0 - b).abs() - x.1).total_cmp(&((y.0 - b).abs() - y.1)));
        nearest.map_or(b, |(middle, _)| b + share * (middle - b))
    }

    /// The b of the set, lifted by whole turns, that is nearest on the real line; `b` itself if it lies in the set.
    pub fn nearest(&self, b: f64) -> Option<f64> {
        let step = |[low, high]: &[f64; 2]| {
            let (past, width) = (wrap(b - low, self.period), high - low);
            let (back, on) = ((past - width).max(0.0), self.period - past);
            if back <= on { -back } else { on }
        };
        self.intervals.iter().map(step).min_by(|s, t| s.abs().total_cmp(&t.abs())).map(|step| b + step)
    }
}

/// b give or take whole turns, in [0, period).
pub(super) fn wrap(b: f64, period: f64) -> f64 {
    let wrapped = b.rem_euclid(period);
    // −1e-20 comes out as the period itself.
    if wrapped < period { wrapped } else { 0.0 }
}
