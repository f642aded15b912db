//! Poses of a point at a b with one drive at a given angle.

use std::f64::consts::TAU;

use super::joint::RelativeJoint;
use super::pattern::Patterns;
use super::space::PoseSpace;
use stillbase_mechanics::planar::{DriveAngles, PerDrive, Vector, unit};

/// Number of whole turns of the given drive that are tried on either side of the middle of its range.
const MAX_TURNS: i32 = 3;
/// Tolerance of the joint limits for rounding, rad.
const LIMIT_TOLERANCE_RAD: f64 = 1e-9;

impl PoseSpace {
    /// Returns poses of four and more drives within the limits that put the end effector on `p`, m, at `b`, rad. One
    /// drive is at a given angle, rad, modulo whole turns. The poses nearest to the given relative angles come first.
    /// Returns no poses unless the given drive is at the end of the joint tree.
    pub fn poses_with_drive_angle(
        &self,
        p: Vector,
        b: f64,
        drive: usize,
        angle: f64,
        near: &[f64],
    ) -> Vec<DriveAngles> {
        let Some((rest, joint)) = self.without(drive) else { return Vec::new() };
        let rest_target = p - self.arms[drive] * unit(angle);
        let about = ((self.lift(&self.middle(), b)[drive] - angle) / TAU).round();
        let mut found: Vec<(f64, DriveAngles)> = Vec::new();
        for turn in -MAX_TURNS..=MAX_TURNS {
            let own = angle + TAU * (about + f64::from(turn));
            let wanted: Vec<f64> = (0..self.joints.len()).filter(|i| *i != joint).map(|i| near[i]).collect();
            for others in rest.poses(rest_target, b - self.lambda[drive] * own, &wanted) {
                let q = PerDrive::from_fn(self.drives(), |k| match k {
                    k if k == drive => own,
                    k => others[k - usize::from(k > drive)],
                });
                let [low, high] = self.joints[joint].bounds();
                let a = self.joints[joint].of(&q);
                if a >= low - LIMIT_TOLERANCE_RAD && a <= high + LIMIT_TOLERANCE_RAD {
                    let far = self.angles(&q).iter().zip(near).map(|(a, near)| (a - near) * (a - near)).sum();
                    found.push((far, DriveAngles(q)));
                }
            }
        }
        found.sort_by(|x, y| x.0.total_cmp(&y.0));
        found.into_iter().map(|(_, q)| q).collect()
    }

    /// Returns the space without a drive at the end of the joint tree, and the index of the removed joint.
    fn without(&self, drive: usize) -> Option<(Self, usize)> {
        let mut own = self.joints.iter().enumerate().filter(|(_, joint)| joint.ends.contains(&drive));
        let (joint, _) = own.next().filter(|(_, joint)| joint.ends[1] == drive)?;
        let sum = self.lambda_sum - self.lambda[drive];
        if own.next().is_some() || sum <= 1e-9 || self.drives() < 4 {
            return None;
        }
        let place = |k: usize| k - usize::from(k > drive);
        let others = |of: &PerDrive| PerDrive::from_fn(of.len() - 1, |k| of[k + usize::from(k >= drive)]);
        let kept = self.joints.iter().enumerate().filter(|(i, _)| *i != joint);
        let joints = kept.map(|(_, joint)| RelativeJoint { ends: joint.ends.map(place), ..*joint }).collect();
        let mut rest = self.clone();
        (rest.arms, rest.lambda, rest.lambda_sum, rest.joints) =
            (others(&self.arms), others(&self.lambda), sum, joints);
        rest.patterns = Patterns::default();
        Some((rest, joint))
    }
}
