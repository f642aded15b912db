//! A motion given by the end effector: with minimum-norm rates, and at constant b.

use super::freedoms;
use super::judge::{AssessedMotion, MotionCandidate, MotionEvaluator};
use super::plane;
use super::request::{MotionImportError, Request};
use super::ways::{MotionProposals, timed_path};
use crate::advice::{Advice, Remedy};
use stillbase_planning::curves::Samples;
use stillbase_planning::curves::path::minimum_norm_curve;
use stillbase_planning::following::nearest::turned_to_plane;
use stillbase_planning::pose_space::PoseSpace;
use stillbase_query::{ProgressCallback, part};
use stillbase_session::scenario::{Task, TaskKind};
use stillbase_settings::number::{counted, fixed};

/// Fraction of the work for the search for a b; the rest is the assessment of minimum-norm rates.
const SEARCH_SHARE: f64 = 0.6;
/// Maximum deviation of b from its mean, rad, up to which a path is taken as lying on the curve of one b.
const MAX_B_DEVIATION_RAD: f64 = 1e-3;

/// Returns the minimum-norm motion for samples of the end effector, and candidates at constant b.
pub(super) fn of_tip(
    request: &Request,
    judge: &MotionEvaluator,
    space: &PoseSpace,
    samples: &Samples,
    goes_on: ProgressCallback<'_>,
) -> Result<MotionProposals, MotionImportError> {
    let curve = samples.curve().ok_or(MotionImportError::TooDense)?;
    let reaches_area = space.reaches_area();
    let (start, constant_b) = if reaches_area {
        let mut searching = part(goes_on, [0.0, SEARCH_SHARE]);
        let (start, candidates) = match space.planes() {
            Ok(planes) => plane::held_plane_motion(request.b, judge, space, planes, samples, &curve),
            Err(_) => freedoms::held_b_motion(request.b, judge, space, samples, &curve, &mut searching),
        };
        (start, Some(candidates))
    } else {
        (space.pose_at_nearest_b(samples.point(0), request.b.unwrap_or(0.0)), None)
    };
    let min_norm = start.and_then(|q| minimum_norm_curve(judge.machine.end_effector(), q, &curve).ok());
    let given = min_norm.map(|path| judge.given(timed_path(path, samples), &mut part(goes_on, [SEARCH_SHARE, 1.0])));
    let candidates = constant_b.unwrap_or_else(|| on_curve(judge, space, samples, given.as_ref()));
    Ok(MotionProposals { given, candidates })
}

/// Returns the candidate for one or two drives, where only motions along the curve of one b are reactionless.
fn on_curve(
    judge: &MotionEvaluator,
    space: &PoseSpace,
    samples: &Samples,
    given: Option<&AssessedMotion>,
) -> Result<Vec<MotionCandidate>, Advice> {
    let drives = counted(space.drives(), "drive");
    let Some(AssessedMotion { motion, account }) = given else {
        let why = format!("{drives} cannot move the end effector along this path: want one within reach");
        return Err(why.into());
    };
    let rows = samples.stations().into_iter().map(|s| motion.path.at(s).q.to_vec());
    let ([low, high], mean) = (account.b_range, account.b_mean);
    if (high - mean).max(mean - low) > MAX_B_DEVIATION_RAD {
        let why = format!("{drives} held to a b move the end effector along one curve of their own (");
        return Err(Advice::from(why).name(Remedy::Workspace).then(format!(
            "), and on this path b goes from {} to {} rad: want a path along such a curve, or samples of the drive \
             angles, which can be turned onto one b",
            fixed(low, 3),
            fixed(high, 3)
        )));
    }
    let task =
        Samples::new(&samples.times().into_iter().zip(rows).map(|(t, q)| [&[t], &q[..]].concat()).collect::<Vec<_>>())
            .ok()
            .and_then(|drives| turned_to_plane(space.lambda(), &drives, mean))
            .and_then(|drives| Task::sampled(TaskKind::Given, drives, None, &judge.machine).ok());
    let why = format!("the path lies along the curve of this b, to {:.1e} rad", (high - mean).max(mean - low));
    task.map(|task| vec![MotionCandidate { method: "turned", why, task }])
        .ok_or_else(|| "the samples give no spline".into())
}
