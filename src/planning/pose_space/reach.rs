//! Which b reach a point.

use super::critical::Critical;
use super::looks::Looks;
use super::space::PoseSpace;
use crate::mechanics::planar::{DriveAngles, Vector};
use crate::planning::reactionless::{BSet, NoReach};

/// Values of b that come as near as this are one, rad: rounding.
const SAME: f64 = 1e-10;
/// How far beside a distance, as a share of it.
const BESIDE: f64 = 1e-9;
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
        let set = self.reach_of(distance, &[], &mut Work::default()).0;
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

    /// The b of points at a distance from B, on the x axis, and what was seen there. What was seen at distances beside it
    /// saves looks.
    pub(super) fn reach_of(&self, distance: f64, beside: &[&Seen], work: &mut Work) -> (BSet, Seen) {
        let period = self.period();
        if self.drives() == 1 {
            // One arm goes round on its circle.
            let on = (distance - self.farthest()).abs() <= 1e-9 * self.farthest();
            let b = if self.tip[0] < 0.0 { 0.5 * period } else { 0.0 };
            return (BSet { intervals: if on { vec![[b, b]] } else { Vec::new() }, period }, Seen::default());
        }
        if distance <= AT_BASE * self.farthest() {
            let any = self.any_pose(distance);
            return (BSet { intervals: if any { vec![[0.0, period]] } else { Vec::new() }, period }, Seen::default());
        }
        work.ends.clear();
        if self.criticals(distance, |c, _| work.ends.push(c)) {
            return self.set_of(distance, beside, work);
        }
        // At distances to which straight arms just reach, ends meet and none is told from another: as beside it.
        let parts = [1.0 - BESIDE, 1.0 + BESIDE].map(|by| {
            work.ends.clear();
            self.criticals(distance * by, |c, _| work.ends.push(c));
            self.set_of(distance * by, &[], work).0.intervals
        });
        (BSet::union(parts.concat(), period), Seen::default())
    }

    /// Joins the critical values: what lies between two is covered where a pose beside it goes there, or goes on.
    fn set_of(&self, distance: f64, beside: &[&Seen], work: &mut Work) -> (BSet, Seen) {
        let period = self.period();
        work.looks.clear();
        for c in &mut work.ends {
            c.b = c.b.rem_euclid(period);
        }
        work.ends.sort_unstable_by(|x, y| x.b.total_cmp(&y.b));
        work.ends.dedup_by(|c, last| {
            let same = c.b - last.b < SAME;
            if same {
                last.up |= c.up;
                last.down |= c.down;
                last.name = last.name.wrapping_add(c.name);
            }
            same
        });
        let (merged, looks) = (&work.ends, &mut work.looks);
        let n = merged.len();
        if n == 0 {
            // b may go round and round without an end: near B the machine turns as a whole.
            let known = agreed(beside.iter().map(|seen| seen.whole()));
            let whole = self.drives() > 2 && known.unwrap_or_else(|| self.any_pose(distance));
            let set = BSet { intervals: if whole { vec![[0.0, period]] } else { Vec::new() }, period };
            return (set, Seen { names: Vec::new(), covered: vec![whole] });
        }
        // covered[i]: from value i to the next.
        let mut covered: Vec<bool> = (0..n).map(|i| merged[i].up || merged[(i + 1) % n].down).collect();
        let spread = |covered: &mut Vec<bool>| {
            // What comes to a value at which nothing ends goes on there.
            for _ in 0..2 {
                for i in 0..n {
                    let next = (i + 1) % n;
                    covered[next] |= covered[i] && !merged[next].down;
                }
                for i in (0..n).rev() {
                    let next = (i + 1) % n;
                    covered[i] |= covered[next] && !merged[next].up;
                }
            }
        };
        spread(&mut covered);
        for i in 0..n {
            let to = if i + 1 < n { merged[i + 1].b } else { merged[0].b + period };
            let width = to - merged[i].b;
            if covered[i] || width <= SAME || self.drives() < 3 {
                continue;
            }
            // Several sheets may lie over one b: whether another one goes on here is known from the same gap beside it, or
            // asked of a pose, anywhere between, as where the set is about to part few poses are left.
            let name = |j: usize| merged[j % n].name;
            let around = [name(i + n - 1), name(i), name(i + 1), name(i + 2)];
            let known = agreed(beside.iter().map(|seen| seen.covers(n, i, around)));
            let between = || [0.5, 0.2, 0.8, 0.05, 0.95].map(|part| merged[i].b + part * width);
            if known.unwrap_or_else(|| self.has_pose(distance, &between(), looks)) {
                covered[i] = true;
                spread(&mut covered);
            }
        }
        let mut parts: Vec<[f64; 2]> = Vec::with_capacity(2 * n);
        parts.extend(merged.iter().map(|c| [c.b, c.b]));
        for (i, covered) in covered.iter().enumerate() {
            if *covered {
                let to = if i + 1 < n { merged[i + 1].b } else { merged[0].b + period };
                parts.push([merged[i].b, to]);
            }
        }
        (BSet::union(parts, period), Seen { names: merged.iter().map(|c| c.name).collect(), covered })
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

/// Which values ended what at a distance, in order, and what was covered between them. Sets begin and end at these
/// values only, so at a distance near by what lies between the same two is covered as well, or not, unless a third one has
/// passed both: then they are not in the same place among all.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Seen {
    names: Vec<u64>,
    covered: Vec<bool>,
}

impl Seen {
    /// Whether gap i of n was covered, if these values lay about it.
    fn covers(&self, n: usize, i: usize, around: [u64; 4]) -> Option<bool> {
        let name = |j: usize| self.names[j % n];
        let same = self.names.len() == n && around == [name(i + n - 1), name(i), name(i + 1), name(i + 2)];
        same.then(|| self.covered[i])
    }

    /// Whether all of it was covered, where there were no values.
    fn whole(&self) -> Option<bool> {
        self.covered.first().copied().filter(|_| self.names.is_empty())
    }
}
