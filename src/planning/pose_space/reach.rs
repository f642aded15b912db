//! Which b reach a point.

use super::covered::Covered;
use super::critical::Critical;
use super::looks::{Gap, Looks};
use super::space::{AT_BASE, PoseSpace};
use crate::mechanics::planar::{DriveAngles, Vector};
use crate::planning::reactionless::{BSet, NoReach};

/// Values of b that come as near as this are one, rad: rounding.
const SAME: f64 = 1e-10;
/// Single b of two drives may be off by this share of Σλ, rad: half of what its poses may be off.
const SINGLE_B: f64 = 0.5e-6;
/// How far beside a distance, as a share of the reach: past what rounding and the slack of limits decide.
const BESIDE: f64 = 4.1e-9;

impl PoseSpace {
    /// All b at which the end effector can be on `p`, m, within the limits; with two drives each is an interval without
    /// extent.
    ///
    /// # Errors
    /// If there is none.
    pub fn reach(&self, p: Vector) -> Result<BSet, NoReach> {
        self.reach_with(p, true)
    }

    /// The same, with poses looked for with all care, or less: then b may be missing.
    pub(in crate::planning) fn reach_with(&self, p: Vector, careful: bool) -> Result<BSet, NoReach> {
        if let Some(map) = self.map() {
            return map.reach(p);
        }
        let (distance, farthest, nearest) = (p.norm(), self.farthest(), self.nearest());
        if distance > farthest * (1.0 + 1e-12) {
            return Err(NoReach::TooFar { distance, farthest });
        }
        if distance < nearest - 1e-12 * farthest {
            return Err(NoReach::TooNear { distance, nearest });
        }
        let set = self.reach_of(distance, careful);
        if set.is_empty() {
            return Err(NoReach::Limits);
        }
        // b of a point that is turned about B turns with it.
        let turn = p.arg() * self.sum;
        let turned = set.intervals.iter().map(|[low, high]| [low + turn, high + turn]);
        Ok(BSet::union(turned.collect(), self.period()))
    }

    /// Whether a point, m, lies in what is reached at b, rad, its edge included.
    pub fn contains(&self, p: Vector, b: f64) -> bool {
        match self.planes() {
            Ok(planes) => planes.boundary().contains(p, b),
            Err(_) => self.reach(p).is_ok_and(|set| set.contains(b)),
        }
    }

    /// By how much single b of two points may differ and still be one, rad: one and two drives reach a point at single b,
    /// which points share up to rounding.
    pub(in crate::planning) fn b_slack(&self) -> f64 {
        if self.drives() < 3 { SINGLE_B * self.sum } else { 0.0 }
    }

    /// A pose of a point at the b nearest to a given one at which there is one.
    pub fn near(&self, p: Vector, b: f64) -> Option<DriveAngles> {
        let set = self.reach(p).ok()?;
        let nearest = set.nearest(b)?;
        let tries = [nearest, set.inwards(nearest, 1e-9), set.inwards(nearest, 1e-3), set.inwards(nearest, 0.5)];
        tries.iter().find_map(|b| self.poses(p, *b, &self.middle()).first().copied())
    }

    /// The b of points at a distance from B, on the x axis.
    fn reach_of(&self, distance: f64, careful: bool) -> BSet {
        let period = self.period();
        if self.drives() == 1 {
            // One arm goes round on its circle.
            let on = (distance - self.farthest()).abs() <= 1e-9 * self.farthest();
            let b = if self.tip[0] < 0.0 { 0.5 * period } else { 0.0 };
            return BSet { intervals: if on { vec![[b, b]] } else { Vec::new() }, period };
        }
        let mut work = Work::default();
        work.looks.careful = careful;
        if distance <= AT_BASE * self.farthest() {
            let any = self.any_pose(distance, &work.looks);
            return BSet { intervals: if any { vec![[0.0, period]] } else { Vec::new() }, period };
        }
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
        let mut merged = work.ends.clone();
        merged.dedup_by(|c, last| joins(c, last, c.b - last.b));
        // b goes round: the last one may be the first.
        if let [first, .., last] = &mut merged[..]
            && joins(last, first, first.b + period - last.b)
        {
            merged.pop();
        }
        let n = merged.len();
        if n == 0 {
            // b may go round and round without an end: near B the machine turns as a whole.
            let known = agreed(beside.iter().map(|seen| seen.whole())).filter(|_| beside.len() > 1);
            let whole = self.drives() > 2 && known.unwrap_or_else(|| self.any_pose(distance, &work.looks));
            return Covered { ends: Vec::new(), gaps: vec![whole], period };
        }
        let gaps = (0..n).map(|i| merged[i].rises() || merged[(i + 1) % n].falls()).collect();
        let mut covered = Covered { ends: merged, gaps, period };
        covered.spread();
        let mut empty = vec![false; n];
        for i in 0..n {
            let [from, to] = covered.edges(i);
            if covered.gaps[i] || to - from <= SAME || self.drives() < 3 {
                continue;
            }
            // Several sheets may lie over one b: whether another one goes on here is known from the same gap beside it, or
            // asked of poses.
            let seen = |seen: &Covered, all: bool| Some(seen.gaps[seen.gap(&covered, i, all)?]);
            let on_both_sides = beside.len() > 1 && beside.iter().all(|beside| seen(beside, false).is_some());
            let known = agreed(beside.iter().map(|beside| seen(beside, !on_both_sides)));
            let asked = || {
                let gap = Gap { from, to, free: covered.free(i, &empty) };
                self.has_pose(distance, &gap, &work.ends, &mut work.looks)
            };
            if known.unwrap_or_else(asked) {
                covered.gaps[i] = true;
                covered.spread();
            } else {
                empty[i] = true;
            }
        }
        covered
    }
}

/// What is written to at each distance, kept so that it is not made anew.
#[derive(Default)]
pub(super) struct Work {
    ends: Vec<Critical>,
    pub looks: Looks,
}

/// What all say that know it.
fn agreed(known: impl Iterator<Item = Option<bool>>) -> Option<bool> {
    let mut all = known.flatten();
    let first = all.next()?;
    all.all(|other| other == first).then_some(first)
}
