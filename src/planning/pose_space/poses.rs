//! Poses of a point at a b: all of them if they are isolated, otherwise the one nearest to given angles.

use super::continuation::{FULL_CONTINUATION, SHORT_CONTINUATION};
use super::nearest::PreferredAngles;
use super::space::PoseSpace;
use stillbase_mechanics::planar::{DriveAngles, MAX_DRIVES, PerDrive, Vector, unit};

/// Tolerance of position with two drives, as a fraction of the reach. It admits errors of b by this fraction of Σλ,
/// such as those of a b printed with nine digits.
const B_TOLERANCE: f64 = 1e-6;
/// With four and more drives: number of samples over all joint ranges, and of starts from which the nearest pose is
/// sought.
const START_SAMPLES: usize = 32;
const MAX_DESCENTS: usize = 12;
/// Maximum number of climbs from critical poses once a pose has been found; until then, all are tried.
const MAX_CLIMBS: usize = 32;
/// Poses whose angles all differ by less than this are equal, rad.
const SAME_POSE_RAD: f64 = 1e-6;
/// Primes, whose square roots generate the sequence of samples.
const PRIMES: [f64; MAX_DRIVES - 1] = [2.0, 3.0, 5.0, 7.0, 11.0, 13.0, 17.0];

impl PoseSpace {
    /// Returns poses within the limits that put the end effector on `p`, m, at `b`, rad, which is not wrapped. With up
    /// to three drives these are all poses, sorted by Σ (a_i − near_i)²; with more only the nearest one by that
    /// measure.
    pub fn poses(&self, p: Vector, b: f64, near: &[f64]) -> Vec<DriveAngles> {
        let far = |a: &PerDrive| a.iter().zip(near).map(|(a, near)| (a - near) * (a - near)).sum::<f64>();
        let mut poses: Vec<(f64, PerDrive)> = match self.drives() {
            ..4 => self.representative_poses(p, b).into_iter().map(|a| (far(&a), a)).collect(),
            _ => self.nearest_pose(p, b, near).into_iter().map(|a| (0.0, a)).collect(),
        };
        poses.sort_by(|x, y| x.0.total_cmp(&y.0));
        poses.iter().map(|(_, a)| self.lift(a, b)).collect()
    }

    /// Returns relative angles of poses at `p`, m, and `b`, rad: of all poses with up to three drives. With more, of
    /// poses found by climbs from critical poses and from samples, in no particular order. As soon as one is found,
    /// climbs beyond the first `MAX_CLIMBS` are skipped, so a connected component may be missed.
    pub fn representative_poses(&self, p: Vector, b: f64) -> Vec<PerDrive> {
        if let Some(map) = self.map() {
            return map.poses(p, b).iter().map(|pose| PerDrive::from(pose.a)).collect();
        }
        let mut poses: Vec<PerDrive> = Vec::new();
        let mut take = |a: &PerDrive| {
            let is_new = poses.iter().all(|other| other.minus(a).max_abs() > SAME_POSE_RAD);
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

    /// Whether a pose within the limits puts the end effector on `p`, m, at `b`, rad.
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

    /// Visits poses of four and more drives until `take` returns false. They are found by climbs from critical poses,
    /// and by Newton's iteration from samples of all joint ranges.
    fn each_found(&self, p: Vector, b: f64, take: &mut impl FnMut(&PerDrive) -> bool) {
        let serves = |careful| self.reach_with(p, careful).is_ok_and(|set| set.contains(b));
        if !serves(false) && !serves(true) {
            return;
        }
        let (p, b) = (Vector::new(p.norm(), 0.0), b - p.arg() * self.lambda_sum);
        let starts = self.starts(p.re);
        let mut any = false;
        for (i, climb) in self.climbs(&starts, b).iter().enumerate() {
            if any && i >= MAX_CLIMBS {
                break;
            }
            if let Some(a) = self.climbed(p, climb, if any { SHORT_CONTINUATION } else { FULL_CONTINUATION }) {
                any = true;
                if !take(&a) {
                    return;
                }
            }
        }
        self.each_spread(p, b, take);
    }

    /// Visits the poses found from samples of all joint ranges until `take` returns false.
    pub(super) fn each_spread(&self, p: Vector, b: f64, take: &mut impl FnMut(&PerDrive) -> bool) {
        let windows = self.windows();
        for a in (0..START_SAMPLES).map(|i| self.sample(i)) {
            if self.solved(p, b, &a, &windows).is_some_and(|a| !take(&a)) {
                return;
            }
        }
    }

    /// Returns the relative angles, rad, of sample i of an infinite sequence that fills all joint ranges evenly.
    pub(crate) fn sample(&self, i: usize) -> PerDrive {
        PerDrive::from_fn(self.joints.len(), |j| {
            let [low, high] = self.joints[j].limits;
            // Fractional parts of multiples of square roots of primes.
            let share = ((i as f64 + 0.5) * PRIMES[j].sqrt()).fract();
            low + share * (high - low)
        })
    }

    /// Returns the pose of four and more drives that is nearest to given relative angles. It is the best of the local
    /// minima found from the nearest starts.
    fn nearest_pose(&self, p: Vector, b: f64, near: &[f64]) -> Option<PerDrive> {
        let (n, windows) = (self.joints.len(), self.windows());
        let near = PerDrive::from_fn(n, |i| near[i]);
        let wish = PreferredAngles { angles: near, weight: PerDrive::from_fn(n, |_| 1.0) };
        let far = |a: &PerDrive| a.minus(&near).dot(&a.minus(&near));
        let own = PerDrive::from_fn(n, |i| near[i].clamp(windows[i][0], windows[i][1]));
        let mut starts = self.representative_poses(p, b);
        starts.extend(self.solved(p, b, &own, &windows));
        starts.sort_by(|x, y| far(x).total_cmp(&far(y)));
        let drawn = starts.iter().take(MAX_DESCENTS).map(|a| self.nearest_to_wish(p, b, a, &wish, &windows));
        drawn.min_by(|x, y| far(x).total_cmp(&far(y)))
    }

    /// Visits the relative angles of all poses of up to three drives until `take` returns false.
    pub(super) fn each_pose(&self, p: Vector, b: f64, take: &mut impl FnMut(&PerDrive) -> bool) {
        match self.drives() {
            1 => {
                let place = self.end_effector(&self.lift(&[], b));
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

    /// Visits the poses of two drives until `take` returns false: a point has two elbow configurations, each at a
    /// different b.
    fn elbows(&self, p: Vector, b: f64, take: &mut impl FnMut(&PerDrive) -> bool) {
        let [l, m] = [self.arms[0], self.arms[1]];
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
                // The point belongs to this b if the pose with this angle and b reaches it.
                let miss = (self.end_effector(&self.lift(&a, b)) - p).norm();
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
