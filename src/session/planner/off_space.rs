//! Of machines without planes: motions that leave their b knowingly, zero momentum where there is none, and the end
//! effector as it was with drive 1 elsewhere.

use std::f64::consts::TAU;

use super::along::{Parts, refusal};
use super::off_plane::{changed, followed, goes_straight, in_rounds};
use super::plan::{Plan, dynamics_of};
use super::pose::{off, posed, reached, start};
use crate::mechanics::planar::{DriveAngles, Vector};
use crate::planning::common::why_not;
use crate::planning::curves::Path;
use crate::planning::curves::path::same_tip_path;
use crate::planning::off_plane::b_integral::BIntegral;
use crate::planning::off_plane::null_space::turns_nothing;
use crate::planning::off_plane::price::{INWARDS, bang_bang, nearest_planes};
use crate::planning::pose_space::{NoPoseSpace, PoseSpace};
use crate::session::refusal::Refusal;
use crate::session::scenario::{Scenario, Shape, Task};
use crate::settings::number::fixed;

/// How near points have to be to the curve of two drives, a share of the reach: what nine printed digits leave.
const ON_CURVE: f64 = 1e-6;
/// Looks along that curve for the place that is nearest to a point.
const LOOKS: usize = 720;

/// From A at the b of the task to B at another, along a straight joint line; a limit on |n_B| sets the time.
pub(super) fn change_b(scenario: &Scenario) -> Result<Plan, Refusal> {
    goes_straight(&scenario.task)?;
    let space = match PoseSpace::of(&scenario.machine) {
        Err(NoPoseSpace::Free) => {
            let why =
                "no motion of this machine has a price, as no drive turns the base: want reactionless or minimum-norm";
            return Err(Refusal::Task(why.into()));
        }
        space => space?,
    };
    let [from, to] = ends(&scenario.task, &space)?;
    let line = Path::JointLine { from, to };
    let at = |q: &DriveAngles| (space.angles(q), space.b(q));
    let bang = || bang_bang(&|a, b| space.lift(a, b), &|ad, bd| space.lift_rates(ad, bd), [at(&from), at(&to)]);
    changed(scenario, line, space.b(&to) - space.b(&from), &bang)
}

/// Poses of A and B, each at its b.
fn ends(task: &Task, space: &PoseSpace) -> Result<[DriveAngles; 2], Refusal> {
    let (points, middle) = (task.points(), space.middle());
    let last = points.len() - 1;
    let (a, b) = (points[0], points[last]);
    if let Some(b_to) = task.b_to {
        let start = posed(task, space, (&points[..1], 0), &middle)?;
        let end = space.poses(b, b_to, &space.angles(&start)).first().copied();
        let end = end.ok_or_else(|| refusal(task, last, why_not(space, &points[last..], 0, b_to)))?;
        return Ok(nearest(space, [a, b], [task.b, b_to]).unwrap_or([start, end]));
    }
    let set = |i: usize, p: Vector| space.reach(p).map_err(|reason| off(task, i, p, reason));
    let sets = [set(0, a)?, set(last, b)?];
    let on = space.reaches(a, task.b);
    // Of one and two drives the point says which b, where the task leaves it out, which stands as 0.
    if !on && (space.drives() > 2 || task.b != 0.0) {
        return Err(refusal(task, 0, why_not(space, &points[..1], 0, task.b)));
    }
    // B's own b nearest to that of A, if A is at its own; else the pair with the least change.
    let pair =
        if on { sets[1].nearest(task.b).map(|b| [task.b, b]) } else { nearest_planes(&sets[0], &sets[1], task.b) };
    let inwards = |[from, to]: [f64; 2], share: f64| match on {
        true => [from, sets[1].inwards(to, share)],
        false => [sets[0].inwards(from, share), sets[1].inwards(to, share)],
    };
    pair.and_then(|pair| INWARDS.into_iter().find_map(|share| nearest(space, [a, b], inwards(pair, share)))).ok_or_else(
        || Refusal::NoWay("no poses of A and B were found to go straight between: want other points".into()),
    )
}

/// Of the poses of two points, each at its b, those that lie nearest together.
fn nearest(space: &PoseSpace, [a, b]: [Vector; 2], [from, to]: [f64; 2]) -> Option<[DriveAngles; 2]> {
    let starts = space.poses(a, from, &space.middle());
    let pairs = starts.into_iter().filter_map(|x| {
        let near = space.angles(&x);
        let far = |y: &DriveAngles| space.angles(y).minus(&near).max_abs();
        let ends = space.poses(b, to, &near);
        ends.into_iter().min_by(|y, z| far(y).total_cmp(&far(z))).map(|y| ([x, y], far(&y)))
    });
    pairs.min_by(|x, y| x.1.total_cmp(&y.1)).map(|(pair, _)| pair)
}

/// Refuses points between A and B of a task that has no path for them.
fn apart(task: &Task) -> Result<(), Refusal> {
    if task.via.is_empty() && !task.closed {
        return Ok(());
    }
    let why = "same-tip goes straight from A to B: want no points between and an open path";
    Err(Refusal::Task(why.into()))
}

/// The end effector as on the joint line from A to B, drive 1 on a course of its own, the others after it.
pub(super) fn same_tip(scenario: &Scenario) -> Result<Parts, Refusal> {
    let (task, machine) = (&scenario.task, &scenario.machine);
    if machine.drives() < 3 {
        return Err(Refusal::Task(
            "with one or two drives the end effector's motion leaves drive 1 no course of its own: want minimum-norm, \
             which follows a path of the end effector, or change-b, which goes to another b"
                .into(),
        ));
    }
    apart(task)?;
    let points = task.points();
    let last = points.len() - 1;
    let (space, has_b) = match PoseSpace::of(machine) {
        Ok(space) => (space, true),
        Err(_) => (PoseSpace::nominal(machine)?, false),
    };
    let pose = |i: usize, near: &[f64]| match has_b {
        true => posed(task, &space, (&points, i), near),
        false => reached(task, &space, i, points[i]),
    };
    let from = pose(0, &space.middle())?;
    let to = pose(last, &space.angles(&from))?;
    let first_to = task.first_drive_to.unwrap_or(from[0]);
    Ok(vec![(Path::Table(same_tip_path(machine.end_effector(), from, to, first_to)?), 1.0)])
}

/// At zero momentum: two drives along the one curve that they have, more along any.
pub(super) fn zero_momentum(scenario: &Scenario) -> Result<Plan, Refusal> {
    let (task, machine) = (&scenario.task, &scenario.machine);
    let (model, _) = dynamics_of(scenario);
    match machine.drives() {
        1 => Err(Refusal::Task(
            "one drive has momentum as soon as it turns: want minimum-norm, and a machine of more drives".into(),
        )),
        2 if !turns_nothing(&model) => {
            if task.shape.is_some_and(|shape| shape != Shape::JointLine) {
                return Err(Refusal::Task(
                    "at zero momentum the end effector of two drives has its own way: want the shape joint-line".into(),
                ));
            }
            let keeps = BIntegral::of(&model).ok_or_else(|| {
                Refusal::NoWay(
                    "turned as a whole, this machine has no momentum in some poses: want rotors that turn the other way \
                     less fast or lighter"
                        .into(),
                )
            })?;
            along_curve(scenario, &keeps)
        }
        _ => followed(scenario, start(scenario)?),
    }
}

/// Two drives, from point to point of a curve q₁ + ∫ D₂/(D₁ + D₂) dδ = const.
fn along_curve(scenario: &Scenario, keeps: &BIntegral) -> Result<Plan, Refusal> {
    let task = &scenario.task;
    let space = PoseSpace::nominal(&scenario.machine)?;
    let mut points = task.points();
    points.extend(task.closed.then(|| points[0]));
    let starts = elbows(task, &space, 0, points[0])?;
    // The elbow of A from which the whole way goes, or the reason of the one that goes farthest.
    let mut refused: Option<(usize, Refusal)> = None;
    for start in &starts {
        match way(task, &space, keeps, *start, &points) {
            Ok(turns) => {
                return in_rounds(scenario, *start, &|mut q, _| {
                    let mut parts = Vec::new();
                    for to in &turns {
                        let far = (to - (q[1] - q[0])).abs();
                        let table = keeps.motion(&q, *to);
                        let table = table.ok_or_else(|| Refusal::NoWay("A and B are too far apart".into()))?;
                        q = table.nodes().last().map_or(q, |last| last.q);
                        // The same point twice in a row makes no path.
                        if far > 1e-12 || turns.len() == 1 {
                            parts.push((Path::Table(table), far.max(1e-12)));
                        }
                    }
                    Ok((parts, q))
                });
            }
            Err((i, why)) if refused.as_ref().is_none_or(|(at, _)| i > *at) => refused = Some((i, why)),
            Err(_) => {}
        }
    }
    Err(refused.map_or_else(|| Refusal::NoWay("A has no pose".into()), |(_, why)| why))
}

/// Every pose of a point that differs by more than whole turns of all drives.
fn elbows(task: &Task, space: &PoseSpace, i: usize, p: Vector) -> Result<Vec<DriveAngles>, Refusal> {
    let set = space.reach(p).map_err(|reason| off(task, i, p, reason))?.near(task.b);
    let poses: Vec<DriveAngles> = set.intervals.iter().flat_map(|[b, _]| space.poses(p, *b, &space.middle())).collect();
    if poses.is_empty() { reached(task, space, i, p).map(|q| vec![q]) } else { Ok(poses) }
}

/// δ of each point after A along the curve through a pose of A, or which one is beside it.
fn way(
    task: &Task,
    space: &PoseSpace,
    keeps: &BIntegral,
    start: DriveAngles,
    points: &[Vector],
) -> Result<Vec<f64>, (usize, Refusal)> {
    let b = keeps.b([start[0], start[1]]);
    let mut turns = Vec::new();
    let mut now = start[1] - start[0];
    for (i, p) in points.iter().enumerate().skip(1) {
        let miss = |delta: f64| (space.place(&keeps.pose(b, delta)) - p).norm();
        let poses = elbows(task, space, i, *p).map_err(|why| (i, why))?;
        let deltas = poses.iter().map(|q| q[1] - q[0]).filter(|delta| miss(*delta) <= ON_CURVE * space.farthest());
        let Some(delta) = deltas.min_by(|x, y| (x - now).abs().total_cmp(&(y - now).abs())) else {
            return Err((i, beside(task, space, keeps, (b, now), i, *p)));
        };
        turns.push(delta);
        now = delta;
    }
    Ok(turns)
}

/// How far a point lies beside the curve, and where that comes nearest to it.
fn beside(task: &Task, space: &PoseSpace, keeps: &BIntegral, (b, now): (f64, f64), i: usize, p: Vector) -> Refusal {
    let joint = space.joints()[0];
    let [low, high] = joint.bounds();
    let place = |delta: f64| space.place(&keeps.pose(b, delta));
    let allowed = |delta: &f64| {
        let a = joint.of(&[0.0, *delta]);
        a >= low - 1e-9 && a <= high + 1e-9
    };
    let (from, to) = match low.is_finite() {
        true => {
            // δ of the limits: the angle is ±δ + offset.
            let at = |a: f64| (a - joint.of(&[0.0, 0.0])) / (joint.of(&[0.0, 1.0]) - joint.of(&[0.0, 0.0]));
            (at(low).min(at(high)), at(low).max(at(high)))
        }
        false => (now - 0.5 * TAU, now + 0.5 * TAU),
    };
    let looks = (0..=LOOKS).map(|k| from + (to - from) * k as f64 / LOOKS as f64).filter(allowed);
    let far = |delta: &f64| (place(*delta) - p).norm();
    let nearest = looks.min_by(|x, y| far(x).total_cmp(&far(y))).unwrap_or(now);
    let at = place(nearest);
    Refusal::NoWay(format!(
        "at zero momentum two drives move their end effector along one curve, and {} lies {} m beside it: want it at \
         ({}, {}) m, or minimum-norm",
        task.name_of(i.min(task.via.len() + 1)),
        fixed(far(&nearest), 3),
        exactly(at.re),
        exactly(at.im)
    ))
}

/// With as many figures as the curve wants.
fn exactly(x: f64) -> String {
    fixed(x, 9)
}
