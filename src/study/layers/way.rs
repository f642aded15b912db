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

    /// Returns the pose in which two solids are nearest, and how near they are, if they come nearer than `limit`, m.
    pub fn nearest(&self, pair: &Pair<'_>, limit: f64) -> Option<(TaskPose, Nearness)> {
        let mut best: Option<(TaskPose, Nearness)> = None;
        // How far the two still must move until they can be nearer than the best.
        let mut free = 0.0;
        for (i, pose) in self.poses.iter().enumerate() {
            free -= self.moved(pair, i);
            if free > 0.0 {
                continue;
            }
            let near = pair.at(&pose.e);
            let least = best.map_or(limit, |(_, near)| near.gap);
            if near.gap < least {
                best = Some((*pose, near));
            }
            free = near.gap - least;
        }
        best
    }

    /// Returns the first pose in which two solids meet, and whether they meet for certain. Between two samples they
    /// may come nearer by as much as their points move from one to the other. The work is taken from `budget`, in pairs
    /// of sides; without any left, they may meet.
    pub(super) fn first_meeting(&self, pair: &Pair<'_>, budget: &mut usize) -> Option<(TaskPose, Nearness, bool)> {
        let mut doubtful = None;
        // A lower bound of the gap, m.
        let mut least = 0.0;
        for (i, pose) in self.poses.iter().enumerate() {
            let moved = self.moved(pair, i);
            let close = moved.max(TOLERANCE);
            least -= moved;
            if least >= close {
                continue;
            }
            let near = pair.at(&pose.e);
            if near.gap < 0.0 {
                return Some((*pose, near, true));
            }
            least = near.gap;
            if doubtful.is_none() && (near.gap < close || *budget < pair.cost()) {
                doubtful = Some((*pose, near, false));
            }
            if *budget < pair.cost() {
                break;
            }
            *budget -= pair.cost();
        }
        doubtful
    }

    /// Returns the most that points of two solids move relative to each other from the pose before to pose i, m.
    fn moved(&self, pair: &Pair<'_>, i: usize) -> f64 {
        let (pose, before) = (&self.poses[i], &self.poses[i.saturating_sub(1)]);
        let angle = |q: &PerDrive, k: usize| q.get(k).copied().unwrap_or_default();
        pair.motion(|k| angle(&pose.q, k) - angle(&before.q, k))
    }
}
