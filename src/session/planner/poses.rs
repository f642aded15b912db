//! Poses of the points of a task.

use std::f64::consts::{PI, TAU};

use super::plan::PlannerSpace;
use crate::refusal::Refusal;
use crate::scenario::{Scenario, Task};
use stillbase_mechanics::planar::{DriveAngles, Vector};
use stillbase_planning::common::unreachable_reason;
use stillbase_planning::pose_constant::Unreachable;
use stillbase_planning::pose_space::PoseSpace;
use stillbase_planning::posed::{self, PoseAngles};
use stillbase_planning::reactionless::NoReach;
use stillbase_settings::number::{ShortNumber, fixed, nine_digits};

/// Returns a pose of each point at the b of the task.
pub(super) fn poses_at_b(task: &Task, space: &PoseSpace, points: &[Vector]) -> Result<Vec<PoseAngles>, Refusal> {
    let Some(start) = stated(task, space.drives(), 0) else {
        return posed::poses_of_points(space, points, task.b).map_err(|(i, unreachable)| refusal(task, i, unreachable));
    };
    let mut poses = vec![PoseAngles::of(space, start)];
    for i in 1..points.len() {
        let near = poses[i - 1].a;
        poses.push(PoseAngles::of(space, posed(task, space, points, i, &near)?));
    }
    Ok(poses)
}

/// Returns the pose of point `i` that the task states: its start, for A on a machine of `drives` drives.
pub(super) fn stated(task: &Task, drives: usize, i: usize) -> Option<DriveAngles> {
    task.start_pose(drives).filter(|_| i == 0)
}

/// Returns a pose of the first point. If the workspace at fixed b is an area, the pose is at the b of the task. On
/// machines with planes it is also on the same sheet as the other points, if possible. If the workspace is no area,
/// the pose is at the nearest b that reaches the point.
pub(super) fn start(scenario: &Scenario, space: PlannerSpace<'_>, points: &[Vector]) -> Result<DriveAngles, Refusal> {
    let task = &scenario.task;
    if let Some(start) = task.start_pose(scenario.machine.drives()) {
        return Ok(start);
    }
    match space {
        Ok(space) if space.reaches_area() => {
            let all = match space.planes() {
                Ok(_) if points.len() > 1 => posed::poses_of_points(space, points, task.b).ok(),
                _ => None,
            };
            let served = all.map_or_else(|| poses_at_b(task, space, &points[..1]), Ok)?;
            served.first().map(|pose| pose.q).ok_or_else(|| Refusal::NoWay("A has no pose".into()))
        }
        _ => reached(task, &PoseSpace::nominal(&scenario.machine)?, 0, points[0]),
    }
}

/// Returns the refusal of a point that the b of the task does not reach, with the name of the point.
pub(super) fn refusal(task: &Task, i: usize, unreachable: Unreachable) -> Refusal {
    match unreachable {
        Unreachable::NoCommonPlane(why) => Refusal::NoCommonPlane { message: why.in_words(&|i| task.name_of(i)), why },
        unreachable => Refusal::Unreachable { point: task.name_of(i), unreachable },
    }
}

/// Returns the pose of `points[i]` at the b of the task that is nearest to the relative angles `near`, rad.
pub(super) fn posed(
    task: &Task,
    space: &PoseSpace,
    points: &[Vector],
    i: usize,
    near: &[f64],
) -> Result<DriveAngles, Refusal> {
    if let Some(start) = stated(task, space.drives(), i) {
        return Ok(start);
    }
    let none = || refusal(task, i, unreachable_reason(space, points, i, task.b));
    space.poses(points[i], task.b, near).first().copied().ok_or_else(none)
}

/// Returns the same pose as [`posed()`] or, if the task sets the orientation of the last link, a pose with this
/// orientation. `kept` is the angle of the last link's drive at the first point, rad, which the drive has to keep.
pub(super) fn poses_facing(
    scenario: &Scenario,
    space: &PoseSpace,
    points: &[Vector],
    i: usize,
    near: &[f64],
    kept: Option<f64>,
) -> Result<DriveAngles, Refusal> {
    let (task, p) = (&scenario.task, points[i]);
    let Some(angle) = task.orientation.filter(|_| scenario.condition_for_effect("task.orientation").is_none()) else {
        return posed(task, space, points, i, near);
    };
    let (drive, turned) = hand_of(scenario);
    let poses = |angle: f64| space.poses_with_drive_angle(p, task.b, drive, angle - turned, near);
    let keeps_angle = |q: &DriveAngles| kept.is_none_or(|kept| (q[drive] - kept).abs() < 1e-6);
    if let Some(q) = poses(angle).into_iter().find(keeps_angle) {
        return Ok(q);
    }
    // The point itself may be out of reach.
    posed(task, space, points, i, near)?;
    let steps = 180;
    let feasible: Vec<bool> =
        (0..steps).map(|k| !poses(angle + TAU * f64::from(k) / f64::from(steps)).is_empty()).collect();
    let at = |k: i32| feasible[k.rem_euclid(steps) as usize];
    let proposal = match (0..=steps / 2).flat_map(|k| [k, -k]).find(|k| at(*k)) {
        None => "another b, or no orientation".into(),
        Some(k) => {
            let low = (0..steps).map(|j| k - j).find(|k| !at(*k)).map_or(k, |k| k + 1);
            let high = (0..steps).map(|j| k + j).find(|k| !at(*k)).map_or(k, |k| k - 1);
            let turned = |k: i32| fixed(angle + TAU * f64::from(k) / f64::from(steps), 2);
            format!("it from {} to {} rad, another b, or no orientation", turned(low), turned(high))
        }
    };
    Err(Refusal::NoWay(format!(
        "at {} no pose of b = {} rad has the last link point to {} rad: want {proposal}",
        task.name_of(i),
        nine_digits(task.b),
        ShortNumber(angle)
    )))
}

/// Returns the drive of the last link, and the angle of the link relative to the drive angle, 0 or π rad.
pub(super) fn hand_of(scenario: &Scenario) -> (usize, f64) {
    let machine = &scenario.machine;
    let link = &machine.resolved_links()[machine.end_link()];
    (link.drive, if link.sign < 0.0 { PI } else { 0.0 })
}

/// Returns the refusal of a point that no b reaches.
pub(super) fn no_b_refusal(task: &Task, i: usize, p: Vector, reason: NoReach) -> Refusal {
    Refusal::Unreachable { point: task.name_of(i), unreachable: Unreachable::Anywhere { x: p.re, y: p.im, reason } }
}

/// Returns a pose of a point at the b nearest to that of the task. Used for machines without a b to hold, or with a
/// single b for each point.
pub(super) fn reached(task: &Task, space: &PoseSpace, i: usize, p: Vector) -> Result<DriveAngles, Refusal> {
    if let Some(start) = stated(task, space.drives(), i) {
        return Ok(start);
    }
    space.reach(p).map_err(|reason| no_b_refusal(task, i, p, reason))?;
    let none = || Refusal::Task(format!("no pose was found for {}: want another point", task.name_of(i)));
    space.pose_at_nearest_b(p, task.b).ok_or_else(none)
}
