//! Tasks of machines that have no plane of three drives: with one, two, four and more.

use super::along::{Parts, along_parts, curves};
use super::given;
use super::plan::Plan;
use crate::mechanics::planar::{DriveAngles, Vector};
use crate::planning::curves::Path;
use crate::planning::curves::path::{least_rate_curve, minimum_norm_curve};
use crate::planning::pose_constant::Unreachable;
use crate::planning::pose_space::{NoPoseSpace, PoseSpace};
use crate::planning::posture::{Posture, Postures};
use crate::session::refusal::Refusal;
use crate::session::scenario::{Corners, Scenario, Shape, Task, TaskKind};

/// Plans the task of such a machine.
///
/// # Errors
/// Which point, part of the path or setting is in the way, and what would do.
pub(super) fn plan(scenario: &Scenario) -> Result<Plan, Refusal> {
    let (task, drives) = (&scenario.task, scenario.machine.drives());
    if task.samples.is_some() || task.kind == TaskKind::Given {
        return given::given(scenario, None);
    }
    match task.kind {
        TaskKind::Reactionless => along_parts(scenario, &|scenario| reactionless(scenario)),
        TaskKind::MinimumNorm => along_parts(scenario, &|scenario| minimum_norm(scenario)),
        _ => Err(Refusal::Task(format!(
            "this kind of task is for machines of three drives, here are {drives}: want reactionless, minimum-norm or \
             given"
        ))),
    }
}

/// A path that holds b.
fn reactionless(scenario: &Scenario) -> Result<Parts, Refusal> {
    let task = &scenario.task;
    let (space, free) = match PoseSpace::of(&scenario.machine) {
        Err(NoPoseSpace::Free) => (PoseSpace::nominal(&scenario.machine)?, true),
        space => (space?, false),
    };
    let points = task.points();
    match task.shape() {
        Shape::JointLine => joint_lines(task, &space, &points, free),
        _ if free => by_least_rates(scenario, reached(task, &space, 0, points[0])?, None),
        _ if space.drives() < 4 => Err(Refusal::Task(format!(
            "while b is held the end effector of a machine with {} drives has its own way: want the shape joint-line",
            space.drives()
        ))),
        _ => {
            let start = posed(task, &space, 0, points[0], &space.middle())?;
            if task.posture == Posture::LeastRates {
                return by_least_rates(scenario, start, Some(&space));
            }
            in_posture(scenario, &Postures::of(&scenario.machine, &space, task.posture), start)
        }
    }
}

/// Straight lines of joint space from pose to pose.
fn joint_lines(task: &Task, space: &PoseSpace, points: &[Vector], free: bool) -> Result<Parts, Refusal> {
    if task.corners == Corners::Blend && (points.len() > 2 || task.closed) {
        let why = "corners of joint lines are rounded off for three drives only: want corners = stop";
        return Err(Refusal::Task(why.into()));
    }
    let mut near = space.middle();
    let mut q: Vec<DriveAngles> = Vec::with_capacity(points.len() + 1);
    for (i, p) in points.iter().enumerate() {
        let pose = if free { reached(task, space, i, *p)? } else { posed(task, space, i, *p, &near)? };
        near = space.angles(&pose);
        q.push(pose);
    }
    q.extend(task.closed.then(|| q[0]));
    let way = |i: usize| q[i + 1].0.minus(&q[i].0).max_abs();
    let line = |i: usize| (Path::JointLine { from: q[i], to: q[i + 1] }, way(i).max(1e-12));
    let moving = (0..q.len() - 1).filter(|i| q.len() == 2 || way(*i) > 1e-12);
    Ok(moving.map(line).collect())
}

/// Least rates along the end effector's curves, from a pose of A.
fn minimum_norm(scenario: &Scenario) -> Result<Parts, Refusal> {
    let (task, machine) = (&scenario.task, &scenario.machine);
    let points = task.points();
    let start = match PoseSpace::of(machine) {
        Ok(space) if space.drives() > 3 => posed(task, &space, 0, points[0], &space.middle())?,
        _ => reached(task, &PoseSpace::nominal(machine)?, 0, points[0])?,
    };
    by_least_rates(scenario, start, None)
}

/// Least rates along the curves of a task from a start, with b held on a space of poses, if there is one.
fn by_least_rates(scenario: &Scenario, start: DriveAngles, held: Option<&PoseSpace>) -> Result<Parts, Refusal> {
    let (task, tip) = (&scenario.task, scenario.machine.end_effector());
    let mut q = start;
    let mut parts = Vec::new();
    for curve in curves(task, &task.points())? {
        let table = match held {
            Some(space) => least_rate_curve(tip, Some(space.lambda()), q, &curve)?,
            None => minimum_norm_curve(tip, q, &curve)?,
        };
        q = table.nodes().last().map_or(q, |last| last.q);
        parts.push((Path::Table(table), curve.length()));
    }
    Ok(parts)
}

/// Along the curves of a task from a pose at its start, with b held and the freedoms that are left used as it says.
fn in_posture(scenario: &Scenario, postures: &Postures<'_>, start: DriveAngles) -> Result<Parts, Refusal> {
    let task = &scenario.task;
    let mut q = postures.settled(start, task.points()[0], task.b).unwrap_or(start);
    let mut parts = Vec::new();
    for curve in curves(task, &task.points())? {
        let table = postures.path(q, &curve)?;
        q = table.nodes().last().map_or(q, |last| last.q);
        parts.push((Path::Table(table), curve.length()));
    }
    Ok(parts)
}

/// A pose of a point at the b of the task, as near as can be to given relative angles.
fn posed(task: &Task, space: &PoseSpace, i: usize, p: Vector, near: &[f64]) -> Result<DriveAngles, Refusal> {
    space.poses(p, task.b, near).first().copied().ok_or_else(|| {
        let unreachable = match space.reach(p) {
            Err(reason) => Unreachable::Anywhere { x: p.re, y: p.im, reason },
            Ok(set) => {
                let nearest_b = set.nearest(task.b);
                let shown_b = nearest_b.and_then(|b| set.decimal(b, 4));
                Unreachable::OnThisPlane { x: p.re, y: p.im, b: task.b, would_do: set.in_words(), nearest_b, shown_b }
            }
        };
        Refusal::Unreachable { point: task.name_of(i), unreachable }
    })
}

/// A pose of a point at the b nearest to that of the task: of machines on which b says nothing, or leaves no choice.
fn reached(task: &Task, space: &PoseSpace, i: usize, p: Vector) -> Result<DriveAngles, Refusal> {
    let anywhere = |reason| Refusal::Unreachable {
        point: task.name_of(i),
        unreachable: Unreachable::Anywhere { x: p.re, y: p.im, reason },
    };
    space.reach(p).map_err(anywhere)?;
    let none = || Refusal::Task(format!("no pose was found for {}: want another point", task.name_of(i)));
    space.near(p, task.b).ok_or_else(none)
}
