//! A motion given by the end effector: with minimum-norm rates, and at constant b.

use super::freedoms;
use super::judge::{Candidate, Given, Judge};
use super::plane;
use super::request::{ImportError, Request};
use super::ways::{Ways, running};
use crate::planning::curves::Samples;
use crate::planning::curves::path::minimum_norm_curve;
use crate::planning::following::nearest::turned;
use crate::planning::pose_space::PoseSpace;
use crate::query::{Watch, part};
use crate::session::scenario::{Task, TaskKind};
use crate::settings::number::{counted, fixed};
use crate::study::advice::{Advice, Remedy};

/// Fraction of the work for the search for a b; the rest is the assessment of minimum-norm rates.
const SEARCH_SHARE: f64 = 0.6;
/// Maximum deviation of b along the motion from its mean, rad, for a path that counts as lying on the curve of one b.
const MAX_B_DEVIATION_RAD: f64 = 1e-3;

/// Returns the minimum-norm motion for samples of the end effector, and candidates at constant b.
pub(super) fn of_tip(
    asked: &Request,
    judge: &Judge,
    space: &PoseSpace,
    samples: &Samples,
    goes_on: Watch<'_>,
) -> Result<Ways, ImportError> {
    let curve = samples.curve().ok_or(ImportError::TooDense)?;
    let reaches_area = space.reaches_area();
    let (start, held) = if reaches_area {
        let mut searching = part(goes_on, [0.0, SEARCH_SHARE]);
        let (start, candidates) = match space.planes() {
            Ok(planes) => plane::held(asked.b, judge, (space, planes), (samples, &curve)),
            Err(_) => freedoms::held(asked.b, judge, space, (samples, &curve), &mut searching),
        };
        (start, Some(candidates))
    } else {
        (space.near(samples.point(0), asked.b.unwrap_or(0.0)), None)
    };
    let usual = start.and_then(|q| minimum_norm_curve(judge.machine.end_effector(), q, &curve).ok());
    let given = usual.map(|path| judge.given(running(path, samples), &mut part(goes_on, [SEARCH_SHARE, 1.0])));
    let candidates = held.unwrap_or_else(|| on_curve(judge, space, samples, given.as_ref()));
    Ok(Ways { given, candidates })
}

/// Returns the candidate for one or two drives, where only motions along the curve of one b are reactionless.
fn on_curve(
    judge: &Judge,
    space: &PoseSpace,
    samples: &Samples,
    given: Option<&Given>,
) -> Result<Vec<Candidate>, Advice> {
    let drives = counted(space.drives(), "drive");
    let Some(Given { motion, account }) = given else {
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
            .and_then(|drives| turned(space.lambda(), &drives, mean))
            .and_then(|drives| Task::sampled(TaskKind::Given, drives, None, &judge.machine).ok());
    let why = format!("the path lies along the curve of this b, to {:.1e} rad", (high - mean).max(mean - low));
    task.map(|task| vec![Candidate { way: "turned", why, task }]).ok_or_else(|| "the samples give no spline".into())
}
