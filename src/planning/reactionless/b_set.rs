//! [`BSet`]: pose constants as intervals within a period.

use super::plane::LIMIT_SLACK;

/// Intervals separated by less than this are merged, rad.
const MERGE_TOLERANCE_RAD: f64 = 1e-11;

/// A set of pose constants: disjoint closed intervals on the circle of b.
#[derive(Clone, Debug, PartialEq)]
pub struct BSet {
    /// [b_min, b_max] ascending, rad: b_min in [0, period), b_max ≥ b_min, possibly beyond the period. The set of all b
    /// is [0, period].
    pub intervals: Vec<[f64; 2]>,
    /// Circumference of the circle, 2π Σλ, rad.
    pub period: f64,
}

impl BSet {
    /// Returns the union, modulo the period, of intervals [low, high] anywhere on the real line, rad.
    pub(crate) fn union(mut parts: Vec<[f64; 2]>, period: f64) -> Self {
        for part in &mut parts {
            let width = (part[1] - part[0]).min(period);
            part[0] = wrap(part[0], period);
            part[1] = part[0] + width;
        }
        parts.sort_unstable_by(|s, t| s[0].total_cmp(&t[0]));
        let mut intervals: Vec<[f64; 2]> = Vec::new();
        for part in parts {
            match intervals.last_mut() {
                Some(last) if part[0] <= last[1] + MERGE_TOLERANCE_RAD => last[1] = last[1].max(part[1]),
                _ => intervals.push(part),
            }
        }
        // The last interval may extend beyond the period, into the first.
        if let Some(mut last) = intervals.pop() {
            let past = |first: &[f64; 2], last: [f64; 2]| first[0] + period <= last[1] + MERGE_TOLERANCE_RAD;
            let mut swallowed = 0;
            while intervals.get(swallowed).is_some_and(|first| past(first, last)) {
                last[1] = last[1].max(intervals[swallowed][1] + period);
                swallowed += 1;
            }
            intervals.drain(..swallowed);
            intervals.push(if last[1] - last[0] >= period - MERGE_TOLERANCE_RAD { [0.0, period] } else { last });
        }
        Self { intervals, period }
    }

    /// Whether the set contains no b.
    pub fn is_empty(&self) -> bool {
        self.intervals.is_empty()
    }

    /// Returns the intersection of sets of one period; of no sets, the empty set.
    pub fn overlap(sets: &[Self]) -> Self {
        let Some((first, others)) = sets.split_first() else {
            return Self { intervals: Vec::new(), period: 0.0 };
        };
        let period = first.period;
        others.iter().fold(first.clone(), |common, set| {
            let mut parts = Vec::new();
            for s in &common.intervals {
                for t in &set.intervals {
                    // Both begin in [0, period) and end before 2 periods.
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

    /// Whether the set contains b, modulo the period and within [`LIMIT_SLACK`].
    pub fn contains(&self, b: f64) -> bool {
        self.intervals.iter().any(|[low, high]| {
            let past = wrap(b - low, self.period);
            past <= high - low + LIMIT_SLACK || past >= self.period - LIMIT_SLACK
        })
    }

    /// Returns the set with each interval shifted by whole periods to where it is nearest to b.
    #[must_use]
    pub fn shifted_near(&self, b: f64) -> Self {
        let lift = |[low, high]: [f64; 2]| {
            let turns = self.period * ((b - 0.5 * (low + high)) / self.period).round();
            [low + turns, high + turns]
        };
        Self { intervals: self.intervals.iter().map(|i| lift(*i)).collect(), period: self.period }
    }

    /// Moves b towards the middle of the interval that contains it or is nearest, by a fraction of the distance. At the
    /// bounds of an interval, rounding may make poses infeasible.
    pub fn moved_inside(&self, b: f64, share: f64) -> f64 {
        let middles =
            self.shifted_near(b).intervals.into_iter().map(|[low, high]| (0.5 * (low + high), 0.5 * (high - low)));
        let nearest = middles.min_by(|x, y| ((x.0 - b).abs() - x.1).total_cmp(&((y.0 - b).abs() - y.1)));
        nearest.map_or(b, |(middle, _)| b + share * (middle - b))
    }

    /// Returns the value of the set, shifted by whole periods, that is nearest to b on the real line. This is b itself
    /// if the set contains it; `None` if the set is empty.
    pub fn nearest(&self, b: f64) -> Option<f64> {
        let step = |[low, high]: &[f64; 2]| {
            let (past, width) = (wrap(b - low, self.period), high - low);
            let (back, on) = ((past - width).max(0.0), self.period - past);
            if back <= on { -back } else { on }
        };
        self.intervals.iter().map(step).min_by(|s, t| s.abs().total_cmp(&t.abs())).map(|step| b + step)
    }
}

/// Returns b modulo the period, in [0, period).
pub(super) fn wrap(b: f64, period: f64) -> f64 {
    let wrapped = b.rem_euclid(period);
    // rem_euclid returns the period itself for −1e-20.
    if wrapped < period { wrapped } else { 0.0 }
}
