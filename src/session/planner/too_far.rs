//! Points beyond the reach of an arm that moves at zero momentum: they, and no singularity on the way, end the plan.

use super::momentum::momentum_model;
use super::poses::no_b_refusal;
use crate::refusal::Refusal;
use crate::scenario::Scenario;
use stillbase_planning::off_plane::drift::DriftError;
use stillbase_planning::off_plane::momentum::TipFrame;
use stillbase_planning::reactionless::NoReach;
use stillbase_settings::number::fixed;
use stillbase_simulation::plant::BaseKind;

/// Returns the refusal of the first point that the arm cannot reach by any motion, if a plan stopped at a singularity.
pub(super) fn beyond_reach(scenario: &Scenario, refusal: &Refusal) -> Option<Refusal> {
    let is_singular = matches!(refusal, Refusal::Drift(DriftError::Singular { .. }) | Refusal::Turns { .. });
    let task = &scenario.task;
    let start = task.start_pose(scenario.machine.drives()).filter(|_| is_singular)?;
    let (centre, farthest) = momentum_model(scenario, &start, task.frame()).range();
    let points = task.points().into_iter().enumerate().skip(1);
    let (i, p, distance) = points.map(|(i, p)| (i, p, (p - centre).norm())).find(|(.., far)| *far > farthest)?;
    if scenario.base.kind == BaseKind::Free && task.frame() == TipFrame::Space {
        let [x, y] = [p.re, p.im].map(|x| fixed(x, 3));
        return Some(Refusal::NoWay(format!(
            "{} ({x}, {y}) m: the point is {} m from the common centre of mass, but the arm reaches only {} m from there: \
             want it nearer",
            task.name_of(i),
            fixed(distance, 3),
            fixed(farthest, 3)
        )));
    }
    Some(no_b_refusal(task, i, p, NoReach::TooFar { distance, farthest }))
}
