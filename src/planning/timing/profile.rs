//! Timings s(t): a law over a time, phases of constant jerk, both from rest to rest, or time itself.

use crate::planning::timing::law::{Progress, TimeLaw};

/// When a motion is where on its path: s(t) from 0 to 1 with its derivatives, still before 0 and from T on.
///
/// Rest before the start and after the end is part of every profile, so its rate may step there only where it is made
/// to ([`even`](Self::even)).
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    duration: f64,
    shape: Shape,
}

/// The last instant of a running profile belongs to it, give or take this share of T.
const END_SLACK_SHARE: f64 = 1e-9;

/// Jumps of s̈ up to this share of its peak are too small for a step to end on.
const SMALL_JUMP: f64 = 1e-3;

#[derive(Clone, Debug, PartialEq)]
enum Shape {
    Law(TimeLaw),
    Running,
    Phases(Phases),
    Sequence(Vec<Leg>),
}

/// A part of a sequence.
#[derive(Clone, Debug, PartialEq)]
struct Leg {
    /// When it begins, s.
    start: f64,
    /// s where it begins, and how far it goes.
    from: f64,
    run: f64,
    profile: Profile,
}

/// Some time at constant s⃛.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// How long, s.
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
    at: Progress,
}

#[derive(Clone, Debug, PartialEq)]
struct Phases {
    starts: Vec<Start>,
    /// For each of as many even parts of T as there are phases, the phase in which it begins.
    guide: Vec<u32>,
    /// Parts of T in a second.
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
    fn at(&self, t: f64) -> Progress {
        let last = self.guide.len() - 1;
        let mut i = self.guide[((t * self.pace) as usize).min(last)] as usize;
        // The guide's part may begin a rounding error late.
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

/// Progress some time later at the same jerk.
#[inline]
pub(super) fn after(from: &Progress, t: f64) -> Progress {
    let Progress { s, rate, acceleration, jerk } = *from;
    Progress {
        s: (s + t * (rate + t * (acceleration / 2.0 + t * (jerk / 6.0)))).min(1.0),
        rate: rate + t * (acceleration + t * (jerk / 2.0)),
        acceleration: acceleration + t * jerk,
        jerk,
    }
}

impl Profile {
    /// A law that takes T, s.
    pub fn of(law: TimeLaw, duration: f64) -> Self {
        Self { duration, shape: Shape::Law(law) }
    }

    /// s = t/T: for paths that hold their timing themselves, and are at rest at both ends.
    pub fn even(duration: f64) -> Self {
        Self::from_starts(vec![(0.0, Progress { rate: 1.0 / duration, ..Progress::still(0.0) })], duration)
    }

    /// s = t/T, both ends included: for paths that hold their timing themselves and need not be at rest where they
    /// begin and end. After T the motion stands.
    pub fn running(duration: f64) -> Self {
        Self { duration, shape: Shape::Running }
    }

    /// Profiles one after another, each with its share of s; shares are put in proportion to their sum.
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

    /// At the end at once, of a path that goes nowhere.
    pub fn none() -> Self {
        Self { duration: 0.0, shape: Shape::Law(TimeLaw::Quintic) }
    }

    /// From rest through spans of constant jerk. Those of no time are left out.
    ///
    /// That s comes to 1 at rest is up to them.
    pub fn of_spans(spans: &[Span]) -> Self {
        let (mut t, mut s, mut rate) = (0.0, 0.0, 0.0);
        let mut starts = Vec::with_capacity(spans.len());
        for span in spans.iter().filter(|span| span.time > 0.0) {
            let from = Progress { s, rate, acceleration: span.acceleration, jerk: span.jerk };
            starts.push((t, from));
            let end = after(&from, span.time);
            (t, s, rate) = (t + span.time, end.s, end.rate);
        }
        Self::from_starts(starts, t)
    }

    /// Through stations s that rise from 0 to 1 with given squares of the rate x = ṡ², 1/s², and between them with s̈
    /// of constant slope in time that rises by as much as is given for each space, 1/s²; none given: constant s̈.
    /// `None` if two neighbours are both at rest, which no time would join, or the lengths differ.
    pub fn through(stations: &[f64], x: &[f64], rise: &[f64]) -> Option<Self> {
        let spaces = stations.len().checked_sub(1).filter(|n| *n > 0 && x.len() == stations.len())?;
        let mut starts = Vec::with_capacity(spaces);
        let mut t = 0.0;
        let mut rate = x[0].sqrt();
        for i in 0..spaces {
            let (way, next) = (stations[i + 1] - stations[i], x[i + 1].sqrt());
            let rise = rise.get(i).copied().unwrap_or(0.0);
            // The way is mean · time − rise · time² / 12.
            let mean = 0.5 * (rate + next);
            let time = 2.0 * way / (mean + (mean * mean - rise * way / 3.0).sqrt());
            let from = Progress {
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

    fn from_starts(starts: Vec<(f64, Progress)>, duration: f64) -> Self {
        if starts.is_empty() {
            return Self::none();
        }
        let starts = starts.into_iter().map(|(t, at)| Start { t, at }).collect();
        Self { duration, shape: Shape::Phases(Phases::new(starts, duration)) }
    }

    /// T, s.
    #[inline]
    pub fn duration(&self) -> f64 {
        self.duration
    }

    /// The law, if it is one.
    pub fn law(&self) -> Option<TimeLaw> {
        match self.shape {
            Shape::Law(law) => Some(law),
            Shape::Running | Shape::Phases(_) | Shape::Sequence(_) => None,
        }
    }

    /// Progress t seconds after the start.
    #[inline]
    pub fn at(&self, t: f64) -> Progress {
        match &self.shape {
            Shape::Law(law) => law.at(t, self.duration),
            // Steps may add up to a hair beside either end.
            Shape::Running if t < -END_SLACK_SHARE * self.duration => Progress::still(0.0),
            Shape::Running if t > (1.0 + END_SLACK_SHARE) * self.duration => Progress::still(1.0),
            Shape::Running => {
                let s = (t / self.duration).clamp(0.0, 1.0);
                Progress { rate: 1.0 / self.duration, ..Progress::still(s) }
            }
            Shape::Phases(_) if t < 0.0 => Progress::still(0.0),
            Shape::Phases(_) if t >= self.duration => Progress::still(1.0),
            Shape::Phases(phases) => phases.at(t),
            Shape::Sequence(_) if t >= self.duration => Progress::still(1.0),
            Shape::Sequence(legs) => {
                let i = legs.partition_point(|leg| leg.start <= t).max(1) - 1;
                legs.get(i).map_or(Progress::still(0.0), |leg| {
                    let at = leg.profile.at(t - leg.start);
                    Progress {
                        s: leg.from + leg.run * at.s,
                        rate: leg.run * at.rate,
                        acceleration: leg.run * at.acceleration,
                        jerk: leg.run * at.jerk,
                    }
                })
            }
        }
    }

    /// The same timing over another time: rates fall with its first, accelerations with its second, jerks with its
    /// third power.
    #[must_use]
    pub fn stretched(&self, factor: f64) -> Self {
        let duration = factor * self.duration;
        match &self.shape {
            Shape::Law(law) => Self::of(*law, duration),
            Shape::Running => Self::running(duration),
            Shape::Phases(phases) => {
                let f = 1.0 / factor;
                let slower = |at: &Progress| Progress {
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

    /// Times at which s̈ jumps or bends, both ends among them, s, in order: where a step of a simulation must end.
    /// Small jumps, as between the stations of a timing that follows a curve, are left out.
    pub fn kinks(&self) -> Vec<f64> {
        let whole = self.duration;
        match &self.shape {
            Shape::Law(law) => law.kinks().iter().map(|u| u * whole).collect(),
            Shape::Running => vec![-END_SLACK_SHARE * whole, (1.0 + END_SLACK_SHARE) * whole],
            Shape::Phases(Phases { starts, .. }) => {
                let most = |f: fn(&Progress) -> f64| starts.iter().map(|p| f(&p.at).abs()).fold(0.0, f64::max);
                let end = |i: usize| after(&starts[i].at, starts.get(i + 1).map_or(whole, |p| p.t) - starts[i].t);
                let peak =
                    (0..starts.len()).map(|i| end(i).acceleration.abs()).fold(most(|p| p.acceleration), f64::max);
                let top = most(|p| p.rate);
                let bends = |i: &usize| {
                    let (was, is) = (end(i - 1), starts[*i].at);
                    (is.rate - was.rate).abs() > 1e-9 * top
                        || (is.acceleration - was.acceleration).abs() > SMALL_JUMP * peak
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

    /// When s is first reached, s.
    pub fn when(&self, s: f64) -> f64 {
        let (mut low, mut high) = (0.0, self.duration);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            *(if self.at(middle).s < s { &mut low } else { &mut high }) = middle;
        }
        high
    }

    /// The phases of constant s⃛, each by how it begins and how long it takes; none of a law, a running profile or a
    /// sequence.
    pub(super) fn phases(&self) -> impl Iterator<Item = (Progress, f64)> + '_ {
        let starts: &[Start] = match &self.shape {
            Shape::Phases(phases) => &phases.starts,
            Shape::Law(_) | Shape::Running | Shape::Sequence(_) => &[],
        };
        let end = |i: usize| starts.get(i + 1).map_or(self.duration, |next| next.t);
        starts.iter().enumerate().map(move |(i, start)| (start.at, end(i) - start.t))
    }

    /// The greatest |s̈|, 1/s²; of a law its own, of a running profile none, of a sequence that of its parts.
    pub fn peak_acceleration(&self) -> f64 {
        match &self.shape {
            Shape::Law(law) => law.peak() / (self.duration * self.duration),
            Shape::Running => 0.0,
            Shape::Phases(_) => {
                let ends = |(from, time): (Progress, f64)| {
                    from.acceleration.abs().max((from.acceleration + time * from.jerk).abs())
                };
                self.phases().map(ends).fold(0.0, f64::max)
            }
            Shape::Sequence(legs) => {
                legs.iter().map(|leg| leg.run * leg.profile.peak_acceleration()).fold(0.0, f64::max)
            }
        }
    }

    /// Through instants with s, ṡ and s̈ given there: between two of them three phases of equal time, which meet both.
    pub(super) fn through_jets(jets: &[(f64, Progress)]) -> Self {
        let mut starts = Vec::with_capacity(3 * jets.len());
        for w in jets.windows(2) {
            let ([(t, a), (end, b)], third) = ([w[0], w[1]], (w[1].0 - w[0].0) / 3.0);
            let whole = end - t;
            // s̈, ṡ and s that the jerks must add.
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
