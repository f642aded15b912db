//! [`Ways`]: candidates for a reactionless motion near a given one, the best first.

use super::judge::{Candidate, Given, Judge};
use super::request::ImportError;
use crate::planning::Motion;
use crate::planning::curves::path::minimum_norm_curve;
use crate::planning::curves::{Path, PathTable, Samples};
use crate::planning::pose_space::PoseSpace;
use crate::planning::timing::Profile;
use crate::query::Watch;
use crate::session::scenario::{Task, TaskKind};
use crate::study::advice::Advice;

/// The given motion, and candidates for the proposal.
pub(super) struct Ways {
    /// The given motion; for the end effector with minimum-norm rates, if these can follow it.
    pub given: Option<Given>,
    /// Candidates, or why there are none.
    pub candidates: Result<Vec<Candidate>, Advice>,
}

/// Returns the motion along a path with the timing of the samples.
pub(super) fn running(path: PathTable, samples: &Samples) -> Motion {
    Motion { path: Path::Table(path), profile: Profile::running(samples.duration()) }
}

/// Returns the given motion as its own candidate: for machines whose every motion is reactionless, or that have no
/// proposal.
pub(super) fn as_given(
    judge: &Judge,
    samples: &Samples,
    drives: bool,
    goes_on: Watch<'_>,
) -> Result<Ways, ImportError> {
    let path = match drives {
        true => Some(samples.path(0.0).ok_or(ImportError::TooDense)?),
        false => {
            let curve = samples.curve().ok_or(ImportError::TooDense)?;
            let start = PoseSpace::nominal(&judge.machine)?.near(samples.point(0), 0.0);
            start.and_then(|q| minimum_norm_curve(judge.machine.end_effector(), q, &curve).ok())
        }
    };
    let kind = if drives { TaskKind::Given } else { TaskKind::MinimumNorm };
    let task = Task::sampled(kind, samples.clone(), Some(0.0), &judge.machine).ok();
    let why = "every motion of this machine is reactionless".into();
    let candidates = match (&path, task) {
        (Some(_), Some(task)) => Ok(vec![Candidate { way: "as-given", why, task }]),
        _ => Err("the path is not within reach: want another".into()),
    };
    Ok(Ways { given: path.map(|path| judge.given(running(path, samples), goes_on)), candidates })
}
