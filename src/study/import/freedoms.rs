//! The same ways of machines without planes: two drives have one curve for each b, four and more freedoms at each point.

use crate::mechanics::planar::Vector;
use crate::planning::Motion;
use crate::planning::curves::path::minimum_norm_curve;
use crate::planning::curves::{Path, PathTable, Samples};
use crate::planning::following::nearest::turned;
use crate::planning::pose_space::PoseSpace;
use crate::planning::posture::Posture;
use crate::planning::reactionless::{BSet, between};
use crate::planning::timing::Profile;
use crate::session::scenario::{Task, TaskKind};
use crate::settings::number::{counted, fixed};

use super::judge::{Candidate, Judge};
use super::request::{ImportError, Request};
use super::ways::Ways;

/// Points of a path of which it is asked which b reach them.
const ASKED: usize = 25;
/// Two drives: b of the samples may differ by this much, rad, from that of the curve that they are meant to lie on.
const ON_CURVE: f64 = 1e-3;

fn running(path: PathTable, samples: &Samples) -> Motion {
    Motion { path: Path::Table(path), profile: Profile::running(samples.duration()) }
}

/// The usual inverse of a motion given by the end effector, and one that holds b.
pub(super) fn of_tip(
    asked: &Request,
    judge: &Judge,
    space: &PoseSpace,
    samples: &Samples,
) -> Result<Ways, ImportError> {
    let curve = samples.curve().ok_or(ImportError::TooDense)?;
    let first = samples.point(0);
    let usual = |b: f64| {
        let q = space.near(first, b)?;
        let table = minimum_norm_curve(judge.machine.end_effector(), q, &curve).ok()?;
        Some(running(table, samples))
    };
    if !space.reaches_area() {
        let given = usual(asked.b.unwrap_or(0.0));
        let candidates = on_curve(judge, space, samples, given.as_ref());
        return Ok(Ways { given, candidates });
    }
    let points: Vec<Vector> = (0..ASKED).map(|i| curve.at(i as f64 / (ASKED - 1) as f64).p).collect();
    let (mut ways, range) = match (asked.b, widest(space, &points)) {
        (Some(b), _) => (vec![b], None),
        (None, Ok([low, high])) => {
            let at = |share: f64| low + share * (high - low);
            ([0.5, 0.3, 0.7, 0.1, 0.9].map(at).to_vec(), Some([low, high]))
        }
        (None, Err(why)) => return Ok(Ways { given: usual(0.0), candidates: Err(why) }),
    };
    ways.dedup();
    let mut refused = None;
    for b in &ways {
        for posture in [Posture::LeastRates, Posture::MidRange, Posture::LeastTorque, Posture::Orientation] {
            let task = Task::sampled(TaskKind::Given, samples.clone(), Some(*b), &judge.machine);
            let Ok(task) = task.map(|task| Task { posture, ..task }) else { continue };
            match judge.plans(&task) {
                Ok(()) => {
                    let why = match range {
                        None => "b is the one asked for".to_owned(),
                        Some([low, high]) if *b == ways[0] => {
                            format!("b is the middle of what reaches all of the path, {} rad", between(low, high))
                        }
                        Some([low, high]) => format!(
                            "b = {} rad is one at which all of it can be followed, of {} rad that reach it",
                            fixed(*b, 4),
                            between(low, high)
                        ),
                    };
                    let candidate = Candidate { way: "on-plane", why, task };
                    return Ok(Ways { given: usual(*b), candidates: Ok(vec![candidate]) });
                }
                Err(why) => refused = refused.or(Some(why)),
            }
        }
    }
    Ok(Ways { given: usual(ways[0]), candidates: Err(refused.unwrap_or_default()) })
}

/// The widest range of b that reach all of some points, or which is in the way.
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
        "some b reaches every point of the path, but none all of them: want a shorter path, or minimum-norm rates"
            .into()
    })
}

/// One and two drives: only what lies along the curve of a b is reactionless.
fn on_curve(
    judge: &Judge,
    space: &PoseSpace,
    samples: &Samples,
    given: Option<&Motion>,
) -> Result<Vec<Candidate>, String> {
    let drives = counted(space.drives(), "drive");
    let Some(motion) = given else {
        return Err(format!("{drives} cannot move the end effector along this path: want one within reach"));
    };
    let rows = samples.stations().into_iter().map(|s| motion.path.at(s).q.to_vec());
    let account = judge.account(motion);
    let ([low, high], mean) = (account.b_range, account.b_mean);
    if (high - mean).max(mean - low) > ON_CURVE {
        return Err(format!(
            "{drives} held to a b move the end effector along one curve of their own (`stillbase workspace --b`), and on \
             this path b goes from {} to {} rad: want a path along such a curve, or samples of the drive angles, which \
             can be turned onto one b",
            fixed(low, 3),
            fixed(high, 3)
        ));
    }
    let task =
        Samples::new(&samples.times().into_iter().zip(rows).map(|(t, q)| [&[t], &q[..]].concat()).collect::<Vec<_>>())
            .ok()
            .and_then(|drives| turned(space.lambda(), &drives, mean))
            .and_then(|drives| Task::sampled(TaskKind::Given, drives, None, &judge.machine).ok());
    let why = format!("the path lies along the curve of this b, to {:.1e} rad", (high - mean).max(mean - low));
    task.map(|task| vec![Candidate { way: "turned", why, task }]).ok_or_else(|| "the samples give no spline".into())
}

/// As it is given: where every motion is reactionless, or none can be proposed.
pub(super) fn as_given(judge: &Judge, samples: &Samples, drives: bool) -> Result<Ways, ImportError> {
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
    Ok(Ways { given: path.map(|path| running(path, samples)), candidates })
}
