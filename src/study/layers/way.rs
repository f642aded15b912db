//! [`TaskPoses`]: the poses along a task, close enough to each other to see what meets between them.

use stillbase_mechanics::planar::{PerDrive, UnitVectors};
use stillbase_planning::Motion;

use super::overlap::{Pair, TOLERANCE};
use super::plan::Nearness;

/// Number of instants at which a motion is sampled.
const SAMPLES: usize = 2000;

/// A pose along a task.
#[derive(Clone, Copy, Debug)]
pub struct TaskPose {
    /// Time, s.
    pub time: f64,
    /// Angles of the drives, rad.
    pub q: PerDrive,
    /// Their rates, rad/s.
    pub qd: PerDrive,
    /// Their accelerations, rad/s².
    pub qdd: PerDrive,
    /// Unit vectors of the drives.
    pub e: UnitVectors,
}

/// The poses along a task, in the order of time.
#[derive(Clone, Debug)]
pub struct TaskPoses {
    poses: Vec<TaskPose>,
}

impl TaskPoses {
    /// Samples a motion.
    pub fn of(motion: &Motion) -> Self {
        let whole = motion.duration();
        let pose = |i: usize| {
            let time = whole * i as f64 / SAMPLES as f64;
            let at = motion.at(time);
            TaskPose { time, q: PerDrive::from_fn(at.q.len(), |k| at.q[k]), qd: at.qd, qdd: at.qdd, e: at.q.units() }
        };
        Self { poses: (0..=SAMPLES).map(pose).collect() }
    }

    /// Returns the poses.
    pub fn poses(&self) -> &[TaskPose] {
        &self.poses
    }

    /// Returns the pose in which two solids are nearest, and how near they are.
    pub fn nearest(&self, pair: &Pair<'_>) -> Option<(TaskPose, Nearness)> {
        let near = self.poses.iter().map(|pose| (*pose, pair.at(&pose.e)));
        near.reduce(|best, next| if next.1.gap < best.1.gap { next } else { best })
    }

    /// Returns the first pose in which two solids meet, and whether they meet for certain. Between two samples they
    /// may come nearer by as much as their points move from one to the other.
    pub(super) fn first_meeting(&self, pair: &Pair<'_>) -> Option<(TaskPose, Nearness, bool)> {
        let mut doubtful = None;
        for (i, pose) in self.poses.iter().enumerate() {
            let near = pair.at(&pose.e);
            if near.gap < 0.0 {
                return Some((*pose, near, true));
            }
            let before = &self.poses[i.saturating_sub(1)];
            let moved = pair
                .motion(|k| pose.q.get(k).copied().unwrap_or_default() - before.q.get(k).copied().unwrap_or_default());
            if doubtful.is_none() && near.gap < moved.max(TOLERANCE) {
                doubtful = Some((*pose, near, false));
            }
        }
        doubtful
    }
}
