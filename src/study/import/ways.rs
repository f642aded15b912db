//! [`MotionProposals`]: candidates for a reactionless motion near a given one, the best first.

use super::judge::{AssessedMotion, MotionCandidate, MotionEvaluator};
use super::request::MotionImportError;
use crate::advice::Advice;
use stillbase_planning::Motion;
use stillbase_planning::curves::path::minimum_norm_curve;
use stillbase_planning::curves::{Path, PathTable, Samples};
use stillbase_planning::pose_space::PoseSpace;
use stillbase_planning::timing::Profile;
use stillbase_query::ProgressCallback;
use stillbase_session::scenario::{Task, TaskKind};

/// The given motion, and candidates for the proposal.
pub(super) struct MotionProposals {
    /// The given motion; samples of the end effector are followed with minimum-norm rates, `None` if that fails.
    pub given: Option<AssessedMotion>,
    /// Candidates, or why there are none.
    pub candidates: Result<Vec<MotionCandidate>, Advice>,
}

/// Returns the motion along a path with the timing of the samples.
pub(super) fn timed_path(path: PathTable, samples: &Samples) -> Motion {
    Motion { path: Path::Table(path), profile: Profile::running(samples.duration()) }
}

/// Returns the given motion as its own candidate: for machines whose every motion is reactionless, or for which there
/// is no proposal.
pub(super) fn unchanged_motion(
    judge: &MotionEvaluator,
    samples: &Samples,
    is_of_drives: bool,
    goes_on: ProgressCallback<'_>,
) -> Result<MotionProposals, MotionImportError> {
    let path = match is_of_drives {
        true => Some(samples.path(0.0).ok_or(MotionImportError::TooDense)?),
        false => {
            let curve = samples.curve().ok_or(MotionImportError::TooDense)?;
            let start = PoseSpace::nominal(&judge.machine)?.pose_at_nearest_b(samples.point(0), 0.0);
            start.and_then(|q| minimum_norm_curve(judge.machine.end_effector(), q, &curve).ok())
        }
    };
    let kind = if is_of_drives { TaskKind::Given } else { TaskKind::MinimumNorm };
    let task = Task::sampled(kind, samples.clone(), Some(0.0), &judge.machine).ok();
    let why = "every motion of this machine is reactionless".into();
    let candidates = match (&path, task) {
        (Some(_), Some(task)) => Ok(vec![MotionCandidate { method: "as-given", why, task }]),
        _ => Err("the path is not within reach: want another".into()),
    };
    Ok(MotionProposals { given: path.map(|path| judge.given(timed_path(path, samples), goes_on)), candidates })
}
