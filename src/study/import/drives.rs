//! A motion given by drive angles: moved onto a plane with the same motion of the end effector, or turned as a whole.

use super::judge::{MotionCandidate, MotionEvaluator};
use super::request::{MotionImportError, PreservedPath, Request};
use super::ways::{MotionProposals, timed_path};
use stillbase_planning::curves::Samples;
use stillbase_planning::following::Rule;
use stillbase_planning::following::nearest::{nearest_b, same_tip, turned_to_plane};
use stillbase_planning::pose_space::{NotFollowable, PoseSpace};
use stillbase_query::{ProgressCallback, part};
use stillbase_session::scenario::{Task, TaskKind};
use stillbase_settings::number::counted;

/// Fraction of the work for the assessment of the given motion; the rest is the search.
const ACCOUNT_SHARE: f64 = 0.3;

/// Returns the motion given by drive angles, and candidates for a proposal, the best first.
pub(super) fn of_drives(
    request: &Request,
    judge: &MotionEvaluator,
    space: &PoseSpace,
    samples: &Samples,
    goes_on: ProgressCallback<'_>,
) -> Result<MotionProposals, MotionImportError> {
    let path = samples.path(0.0).ok_or(MotionImportError::TooDense)?;
    let given = judge.given(timed_path(path, samples), &mut part(goes_on, [0.0, ACCOUNT_SHARE]));
    let mean = given.account.b_mean;
    // Whole turns of all drives change b but not the pose: choose the equivalent b nearest to the motion's mean.
    let wanted = request.b.map_or(mean, |b| b + space.period() * ((mean - b) / space.period()).round());
    let which = if request.b.is_some() { "the b asked for" } else { "the mean b" };
    let task = |samples: Samples| Task::sampled(TaskKind::Given, samples, None, &judge.machine).ok();
    let mut candidates = Vec::new();
    let mut path_refusal = None;
    if request.keep != Some(PreservedPath::Joints) {
        let mut add = |b: f64, why: String| match same_tip(space, judge.arm.arm(), samples, b, Rule::default()) {
            Ok(moved) => {
                let made = moved.and_then(task).map(|task| MotionCandidate { method: "same-tip", why, task });
                candidates.extend(made);
                None
            }
            Err(stop) => Some(stop),
        };
        let near =
            || nearest_b(space, judge.arm.arm(), samples, Rule::default(), &mut part(goes_on, [ACCOUNT_SHARE, 1.0]));
        path_refusal = if let Err(NotFollowable { drives }) = space.follows_curves() {
            Some(format!("{} held to a b move the end effector along one curve of their own", counted(drives, "drive")))
        } else if let Some((b, _)) = request.b.is_none().then(near).flatten() {
            let why = "of all b that reach every point of the tip's path, the one that moves the drives least";
            // Between the samples that determined b, the path may leave the workspace slightly.
            let stop = match add(b, why.into()) {
                Some(stop) => stop.nearest_b().map_or(Some(stop), |other| add(other, why.into())),
                None => None,
            };
            stop.map(|stop| stop.to_string())
        } else {
            add(wanted, format!("{which} reaches every point of the tip's path")).map(|stop| stop.to_string())
        };
    }
    if request.keep == Some(PreservedPath::Tip) {
        let candidates = match path_refusal {
            Some(why) if candidates.is_empty() => Err(why.into()),
            _ => Ok(candidates),
        };
        return Ok(MotionProposals { given: Some(given), candidates });
    }
    let why = match (request.keep, path_refusal) {
        (Some(_), _) => "the relative joint angles are to be kept".into(),
        (None, Some(stop)) => format!("the end effector's path cannot be kept: {stop}"),
        (None, None) => "the end effector's path cannot be kept within the rules".into(),
    };
    let made = turned_to_plane(space.lambda(), samples, wanted).and_then(task);
    candidates.extend(made.map(|task| MotionCandidate { method: "turned", why, task }));
    Ok(MotionProposals { given: Some(given), candidates: Ok(candidates) })
}
