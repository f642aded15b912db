//! Motions of the end effector that do not hold b: with least joint rates, or with the motion of drive 1 chosen freely.

use super::along::{PathSegments, by_least_rates, curves};
use super::plan::PlannerSpace;
use super::poses::{posed, poses_at_b, reached, start};
use crate::refusal::Refusal;
use crate::scenario::Scenario;
use stillbase_planning::curves::Path;
use stillbase_planning::curves::path::{SameTip, same_tip_path};
use stillbase_planning::pose_space::PoseSpace;
use stillbase_planning::posed::PoseAngles;

/// Follows the curves of the end effector with least joint rates, from a pose with the end effector at A.
pub(super) fn minimum_norm(scenario: &Scenario, space: PlannerSpace<'_>) -> Result<PathSegments, Refusal> {
    let (task, points) = (&scenario.task, scenario.task.points());
    let start = start(scenario, space, &[points[0], points[points.len() - 1]])?;
    by_least_rates(scenario, start, &curves(task, &points)?, None)
}

/// Moves the end effector as on the joint line from A to B. Drive 1 turns to the angle `first_drive_to` of the task,
/// by default its start angle, and the other drives follow.
pub(super) fn same_tip(scenario: &Scenario, space: PlannerSpace<'_>) -> Result<PathSegments, Refusal> {
    let (task, machine) = (&scenario.task, &scenario.machine);
    if !machine.is_redundant() {
        return Err(Refusal::Task(
            "with one or two drives the end effector's motion leaves drive 1 no course of its own: want minimum-norm, \
             which follows a path of the end effector, or change-b, which goes to another b"
                .into(),
        ));
    }
    if !task.via.is_empty() || task.closed {
        let why = "same-tip goes straight from A to B: want no points between and an open path";
        return Err(Refusal::Task(why.into()));
    }
    let points = task.points();
    let last = points.len() - 1;
    let tip = machine.end_effector();
    let first_to = |from: &PoseAngles| task.first_drive_to.unwrap_or(from.q[0]);
    if let Ok(space) = space
        && space.planes().is_ok()
    {
        let [from, to] = poses_at_b(task, space, &[points[0], points[last]])?[..] else {
            return Err(Refusal::Task("same-tip: want two points".into()));
        };
        return Ok(vec![(Path::SameTip(SameTip::new(tip, from.q, to.q, first_to(&from))?), 1.0)]);
    }
    let nominal;
    let (known, has_b) = match space {
        Ok(space) => (space, true),
        Err(_) => {
            nominal = PoseSpace::nominal(machine)?;
            (&nominal, false)
        }
    };
    let pose = |i: usize, near: &[f64]| {
        let q = match has_b {
            true => posed(task, known, &points, i, near)?,
            false => reached(task, known, i, points[i])?,
        };
        Ok::<PoseAngles, Refusal>(PoseAngles::of(known, q))
    };
    let from = pose(0, &known.middle())?;
    let to = pose(last, &from.a)?;
    Ok(vec![(Path::Table(same_tip_path(tip, from.q, to.q, first_to(&from))?), 1.0)])
}
