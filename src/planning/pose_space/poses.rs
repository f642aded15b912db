//! Poses of a point on the set of a b: all where no freedom is left but elbows, the nearest one where more is.

use super::continuation::{BRIEF, THOROUGH};
use super::nearest::Wish;
use super::space::PoseSpace;
use crate::mechanics::planar::{DriveAngles, MAX_DRIVES, PerDrive, Vector, unit};

/// b of a pose of two drives may be off by this much, rad: what nine printed digits leave.
const B_TOLERANCE: f64 = 1e-6;
/// Poses of four drives and more to begin with, spread evenly over all ranges, and how many are gone on from.
const SPREAD: usize = 32;
const GONE_ON_FROM: usize = 12;
/// Ways from critical poses at most, once a pose is found.
const MAX_CLIMBS: usize = 32;
/// Poses whose angles differ by less are one, rad.
const SAME_POSE: f64 = 1e-6;
const PRIMES: [f64; MAX_DRIVES - 1] = [2.0, 3.0, 5.0, 7.0, 11.0, 13.0, 17.0];

impl PoseSpace {
    /// Poses within the limits that put the end effector on `p`, m, at `b`, rad, which is not wrapped: with two and
    /// three drives all of them, those nearest to the given relative angles first; with more the nearest one, by
    /// Σ (a_i − near_i)².
    pub fn poses(&self, p: Vector, b: f64, near: &[f64]) -> Vec<DriveAngles> {
        let far = |a: &PerDrive| a.iter().zip(near).map(|(a, near)| (a - near) * (a - near)).sum::<f64>();
        let mut poses: Vec<(f64, PerDrive)> = match self.drives() {
            ..4 => self.sheets(p, b).into_iter().map(|a| (far(&a), a)).collect(),
            _ => self.nearest_pose(p, b, near).into_iter().map(|a| (0.0, a)).collect(),
        };
        poses.sort_by(|x, y| x.0.total_cmp(&y.0));
        poses.iter().map(|(_, a)| self.lift(a, b)).collect()
    }

    /// Relative angles of poses at `p`, m, and `b`, rad: with up to three drives all of them. With more, at least one of
    /// each piece that these poses consist of, and others that are spread over it, in no order.
    pub fn sheets(&self, p: Vector, b: f64) -> Vec<PerDrive> {
        if let Some(map) = self.map() {
            return map.poses(p, b).iter().map(|pose| PerDrive::from(pose.a)).collect();
        }
        let mut poses: Vec<PerDrive> = Vec::new();
        let mut take = |a: &PerDrive| {
            let is_new = poses.iter().all(|other| other.minus(a).max_abs() > SAME_POSE);
            if is_new {
                poses.push(*a);
            }
            true
        };
        if self.drives() > 3 {
            self.each_found(p, b, &mut take);
        } else {
            self.each_pose(p, b, &mut take);
        }
        poses
    }

    /// Whether some pose within the limits puts the end effector on `p`, m, at `b`, rad.
    pub fn reaches(&self, p: Vector, b: f64) -> bool {
        if let Some(map) = self.map() {
            return !map.poses(p, b).is_empty();
        }
        let mut any = false;
        let mut take = |_: &PerDrive| {
            any = true;
            false
        };
        if self.drives() > 3 {
            self.each_found(p, b, &mut take);
        } else {
            self.each_pose(p, b, &mut take);
        }
        any
    }

    /// Poses of four drives and more, while more are wanted: by climbing from critical poses, and by going there from all
    /// over the ranges.
    fn each_found(&self, p: Vector, b: f64, take: &mut impl FnMut(&PerDrive) -> bool) {
        let serves = |careful| self.reach_with(p, careful).is_ok_and(|set| set.contains(b));
        if !serves(false) && !serves(true) {
            return;
        }
        let (p, b) = (Vector::new(p.norm(), 0.0), b - p.arg() * self.sum);
        let starts = self.starts(p.re);
        let mut any = false;
        for (i, climb) in self.climbs(&starts, b).iter().enumerate() {
            if any && i >= MAX_CLIMBS {
                break;
            }
            if let Some(a) = self.climbed(p, climb, if any { BRIEF } else { THOROUGH }) {
                any = true;
                if !take(&a) {
                    return;
                }
            }
        }
        self.each_spread(p, b, take);
    }

    /// The same, from all over the ranges.
    pub(super) fn each_spread(&self, p: Vector, b: f64, take: &mut impl FnMut(&PerDrive) -> bool) {
        let windows = self.windows();
        for a in (0..SPREAD).map(|i| self.spread(i)) {
            if self.solved(p, b, &a, &windows).is_some_and(|a| !take(&a)) {
                return;
            }
        }
    }

    /// Relative angles of an endless sequence that fills all ranges evenly.
    pub(in crate::planning) fn spread(&self, i: usize) -> PerDrive {
        PerDrive::from_fn(self.joints.len(), |j| {
            let [low, high] = self.joints[j].limits;
            // Multiples of the square roots of primes.
            let share = ((i as f64 + 0.5) * PRIMES[j].sqrt()).fract();
            low + share * (high - low)
        })
    }

    /// The pose of four drives and more that is nearest to given relative angles: the nearest of those to which the
    /// nearest ones of every piece lead.
    fn nearest_pose(&self, p: Vector, b: f64, near: &[f64]) -> Option<PerDrive> {
        let (n, windows) = (self.joints.len(), self.windows());
        let near = PerDrive::from_fn(n, |i| near[i]);
        let wish = Wish { angles: near, weight: PerDrive::from_fn(n, |_| 1.0) };
        let far = |a: &PerDrive| a.minus(&near).dot(&a.minus(&near));
        let own = PerDrive::from_fn(n, |i| near[i].clamp(windows[i][0], windows[i][1]));
        let mut starts = self.sheets(p, b);
        starts.extend(self.solved(p, b, &own, &windows));
        starts.sort_by(|x, y| far(x).total_cmp(&far(y)));
        let drawn = starts.iter().take(GONE_ON_FROM).map(|a| self.drawn((p, b), a, &wish, &windows));
        drawn.min_by(|x, y| far(x).total_cmp(&far(y)))
    }

    /// Relative angles of all poses of up to three drives, while more are wanted.
    pub(super) fn each_pose(&self, p: Vector, b: f64, take: &mut impl FnMut(&PerDrive) -> bool) {
        match self.drives() {
            1 => {
                let place = self.place(&self.lift(&[], b));
                if (place - p).norm() <= 1e-6 * self.farthest() {
                    take(&PerDrive::zeros(0));
                }
            }
            2 => self.elbows(p, b, take),
            _ => {
                let Some((map, shift)) = self.three(&PerDrive::zeros(2)) else { return };
                for pose in map.poses(p, b - shift).iter() {
                    if !take(&PerDrive::from(pose.a)) {
                        return;
                    }
                }
            }
        }
    }

    /// Two drives: a point leaves two elbows, each with its own b.
    fn elbows(&self, p: Vector, b: f64, take: &mut impl FnMut(&PerDrive) -> bool) {
        let [l, m] = [self.tip[0], self.tip[1]];
        let cos = (p.norm_sqr() - l * l - m * m) / (2.0 * l * m);
        if cos.is_nan() || cos.abs() > 1.0 + 1e-12 {
            return;
        }
        let (joint, bend) = (&self.joints[0], cos.clamp(-1.0, 1.0).acos());
        for sign in [1.0, -1.0] {
            let between = sign * bend;
            let first = (p * (l + m * unit(between)).conj()).arg();
            let q = [first, first + between];
            let own = joint.of(&q);
            let [low, high] = joint.limits;
            let tau = std::f64::consts::TAU;
            let mut angle = own - tau * ((own - low + 1e-9) / tau).floor();
            while angle <= high + 1e-9 {
                let a = PerDrive::from([angle.clamp(low, high)]);
                // The point is on this set if the pose with this angle is there at this b.
                let miss = (self.place(&self.lift(&a, b)) - p).norm();
                if miss <= B_TOLERANCE * self.farthest() && !take(&a) {
                    return;
                }
                angle += tau;
            }
            if bend == 0.0 {
                return;
            }
        }
    }
}
