//! Search for poses at a given distance from B with b in a gap, an interval between two critical values.
//!
//! # Method
//! A connected set of poses with b in the gap extends over the whole gap. It ends or merges at critical poses
//! outside it. So it is found by climbing from the nearest critical poses below or descending from the nearest ones
//! above. A component without an extremum of b has no critical poses. Such components are found on a grid over the last
//! joints, with the remaining three arms in closed form.

use std::f64::consts::{PI, TAU};

use super::continuation::{Climb, MINIMAL_CONTINUATION};
use super::critical::CriticalPose;
use super::space::{BASE_RADIUS, PoseSpace};
use crate::reactionless::{AngleDefinition, AngleLimit, PlaneMap};
use stillbase_mechanics::planar::{DriveAngles, MAX_DRIVES, PerDrive, Vector, unit};

/// Number of grid points over the range of each joint beyond the first two, for one, two, three, four, and at least
/// five such joints.
const GRID_POINTS: [usize; 5] = [33, 13, 7, 5, 3];
/// Number of critical poses on either side of a gap from which climbs are tried: in a quick and in a careful search.
const NEAREST_CRITICALS: [usize; 2] = [3, 24];
/// Depth of a climb into a gap, as a fraction of the gap.
const GAP_DEPTH: f64 = 0.3;
/// Maximum of this depth, as a fraction of the period of b.
const MAX_GAP_DEPTH: f64 = 0.02;
/// Maximum number of sweeps over all joints in a search for a pose at a distance.
const MAX_SWEEPS: usize = 200;
/// The search ends after a sweep that reduces the error of the distance by less than this fraction of the reach.
const MIN_SWEEP_GAIN: f64 = 1e-12;
/// Number of samples over all joint ranges from which poses at a distance are sought: in a quick and in a careful
/// search.
const START_SAMPLES: [usize; 2] = [32, 512];
/// Margin by which a sample must lie inside a gap, as a fraction of the gap.
const GAP_MARGIN: f64 = 1e-3;
/// Distance from B of poses from which a search for a pose at B starts, as a fraction of the reach.
const NEAR_BASE_DISTANCE: f64 = 1e-2;
/// Critical values within this tolerance are equal, rad.
const SAME_CRITICAL_RAD: f64 = 1e-9;

/// The interval between two critical values of b, rad.
pub(super) struct CriticalInterval {
    pub from: f64,
    pub to: f64,
    /// Critical poses can lead into the gap from at most this far below and above it, rad.
    pub free: [f64; 2],
}

impl CriticalInterval {
    /// Returns sample values of b in the gap, rad, some of them near its bounds.
    fn places(&self) -> [f64; 5] {
        [0.5, 0.2, 0.8, 0.05, 0.95].map(|part| self.from + part * (self.to - self.from))
    }
}

/// Cached samples at one distance, valid for every b.
#[derive(Default)]
pub(super) struct ReachGrid {
    /// Feasible intervals of b with the last joints held at each grid point, rad. `ends` contains the index after the
    /// last interval of each grid point.
    spans: Vec<[f64; 2]>,
    ends: Vec<usize>,
    /// The b of sampled poses at the distance, rad.
    samples: Vec<f64>,
    /// Whether the search is careful rather than quick.
    pub careful: bool,
}

impl ReachGrid {
    /// Clears the samples, for another distance.
    pub fn clear(&mut self) {
        self.spans.clear();
        self.ends.clear();
        self.samples.clear();
    }
}

impl PoseSpace {
    /// Whether some pose has its b in the gap and its end effector on the x axis at a distance from B, m. The critical
    /// poses are given in ascending b.
    pub(super) fn has_pose(
        &self,
        distance: f64,
        gap: &CriticalInterval,
        criticals: &[CriticalPose],
        grid: &mut ReachGrid,
    ) -> bool {
        let p = Vector::new(distance, 0.0);
        if self.drives() > 3 {
            return self.is_reached_by_climbs(p, gap, criticals, NEAREST_CRITICALS[usize::from(grid.careful)])
                || self.is_reached_on_grid(p, &gap.places(), grid)
                || self.is_sampled(distance, gap, grid)
                || (grid.careful && self.is_reached_from_samples(p, 0.5 * (gap.from + gap.to)));
        }
        gap.places().iter().any(|b| self.has_isolated_pose(p, *b))
    }

    /// Whether a climb from a critical pose near a gap leads into it.
    fn is_reached_by_climbs(
        &self,
        p: Vector,
        gap: &CriticalInterval,
        criticals: &[CriticalPose],
        nearest: usize,
    ) -> bool {
        let (period, n) = (self.period(), criticals.len());
        let into = (GAP_DEPTH * (gap.to - gap.from)).min(MAX_GAP_DEPTH * period);
        let past = |by: f64| (by + SAME_CRITICAL_RAD).rem_euclid(period) - SAME_CRITICAL_RAD;
        let at_most = |by: &f64, free: f64| *by <= free + SAME_CRITICAL_RAD;
        let first = criticals.partition_point(|c| c.b <= gap.from + SAME_CRITICAL_RAD);
        let mut below = (1..=n)
            .map(|k| &criticals[(first + n - k) % n])
            .map(|c| (c, past(gap.from - c.b)))
            .take_while(|(_, by)| at_most(by, gap.free[0]))
            .filter(|(c, _)| c.up);
        let last = criticals.partition_point(|c| c.b < gap.to - SAME_CRITICAL_RAD);
        let mut above = (0..n)
            .map(|k| &criticals[(last + k) % n])
            .map(|c| (c, past(c.b - gap.to)))
            .take_while(|(_, by)| at_most(by, gap.free[1]))
            .filter(|(c, _)| c.down);
        (0..nearest).any(|_| {
            let rise = below.next().map(|(from, by)| Climb { from, rise: by + into });
            let fall = above.next().map(|(from, by)| Climb { from, rise: -(by + into) });
            rise.iter().chain(&fall).any(|climb| self.climbed_strictly(p, climb, MINIMAL_CONTINUATION).is_some())
        })
    }

    /// Whether a pose exists at one of these b with the last joints held at a grid point.
    fn is_reached_on_grid(&self, p: Vector, b: &[f64], grid: &mut ReachGrid) -> bool {
        let (n, first) = (self.joints.len(), 2);
        let each = GRID_POINTS[(self.drives() - 4).min(GRID_POINTS.len() - 1)];
        let at = |i: usize, j: usize| {
            let [low, high] = self.joints[i].limits;
            low + (high - low) * (j as f64 + 0.5) / each as f64
        };
        let middle = self.middle();
        let held_at = |code: usize| {
            let (mut held, mut rest) = (middle, code);
            for i in first..n {
                held[i] = at(i, rest % each);
                rest /= each;
            }
            held
        };
        (0..each.pow((n - first) as u32)).any(|code| {
            if code == grid.ends.len() {
                self.spans(p, &held_at(code), |span| grid.spans.push(span));
                grid.ends.push(grid.spans.len());
            }
            let from = if code > 0 { grid.ends[code - 1] } else { 0 };
            grid.spans[from..grid.ends[code]].iter().any(|span| b.iter().any(|b| self.holds(*span, *b)))
        })
    }

    /// Whether a sampled pose at the distance has a b in the gap.
    fn is_sampled(&self, distance: f64, gap: &CriticalInterval, grid: &mut ReachGrid) -> bool {
        if grid.samples.is_empty() {
            let b = |a: PerDrive| {
                let q = self.unturned(&a);
                let turn = self.end_effector(&DriveAngles(q)).arg();
                self.lambda.dot(&q) - turn * self.lambda_sum
            };
            let found = (0..START_SAMPLES[usize::from(grid.careful)])
                .filter_map(|i| self.pose_at_distance(distance, self.sample(i)))
                .map(b);
            grid.samples.extend(found.chain([f64::NAN]));
        }
        let inside = GAP_MARGIN * (gap.to - gap.from);
        grid.samples.iter().any(|b| self.holds([gap.from + inside, gap.to - inside], *b))
    }

    /// Whether an interval contains a b, modulo the period.
    fn holds(&self, [low, high]: [f64; 2], b: f64) -> bool {
        (b - low).rem_euclid(self.period()) <= high - low
    }

    /// Visits the intervals of b at which p can be reached with the last joints held.
    fn spans(&self, p: Vector, held: &PerDrive, mut take: impl FnMut([f64; 2])) {
        if let Some((map, shift)) = self.three(held) {
            map.spans(p, |[low, high]| take([low + shift, high + shift]));
        }
    }

    /// Whether any pose is at a distance from B, m. If so, and without critical values there, every b has such poses.
    pub(super) fn any_pose(&self, distance: f64, grid: &ReachGrid) -> bool {
        let starts = START_SAMPLES[usize::from(grid.careful)];
        match self.drives() {
            ..4 => self.has_isolated_pose(Vector::new(distance, 0.0), 0.0),
            _ if distance <= BASE_RADIUS * self.farthest() => self.has_pose_at_base(starts),
            _ if (0..starts).any(|i| self.pose_at_distance(distance, self.sample(i)).is_some()) => true,
            // By continuity, a pose farther from B and one at B imply one at this distance.
            _ => {
                let distance_of = |i: usize| self.end_effector(&DriveAngles(self.unturned(&self.sample(i)))).norm();
                (0..starts).any(|i| distance_of(i) >= distance) && self.has_pose_at_base(starts)
            }
        }
    }

    /// Whether a pose at B is found from one of the first `starts` samples; if so, one exists at every b.
    fn has_pose_at_base(&self, starts: usize) -> bool {
        let windows = self.windows();
        let leads = |a: &PerDrive| self.solved(Vector::default(), 0.0, a, &windows).is_some();
        (0..starts).map(|i| self.sample(i)).any(|a| {
            leads(&a) || self.pose_at_distance(NEAR_BASE_DISTANCE * self.farthest(), a).is_some_and(|near| leads(&near))
        })
    }

    /// Whether a pose at a point and b is found from any sample.
    fn is_reached_from_samples(&self, p: Vector, b: f64) -> bool {
        let mut any = false;
        self.each_spread(p, b, &mut |_| {
            any = true;
            false
        });
        any
    }

    /// Finds a pose at a distance from B, m, by coordinate descent. The joints turn one after another, each to the
    /// angle that brings the end effector nearest to this distance.
    fn pose_at_distance(&self, distance: f64, mut a: PerDrive) -> Option<PerDrive> {
        let far = self.farthest();
        let at = |a: &PerDrive| self.end_effector(&DriveAngles(self.unturned(a)));
        let mut missing = f64::INFINITY;
        for _ in 0..MAX_SWEEPS {
            let before = missing;
            for i in 0..a.len() {
                let own = a[i];
                let here = at(&a);
                a[i] = own + PI;
                let there = at(&a);
                // The joint turns one part of the arm about the other.
                let (still, turning) = (0.5 * (here + there), 0.5 * (here - there));
                let [low, high] = self.joints[i].limits;
                let apart = (turning * still.conj()).arg();
                let sense = self.joints[i].sense;
                let [from, to] = [low, high].map(|end| apart + sense * (end - own));
                let (from, to) = (from.min(to), from.max(to));
                // The distance is extreme where the two parts are in line, at the angles 0 and π between them, or at
                // the limits.
                let inside = |line: f64| Some(line + ((from - line) / TAU).ceil() * TAU).filter(|x| *x <= to);
                let length = |angle: f64| (still + turning * unit(angle - apart)).norm();
                let ends = if length(from) < length(to) { [from, to] } else { [to, from] };
                let [least, most] = [inside(PI).unwrap_or(ends[0]), inside(0.0).unwrap_or(ends[1])];
                let lengths = [length(least), length(most)];
                if lengths[0] <= distance && distance <= lengths[1] {
                    let sizes = [still.norm(), turning.norm()];
                    let square = distance * distance - sizes[0] * sizes[0] - sizes[1] * sizes[1];
                    let bend = (square / (2.0 * sizes[0] * sizes[1])).clamp(-1.0, 1.0).acos();
                    // The nearest solution in the range; rounding may exclude both.
                    let both = [bend, -bend].map(|line| line + ((from - line) / TAU).ceil() * TAU);
                    let there = both
                        .into_iter()
                        .filter(|x| *x <= to)
                        .min_by(|x, y| (x - apart).abs().total_cmp(&(y - apart).abs()))?;
                    a[i] = (own + sense * (there - apart)).clamp(low, high);
                    return Some(a);
                }
                let best = if distance < lengths[0] { least } else { most };
                a[i] = (own + sense * (best - apart)).clamp(low, high);
                missing = (length(best) - distance).abs();
            }
            if before - missing <= MIN_SWEEP_GAIN * far {
                break;
            }
        }
        None
    }

    /// Whether a pose exists at a point and b, for up to three drives.
    fn has_isolated_pose(&self, p: Vector, b: f64) -> bool {
        let mut any = false;
        self.each_pose(p, b, &mut |_| {
            any = true;
            false
        });
        any
    }

    /// Returns the plane map of the first two joints with all others held, and the offset to add to its b, rad.
    pub(super) fn three(&self, held: &PerDrive) -> Option<(PlaneMap, f64)> {
        let n = self.drives();
        let (mut of, mut delta, mut count) = ([0; MAX_DRIVES], [0.0; MAX_DRIVES], 1);
        for (i, joint) in self.joints.iter().enumerate() {
            let [near, far] = joint.ends;
            if i < 2 {
                of[far] = count;
                count += 1;
            } else {
                of[far] = of[near];
                delta[far] = delta[near] + joint.sense * (held[i] - joint.offset);
            }
        }
        let (mut arm, mut lambda) = ([Vector::default(); 3], [0.0; 3]);
        for k in 0..n {
            arm[of[k]] += self.arms[k] * unit(delta[k]);
            lambda[of[k]] += self.lambda[k];
        }
        let lean = arm.map(|l| l.arg());
        let angle = |i: usize| {
            let joint = &self.joints[i];
            let [near, far] = joint.ends;
            let (to, from) = if joint.sense > 0.0 { (far, near) } else { (near, far) };
            let at = |k: usize| delta[k] - lean[of[k]];
            AngleDefinition { to: of[to], from: of[from], offset: joint.offset + at(to) - at(from) }
        };
        let limit = |i: usize| AngleLimit { min: self.joints[i].limits[0], max: self.joints[i].limits[1] };
        let map = PlaneMap::new(arm.map(|l| l.norm()), lambda, [angle(0), angle(1)], [limit(0), limit(1)]).ok()?;
        // b = Σ Λ_i (Q'_i − lean_i) + Σ λ_k δ_k, with the drive angles Q' and the weights Λ = `lambda` of the map.
        let shift =
            (0..n).map(|k| self.lambda[k] * delta[k]).sum::<f64>() - (0..3).map(|i| lambda[i] * lean[i]).sum::<f64>();
        Some((map, shift))
    }
}
