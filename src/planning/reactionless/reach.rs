//! The planes that contain a point: the pose constants at which it can be reached, and the self-motion between them,
//! Fig. 3.
//!
//! Source: (13)–(16). Points are joined by a reactionless path if and only if their sets of b have a common element.

use thiserror::Error;

use super::b_set::{BSet, wrap};
use super::decimal::metres_apart;
use super::plane::{LIMIT_SLACK, PlaneMap, PlanePoint};
use super::quadrilateral::{MonotoneArc, Quadrilateral, REACH_ROUNDING, Site};
use stillbase_mechanics::planar::Vector;

/// At corners of the limits, and where the arms are flat, a rounding error of the point moves the curve by its square
/// root. A pose there belongs to a curve that passes within this distance, rad.
const BRANCH_TOLERANCE_RAD: f64 = 1e-6;

/// Why a point cannot be reached at any b.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum NoReach {
    /// The point is beyond full stretch.
    #[error("the point is {} m from the base, but the arms reach only {} m", metres_apart(*.distance, *.farthest)[0], metres_apart(*.distance, *.farthest)[1])]
    TooFar {
        /// Distance from the base, m.
        distance: f64,
        /// Greatest distance that the arms reach, m.
        farthest: f64,
    },
    /// The point is too near to the base: one arm is longer than all others together.
    #[error("the point is {} m from the base, but the arms cannot come nearer than {} m", metres_apart(*.distance, *.nearest)[0], metres_apart(*.distance, *.nearest)[1])]
    TooNear {
        /// Distance from the base, m.
        distance: f64,
        /// Least distance that the arms reach, m.
        nearest: f64,
    },
    /// The arms are long enough, but the relative angles would pass their limits.
    #[error("the arms are long enough for the point, but the joint limits keep them from it")]
    Limits,
}

/// The poses within the limits with the end effector on a point.
enum SelfMotion {
    /// The point is B: these (a_1, a_2) put the end effector there at every b.
    EveryB(Vec<[f64; 2]>),
    /// Arcs along which b varies, and (a_1, a_2) of corners of the limits and of flat poses, which rounding may have
    /// removed from the arcs.
    Curve(Quadrilateral, Vec<MonotoneArc>, Vec<[f64; 2]>),
}

impl PlaneMap {
    /// Returns all b at which the end effector can be on `p`, m, within the limits, over all elbow configurations and
    /// sheets.
    ///
    /// # Errors
    /// If there are none: the reason.
    pub fn reach(&self, p: Vector) -> Result<BSet, NoReach> {
        let period = self.period();
        Ok(match self.curve(p)? {
            SelfMotion::EveryB(_) => BSet { intervals: vec![[0.0, period]], period },
            SelfMotion::Curve(_, arcs, points) => {
                let span = |arc: &MonotoneArc| [arc.from.b.min(arc.to.b), arc.from.b.max(arc.to.b)];
                points.iter().fold(BSet::union(arcs.iter().map(span).collect(), period), |set, &a| {
                    let b = self.b_of(p, a);
                    let near = set.nearest(b).filter(|near| (b - near).abs() < BRANCH_TOLERANCE_RAD).unwrap_or(b);
                    if near == b && set.contains(b) {
                        return set;
                    }
                    let mut parts = set.intervals;
                    parts.push([b.min(near), b.max(near)]);
                    BSet::union(parts, period)
                })
            }
        })
    }

    /// Visits intervals of b at which `p`, m, can be reached, unsorted and possibly overlapping; parts removed by
    /// rounding are missing. Faster than [`reach`](Self::reach) for tests at many points.
    pub(crate) fn spans(&self, p: Vector, mut take: impl FnMut([f64; 2])) {
        if self.within_reach(p).is_err() {
            return;
        }
        for slack in [0.0, LIMIT_SLACK] {
            let (curve, mut any) = (Quadrilateral::new(self, p, slack), false);
            if curve.is_at_base() {
                curve.triangles(|_| any = true);
                if any {
                    return take([0.0, self.period()]);
                }
                continue;
            }
            curve.arcs(|arc| {
                any = true;
                take([arc.from.b.min(arc.to.b), arc.from.b.max(arc.to.b)]);
            });
            if any {
                return;
            }
        }
    }

    /// Returns the self-motion that keeps the end effector on `p`, m. Each connected branch is a polyline, closed if
    /// its first and last poses are equal; Fig. 3 shows q_1 over b. Empty if the point cannot be reached at any b.
    ///
    /// b is continuous along a branch and starts in [0, period). A branch has `samples` points, denser towards its
    /// ends, plus the points where its arcs meet, such as where b turns back; one of zero length is one point.
    pub fn self_motion(&self, p: Vector, samples: usize) -> Vec<Vec<PlanePoint>> {
        let samples = samples.max(2);
        match self.curve(p) {
            Err(_) => Vec::new(),
            Ok(SelfMotion::EveryB(poses)) => {
                let b = |i: usize| self.period() * i as f64 / (samples - 1) as f64;
                poses.iter().map(|&a| (0..samples).map(|i| PlanePoint { a, b: b(i) }).collect()).collect()
            }
            Ok(SelfMotion::Curve(curve, arcs, points)) => {
                let mut lines: Vec<Vec<PlanePoint>> =
                    branches(arcs).iter().map(|branch| self.polyline(&curve, branch, samples)).collect();
                let near = |s: [f64; 2], t: [f64; 2]| (s[0] - t[0]).hypot(s[1] - t[1]) < BRANCH_TOLERANCE_RAD;
                for a in points {
                    if !lines.iter().flatten().any(|at| near(at.a, a)) {
                        lines.push(vec![PlanePoint { a, b: wrap(self.b_of(p, a), self.period()) }]);
                    }
                }
                lines
            }
        }
    }

    /// Returns b of the pose with (a_1, a_2) and the end effector on `p`, modulo the period, rad.
    fn b_of(&self, p: Vector, a: [f64; 2]) -> f64 {
        self.lambda_sum() * (p * self.forward_unturned(a).conj()).arg()
    }

    /// Checks whether the arms alone allow the distance of `p` from the base.
    fn within_reach(&self, p: Vector) -> Result<(), NoReach> {
        let lengths = self.c().map(f64::abs);
        let (distance, farthest) = (p.norm(), lengths.iter().sum::<f64>());
        let nearest = (2.0 * lengths.into_iter().fold(0.0, f64::max) - farthest).max(0.0);
        let within = distance <= farthest * (1.0 + REACH_ROUNDING);
        if !within {
            return Err(NoReach::TooFar { distance, farthest });
        }
        if distance < nearest - REACH_ROUNDING * farthest {
            return Err(NoReach::TooNear { distance, nearest });
        }
        Ok(())
    }

    fn curve(&self, p: Vector) -> Result<SelfMotion, NoReach> {
        self.within_reach(p)?;
        // A point on the workspace boundary may violate the limits by rounding.
        for slack in [0.0, LIMIT_SLACK] {
            let curve = Quadrilateral::new(self, p, slack);
            if curve.is_at_base() {
                let mut poses = Vec::new();
                curve.triangles(|a| poses.push(self.clamp(a)));
                if !poses.is_empty() {
                    return Ok(SelfMotion::EveryB(poses));
                }
                continue;
            }
            let mut arcs = Vec::with_capacity(16);
            curve.arcs(|arc| arcs.push(*arc));
            let mut points = Vec::new();
            curve.corners(|a| points.push(self.clamp(a)));
            curve.flat(|a| points.push(self.clamp(a)));
            if !(arcs.is_empty() && points.is_empty()) {
                return Ok(SelfMotion::Curve(curve, arcs, points));
            }
        }
        Err(NoReach::Limits)
    }

    fn polyline(&self, curve: &Quadrilateral, branch: &[Step], samples: usize) -> Vec<PlanePoint> {
        let length = branch.iter().map(Step::length).sum::<f64>();
        let period = self.period();
        let mut line: Vec<PlanePoint> = Vec::with_capacity(samples + branch.len() + 1);
        let put = |site: Site, line: &mut Vec<PlanePoint>| {
            // The b of consecutive arcs agree modulo the period.
            let b = match line.last() {
                Some(last) => site.b + period * ((last.b - site.b) / period).round(),
                None => wrap(site.b, period),
            };
            line.push(PlanePoint { a: self.clamp(curve.relative_angles(site.alpha, site.beta)), b });
        };
        let (mut behind, mut i) = (0.0, 0);
        for step in branch {
            put(step.start(), &mut line);
            while i < samples {
                let at = 0.5 * length * (1.0 - (std::f64::consts::PI * i as f64 / (samples - 1) as f64).cos());
                let t = (at - behind) / step.length();
                if t > 1.0 - 1e-9 {
                    break;
                }
                if t > 1e-9 {
                    put(curve.on(&step.arc, step.s(t)), &mut line);
                }
                i += 1;
            }
            behind += step.length();
        }
        if length > 0.0 {
            branch.iter().rev().take(1).for_each(|last| put(last.end(), &mut line));
        }
        line
    }
}

/// An arc of a branch, and the sense in which the branch traverses it.
struct Step {
    arc: MonotoneArc,
    forwards: bool,
}

impl Step {
    fn length(&self) -> f64 {
        (self.arc.s[1] - self.arc.s[0]).abs()
    }

    fn start(&self) -> Site {
        if self.forwards { self.arc.from } else { self.arc.to }
    }

    fn end(&self) -> Site {
        if self.forwards { self.arc.to } else { self.arc.from }
    }

    fn s(&self, t: f64) -> f64 {
        let t = if self.forwards { t } else { 1.0 - t };
        self.arc.s[0] + t * (self.arc.s[1] - self.arc.s[0])
    }
}

/// Joins arcs end to end into branches.
fn branches(mut arcs: Vec<MonotoneArc>) -> Vec<Vec<Step>> {
    // Rounding can leave a single point beside an arc that begins there.
    let meets = |s: &Site, t: &Site| (s.alpha - t.alpha).abs().max((s.beta - t.beta).abs()) < 1e-9;
    let lone = |i: usize, arcs: &[MonotoneArc]| {
        let point = arcs[i].from;
        !arcs.iter().enumerate().any(|(k, arc)| {
            let before = k < i || arc.s[0] != arc.s[1];
            k != i && before && (meets(&arc.from, &point) || meets(&arc.to, &point))
        })
    };
    let keep: Vec<bool> = (0..arcs.len()).map(|i| arcs[i].s[0] != arcs[i].s[1] || lone(i, &arcs)).collect();
    let mut keep = keep.into_iter();
    arcs.retain(|_| keep.next().unwrap_or(true));

    let take = |arcs: &mut Vec<MonotoneArc>, end: &Site| {
        let i = arcs.iter().position(|arc| meets(&arc.from, end) || meets(&arc.to, end))?;
        let arc = arcs.swap_remove(i);
        Some((arc, meets(&arc.from, end)))
    };
    let mut branches = Vec::new();
    while let Some(arc) = arcs.pop() {
        let mut branch = std::collections::VecDeque::from([Step { arc, forwards: true }]);
        while let Some((arc, forwards)) = branch.back().and_then(|last| take(&mut arcs, &last.end())) {
            branch.push_back(Step { arc, forwards });
        }
        while let Some((arc, backwards)) = branch.front().and_then(|first| take(&mut arcs, &first.start())) {
            branch.push_front(Step { arc, forwards: !backwards });
        }
        branches.push(branch.into());
    }
    branches
}
