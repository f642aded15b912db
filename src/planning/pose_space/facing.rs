//! Poses of a point and a b with one drive at a given angle.

use std::f64::consts::TAU;

use super::joint::Joint;
use super::pattern::Patterns;
use super::space::PoseSpace;
use crate::mechanics::planar::{DriveAngles, PerDrive, Vector, unit};

/// Whole turns of that drive either way from the middle of its range.
const MAX_TURNS: i32 = 3;
/// Rounding of a limit, rad.
const LIMIT_ROUNDING: f64 = 1e-9;

impl PoseSpace {
    /// Poses of four drives and more within the limits that put the end effector on `p`, m, at `b`, rad, with a drive at
    /// an angle, rad, whole turns aside: those nearest to the given relative angles first. Without one for a drive that
    /// others are joined to.
    pub fn facing(&self, p: Vector, b: f64, (drive, angle): (usize, f64), near: &[f64]) -> Vec<DriveAngles> {
        let Some((rest, joint)) = self.without(drive) else { return Vec::new() };
        let left = p - self.tip[drive] * unit(angle);
        let about = ((self.lift(&self.middle(), b)[drive] - angle) / TAU).round();
        let mut found: Vec<(f64, DriveAngles)> = Vec::new();
        for turn in -MAX_TURNS..=MAX_TURNS {
            let own = angle + TAU * (about + f64::from(turn));
            let wanted: Vec<f64> = (0..self.joints.len()).filter(|i| *i != joint).map(|i| near[i]).collect();
            for others in rest.poses(left, b - self.lambda[drive] * own, &wanted) {
                let q = PerDrive::from_fn(self.drives(), |k| match k {
                    k if k == drive => own,
                    k => others[k - usize::from(k > drive)],
                });
                let [low, high] = self.joints[joint].bounds();
                let a = self.joints[joint].of(&q);
                if a >= low - LIMIT_ROUNDING && a <= high + LIMIT_ROUNDING {
                    let far = self.angles(&q).iter().zip(near).map(|(a, near)| (a - near) * (a - near)).sum();
                    found.push((far, DriveAngles(q)));
                }
            }
        }
        found.sort_by(|x, y| x.0.total_cmp(&y.0));
        found.into_iter().map(|(_, q)| q).collect()
    }

    /// The same machine less a drive to which no other is joined, and the joint that it had.
    fn without(&self, drive: usize) -> Option<(Self, usize)> {
        let mut own = self.joints.iter().enumerate().filter(|(_, joint)| joint.ends.contains(&drive));
        let (joint, _) = own.next().filter(|(_, joint)| joint.ends[1] == drive)?;
        let sum = self.sum - self.lambda[drive];
        if own.next().is_some() || sum <= 1e-9 || self.drives() < 4 {
            return None;
        }
        let place = |k: usize| k - usize::from(k > drive);
        let others = |of: &PerDrive| PerDrive::from_fn(of.len() - 1, |k| of[k + usize::from(k >= drive)]);
        let kept = self.joints.iter().enumerate().filter(|(i, _)| *i != joint);
        let joints = kept.map(|(_, joint)| Joint { ends: joint.ends.map(place), ..*joint }).collect();
        let mut rest = self.clone();
        (rest.tip, rest.lambda, rest.sum, rest.joints) = (others(&self.tip), others(&self.lambda), sum, joints);
        rest.patterns = Patterns::default();
        Some((rest, joint))
    }
}
