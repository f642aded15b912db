//! Time-optimal path parameterisation: the maximum rate that limits allow everywhere on a path.
//!
//! With x = ṡ² and u = s̈ the motion is x′ = 2 u, and every limit is linear in (u, x). Over an interval Δ of the grid u
//! has a mean u_i, so x_{i+1} = x_i + 2 Δ u_i exactly. Limits hold at both ends of the interval. Backwards from rest
//! at the end, the *controllable* x at each station, from which the end can be reached, form an interval. Forwards from
//! rest, the maximum u that stays within these gives the fastest motion (reachability analysis, Pham & Pham 2018).
//!
//! A first pass takes u as constant over an interval. A limit is then met at one end only, and T is accurate to first
//! order in Δ. A second pass lets u change over the interval by as much as it does in the first pass. The limit is then
//! met at both ends, and T is accurate to second order.

use crate::timing::law::PathProgress;
use crate::timing::limits::{ConstraintRow, LimitsOnPath, Stretches, stretches};

/// An x of this or more is treated as unlimited, 1/s².
pub(super) const UNLIMITED: f64 = 1e20;

/// Maximum change of a limited quantity over an interval due to the path, as a fraction of its limit; above it the
/// interval is divided.
const MAX_CHANGE_SHARE: f64 = 0.04;
/// Maximum number of parts into which an interval is divided at once.
const MAX_PARTS: usize = 8;
/// Maximum number of refinements.
const MAX_REFINEMENTS: usize = 8;
/// Intervals of this length of s or less are not divided.
const MIN_INTERVAL: f64 = 1e-9;
/// Maximum number of intervals.
const MAX_INTERVALS: usize = 60_000;

/// Number of parts into which an interval with an exceeded limit is divided.
const PARTS_IF_EXCEEDED: usize = 4;
/// An interval is divided if the factor on the duration that it needs exceeds 1 by more than this.
pub(super) const REPAIR_THRESHOLD: f64 = 1e-4;

/// The constraints of a path at all stations, at least two.
pub(super) struct PathConstraints {
    pub(super) s: Vec<f64>,
    /// Number of rows per station.
    pub(super) m: usize,
    pub(super) rows: Vec<ConstraintRow>,
    /// Number of speeds per station.
    per: usize,
    /// Speeds of all stations at ṡ = 1, divided by their limits.
    speeds: Vec<f64>,
    /// Maximum x that speeds allow, 1/s².
    pub(super) cap: Vec<f64>,
    /// 1/√cap, s.
    slow: Vec<f64>,
}

/// Station at which the sweeps fail.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum NoTiming {
    /// No x is controllable at this station.
    At(usize),
    /// The start is not controllable at rest, or the motion stops at this station.
    Rest(usize),
}

impl PathConstraints {
    pub(super) fn new(limits: &impl LimitsOnPath, s: Vec<f64>) -> Self {
        let mut grid = Self::with_capacity(limits.counts(), s.len());
        s.iter().for_each(|s| grid.push(limits, *s));
        Self { s, ..grid }
    }

    /// Returns an empty grid with capacity for `stations` of m rows and `per` speeds each.
    fn with_capacity([m, per]: [usize; 2], stations: usize) -> Self {
        let empty = Vec::with_capacity;
        let rows = Vec::with_capacity(m * stations);
        Self {
            s: empty(stations),
            m,
            rows,
            per,
            speeds: empty(per * stations),
            cap: empty(stations),
            slow: empty(stations),
        }
    }

    /// Appends the rows of one more station, without adding it to `s`.
    fn push(&mut self, limits: &impl LimitsOnPath, s: f64) {
        let (row, speed) = (self.rows.len(), self.speeds.len());
        self.rows.resize(row + self.m, ConstraintRow::default());
        self.speeds.resize(speed + self.per, 0.0);
        let cap = limits.at(s, &mut self.rows[row..], &mut self.speeds[speed..]).min(10.0 * UNLIMITED);
        self.cap.push(cap);
        self.slow.push(cap.sqrt().recip());
    }

    /// Returns the grid with each interval divided into a given number of equal parts.
    fn divided(&self, limits: &impl LimitsOnPath, parts: &[usize]) -> Self {
        let total = 1 + parts.iter().sum::<usize>();
        let mut fine = Self::with_capacity([self.m, self.per], total);
        for i in 0..self.s.len() {
            fine.s.push(self.s[i]);
            fine.rows.extend_from_slice(self.rows_at(i));
            fine.speeds.extend_from_slice(self.speeds_at(i));
            fine.cap.push(self.cap[i]);
            fine.slow.push(self.slow[i]);
            let count = parts.get(i).copied().unwrap_or(1);
            for k in 1..count {
                let s = self.s[i] + (self.s[i + 1] - self.s[i]) * k as f64 / count as f64;
                fine.push(limits, s);
                fine.s.push(s);
            }
        }
        fine
    }

    /// Finds the fastest motion on a grid that is refined wherever a limited quantity changes much within an interval.
    pub(super) fn fastest_refined(mut self, limits: &impl LimitsOnPath) -> (Self, Result<TimingSweep, NoTiming>) {
        let mut level = self.level();
        for _ in 0..MAX_REFINEMENTS {
            let Ok(x) = &level else { break };
            let (parts, most) = self.parts(x);
            if most == 1 || parts.iter().sum::<usize>() > MAX_INTERVALS {
                break;
            }
            self = self.divided(limits, &parts);
            level = self.level();
        }
        let found = level.map(|x| self.risen(x));
        (self, found)
    }

    /// Finds the fastest motion on a grid that is refined where a profile exceeds a limit between two stations. `past`
    /// is the factor on time that each interval needs.
    pub(super) fn mended(self, limits: &impl LimitsOnPath, past: &[f64]) -> (Self, Result<TimingSweep, NoTiming>) {
        let parts: Vec<usize> = (0..past.len())
            .map(|i| {
                let wide = self.s[i + 1] - self.s[i] > MIN_INTERVAL;
                if past[i] > 1.0 + REPAIR_THRESHOLD && wide { PARTS_IF_EXCEEDED } else { 1 }
            })
            .collect();
        let grid = self.divided(limits, &parts);
        let found = grid.fastest();
        (grid, found)
    }

    /// Returns the number of parts into which each interval is to be divided, and the maximum of these.
    fn parts(&self, x: &[f64]) -> (Vec<usize>, usize) {
        let of = |i: usize| {
            let way = self.s[i + 1] - self.s[i];
            let u = (x[i + 1] - x[i]) / (2.0 * way);
            let (here, there) = (self.rows_at(i), self.rows_at(i + 1));
            // Change of a quantity over the interval, as a fraction of its limit, without the change due to x.
            let high = x[i].max(x[i + 1]);
            let change = |(a, b): (&ConstraintRow, &ConstraintRow)| {
                ((b.a - a.a) * u).abs() + ((b.c - a.c) * high).abs() + (b.g - a.g).abs()
            };
            let rows = here.iter().zip(there).map(change).fold(0.0, f64::max);
            let speed = (high / self.cap[i]).sqrt() - (high / self.cap[i + 1]).sqrt();
            let parts = (rows.max(speed.abs()) / MAX_CHANGE_SHARE).ceil();
            if way > MIN_INTERVAL { (parts as usize).clamp(1, MAX_PARTS) } else { 1 }
        };
        let parts: Vec<usize> = (0..x.len() - 1).map(of).collect();
        let most = parts.iter().copied().max().unwrap_or(1);
        (parts, most)
    }

    pub(super) fn rows_at(&self, i: usize) -> &[ConstraintRow] {
        &self.rows[i * self.m..(i + 1) * self.m]
    }

    fn speeds_at(&self, i: usize) -> &[f64] {
        &self.speeds[i * self.per..(i + 1) * self.per]
    }

    /// Returns the factors on the duration with which each limit, except those on jerk, is just met at a station.
    /// `at` is the progress there.
    pub(super) fn stretches(&self, i: usize, at: &PathProgress) -> Stretches {
        stretches(self.rows_at(i), self.speeds_at(i), at)
    }

    /// Finds the fastest motion from rest to rest.
    pub(super) fn fastest(&self) -> Result<TimingSweep, NoTiming> {
        Ok(self.risen(self.level()?))
    }

    /// First pass: returns x at every station with u constant over each interval.
    fn level(&self) -> Result<Vec<f64>, NoTiming> {
        self.sweep(&vec![0.0; self.s.len().saturating_sub(1)])
    }

    /// Second pass: returns x and the rises of u, from the x of the first pass.
    fn risen(&self, level: Vec<f64>) -> TimingSweep {
        let rise = self.rises(&level);
        match self.sweep(&rise) {
            Ok(x) => {
                // Limit the rises to those with which the new x stays positive.
                let rise = (0..rise.len()).map(|i| self.clamped(&x, i, rise[i])).collect();
                TimingSweep { x, rise }
            }
            Err(_) => TimingSweep { rise: vec![0.0; rise.len()], x: level },
        }
    }

    /// Sweeps the grid backwards and forwards; returns x at every station of the fastest motion with given rises of u.
    fn sweep(&self, rise: &[f64]) -> Result<Vec<f64>, NoTiming> {
        let n = self.s.len();
        let mut x = vec![0.0; n];
        let mut reach = vec![[0.0; 2]; n];
        let mut space = Space::of(self.m);
        for i in (0..rise.len()).rev() {
            space.set(self, i, rise[i], reach[i + 1]);
            let least = space.least().ok_or(NoTiming::At(i))?;
            let greatest = space.greatest().filter(|x| *x >= least).ok_or(NoTiming::At(i))?;
            reach[i] = [least, greatest];
        }
        if reach[0][0] > 0.0 {
            return Err(NoTiming::Rest(0));
        }
        for i in 0..rise.len() {
            space.set(self, i, rise[i], reach[i + 1]);
            let u = space.fastest_at(x[i]);
            let [least, most] = reach[i + 1];
            x[i + 1] = (x[i] + 2.0 * (self.s[i + 1] - self.s[i]) * u).clamp(least, most);
            if x[i] == 0.0 && x[i + 1] == 0.0 {
                return Err(NoTiming::Rest(i));
            }
        }
        Ok(x)
    }

    /// Estimates the rise of u over each interval from its neighbours. It is given by the smaller of both slopes, or
    /// zero if their signs differ, as where u switches.
    fn rises(&self, x: &[f64]) -> Vec<f64> {
        let spaces = x.len() - 1;
        let u = |i: usize| (x[i + 1] - x[i]) / (2.0 * (self.s[i + 1] - self.s[i]));
        let slope = |i: usize| 2.0 * (u(i) - u(i - 1)) / (self.s[i + 1] - self.s[i - 1]);
        let rise = |i: usize| {
            if i == 0 || i + 1 == spaces {
                return 0.0;
            }
            let (before, after) = (slope(i), slope(i + 1));
            let lesser = if before.abs() < after.abs() { before } else { after };
            let both = if before * after > 0.0 { lesser * (self.s[i + 1] - self.s[i]) } else { 0.0 };
            self.clamped(x, i, both)
        };
        (0..spaces).map(rise).collect()
    }

    /// Clamps a rise of u over an interval so that x stays above 0 there.
    fn clamped(&self, x: &[f64], i: usize, rise: f64) -> f64 {
        let bound = 0.5 * x[i].min(x[i + 1]) / (self.s[i + 1] - self.s[i]);
        rise.clamp(-bound, bound)
    }
}

/// x at every station, and the rise of u over every interval.
pub(super) struct TimingSweep {
    pub(super) x: Vec<f64>,
    pub(super) rise: Vec<f64>,
}

/// A constraint low + slope x ≤ u ≤ high + slope x.
#[derive(Clone, Copy, Default)]
struct Strip {
    low: f64,
    high: f64,
    slope: f64,
}

/// Number of strips of one interval beside those of the rows at both ends: the controllable x at its end, the speeds in
/// its middle.
const OTHER_STRIPS: usize = 2;
/// Maximum number of iterations of a search for each strip; each discards at least one pair of lines.
const ITERATIONS_PER_STRIP: usize = 4;
/// A coefficient of u below this fraction of the largest is treated as zero: the row then bounds x alone.
const COEFFICIENT_TOLERANCE: f64 = 1e-13;
/// Relative amount by which bounds may cross by rounding.
const CROSSING_TOLERANCE: f64 = 1e-12;

/// The convex polygon of the pairs (u, x) that keep every row over one interval of the grid.
struct Space {
    strips: Vec<Strip>,
    len: usize,
    x: [f64; 2],
}

impl Space {
    /// Returns an empty polygon for `rows` rows at each end.
    fn of(rows: usize) -> Self {
        Self { strips: vec![Strip::default(); 2 * rows + OTHER_STRIPS], len: 0, x: [0.0; 2] }
    }

    #[inline]
    fn set(&mut self, grid: &PathConstraints, i: usize, rise: f64, arrive: [f64; 2]) {
        let twice = 2.0 * (grid.s[i + 1] - grid.s[i]);
        self.x = [0.0, grid.cap[i]];
        let (here, there) = (grid.rows_at(i), grid.rows_at(i + 1));
        // a u + c (x + 2 Δ u) at the far end.
        let near = here.iter().map(|r| ConstraintRow { g: r.g - 0.5 * rise * r.a, ..*r });
        let far = there.iter().map(|r| ConstraintRow { a: r.a + twice * r.c, c: r.c, g: r.g + 0.5 * rise * r.a });
        let all = || near.clone().chain(far.clone());
        let floor = COEFFICIENT_TOLERANCE * all().fold(0.0, |m: f64, r| m.max(r.a.abs()));
        self.strips[0] = Strip { low: arrive[0] / twice, high: arrive[1] / twice, slope: -1.0 / twice };
        self.len = 1;
        // The bound by speeds, 1/(q′)², is not linear in s: it is imposed in the middle of the interval too, where q′
        // is nearly the mean.
        let slow = 0.5 * (grid.slow[i] + grid.slow[i + 1]);
        let middle = 1.0 / (slow * slow);
        if middle < UNLIMITED {
            let (per, high) = (2.0 / twice, middle + 0.125 * twice * rise);
            self.strips[1] = Strip { low: f64::NEG_INFINITY, high: per * high, slope: -per };
            self.len = 2;
        }
        for r in all() {
            if r.a.abs() > floor {
                let per = 1.0 / r.a;
                let (p, q) = ((-1.0 - r.g) * per, (1.0 - r.g) * per);
                let (low, high) = if per > 0.0 { (p, q) } else { (q, p) };
                self.strips[self.len] = Strip { low, high, slope: -r.c * per };
                self.len += 1;
            } else if r.c != 0.0 {
                let (p, q) = ((-1.0 - r.g) / r.c, (1.0 - r.g) / r.c);
                self.x = [self.x[0].max(p.min(q)), self.x[1].min(p.max(q))];
            } else if r.g.abs() > 1.0 {
                self.x[1] = -1.0;
            }
        }
    }

    /// Returns the lines that bound u at x from below and from above, each with its value and its strip.
    #[inline]
    fn bounds(&self, x: f64) -> [(f64, &Strip); 2] {
        let mut low = (f64::NEG_INFINITY, &self.strips[0]);
        let mut high = (f64::INFINITY, &self.strips[0]);
        for strip in &self.strips[..self.len] {
            let by = strip.slope * x;
            if strip.low + by > low.0 {
                low = (strip.low + by, strip);
            }
            if strip.high + by < high.0 {
                high = (strip.high + by, strip);
            }
        }
        [low, high]
    }

    /// Returns the maximum x of the polygon; `None` if it is empty.
    fn greatest(&self) -> Option<f64> {
        self.search(self.x[1], 1.0)
    }

    /// Returns the minimum x of the polygon; `None` if it is empty.
    fn least(&self) -> Option<f64> {
        self.search(self.x[0], -1.0)
    }

    /// Finds an extreme x by Newton's method on the convex gap between the bounds, from outside inwards. Every step
    /// ends where two lines meet, and none overshoots the polygon.
    #[inline]
    fn search(&self, start: f64, outwards: f64) -> Option<f64> {
        let mut x = start;
        for _ in 0..ITERATIONS_PER_STRIP * self.strips.len() {
            if !(self.x[0]..=self.x[1]).contains(&x) {
                return None;
            }
            let [(l, low), (h, high)] = self.bounds(x);
            if l - h <= CROSSING_TOLERANCE * (l.abs() + h.abs()) {
                return Some(x);
            }
            let slope = low.slope - high.slope;
            // The gap does not close inwards.
            if slope * outwards <= 0.0 {
                return None;
            }
            let next = (high.low_or_high(false) - low.low_or_high(true)) / slope;
            if (x - next) * outwards <= 0.0 {
                return Some(x);
            }
            x = next;
        }
        Some(x)
    }

    /// Returns the maximum u at a controllable x.
    #[inline]
    fn fastest_at(&self, x: f64) -> f64 {
        let [(low, _), (high, _)] = self.bounds(x);
        // The bounds can cross by rounding only.
        if low > high { 0.5 * (low + high) } else { high }
    }
}

impl Strip {
    #[inline]
    fn low_or_high(&self, low: bool) -> f64 {
        if low { self.low } else { self.high }
    }
}
