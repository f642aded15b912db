//! Along curves and joint lines, on a plane or by least rates.

use super::plan::{Effort, Pace, Plan, dynamics_of, keeps_rules};
use crate::mechanics::dynamics::Surroundings;
use crate::mechanics::machine::Inertia;
use crate::mechanics::planar::{DriveAngles, Vector};
use crate::planning::Motion;
use crate::planning::common::{Reaching, common};
use crate::planning::curves::path::{Chained, SameTip, minimum_norm_curve};
use crate::planning::curves::{Curve, Path};
use crate::planning::following::{Rule, trace};
use crate::planning::pose_constant::{Mend, Planes, Unreachable};
use crate::planning::reactionless::{BSet, Decimal, PlanePoint};
use crate::planning::timing::{Limits, Profile, TimeLaw, Usage, fastest};
use crate::session::refusal::Refusal;
use crate::session::scenario::{Corners, Scenario, Shape, Task, TaskKind};

/// How far inside a set of b, as a share of half its width, values are tried, and their decimals.
const INWARDS: [f64; 8] = [1e-3, 0.1, 0.3, 0.6, 1.0, 1.4, 1.7, 1.9];
const DECIMALS: usize = 4;

/// A path through the points of a task, and its timing.
pub(super) fn along(scenario: &Scenario, planes: &Planes) -> Result<Plan, Refusal> {
    along_parts(scenario, &|scenario| parts(scenario, planes))
}

/// Paths from rest to rest, each with its length.
pub(super) type Parts = Vec<(Path, f64)>;

/// The same with what finds the paths of a task.
pub(super) fn along_parts(
    scenario: &Scenario,
    parts: &dyn Fn(&Scenario) -> Result<Parts, Refusal>,
) -> Result<Plan, Refusal> {
    let task = &scenario.task;
    let motion = |scenario: &Scenario| -> Result<(Motion, Option<Pace>), Refusal> {
        let (motion, pace) = timed(scenario, parts(scenario)?)?;
        keeps_rules(scenario, &motion)?;
        Ok((motion, pace))
    };
    let (own, pace) = motion(scenario)?;
    let has_corners = !task.via.is_empty() || task.closed;
    if task.law.is_fastest() && task.corners == Corners::Blend && has_corners {
        // A corner rounded off very tightly may be no faster than a rest at it.
        let resting = Scenario { task: Task { corners: Corners::Stop, ..task.clone() }, ..scenario.clone() };
        if let Ok((rests, pace)) = motion(&resting)
            && rests.duration() < own.duration()
        {
            let blended = Some(own.duration());
            return Ok(Plan { pace, blended, ..Plan::of(scenario, rests) });
        }
    }
    Ok(Plan { pace, ..Plan::of(scenario, own) })
}

/// The paths of a task from rest to rest, each with its length.
pub(super) fn parts(scenario: &Scenario, planes: &Planes) -> Result<Vec<(Path, f64)>, Refusal> {
    let task = &scenario.task;
    let points = task.points();
    match (task.kind, task.shape()) {
        (TaskKind::Reactionless, _) => reactionless(task, planes)
            .map_err(|refusal| proved(task, planes.map(), &|task, _| reactionless(task, planes).map(|_| ()), refusal)),
        (TaskKind::MinimumNorm, _) => minimum_norm(scenario, planes, &points),
        _ => {
            if !task.via.is_empty() || task.closed {
                let why = "same-tip goes straight from A to B: want no points between and an open path";
                return Err(Refusal::Task(why.into()));
            }
            let [from, to] = lifted(planes, &serve(task, planes, &[points[0], points[points.len() - 1]])?)[..] else {
                return Err(Refusal::Task("same-tip: want two points".into()));
            };
            let first_to = task.first_drive_to.unwrap_or(from[0]);
            Ok(vec![(Path::SameTip(SameTip::new(scenario.machine.end_effector(), from, to, first_to)?), 1.0)])
        }
    }
}

/// The path of a task that holds its b.
pub(super) fn reactionless(task: &Task, planes: &Planes) -> Result<Vec<(Path, f64)>, Refusal> {
    match task.shape() {
        Shape::JointLine => joint_lines(task, planes, &task.points()),
        _ => on_plane(task, planes, &task.points()),
    }
}

/// A refusal that proposes only what has been tried: points that share a b may still be joined by no path on its plane.
pub(super) fn proved(
    task: &Task,
    map: &dyn Reaching,
    goes: &dyn Fn(&Task, Effort) -> Result<(), Refusal>,
    refusal: Refusal,
) -> Refusal {
    let at = |task: &Task, b: f64| Task { b, ..task.clone() };
    // A refusal of a path on one plane may name another plane.
    let another = |why: &Refusal| match why {
        Refusal::Blocked(blocked) => blocked.nearest_b.zip(blocked.shown_b),
        _ => None,
    };
    match refusal {
        Refusal::NoCommonPlane { mut why, .. } => {
            if let Some((mend, mut shown)) = why.mend.and_then(|mend| Some((mend, mend.shown?))) {
                let moved = task.moved(mend.point, shown.point());
                let result = moved.as_ref().map(|moved| goes(&at(moved, shown.b.value()), Effort::Trial));
                shown.does = match result {
                    Some(Ok(_)) => true,
                    Some(Err(stopped)) => {
                        let other = another(&stopped).map(|(_, other)| other).or_else(|| {
                            let moved = moved.as_ref()?;
                            let serving = common(map, &moved.points())?;
                            inner(&serving, shown.b.value())
                                .find(|b| goes(&at(moved, b.value()), Effort::Trial).is_ok())
                        });
                        shown.b = other.unwrap_or(shown.b);
                        other.is_some()
                    }
                    None => false,
                };
                why.mend = Some(Mend { shown: Some(shown), ..mend });
            }
            Refusal::NoCommonPlane { said: why.in_words(&|i| task.name_of(i)), why }
        }
        Refusal::Unreachable { .. } if task.shape() != Shape::JointLine || task.keep_off_change_points => {
            tried(map, refusal, |b, effort| goes(&at(task, b), effort))
        }
        other => other,
    }
}

/// A refusal for a b that does not reach a point: the b nearest to it with which the whole path goes, or what stops it.
pub(super) fn tried(
    map: &dyn Reaching,
    refusal: Refusal,
    goes: impl Fn(f64, Effort) -> Result<(), Refusal>,
) -> Refusal {
    let Refusal::Unreachable {
        point,
        unreachable: Unreachable::OnThisPlane { x, y, b, nearest_b: Some(nearest), shown_b: Some(shown), .. },
    } = &refusal
    else {
        return refusal;
    };
    let made = |would_do: String, nearest_b: Option<f64>, shown_b: Option<Decimal>| {
        let unreachable = Unreachable::OnThisPlane { x: *x, y: *y, b: *b, would_do, nearest_b, shown_b };
        Refusal::Unreachable { point: point.clone(), unreachable }
    };
    let stopped = match goes(shown.value(), Effort::Whole) {
        Ok(()) => {
            let exact = if goes(*nearest, Effort::Trial).is_ok() { *nearest } else { shown.value() };
            return made(format!("b = {shown} rad"), Some(exact), Some(*shown));
        }
        Err(stopped) => stopped,
    };
    // A refusal of the path on one plane may name another plane.
    if let Refusal::Blocked(blocked) = &stopped
        && let Some((nearest, shown)) = blocked.nearest_b.zip(blocked.shown_b)
    {
        return made(format!("b = {shown} rad"), Some(nearest), Some(shown));
    }
    let own = map.b_of(Vector::new(*x, *y)).ok();
    if let Some(shown) = own.and_then(|set| inner(&set, *nearest).find(|b| goes(b.value(), Effort::Trial).is_ok())) {
        return made(format!("b = {shown} rad"), Some(shown.value()), Some(shown));
    }
    // What stops a path of four drives and more names its b itself.
    let (said, at) = (stopped.to_string(), format!("at b = {shown} rad "));
    made(format!("another path: {at}{}", said.strip_prefix(&at).unwrap_or(&said)), None, None)
}

/// Values of b farther and farther inside a set, from its end beside a given b, rad, on to the other end.
pub(super) fn inner(set: &BSet, near: f64) -> impl Iterator<Item = Decimal> + use<'_> {
    INWARDS.into_iter().filter_map(move |share| set.decimal(set.inwards(near, share), DECIMALS))
}

/// The parts of a path, each from rest to rest: by a law in their share of the time, or as fast as they can.
pub(super) fn timed(scenario: &Scenario, parts: Vec<(Path, f64)>) -> Result<(Motion, Option<Pace>), Refusal> {
    let task = &scenario.task;
    let total: f64 = parts.iter().map(|(_, length)| length).sum();
    let (model, around) = dynamics_of(scenario);
    let limits = Limits::of(&scenario.machine);
    let mut timings = Vec::with_capacity(parts.len());
    let mut pace: Option<Pace> = None;
    for (path, length) in &parts {
        let profile = if task.law.is_fastest() {
            let fastest = fastest(path, &model, &around, &limits, task.law == TimeLaw::FastestSmooth)?;
            let profile = fastest.profile;
            let time = profile.duration();
            // Parts that do not move have no limit.
            let least = fastest.gap.map(|gap| time / (1.0 + gap)).or((time == 0.0).then_some(0.0));
            let pace = pace.get_or_insert(Pace { unlimited: Some(0.0), ..Pace::default() });
            pace.unlimited = pace.unlimited.zip(least).map(|(sum, least)| sum + least);
            pace.taken += time;
            if pace.leading.is_none() {
                pace.leading = fastest.limiting.first().map(|(limit, _)| *limit);
            }
            profile
        } else {
            Profile::of(task.law, task.time * length / total)
        };
        timings.push((profile, length / total));
    }
    let mut parts = parts;
    let motion = match parts.len() {
        1 => Motion { path: parts.remove(0).0, profile: timings.remove(0).0 },
        _ => {
            let nowhere = || Refusal::Task("want at least two points that are apart".into());
            let path = Path::Chain(Chained::new(parts).ok_or_else(nowhere)?);
            Motion { path, profile: Profile::sequence(timings) }
        }
    };
    Ok((motion, pace))
}

/// A motion as slow as the limits of the drives want it, whatever the timing of its path.
pub(super) fn slowed(
    motion: Motion,
    model: &Inertia,
    around: &Surroundings,
    limits: &Limits,
) -> Result<Motion, Refusal> {
    const SAMPLES: usize = 2000;
    motion.slowed(model, around, limits).ok_or_else(|| {
        let usage = Usage::of(&motion, model, around, limits, SAMPLES);
        let limit = usage.limit.map_or("a limit".into(), |limit| format!("the {limit}"));
        Refusal::NoWay(format!("{limit} is passed however slow the motion is: want a higher one"))
    })
}

/// Poses of the points on the plane of the task.
pub(super) fn serve(task: &Task, planes: &Planes, points: &[Vector]) -> Result<Vec<PlanePoint>, Refusal> {
    planes.serve(points, task.b).map_err(|(i, unreachable)| refusal(task, i, unreachable))
}

pub(super) fn refusal(task: &Task, i: usize, unreachable: Unreachable) -> Refusal {
    match unreachable {
        Unreachable::NoCommonPlane(why) => Refusal::NoCommonPlane { said: why.in_words(&|i| task.name_of(i)), why },
        unreachable => Refusal::Unreachable { point: task.name_of(i), unreachable },
    }
}

pub(super) fn lifted(planes: &Planes, poses: &[PlanePoint]) -> Vec<DriveAngles> {
    poses.iter().map(|x| DriveAngles::from(planes.map().lift(*x))).collect()
}

/// Straight lines of joint space from pose to pose; their corners a stop or a blend.
pub(super) fn joint_lines(task: &Task, planes: &Planes, points: &[Vector]) -> Result<Vec<(Path, f64)>, Refusal> {
    let mut poses = serve(task, planes, points)?;
    if task.keep_off_change_points {
        same_side(task, planes, &poses)?;
    }
    let a = |x: &PlanePoint| Vector::new(x.a[0], x.a[1]);
    if task.corners == Corners::Blend && (poses.len() > 2 || task.closed) {
        let corners: Vec<Vector> = poses.iter().map(a).collect();
        // The curve closes itself, so that an error names points that were given.
        let curves = Curve::polyline(&corners, task.closed, task.blend)?;
        let path = |curve: Curve| {
            let length = curve.length();
            (Path::OnPlane { map: *planes.map(), b: task.b, curve }, length)
        };
        return Ok(curves.into_iter().map(path).collect());
    }
    poses.extend(task.closed.then(|| poses[0]));
    let q = lifted(planes, &poses);
    let way = |i: usize| (a(&poses[i + 1]) - a(&poses[i])).norm();
    let line = |i: usize| (Path::JointLine { from: q[i], to: q[i + 1] }, way(i).max(1e-12));
    // The same point twice in a row makes no path.
    let moving = (0..q.len() - 1).filter(|i| q.len() == 2 || way(*i) > 1e-12);
    Ok(moving.map(line).collect())
}

/// Refuses poses between which two drives would become parallel.
pub(super) fn same_side(task: &Task, planes: &Planes, poses: &[PlanePoint]) -> Result<(), Refusal> {
    for (i, w) in poses.windows(2).enumerate() {
        let [from, to] = [w[0], w[1]].map(|x| planes.map().lift(x));
        for [k, l] in [[0, 1], [0, 2], [1, 2]] {
            let side = |q: &[f64; 3]| (q[k] - q[l]).sin();
            let turns = |q: &[f64; 3]| ((q[k] - q[l]) / std::f64::consts::PI).floor();
            if side(&from) * side(&to) < 0.0 || (turns(&from) != turns(&to) && side(&from) * side(&to) > 0.0) {
                let between = [task.name_of(i), task.name_of(i + 1)];
                return Err(Refusal::NoWay(format!(
                    "between {} and {} drives {} and {} become parallel, a change point: want points on one side of \
                     it, another b, or keep_off_change_points = false",
                    between[0],
                    between[1],
                    k + 1,
                    l + 1
                )));
            }
        }
    }
    Ok(())
}

/// The end effector's curves through the points; at their ends the motion rests.
///
/// # Errors
/// If the points give none.
pub fn curves(task: &Task, points: &[Vector]) -> Result<Vec<Curve>, Refusal> {
    let blend = if task.corners == Corners::Blend { task.blend } else { 0.0 };
    Ok(match task.shape() {
        Shape::JointLine | Shape::Line => Curve::polyline(points, task.closed, blend)?,
        Shape::Arc => match points {
            [a, b, c] => vec![Curve::arc([*a, *b, *c], task.closed)?],
            _ => {
                let have = points.len();
                return Err(Refusal::Task(format!(
                    "an arc goes through 3 points, here are {have}: want one via point"
                )));
            }
        },
        Shape::Spline => vec![Curve::spline(points, task.closed)?],
        Shape::Freehand => vec![Curve::freehand(points, task.closed)?],
    })
}

/// The end effector's curves followed on the plane of the task.
pub(super) fn on_plane(task: &Task, planes: &Planes, points: &[Vector]) -> Result<Vec<(Path, f64)>, Refusal> {
    let curves = curves(task, points)?;
    let rule = Rule { keep_off_change_points: task.keep_off_change_points };
    // Where single points cannot be reached, they are the clearer reason.
    let prefer = match task.shape() {
        Shape::Freehand => None,
        _ => serve(task, planes, points)?.first().map(|pose| pose.a),
    };
    let tables = trace::follow(planes.map(), &curves, task.b, prefer, rule)?;
    Ok(tables.into_iter().zip(&curves).map(|(table, curve)| (Path::Table(table), curve.length())).collect())
}

/// A pose of A on the plane of the task: A and B on one sheet, as for the reactionless motion to compare with, or else
/// A alone.
pub(super) fn start(task: &Task, planes: &Planes, points: &[Vector]) -> Result<DriveAngles, Refusal> {
    let ends = [points[0], points[points.len() - 1]];
    let start = planes.serve(&ends, task.b).or_else(|_| planes.serve(&ends[..1], task.b));
    let start = start.map_err(|(i, unreachable)| refusal(task, i, unreachable))?;
    Ok(DriveAngles::from(planes.map().lift(start[0])))
}

/// Minimum-norm joint rates along the end effector's curves, from the pose of A on the plane of the task.
pub(super) fn minimum_norm(
    scenario: &Scenario,
    planes: &Planes,
    points: &[Vector],
) -> Result<Vec<(Path, f64)>, Refusal> {
    let task = &scenario.task;
    let mut q = start(task, planes, points)?;
    let mut parts = Vec::new();
    for curve in curves(task, points)? {
        let table = minimum_norm_curve(scenario.machine.end_effector(), q, &curve)?;
        q = table.nodes().last().map_or(q, |last| last.q);
        parts.push((Path::Table(table), curve.length()));
    }
    Ok(parts)
}
