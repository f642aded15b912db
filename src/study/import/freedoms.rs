//! Motion of the end effector at constant b, for machines without planes whose workspace is an area. The first b and
//! posture that can be planned are used.

use super::judge::{MotionCandidate, MotionEvaluator};
use crate::advice::Advice;
use stillbase_mechanics::planar::{DriveAngles, Vector};
use stillbase_planning::curves::{Curve, Samples};
use stillbase_planning::pose_space::PoseSpace;
use stillbase_planning::posture::Posture;
use stillbase_planning::reactionless::{BSet, describe_interval};
use stillbase_query::ProgressCallback;
use stillbase_session::scenario::{Task, TaskKind};
use stillbase_settings::number::fixed;

/// Number of points of a path at which the reachable b are computed.
const PATH_POINTS: usize = 25;
/// Values of b to try, the best first, as fractions of the interval of b that reaches the whole path.
const B_FRACTIONS: [f64; 5] = [0.5, 0.3, 0.7, 0.1, 0.9];
/// Postures to try at each b, the best first.
const POSTURES: [Posture; 4] = [Posture::LeastRates, Posture::MidRange, Posture::LeastTorque, Posture::Orientation];

/// Returns the initial pose for minimum-norm rates, and the motion at the requested b, rad, or at a b that reaches the
/// whole path.
pub(super) fn held_b_motion(
    fixed_b: Option<f64>,
    judge: &MotionEvaluator,
    space: &PoseSpace,
    samples: &Samples,
    curve: &Curve,
    goes_on: ProgressCallback<'_>,
) -> (Option<DriveAngles>, Result<Vec<MotionCandidate>, Advice>) {
    let start = |b: f64| space.pose_at_nearest_b(samples.point(0), b);
    let points: Vec<Vector> = (0..PATH_POINTS).map(|i| curve.at(i as f64 / (PATH_POINTS - 1) as f64).p).collect();
    let (mut tried, range) = match (fixed_b, widest(space, &points)) {
        (Some(b), _) => (vec![b], None),
        (None, Ok([low, high])) => (B_FRACTIONS.map(|share| low + share * (high - low)).to_vec(), Some([low, high])),
        (None, Err(why)) => return (start(0.0), Err(why.into())),
    };
    tried.dedup();
    let mut refused = None;
    let ways = tried.iter().flat_map(|b| POSTURES.map(|posture| (*b, posture)));
    for (i, (b, posture)) in ways.enumerate() {
        if !goes_on(i as f64 / (tried.len() * POSTURES.len()) as f64) {
            break;
        }
        let task = Task::sampled(TaskKind::Given, samples.clone(), Some(b), &judge.machine);
        let Ok(task) = task.map(|task| Task { posture, ..task }) else { continue };
        match judge.plans(&task) {
            Ok(()) => {
                let why = match range {
                    None => "b is the one asked for".to_owned(),
                    Some([low, high]) if b == tried[0] => {
                        format!(
                            "b is the middle of the interval of b that reach the whole path, {} rad",
                            describe_interval(low, high)
                        )
                    }
                    Some([low, high]) => format!(
                        "the whole path can be followed at b = {} rad; it can be reached at b in {} rad",
                        fixed(b, 4),
                        describe_interval(low, high)
                    ),
                };
                return (start(b), Ok(vec![MotionCandidate { method: "on-plane", why, task }]));
            }
            Err(why) => refused = refused.or(Some(why)),
        }
    }
    (start(tried[0]), Err(refused.unwrap_or_default().into()))
}

/// Returns the widest interval of b that reaches all points, or the reason that there is none.
fn widest(space: &PoseSpace, points: &[Vector]) -> Result<[f64; 2], String> {
    let mut sets = Vec::with_capacity(points.len());
    for (i, p) in points.iter().enumerate() {
        let share = 100.0 * i as f64 / (points.len() - 1) as f64;
        sets.push(space.reach(*p).map_err(|reason| {
            format!("{share:.0} % along, at ({}, {}) m: {reason}", fixed(p.re, 3), fixed(p.im, 3))
        })?);
    }
    let common = BSet::overlap(&sets).intervals;
    common.into_iter().max_by(|x, y| (x[1] - x[0]).total_cmp(&(y[1] - y[0]))).ok_or_else(|| {
        "every point of the path is reached at some b, but no b reaches all points: want a shorter path, or minimum-norm rates"
            .into()
    })
}
