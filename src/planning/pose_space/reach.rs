//! Which b reach a point.

use super::critical::Critical;
use super::looks::Looks;
use super::space::PoseSpace;
use crate::mechanics::planar::{DriveAngles, Vector};
use crate::planning::reactionless::{BSet, NoReach};

/// Values of b that come as near as this are one, rad: rounding.
const SAME: f64 = 1e-10;
/// How far beside a distance, as a share of the reach: past what rounding and the slack of limits decide.
const BESIDE: f64 = 4.1e-9;
/// Values as near to a gap as this, as a share of b's period, may pass it from one circle to the next.
const NEAR_GAP: f64 = 0.125;
/// A point as near to B as this, as a share of the reach, is B: the workspace turned about it.
const AT_BASE: f64 = 1e-12;

impl PoseSpace {
    /// All b at which the end effector can be on `p`, m, within the limits; with two drives each is an interval without
    /// extent.
    ///
    /// # Errors
    /// If there is none.
    pub fn reach(&self, p: Vector) -> Result<BSet, NoReach> {
        let (distance, farthest, nearest) = (p.norm(), self.farthest(), self.nearest());
        if distance > farthest * (1.0 + 1e-12) {
            return Err(NoReach::TooFar { distance, farthest });
        }
        if distance < nearest - 1e-12 * farthest {
            return Err(NoReach::TooNear { distance, nearest });
        }
        let set = self.reach_of(distance);
        if set.is_empty() {
            return Err(NoReach::Limits);
        }
        // b of a point that is turned about B turns with it.
        let turn = p.arg() * self.sum;
        let turned = set.intervals.iter().map(|[low, high]| [low + turn, high + turn]);
        Ok(BSet::union(turned.collect(), self.period()))
    }

    /// A pose of a point at the b nearest to a given one at which there is one.
    pub fn near(&self, p: Vector, b: f64) -> Option<DriveAngles> {
        let set = self.reach(p).ok()?;
        let nearest = set.nearest(b)?;
        let tries = [nearest, set.inwards(nearest, 1e-9), set.inwards(nearest, 1e-3), set.inwards(nearest, 0.5)];
        tries.iter().find_map(|b| self.poses(p, *b, &self.middle()).first().copied())
    }

    /// The b of points at a distance from B, on the x axis.
    fn reach_of(&self, distance: f64) -> BSet {
        let period = self.period();
        if self.drives() == 1 {
            // One arm goes round on its circle.
            let on = (distance - self.farthest()).abs() <= 1e-9 * self.farthest();
            let b = if self.tip[0] < 0.0 { 0.5 * period } else { 0.0 };
            return BSet { intervals: if on { vec![[b, b]] } else { Vec::new() }, period };
        }
        if distance <= AT_BASE * self.farthest() {
            let any = self.any_pose(distance);
            return BSet { intervals: if any { vec![[0.0, period]] } else { Vec::new() }, period };
        }
        let mut work = Work::default();
        if self.criticals(distance, |c| work.ends.push(c)) {
            return self.joined(distance, &[], &mut work).set(period);
        }
        // At distances to which straight arms just reach, and corners of limits, ends meet and none is told from another:
        // as beside it.
        let parts = [-BESIDE, BESIDE].map(|by| {
            let beside = (distance + by * self.farthest()).abs();
            work.ends.clear();
            self.criticals(beside, |c| work.ends.push(c));
            self.joined(beside, &[], &mut work).set(period).intervals
        });
        BSet::union(parts.concat(), period)
    }

    /// What of the circle of b is covered at a distance from B, m, three drives and more. What was seen at distances
    /// beside it saves looks. Where rounding decides it is moved by up to twice [`BESIDE`], and says where to.
    pub(super) fn covered(&self, distance: f64, beside: &[&Covered], work: &mut Work) -> (f64, Covered) {
        let mut at = distance;
        for by in [0.0, 1.0, -1.0, 2.0, -2.0] {
            at = distance + by * BESIDE * self.farthest();
            work.ends.clear();
            if self.criticals(at, |c| work.ends.push(c)) {
                break;
            }
        }
        (at, self.joined(at, beside, work))
    }

    /// Joins the critical values: what lies between two is covered where a pose beside it goes there, or goes on.
    fn joined(&self, distance: f64, beside: &[&Covered], work: &mut Work) -> Covered {
        let period = self.period();
        work.looks.clear();
        for c in &mut work.ends {
            c.b = c.b.rem_euclid(period);
        }
        work.ends.sort_unstable_by(|x, y| x.b.total_cmp(&y.b));
        let joins = |c: &Critical, last: &mut Critical, apart: f64| {
            let same = apart < SAME;
            if same {
                last.merge(c);
            }
            same
        };
        work.ends.dedup_by(|c, last| joins(c, last, c.b - last.b));
        // b goes round: the last one may be the first.
        if let [first, .., last] = &mut work.ends[..]
            && joins(last, first, first.b + period - last.b)
        {
            work.ends.pop();
        }
        let (merged, looks) = (&work.ends, &mut work.looks);
        let n = merged.len();
        if n == 0 {
            // b may go round and round without an end: near B the machine turns as a whole.
            let known = agreed(beside.iter().map(|seen| seen.whole())).filter(|_| beside.len() > 1);
            let whole = self.drives() > 2 && known.unwrap_or_else(|| self.any_pose(distance));
            return Covered { ends: Vec::new(), gaps: vec![whole], period };
        }
        let gaps = (0..n).map(|i| merged[i].up || merged[(i + 1) % n].down).collect();
        let mut covered = Covered { ends: merged.clone(), gaps, period };
        covered.spread();
        for i in 0..n {
            let to = if i + 1 < n { merged[i + 1].b } else { merged[0].b + period };
            let width = to - merged[i].b;
            if covered.gaps[i] || width <= SAME || self.drives() < 3 {
                continue;
            }
            // Several sheets may lie over one b: whether another one goes on here is known from the same gap beside it, or
            // asked of a pose, anywhere between, as where the set is about to part few poses are left.
            let seen = |seen: &Covered, all: bool| Some(seen.gaps[seen.gap(&covered, i, all)?]);
            let on_both_sides = beside.len() > 1 && beside.iter().all(|beside| seen(beside, false).is_some());
            let known = agreed(beside.iter().map(|beside| seen(beside, !on_both_sides)));
            let between = || [0.5, 0.2, 0.8, 0.05, 0.95].map(|part| merged[i].b + part * width);
            if known.unwrap_or_else(|| self.has_pose(distance, &between(), looks)) {
                covered.gaps[i] = true;
                covered.spread();
            }
        }
        covered
    }
}

/// What is written to at each distance, kept so that it is not made anew.
#[derive(Default)]
pub(super) struct Work {
    ends: Vec<Critical>,
    looks: Looks,
}

/// What all say that know it.
fn agreed(known: impl Iterator<Item = Option<bool>>) -> Option<bool> {
    let mut all = known.flatten();
    let first = all.next()?;
    all.all(|other| other == first).then_some(first)
}

/// What of the circle of b is covered at a distance. Sets begin and end at critical values only, so at a distance near by
/// what lies between the same two is covered as well, or not, unless a third one has passed both: then there are mostly
/// others about them.
#[derive(Clone, Debug, Default)]
pub(super) struct Covered {
    /// The critical values, from the least.
    pub ends: Vec<Critical>,
    /// Whether what lies between each and the next is covered; one, of the whole circle, where there are no values.
    pub gaps: Vec<bool>,
    period: f64,
}

impl Covered {
    /// As intervals of b.
    fn set(&self, period: f64) -> BSet {
        let n = self.ends.len();
        if n == 0 {
            let whole = self.gaps.first() == Some(&true);
            return BSet { intervals: if whole { vec![[0.0, period]] } else { Vec::new() }, period };
        }
        let mut parts: Vec<[f64; 2]> = Vec::with_capacity(2 * n);
        parts.extend(self.ends.iter().map(|c| [c.b, c.b]));
        for (i, covered) in self.gaps.iter().enumerate() {
            if *covered {
                let to = if i + 1 < n { self.ends[i + 1].b } else { self.ends[0].b + period };
                parts.push([self.ends[i].b, to]);
            }
        }
        BSet::union(parts, period)
    }

    /// What comes to a value at which nothing ends goes on there.
    fn spread(&mut self) {
        let n = self.ends.len();
        for _ in 0..2 {
            for i in 0..n {
                let next = (i + 1) % n;
                self.gaps[next] |= self.gaps[i] && !self.ends[next].down;
            }
            for i in (0..n).rev() {
                let next = (i + 1) % n;
                self.gaps[i] |= self.gaps[next] && !self.ends[next].up;
            }
        }
    }

    /// The names of the values about gap i, two on either side.
    fn around(&self, i: usize) -> [u64; 4] {
        let n = self.ends.len();
        [n - 1, 0, 1, 2].map(|j| self.ends[(i + j) % n].name)
    }

    /// The gap between the same two values as one of another distance; with the same ones on either side of it, too, if
    /// all have to be. Two values that pass each other keep their order round the circle: of two, it has to be the same
    /// from 0 on.
    fn gap(&self, of: &Self, i: usize, all: bool) -> Option<usize> {
        let (n, around) = (self.ends.len(), of.around(i));
        let same = |j: &usize| {
            let own = self.around(*j);
            own[1..3] == around[1..3] && (!all || (own == around && self.has_sides(*j, of, i)))
        };
        if n < 3 || of.ends.len() < 3 {
            return (n == of.ends.len() && same(&i)).then_some(i);
        }
        (0..n).find(same)
    }

    /// Whether no value has passed gap j on its way to gap i of another distance: those near either have kept their sides,
    /// and none is new or gone.
    fn has_sides(&self, j: usize, of: &Self, i: usize) -> bool {
        let near = NEAR_GAP * self.period;
        let (here, there) = (self.middle(j), of.middle(i));
        let off = |c: &Critical, middle: f64| {
            let half = 0.5 * self.period;
            (c.b - middle + half).rem_euclid(self.period) - half
        };
        let keeps = |one: &Self, middle: f64, other: &Self, others: f64| {
            one.ends.iter().all(|c| {
                let own = off(c, middle);
                own.abs() > near || other.ends.iter().any(|d| d.name == c.name && (off(d, others) > 0.0) == (own > 0.0))
            })
        };
        keeps(self, here, of, there) && keeps(of, there, self, here)
    }

    /// The b in the middle of a gap, rad.
    fn middle(&self, i: usize) -> f64 {
        let n = self.ends.len();
        let to = if i + 1 < n { self.ends[i + 1].b } else { self.ends[0].b + self.period };
        0.5 * (self.ends[i].b + to)
    }

    /// Covers what is covered at a distance beside this one: what was found there cannot be missing here.
    pub fn covers_too(&mut self, beside: &Self) {
        for i in 0..self.ends.len() {
            self.gaps[i] |= beside.gap(self, i, true).is_some_and(|j| beside.gaps[j]);
        }
        self.spread();
    }

    /// Whether all of it was covered, where there were no values.
    fn whole(&self) -> Option<bool> {
        self.gaps.first().copied().filter(|_| self.ends.is_empty())
    }
}
