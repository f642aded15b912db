//! Timings s(t): a time law over a duration, phases of constant jerk, s proportional to time, or a sequence of these.

use crate::timing::law::{PathProgress, TimeLaw};

/// Timing of a motion on its path: s(t) from 0 to 1 with its derivatives, at rest before 0 and after T.
///
/// Rest before the start and after the end is part of every profile. The rate jumps there only for [`even`](Self::even)
/// and [`running`](Self::running) profiles.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    duration: f64,
    shape: Shape,
}

/// Tolerance of both ends of a running profile, as a fraction of T.
const END_SLACK_SHARE: f64 = 1e-9;

/// Integration steps need not end at jumps of s̈ up to this fraction of its peak.
const NEGLIGIBLE_JUMP: f64 = 1e-3;

#[derive(Clone, Debug, PartialEq)]
enum Shape {
    Law(TimeLaw),
    Running,
    Phases(Phases),
    Sequence(Vec<Leg>),
}

/// A profile in a sequence.
#[derive(Clone, Debug, PartialEq)]
struct Leg {
    /// Time at which it begins, s.
    start: f64,
    /// s at its start.
    from: f64,
    /// Increase of s over it.
    run: f64,
    profile: Profile,
}

/// A time span of constant s⃛.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JerkPhase {
    /// Duration, s.
    pub time: f64,
    /// s̈ at its start, 1/s².
    pub acceleration: f64,
    /// s⃛, 1/s³.
    pub jerk: f64,
}

/// The start of a span.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Start {
    t: f64,
    at: PathProgress,
}

#[derive(Clone, Debug, PartialEq)]
struct Phases {
    starts: Vec<Start>,
    /// Lookup table: T has as many equal parts as there are phases; entry i is the phase in which part i begins.
    guide: Vec<u32>,
    /// Parts of T per second.
    pace: f64,
}

impl Phases {
    fn new(starts: Vec<Start>, duration: f64) -> Self {
        let n = starts.len();
        let mut guide = Vec::with_capacity(n);
        let mut at = 0;
        for i in 0..n {
            let begin = i as f64 / n as f64 * duration;
            while at + 1 < n && starts[at + 1].t <= begin {
                at += 1;
            }
            guide.push(at as u32);
        }
        Self { starts, guide, pace: n as f64 / duration }
    }

    #[inline]
    fn at(&self, t: f64) -> PathProgress {
        let last = self.guide.len() - 1;
        let mut i = self.guide[((t * self.pace) as usize).min(last)] as usize;
        // A part of the lookup table may begin late by a rounding error.
        while i > 0 && self.starts[i].t > t {
            i -= 1;
        }
        while i < last && self.starts[i + 1].t <= t {
            i += 1;
        }
        let Start { t: begin, at } = self.starts[i];
        after(&at, t - begin)
    }
}

/// Returns the progress after a time t, s, at constant jerk.
#[inline]
pub(super) fn after(from: &PathProgress, t: f64) -> PathProgress {
    let PathProgress { s, rate, acceleration, jerk } = *from;
    PathProgress {
        s: (s + t * (rate + t * (acceleration / 2.0 + t * (jerk / 6.0)))).min(1.0),
        rate: rate + t * (acceleration + t * (jerk / 2.0)),
        acceleration: acceleration + t * jerk,
        jerk,
    }
}

impl Profile {
    /// Returns the profile of a law over a duration T, s.
    pub fn of(law: TimeLaw, duration: f64) -> Self {
        Self { duration, shape: Shape::Law(law) }
    }

    /// Returns s = t/T, for paths that contain their own timing and are at rest at both ends.
    pub fn even(duration: f64) -> Self {
        Self::from_starts(vec![(0.0, PathProgress { rate: 1.0 / duration, ..PathProgress::at_rest(0.0) })], duration)
    }

    /// Returns s = t/T with ṡ = 1/T even at t = 0 and T, for paths with their own timing that need not rest at their
    /// ends. After T the motion is at rest.
    pub fn running(duration: f64) -> Self {
        Self { duration, shape: Shape::Running }
    }

    /// Concatenates profiles, each with its share of s; shares are divided by their sum.
    pub fn sequence(legs: Vec<(Self, f64)>) -> Self {
        let total: f64 = legs.iter().map(|(_, share)| share).sum();
        let (mut start, mut from) = (0.0, 0.0);
        let leg = |(profile, share): (Self, f64)| {
            let leg = Leg { start, from, run: share / total, profile };
            start += leg.profile.duration;
            from += leg.run;
            leg
        };
        let legs: Vec<Leg> = legs.into_iter().map(leg).collect();
        Self { duration: start, shape: Shape::Sequence(legs) }
    }

    /// Returns the profile of zero duration, for a path of no length.
    pub fn none() -> Self {
        Self { duration: 0.0, shape: Shape::Law(TimeLaw::Quintic) }
    }

    /// Builds a profile from rest through spans of constant jerk. Spans of zero duration are omitted.
    ///
    /// The caller must make sure that s ends at 1 at rest.
    pub fn of_spans(spans: &[JerkPhase]) -> Self {
        let (mut t, mut s, mut rate) = (0.0, 0.0, 0.0);
        let mut starts = Vec::with_capacity(spans.len());
        for span in spans.iter().filter(|span| span.time > 0.0) {
            let from = PathProgress { s, rate, acceleration: span.acceleration, jerk: span.jerk };
            starts.push((t, from));
            let end = after(&from, span.time);
            (t, s, rate) = (t + span.time, end.s, end.rate);
        }
        Self::from_starts(starts, t)
    }

    /// Builds a profile through stations s that rise from 0 to 1 with given x = ṡ², 1/s². Between stations s̈ is linear
    /// in time and changes by `rise`, 1/s²; where `rise` is missing, s̈ is constant. Returns `None` if two neighbours
    /// are both at rest (infinite time), `stations` and `x` differ in length, or there are fewer than two stations.
    pub fn through(stations: &[f64], x: &[f64], rise: &[f64]) -> Option<Self> {
        let spaces = stations.len().checked_sub(1).filter(|n| *n > 0 && x.len() == stations.len())?;
        let mut starts = Vec::with_capacity(spaces);
        let mut t = 0.0;
        let mut rate = x[0].sqrt();
        for i in 0..spaces {
            let (way, next) = (stations[i + 1] - stations[i], x[i + 1].sqrt());
            let rise = rise.get(i).copied().unwrap_or(0.0);
            // The distance is mean · time − rise · time² / 12.
            let mean = 0.5 * (rate + next);
            let time = 2.0 * way / (mean + (mean * mean - rise * way / 3.0).sqrt());
            let from = PathProgress {
                s: stations[i],
                rate,
                acceleration: if rise == 0.0 {
                    (x[i + 1] - x[i]) / (2.0 * way)
                } else {
                    (next - rate) / time - 0.5 * rise
                },
                jerk: rise / time,
            };
            starts.push((t, from));
            t += time;
            rate = next;
        }
        t.is_finite().then(|| Self::from_starts(starts, t))
    }

    fn from_starts(starts: Vec<(f64, PathProgress)>, duration: f64) -> Self {
        if starts.is_empty() {
            return Self::none();
        }
        let starts = starts.into_iter().map(|(t, at)| Start { t, at }).collect();
        Self { duration, shape: Shape::Phases(Phases::new(starts, duration)) }
    }

    /// Returns the duration T, s.
    #[inline]
    pub fn duration(&self) -> f64 {
        self.duration
    }

    /// Returns the time law, if the profile is one.
    pub fn law(&self) -> Option<TimeLaw> {
        match self.shape {
            Shape::Law(law) => Some(law),
            Shape::Running | Shape::Phases(_) | Shape::Sequence(_) => None,
        }
    }

    /// Returns the progress t seconds after the start.
    #[inline]
    pub fn at(&self, t: f64) -> PathProgress {
        match &self.shape {
            Shape::Law(law) => law.at(t, self.duration),
            // The sum of integration steps may miss either end by rounding.
            Shape::Running if t < -END_SLACK_SHARE * self.duration => PathProgress::at_rest(0.0),
            Shape::Running if t > (1.0 + END_SLACK_SHARE) * self.duration => PathProgress::at_rest(1.0),
            Shape::Running => {
                let s = (t / self.duration).clamp(0.0, 1.0);
                PathProgress { rate: 1.0 / self.duration, ..PathProgress::at_rest(s) }
            }
            Shape::Phases(_) if t < 0.0 => PathProgress::at_rest(0.0),
            Shape::Phases(_) if t >= self.duration => PathProgress::at_rest(1.0),
            Shape::Phases(phases) => phases.at(t),
            Shape::Sequence(_) if t >= self.duration => PathProgress::at_rest(1.0),
            Shape::Sequence(legs) => {
                let i = legs.partition_point(|leg| leg.start <= t).max(1) - 1;
                legs.get(i).map_or(PathProgress::at_rest(0.0), |leg| {
                    let at = leg.profile.at(t - leg.start);
                    PathProgress {
                        s: leg.from + leg.run * at.s,
                        rate: leg.run * at.rate,
                        acceleration: leg.run * at.acceleration,
                        jerk: leg.run * at.jerk,
                    }
                })
            }
        }
    }

    /// Returns the timing stretched by a factor on time. Rates are inversely proportional to the factor, accelerations
    /// to its square, jerks to its cube.
    #[must_use]
    pub fn stretched(&self, factor: f64) -> Self {
        let duration = factor * self.duration;
        match &self.shape {
            Shape::Law(law) => Self::of(*law, duration),
            Shape::Running => Self::running(duration),
            Shape::Phases(phases) => {
                let f = 1.0 / factor;
                let slower = |at: &PathProgress| PathProgress {
                    s: at.s,
                    rate: f * at.rate,
                    acceleration: f * f * at.acceleration,
                    jerk: f * f * f * at.jerk,
                };
                Self::from_starts(phases.starts.iter().map(|p| (factor * p.t, slower(&p.at))).collect(), duration)
            }
            Shape::Sequence(legs) => {
                Self::sequence(legs.iter().map(|leg| (leg.profile.stretched(factor), leg.run)).collect())
            }
        }
    }

    /// Returns the ascending times, s, at which s̈ or its slope jumps, including both ends: a simulation step must end
    /// there. Small jumps, such as between the stations of a timing along a curve, are omitted.
    pub fn kinks(&self) -> Vec<f64> {
        let whole = self.duration;
        match &self.shape {
            Shape::Law(law) => law.kinks().iter().map(|u| u * whole).collect(),
            Shape::Running => vec![-END_SLACK_SHARE * whole, (1.0 + END_SLACK_SHARE) * whole],
            Shape::Phases(Phases { starts, .. }) => {
                let max_of = |f: fn(&PathProgress) -> f64| starts.iter().map(|p| f(&p.at).abs()).fold(0.0, f64::max);
                let end = |i: usize| after(&starts[i].at, starts.get(i + 1).map_or(whole, |p| p.t) - starts[i].t);
                let peak =
                    (0..starts.len()).map(|i| end(i).acceleration.abs()).fold(max_of(|p| p.acceleration), f64::max);
                let top = max_of(|p| p.rate);
                let bends = |i: &usize| {
                    let (was, is) = (end(i - 1), starts[*i].at);
                    (is.rate - was.rate).abs() > 1e-9 * top
                        || (is.acceleration - was.acceleration).abs() > NEGLIGIBLE_JUMP * peak
                        || (is.jerk - was.jerk).abs() * whole > peak
                };
                let inner = (1..starts.len()).filter(bends).map(|i| starts[i].t);
                [0.0].into_iter().chain(inner).chain([whole]).collect()
            }
            Shape::Sequence(legs) => {
                legs.iter().flat_map(|leg| leg.profile.kinks().into_iter().map(|t| leg.start + t)).collect()
            }
        }
    }

    /// Returns the time, s, at which the position s on the path is first reached, by bisection.
    pub fn time_at(&self, s: f64) -> f64 {
        let (mut low, mut high) = (0.0, self.duration);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            *(if self.at(middle).s < s { &mut low } else { &mut high }) = middle;
        }
        high
    }

    /// Returns the phases of constant s⃛, each with its initial progress and its duration, s. A law, a running profile
    /// and a sequence have none.
    pub(super) fn phases(&self) -> impl Iterator<Item = (PathProgress, f64)> + '_ {
        let starts: &[Start] = match &self.shape {
            Shape::Phases(phases) => &phases.starts,
            Shape::Law(_) | Shape::Running | Shape::Sequence(_) => &[],
        };
        let end = |i: usize| starts.get(i + 1).map_or(self.duration, |next| next.t);
        starts.iter().enumerate().map(move |(i, start)| (start.at, end(i) - start.t))
    }

    /// Returns the maximum |s̈|, 1/s²; 0 for a running profile.
    pub fn peak_acceleration(&self) -> f64 {
        match &self.shape {
            Shape::Law(law) => law.peak() / (self.duration * self.duration),
            Shape::Running => 0.0,
            Shape::Phases(_) => {
                let ends = |(from, time): (PathProgress, f64)| {
                    from.acceleration.abs().max((from.acceleration + time * from.jerk).abs())
                };
                self.phases().map(ends).fold(0.0, f64::max)
            }
            Shape::Sequence(legs) => {
                legs.iter().map(|leg| leg.run * leg.profile.peak_acceleration()).fold(0.0, f64::max)
            }
        }
    }

    /// Builds a profile through instants with given s, ṡ and s̈. Between two instants, three phases of equal duration
    /// match the values at both.
    pub(super) fn through_jets(jets: &[(f64, PathProgress)]) -> Self {
        let mut starts = Vec::with_capacity(3 * jets.len());
        for w in jets.windows(2) {
            let ([(t, a), (end, b)], third) = ([w[0], w[1]], (w[1].0 - w[0].0) / 3.0);
            let whole = end - t;
            // Changes of s̈, ṡ and s that the jerks must produce.
            let bend = (b.acceleration - a.acceleration) / third;
            let rate = (b.rate - a.rate - a.acceleration * whole) / (third * third);
            let way = b.s - a.s - whole * (a.rate + 0.5 * whole * a.acceleration);
            let first = way / (third * third * third) - rate + bend / 3.0;
            let second = rate - 0.5 * bend - 2.0 * first;
            let mut from = a;
            for (i, jerk) in [first, second, bend - first - second].into_iter().enumerate() {
                from.jerk = jerk;
                starts.push((t + i as f64 * third, from));
                from = after(&from, third);
            }
        }
        let duration = jets.last().map_or(0.0, |last| last.0);
        Self::from_starts(starts, duration)
    }
}
