//! [`Ways`]: the ways in which a given motion might be made reactionless, the best first.

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

/// The motion that samples give, and what might be proposed in its place.
pub(super) struct Ways {
    /// The motion as given; for the end effector with minimum-norm rates, if these can follow.
    pub given: Option<Given>,
    /// What might be proposed, or why nothing can be.
    pub candidates: Result<Vec<Candidate>, Advice>,
}

/// A path that is run along as samples are timed.
pub(super) fn running(path: PathTable, samples: &Samples) -> Motion {
    Motion { path: Path::Table(path), profile: Profile::running(samples.duration()) }
}

/// As it is given: where every motion is reactionless, or none can be proposed.
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
