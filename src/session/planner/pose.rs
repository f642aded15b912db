//! Poses of the points of a task, of machines without planes.

use crate::mechanics::planar::{DriveAngles, Vector};
use crate::planning::pose_constant::Unreachable;
use crate::planning::pose_space::PoseSpace;
use crate::planning::reactionless::NoReach;
use crate::session::refusal::Refusal;
use crate::session::scenario::{Scenario, Task};

/// A pose of A: at the b of the task where that leaves a choice.
pub(super) fn start(scenario: &Scenario) -> Result<DriveAngles, Refusal> {
    let (task, machine) = (&scenario.task, &scenario.machine);
    let points = task.points();
    match PoseSpace::of(machine) {
        Ok(space) if space.drives() > 3 => posed(task, &space, 0, points[0], &space.middle()),
        _ => reached(task, &PoseSpace::nominal(machine)?, 0, points[0]),
    }
}

/// A pose of a point at the b of the task, as near as can be to given relative angles.
pub(super) fn posed(task: &Task, space: &PoseSpace, i: usize, p: Vector, near: &[f64]) -> Result<DriveAngles, Refusal> {
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

/// A point that no b reaches.
pub(super) fn off(task: &Task, i: usize, p: Vector, reason: NoReach) -> Refusal {
    Refusal::Unreachable { point: task.name_of(i), unreachable: Unreachable::Anywhere { x: p.re, y: p.im, reason } }
}

/// A pose of a point at the b nearest to that of the task: of machines on which b says nothing, or leaves no choice.
pub(super) fn reached(task: &Task, space: &PoseSpace, i: usize, p: Vector) -> Result<DriveAngles, Refusal> {
    space.reach(p).map_err(|reason| off(task, i, p, reason))?;
    let none = || Refusal::Task(format!("no pose was found for {}: want another point", task.name_of(i)));
    space.near(p, task.b).ok_or_else(none)
}
