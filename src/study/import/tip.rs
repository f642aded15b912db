//! A motion given by the end effector: with minimum-norm rates, and with b held.

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

/// Up to this share of the work a b is searched for; in the rest it is found what minimum-norm rates do.
const SEARCH: f64 = 0.6;
/// b of the samples may differ by this much, rad, from that of the curve that they are meant to lie on.
const ON_CURVE: f64 = 1e-3;

/// The usual inverse of a motion given by the end effector, and one that holds b.
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
        let mut searching = part(goes_on, [0.0, SEARCH]);
        let (start, candidates) = match space.planes() {
            Ok(planes) => plane::held(asked.b, judge, (space, planes), (samples, &curve)),
            Err(_) => freedoms::held(asked.b, judge, space, (samples, &curve), &mut searching),
        };
        (start, Some(candidates))
    } else {
        (space.near(samples.point(0), asked.b.unwrap_or(0.0)), None)
    };
    let usual = start.and_then(|q| minimum_norm_curve(judge.machine.end_effector(), q, &curve).ok());
    let given = usual.map(|path| judge.given(running(path, samples), &mut part(goes_on, [SEARCH, 1.0])));
    let candidates = held.unwrap_or_else(|| on_curve(judge, space, samples, given.as_ref()));
    Ok(Ways { given, candidates })
}

/// One and two drives: only what lies along the curve of a b is reactionless.
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
    if (high - mean).max(mean - low) > ON_CURVE {
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
