//! The b at which a point can be reached.

use super::b_coverage::BCoverage;
use super::critical::CriticalPose;
use super::gap_search::{CriticalInterval, ReachGrid};
use super::space::{BASE_RADIUS, PoseSpace};
use crate::reactionless::{BSet, NoReach};
use stillbase_mechanics::planar::{DriveAngles, Vector};

/// Critical values of b within this tolerance are equal, rad.
const SAME_B_RAD: f64 = 1e-10;
/// Tolerance of a single b of one and two drives, as a fraction of Σλ: half the tolerance used for their poses.
const SINGLE_B_TOLERANCE: f64 = 0.5e-6;
/// Offset to a neighbouring distance, as a fraction of the reach: larger than the effects of rounding and of the
/// tolerance of limits.
const NEIGHBOUR_OFFSET: f64 = 4.1e-9;

impl PoseSpace {
    /// Returns all b at which the end effector can be on `p`, m, within the limits. With one and two drives each
    /// interval is a single value, except at B: two drives that reach B do so at every b.
    ///
    /// # Errors
    /// If there are none: the reason.
    pub fn reach(&self, p: Vector) -> Result<BSet, NoReach> {
        self.reach_with(p, true)
    }

    /// Returns the same set by a careful or a quick search for poses; a quick one may miss some b.
    pub(crate) fn reach_with(&self, p: Vector, careful: bool) -> Result<BSet, NoReach> {
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
        // Turning a point about B by an angle adds Σλ times that angle to b.
        let turn = p.arg() * self.lambda_sum;
        let turned = set.intervals.iter().map(|[low, high]| [low + turn, high + turn]);
        Ok(BSet::union(turned.collect(), self.period()))
    }

    /// Whether a point, m, lies in the workspace of b, rad, or on its boundary.
    pub fn contains(&self, p: Vector, b: f64) -> bool {
        match self.planes() {
            Ok(planes) => planes.boundary().contains(p, b),
            Err(_) => self.reach(p).is_ok_and(|set| set.contains(b)),
        }
    }

    /// Returns the tolerance within which two single values of b are equal, rad. With one and two drives, points have
    /// single values of b that agree within rounding only.
    pub(crate) fn b_slack(&self) -> f64 {
        if self.drives() < 3 { SINGLE_B_TOLERANCE * self.lambda_sum } else { 0.0 }
    }

    /// Returns a pose of a point, m, at the feasible b nearest to the given one; `None` if there is none.
    pub fn pose_at_nearest_b(&self, p: Vector, b: f64) -> Option<DriveAngles> {
        let set = self.reach(p).ok()?;
        let nearest = set.nearest(b)?;
        let tries =
            [nearest, set.moved_inside(nearest, 1e-9), set.moved_inside(nearest, 1e-3), set.moved_inside(nearest, 0.5)];
        tries.iter().find_map(|b| self.poses(p, *b, &self.middle()).first().copied())
    }

    /// Returns the feasible b of the point on the x axis at a distance from B, m.
    fn reach_of(&self, distance: f64, careful: bool) -> BSet {
        let period = self.period();
        if self.drives() == 1 {
            // A single arm only reaches its circle.
            let on = (distance - self.farthest()).abs() <= 1e-9 * self.farthest();
            let b = if self.arms[0] < 0.0 { 0.5 * period } else { 0.0 };
            return BSet { intervals: if on { vec![[b, b]] } else { Vec::new() }, period };
        }
        let mut work = ReachBuffers::default();
        work.looks.careful = careful;
        if distance <= BASE_RADIUS * self.farthest() {
            let any = self.any_pose(distance, &work.looks);
            return BSet { intervals: if any { vec![[0.0, period]] } else { Vec::new() }, period };
        }
        if self.criticals(distance, |c| work.ends.push(c)) {
            return self.joined(distance, &[], &mut work).set(period);
        }
        // Where straight arms, or arms with all joints at limits, just reach a distance, critical values coincide. Then
        // the union of the sets at both neighbouring distances is taken.
        let parts = [-NEIGHBOUR_OFFSET, NEIGHBOUR_OFFSET].map(|by| {
            let neighbour = (distance + by * self.farthest()).abs();
            work.ends.clear();
            self.criticals(neighbour, |c| work.ends.push(c));
            self.joined(neighbour, &[], &mut work).set(period).intervals
        });
        BSet::union(parts.concat(), period)
    }

    /// Returns the feasible b at a distance from B, m, for three and more drives. Results at neighbouring distances
    /// save searches for poses. If rounding affects the result, the distance is shifted by up to twice
    /// [`NEIGHBOUR_OFFSET`]; it is returned too.
    pub(super) fn covered(
        &self,
        distance: f64,
        neighbours: &[&BCoverage],
        work: &mut ReachBuffers,
    ) -> (f64, BCoverage) {
        let mut at = distance;
        for by in [0.0, 1.0, -1.0, 2.0, -2.0] {
            at = distance + by * NEIGHBOUR_OFFSET * self.farthest();
            work.ends.clear();
            if self.criticals(at, |c| work.ends.push(c)) {
                break;
            }
        }
        (at, self.joined(at, neighbours, work))
    }

    /// Determines which gaps between critical values are feasible: by the critical poses at their bounds, by
    /// neighbouring distances, or by a search for poses.
    fn joined(&self, distance: f64, neighbours: &[&BCoverage], work: &mut ReachBuffers) -> BCoverage {
        let period = self.period();
        work.looks.clear();
        for c in &mut work.ends {
            c.b = c.b.rem_euclid(period);
        }
        work.ends.sort_unstable_by(|x, y| x.b.total_cmp(&y.b));
        let joins = |c: &CriticalPose, last: &mut CriticalPose, apart: f64| {
            let same = apart < SAME_B_RAD;
            if same {
                last.merge(c);
            }
            same
        };
        let mut merged = work.ends.clone();
        merged.dedup_by(|c, last| joins(c, last, c.b - last.b));
        // b is periodic: the last value may equal the first.
        if let [first, .., last] = &mut merged[..]
            && joins(last, first, first.b + period - last.b)
        {
            merged.pop();
        }
        let n = merged.len();
        if n == 0 {
            // Without critical values, all b are feasible or none. Near B, for instance, turning the whole machine
            // changes b and hardly moves the end effector.
            let known = agreed(neighbours.iter().map(|seen| seen.whole())).filter(|_| neighbours.len() > 1);
            let whole = self.drives() > 2 && known.unwrap_or_else(|| self.any_pose(distance, &work.looks));
            return BCoverage { ends: Vec::new(), gaps: vec![whole], period };
        }
        let gaps = (0..n).map(|i| merged[i].rises() || merged[(i + 1) % n].falls()).collect();
        let mut covered = BCoverage { ends: merged, gaps, period };
        covered.spread();
        let mut empty = vec![false; n];
        for i in 0..n {
            let [from, to] = covered.edges(i);
            if covered.gaps[i] || to - from <= SAME_B_RAD || self.drives() < 3 {
                continue;
            }
            // Several sheets may overlap in b. Whether one covers this gap is known from the same gap at neighbouring
            // distances, or from a search for poses.
            let seen = |seen: &BCoverage, all: bool| Some(seen.gaps[seen.gap(&covered, i, all)?]);
            let on_both_sides =
                neighbours.len() > 1 && neighbours.iter().all(|neighbour| seen(neighbour, false).is_some());
            let known = agreed(neighbours.iter().map(|neighbour| seen(neighbour, !on_both_sides)));
            let search = || {
                let gap = CriticalInterval { from, to, free: covered.free(i, &empty) };
                self.has_pose(distance, &gap, &work.ends, &mut work.looks)
            };
            if known.unwrap_or_else(search) {
                covered.gaps[i] = true;
                covered.spread();
            } else {
                empty[i] = true;
            }
        }
        covered
    }
}

/// Buffers reused at each distance.
#[derive(Default)]
pub(super) struct ReachBuffers {
    ends: Vec<CriticalPose>,
    pub looks: ReachGrid,
}

/// Returns the common value of all known ones; `None` if they disagree or there are none.
fn agreed(known: impl Iterator<Item = Option<bool>>) -> Option<bool> {
    let mut all = known.flatten();
    let first = all.next()?;
    all.all(|other| other == first).then_some(first)
}
