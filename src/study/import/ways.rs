//! The ways in which a given motion might be made reactionless, the best first.

use super::judge::{Candidate, Judge};
use super::request::{ImportError, Keep, Request};
use crate::planning::Motion;
use crate::planning::curves::path::minimum_norm_curve;
use crate::planning::curves::{Path, Samples};
use crate::planning::following::nearest::{nearest_b, same_tip, turned};
use crate::planning::following::{Rule, trace};
use crate::planning::pose_space::{OwnWay, Planes, PoseSpace};
use crate::planning::posed::serve;
use crate::planning::reactionless::{BSet, between};
use crate::planning::timing::Profile;
use crate::session::scenario::{Task, TaskKind};
use crate::settings::number::counted;

/// The motion that samples give, and what might be proposed in its place.
pub(super) struct Ways {
    /// The motion as given; for the end effector with minimum-norm rates, if these can follow.
    pub given: Option<Motion>,
    /// What might be proposed, or why nothing can be.
    pub candidates: Result<Vec<Candidate>, String>,
}

/// The motion given by drive angles, and what might be proposed, the best first.
pub(super) fn of_drives(
    asked: &Request,
    judge: &Judge,
    space: &PoseSpace,
    samples: &Samples,
) -> Result<Ways, ImportError> {
    let path = samples.path(0.0).ok_or(ImportError::TooDense)?;
    let motion = Motion { path: Path::Table(path), profile: Profile::running(samples.duration()) };
    let mean = judge.account(&motion).b_mean;
    // Whole turns of all drives are nothing: the one nearest to where the motion is.
    let wanted = asked.b.map_or(mean, |b| b + space.period() * ((mean - b) / space.period()).round());
    let which = if asked.b.is_some() { "the b asked for" } else { "the mean b" };
    let task = |samples: Samples| Task::sampled(TaskKind::Given, samples, None, &judge.machine).ok();
    let mut candidates = Vec::new();
    let mut lost = None;
    if asked.keep != Some(Keep::Joints) {
        let mut add = |b: f64, why: String| match same_tip(space, &judge.model, samples, b, Rule::default()) {
            Ok(moved) => {
                let made = moved.and_then(task).map(|task| Candidate { way: "same-tip", why, task });
                candidates.extend(made);
                None
            }
            Err(stop) => Some(stop),
        };
        let near = || nearest_b(space, &judge.model, samples, Rule::default());
        lost = if let Err(OwnWay { drives }) = space.follows_curves() {
            Some(format!("{} held to a b move the end effector along one curve of their own", counted(drives, "drive")))
        } else if let Some((b, _)) = asked.b.is_none().then(near).flatten() {
            let why = "of all b that reach every point of its path, the one that moves the drives least";
            // Between the samples that chose it the path may still leave the workspace by a little.
            let stop = match add(b, why.into()) {
                Some(stop) => stop.nearest_b().map_or(Some(stop), |other| add(other, why.into())),
                None => None,
            };
            stop.map(|stop| stop.to_string())
        } else {
            add(wanted, format!("{which} reaches every point of its path")).map(|stop| stop.to_string())
        };
    }
    if asked.keep == Some(Keep::Tip) {
        let candidates = match lost {
            Some(why) if candidates.is_empty() => Err(why),
            _ => Ok(candidates),
        };
        return Ok(Ways { given: Some(motion), candidates });
    }
    let why = match (asked.keep, lost) {
        (Some(_), _) => "the relative joint angles are to be kept".into(),
        (None, Some(stop)) => format!("the end effector's path cannot be kept: {stop}"),
        (None, None) => "the end effector's path cannot be kept within the rules".into(),
    };
    let made = turned(space.lambda(), samples, wanted).and_then(task);
    candidates.extend(made.map(|task| Candidate { way: "turned", why, task }));
    Ok(Ways { given: Some(motion), candidates: Ok(candidates) })
}

/// The usual inverse of a motion given by the end effector, and the one on a plane.
pub(super) fn of_tip(
    asked: &Request,
    judge: &Judge,
    (space, planes): (&PoseSpace, &Planes),
    samples: &Samples,
) -> Result<Ways, ImportError> {
    let map = planes.map();
    let curve = samples.curve().ok_or(ImportError::TooDense)?;
    let curves = [curve];
    let (b, why) = match asked.b {
        Some(b) => (b, "b is the one asked for".to_owned()),
        None => {
            let serves = |set: BSet| set.intervals.into_iter().max_by(|x, y| (x[1] - x[0]).total_cmp(&(y[1] - y[0])));
            let all = serves(trace::common_b(map, &curves, 257));
            // Where no b serves all points, the first one's gives the reason.
            let first = map.reach(samples.point(0)).ok().and_then(serves);
            let range = all.or(first).unwrap_or([0.0; 2]);
            let b = 0.5 * (range[0] + range[1]);
            (b, format!("b is the middle of what reaches all of the path, {} rad", between(range[0], range[1])))
        }
    };
    let follow = |b: f64| trace::follow(map, &curves, b, None, Rule::default()).map(|_| b);
    let followed = follow(b).map(|b| (b, why)).or_else(|stop| match (stop.nearest_b.zip(stop.shown_b), asked.b) {
        (Some((b, shown)), None) => {
            follow(b).map(|b| (b, format!("b = {shown} rad is one at which all of it can be followed")))
        }
        _ => Err(stop),
    });
    let b = followed.as_ref().map_or(b, |(b, _)| *b);
    let starts = serve(space, &[samples.point(0)], b).ok().and_then(|poses| poses.first().copied());
    let usual = starts.and_then(|pose| {
        let table = minimum_norm_curve(judge.machine.end_effector(), pose.q, &curves[0]).ok()?;
        Some(Motion { path: Path::Table(table), profile: Profile::running(samples.duration()) })
    });
    let candidates = followed.map_err(|stop| stop.to_string()).map(|(b, why)| {
        let task = Task::sampled(TaskKind::Given, samples.clone(), Some(b), &judge.machine).ok();
        task.map(|task| Candidate { way: "on-plane", why, task }).into_iter().collect()
    });
    Ok(Ways { given: usual, candidates })
}
