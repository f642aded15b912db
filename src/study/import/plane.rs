//! A motion of the end effector on a plane b = const, for machines with closed-form planes. The path is followed on one
//! sheet of the plane.

use super::judge::{MotionCandidate, MotionEvaluator};
use crate::advice::Advice;
use stillbase_mechanics::planar::DriveAngles;
use stillbase_planning::curves::{Curve, Samples};
use stillbase_planning::following::{Rule, trace};
use stillbase_planning::pose_space::{Planes, PoseSpace};
use stillbase_planning::posed::poses_of_points;
use stillbase_planning::reactionless::{BSet, describe_interval};
use stillbase_session::scenario::{Task, TaskKind};

/// Number of points of a path at which the reachable b are computed.
const PATH_POINTS: usize = 257;

/// Returns the initial pose for minimum-norm rates, and the motion on a plane. Its b, rad, is the requested one, or one
/// that reaches the path.
pub(super) fn held_plane_motion(
    fixed_b: Option<f64>,
    judge: &MotionEvaluator,
    space: &PoseSpace,
    planes: &Planes,
    samples: &Samples,
    curve: &Curve,
) -> (Option<DriveAngles>, Result<Vec<MotionCandidate>, Advice>) {
    let (map, curves) = (planes.map(), std::slice::from_ref(curve));
    let (b, why) = match fixed_b {
        Some(b) => (b, "b is the one asked for".to_owned()),
        None => {
            let widest = |set: BSet| set.intervals.into_iter().max_by(|x, y| (x[1] - x[0]).total_cmp(&(y[1] - y[0])));
            let all = widest(trace::common_b(map, curves, PATH_POINTS));
            // If no b reaches all points, the attempt at a b that reaches the first point yields the reason.
            let first = map.reach(samples.point(0)).ok().and_then(widest);
            let what = if all.is_some() { "all of the path" } else { "its first point" };
            let range = all.or(first).unwrap_or([0.0; 2]);
            let b = 0.5 * (range[0] + range[1]);
            (
                b,
                format!(
                    "b is the middle of the interval of b that reach {what}, {} rad",
                    describe_interval(range[0], range[1])
                ),
            )
        }
    };
    let follow = |b: f64| trace::follow(map, curves, b, None, Rule::default()).map(|_| b);
    let followed = follow(b).map(|b| (b, why)).or_else(|stop| match (stop.nearest_b.zip(stop.displayed_b), fixed_b) {
        (Some((b, shown)), None) => {
            follow(b).map(|b| (b, format!("the whole path can be followed at b = {shown} rad")))
        }
        _ => Err(stop),
    });
    let b = followed.as_ref().map_or(b, |(b, _)| *b);
    let start = poses_of_points(space, &[samples.point(0)], b).ok().and_then(|poses| poses.first().map(|pose| pose.q));
    let candidates = followed.map_err(|stop| stop.to_string().into()).and_then(|(b, why)| {
        let task = Task::sampled(TaskKind::Given, samples.clone(), Some(b), &judge.machine);
        let task = task.map_err(|key| format!("the samples make no task: task.{key} is missing"))?;
        Ok(vec![MotionCandidate { method: "on-plane", why, task }])
    });
    (start, candidates)
}
