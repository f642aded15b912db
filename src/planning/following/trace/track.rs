//! Following a curve on a plane step by step: poses with derivatives, and the reason for a stop.

use super::rule::{Rule, SheetEnd, TraceEnd, crossed};
use crate::curves::PathPoint;
use crate::curves::curve::{Curve, CurvePoint};
use crate::curves::table::PathTable;
use crate::off_plane::inverse::rates;
use crate::reactionless::{LIMIT_SLACK, PlaneMap, PlanePoint};
use stillbase_mechanics::planar::{DriveAngles, PerDrive, Vector};

/// Minimum step of s; if even this fails, the curve cannot be followed further.
const MIN_STEP: f64 = 1e-11;

/// Constant part of the maximum distance of a pose from its tangent prediction, rad; a quarter of the change of pose
/// is added. Beyond the sum the step is halved.
const MAX_PREDICTION_ERROR_RAD: f64 = 0.02;

/// Tolerance of the quintics between nodes, rad: above it an interval is halved.
const MAX_QUINTIC_ERROR_RAD: f64 = 2e-11;

/// Tolerance of the quintics in the shortest intervals, close to a fold, rad.
const MAX_QUINTIC_ERROR_NEAR_FOLD_RAD: f64 = 1e-8;
/// Initial number of intervals between nodes on a piece of a curve.
const INITIAL_INTERVALS: usize = 8;
/// If a curve has more pieces than this, each begins with one interval.
const MANY_PIECES: usize = 200;
/// Minimum length of an interval, as a fraction of its piece.
const MIN_INTERVAL: f64 = 1e-6;
/// Maximum number of nodes of a curve, besides four for each piece.
const MAX_NODES: usize = 20_000;

/// A curve on a plane.
#[derive(Clone, Copy)]
pub(super) struct PlaneTrack<'a> {
    pub map: &'a PlaneMap,
    pub b: f64,
    pub turn: Vector,
    pub curve: &'a Curve,
    pub rule: Rule,
}

impl PlaneTrack<'_> {
    /// Follows the curve from the pose at one s to that at another and returns the latter, rad.
    pub fn advance(&self, mut a: [f64; 2], from: f64, to: f64) -> Result<[f64; 2], TraceEnd> {
        let (mut s, mut step) = (from, to - from);
        let mut here = self.jet(a, s);
        while s < to {
            let next = if s + step >= to { to } else { s + step };
            let ahead = [0, 1].map(|i| a[i] + (next - s) * here.first[i]);
            let found =
                self.map.follow(self.curve.at(next).p, self.b, a).filter(|x| self.rule.keeps_side(self.map, a, *x));
            let near = |x: &[f64; 2]| {
                let step = (x[0] - a[0]).hypot(x[1] - a[1]);
                (x[0] - ahead[0]).hypot(x[1] - ahead[1]) <= MAX_PREDICTION_ERROR_RAD + 0.25 * step
            };
            match found.filter(near) {
                Some(x) => {
                    let there = self.jet(x, next);
                    self.keeps_limits(s, here, next, there)?;
                    (a, s, here) = (x, next, there);
                    step *= 2.0;
                }
                None if step > MIN_STEP => step *= 0.5,
                None => return Err((s, a, self.stop(a, here.first))),
            }
        }
        Ok(a)
    }

    /// Returns (a_1, a_2) with derivatives by s, for the pose at s.
    fn jet(&self, a: [f64; 2], s: f64) -> Jet {
        let CurvePoint { first, second, .. } = self.curve.at(s);
        let [first, second] = rates(self.map, a, first * self.turn, second * self.turn);
        Jet { a, first, second }
    }

    /// Returns why a pose cannot be left along a tangent.
    fn stop(&self, a: [f64; 2], tangent: [f64; 2]) -> SheetEnd {
        let length = tangent[0].hypot(tangent[1]);
        let ahead = [0, 1].map(|i| a[i] + 1e-5 * tangent[i] / length);
        if let (true, Some(drives)) = (self.rule.keep_off_change_points, crossed(self.map, a, ahead)) {
            return SheetEnd::ChangePoint { drives };
        }
        let limits = self.map.limits();
        for (angle, limit) in limits.iter().enumerate() {
            let out = [(a[angle] - limit.min, false, -tangent[angle]), (limit.max - a[angle], true, tangent[angle])];
            for (room, upper, outwards) in out {
                if room < 1e-6 && outwards > 0.0 {
                    return SheetEnd::Limit { angle, upper };
                }
            }
        }
        SheetEnd::Fold
    }

    /// Returns nodes along the curve; intervals are halved until their quintics meet the tolerance.
    pub fn table(&self, start: [f64; 2]) -> Result<PathTable, TraceEnd> {
        let (mut stations, mut nodes) = (vec![0.0], vec![self.jet(start, 0.0)]);
        let joints: Vec<f64> = self.curve.joints().collect();
        let mut ahead: Vec<f64> = Vec::with_capacity(64);
        let pieces = joints.len() - 1;
        // Curves with very many pieces, such as those through samples, have short pieces.
        let spaces = if pieces > MANY_PIECES { 1 } else { INITIAL_INTERVALS };
        for ends in joints.windows(2) {
            let run = ends[1] - ends[0];
            let station = |i: usize| if i == spaces { ends[1] } else { ends[0] + run * i as f64 / spaces as f64 };
            ahead.extend((1..=spaces).rev().map(station));
            while let Some(&next) = ahead.last() {
                let (s, here) = (stations[stations.len() - 1], nodes[nodes.len() - 1]);
                let there = self.jet(self.advance(here.a, s, next)?, next);
                let error = self.quintic_error(s, here, next, there);
                if error < MAX_QUINTIC_ERROR_RAD
                    || (next - s < MIN_INTERVAL * run && error < MAX_QUINTIC_ERROR_NEAR_FOLD_RAD)
                {
                    stations.push(next);
                    nodes.push(there);
                    ahead.pop();
                } else if next - s < MIN_INTERVAL * run || nodes.len() > MAX_NODES + 4 * pieces {
                    // Too close to a fold for any node density.
                    return Err((s, here.a, SheetEnd::Fold));
                } else {
                    ahead.push(0.5 * (s + next));
                }
            }
        }
        let lifted = nodes.iter().map(|jet| self.lifted(jet)).collect();
        let last = stations.len() - 1;
        stations[last] = 1.0;
        PathTable::new(stations, lifted).ok_or((0.0, start, SheetEnd::Start))
    }

    /// Returns the error of the quintic halfway between two nodes, rad.
    fn quintic_error(&self, s: f64, x: Jet, t: f64, y: Jet) -> f64 {
        let middle =
            [0, 1].map(|i| hermite([x.a[i], x.first[i], x.second[i]], [y.a[i], y.first[i], y.second[i]], t - s, 0.5));
        match self.map.follow(self.curve.at(0.5 * (s + t)).p, self.b, x.a) {
            Some(a) => (a[0] - middle[0]).abs().max((a[1] - middle[1]).abs()),
            None => f64::INFINITY,
        }
    }

    /// Checks that no angle exceeds its limit between two nodes, where it may have an extremum.
    fn keeps_limits(&self, s: f64, x: Jet, t: f64, y: Jet) -> Result<(), TraceEnd> {
        const PROBES: i32 = 16;
        let limits = self.map.limits();
        for (i, limit) in limits.iter().enumerate() {
            if x.first[i] * y.first[i] >= 0.0 {
                continue;
            }
            let at = |u: f64| hermite([x.a[i], x.first[i], x.second[i]], [y.a[i], y.first[i], y.second[i]], t - s, u);
            let past = |u: f64| (at(u) - limit.max).max(limit.min - at(u));
            let probes = (1..PROBES).map(|k| f64::from(k) / f64::from(PROBES));
            let Some(mut bad) = probes.max_by(|u, v| past(*u).total_cmp(&past(*v))) else { continue };
            // The extremum between the probes, to second order.
            let d = 1.0 / f64::from(PROBES);
            let [before, here, after] = [past(bad - d), past(bad), past(bad + d)];
            let shift = 0.5 * d * (before - after) / (before - 2.0 * here + after);
            if shift.is_finite() && past(bad + shift) > here {
                bad += shift;
            }
            if past(bad) <= LIMIT_SLACK {
                continue;
            }
            // The quintic of a long interval is inaccurate: its excess counts only if the pose there is infeasible.
            if self.map.follow(self.curve.at(s + (t - s) * bad).p, self.b, x.a).is_some() {
                continue;
            }
            let upper = at(bad) > limit.max;
            let mut good = 0.0;
            for _ in 0..50 {
                let middle = 0.5 * (good + bad);
                if past(middle) <= 0.0 { good = middle } else { bad = middle }
            }
            let end = s + (t - s) * good;
            let a = self.map.follow(self.curve.at(end).p, self.b, x.a).unwrap_or(x.a);
            return Err((end, a, SheetEnd::Limit { angle: i, upper }));
        }
        Ok(())
    }

    fn lifted(&self, jet: &Jet) -> PathPoint {
        PathPoint {
            q: DriveAngles::from(self.map.lift(PlanePoint { a: jet.a, b: self.b })),
            first: PerDrive::from(self.map.lift_rates(jet.first, 0.0)),
            second: PerDrive::from(self.map.lift_rates(jet.second, 0.0)),
        }
    }
}

/// Plane coordinates with derivatives by s.
#[derive(Clone, Copy)]
struct Jet {
    a: [f64; 2],
    first: [f64; 2],
    second: [f64; 2],
}

/// Evaluates, at the fraction u of an interval of length h, the quintic through value and two derivatives at both
/// ends.
fn hermite(from: [f64; 3], to: [f64; 3], h: f64, u: f64) -> f64 {
    let (c1, c2) = (from[1] * h, 0.5 * from[2] * h * h);
    let (v, v1, v2) = (to[0] - from[0] - c1 - c2, to[1] * h - c1 - 2.0 * c2, to[2] * h * h - 2.0 * c2);
    let (c3, c4, c5) = (10.0 * v - 4.0 * v1 + 0.5 * v2, -15.0 * v + 7.0 * v1 - v2, 6.0 * v - 3.0 * v1 + 0.5 * v2);
    from[0] + u * (c1 + u * (c2 + u * (c3 + u * (c4 + u * c5))))
}
