//! Which b reach a point.

use super::critical::{Critical, Scan};
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
        let set = self.reach_of(distance, &mut Scan::default(), &mut Seen::default());
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
    /// What was seen at distances before saves looks where it is seen again.
    pub(super) fn reach_of(&self, distance: f64, scan: &mut Scan, seen: &mut Seen) -> BSet {
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
        let mut ends: Vec<Critical> = Vec::with_capacity(64);
        if self.criticals(distance, scan, |c| ends.push(c)) {
            return self.set_of(ends, distance, seen);
        }
        *seen = Seen::default();
        // At distances to which straight arms just reach, ends meet and none is told from another: as beside it.
        let parts = [1.0 - BESIDE, 1.0 + BESIDE].map(|by| {
            ends.clear();
            self.criticals(distance * by, scan, |c| ends.push(c));
            self.set_of(std::mem::take(&mut ends), distance * by, &mut Seen::default()).intervals
        });
        BSet::union(parts.concat(), period)
    }

    /// Joins the critical values: what lies between two is covered where a pose beside it goes there, or goes on.
    fn set_of(&self, mut ends: Vec<Critical>, distance: f64, seen: &mut Seen) -> BSet {
        let period = self.period();
        for c in &mut ends {
            c.b = c.b.rem_euclid(period);
        }
        ends.sort_by(|x, y| x.b.total_cmp(&y.b));
        let mut merged: Vec<Critical> = Vec::with_capacity(ends.len());
        for c in ends {
            match merged.last_mut() {
                Some(last) if c.b - last.b < SAME => {
                    last.up |= c.up;
                    last.down |= c.down;
                }
                _ => merged.push(c),
            }
        }
        let n = merged.len();
        let kinds: Vec<[bool; 2]> = merged.iter().map(|c| [c.up, c.down]).collect();
        let known = std::mem::take(seen);
        if n == 0 {
            // b may go round and round without an end: near B the machine turns as a whole.
            let whole = self.drives() > 2 && self.any_pose(distance);
            return BSet { intervals: if whole { vec![[0.0, period]] } else { Vec::new() }, period };
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
        if known.kinds == kinds {
            covered.clone_from(&known.covered);
        } else if self.drives() > 2 {
            for i in 0..n {
                let width = if i + 1 < n { merged[i + 1].b - merged[i].b } else { merged[0].b + period - merged[i].b };
                // Several sheets may lie over one b: whether another one goes on here is asked of a pose, anywhere between,
                // as where the set is about to part few poses are left.
                let between = [0.5, 0.2, 0.8, 0.05, 0.95].map(|part| merged[i].b + part * width);
                if !covered[i] && width > SAME && self.has_pose(distance, &between) {
                    covered[i] = true;
                    spread(&mut covered);
                }
            }
        }
        let mut parts: Vec<[f64; 2]> = merged.iter().map(|c| [c.b, c.b]).collect();
        for (i, covered) in covered.iter().enumerate() {
            if *covered {
                let to = if i + 1 < n { merged[i + 1].b } else { merged[0].b + period };
                parts.push([merged[i].b, to]);
            }
        }
        *seen = Seen { kinds, covered };
        BSet::union(parts, period)
    }
}

/// Which values ended what at a distance, in order, and what was covered between them. Until the order of kinds changes
/// no set begins or ends between two values, so at a distance near by the same is covered.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Seen {
    kinds: Vec<[bool; 2]>,
    covered: Vec<bool>,
}
