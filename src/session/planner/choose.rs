//! Chooses the planner of a task by its kind.

use super::along::along_parts;
use super::change_b::change_b;
use super::given::given;
use super::held::held;
use super::least_reaction::least_reaction;
use super::momentum::zero_momentum;
use super::plan::{Plan, PlannerSpace};
use super::proposals::tried_refusal;
use super::rates::{minimum_norm, same_tip};
use super::turn_base::{may_turn_base, turn_base};
use stillbase_mechanics::planar::DriveAngles;
use stillbase_planning::pose_space::PoseSpace;
use stillbase_planning::timing::TimeLaw;

use crate::refusal::{Refusal, check_time};
use crate::scenario::{Scenario, Task, TaskKind};
use stillbase_settings::word::Choice as _;

/// Largest distance of the first pose of a plan from the start that its task states, rad.
pub(super) const START_TOLERANCE_RAD: f64 = 1e-6;

/// A start may pass a limit by this much, rad, because of rounding.
const LIMIT_TOLERANCE_RAD: f64 = 1e-6;

/// Plans the task of a scenario.
///
/// # Errors
/// If the task is infeasible: the error names the point, part of the path or setting, and a feasible alternative.
pub fn plan(scenario: &Scenario, space: PlannerSpace<'_>) -> Result<Plan, Refusal> {
    if let Some(task) = scenario.task.at_its_start(&scenario.machine) {
        return plan(&Scenario { task, ..scenario.clone() }, space);
    }
    let task = &scenario.task;
    let given = task.samples.is_some();
    // No other start helps an arm that turns no base.
    if task.kind == TaskKind::TurnBase && !given {
        may_turn_base(scenario)?;
    }
    start_within_limits(scenario)?;
    let leaves_plane = !given && matches!(task.kind, TaskKind::MinimumNorm | TaskKind::LeastReaction);
    let plan = directly(scenario, space).map_err(|refusal| match space {
        // With planes, other values of b can be tried quickly.
        Ok(space) if leaves_plane && space.planes().is_ok() => with_nearest_b(scenario, space, refusal),
        _ => refusal,
    })?;
    let begun = |start: DriveAngles| plan.motion.path.at(0.0).q.0.minus(&start.0).max_abs() <= START_TOLERANCE_RAD;
    if !task.start_pose(scenario.machine.drives()).is_none_or(begun) {
        return Err(Refusal::Task(format!(
            "from this start the kind {} finds no motion, but from another pose of A: want no start, or another kind or shape",
            task.kind.words().file
        )));
    }
    let finds_time = task.law.is_fastest() || (task.kind == TaskKind::ChangeB && task.moment_limit.is_some());
    let time = plan.motion.duration();
    // A path without motion takes no time.
    if finds_time && time != 0.0 && time < scenario.step {
        return Err(Refusal::Task(format!(
            "the limits let the motion take {time:.1e} s: want at least one step, {} s, with lower limits or a smaller \
             step",
            scenario.step
        )));
    }
    check_time(time).map(|()| plan)
}

/// Refuses a start past a limit of the machine.
fn start_within_limits(scenario: &Scenario) -> Result<(), Refusal> {
    let machine = &scenario.machine;
    let start =
        scenario.task.start_pose(machine.drives()).filter(|_| scenario.condition_for_effect("task.start").is_none());
    let Some(start) = start else { return Ok(()) };
    match machine.angles().iter().find(|angle| angle.past_limit(&start) > LIMIT_TOLERANCE_RAD) {
        None => Ok(()),
        Some(angle) => Err(Refusal::Task(format!(
            "at the start {} is {:.4} rad: want it from {:.4} to {:.4} rad there, or no start",
            angle.name,
            angle.value(&start),
            angle.limits.start(),
            angle.limits.end()
        ))),
    }
}

/// Plans the task of a scenario, without the proposals of [`with_nearest_b`].
fn directly(scenario: &Scenario, space: PlannerSpace<'_>) -> Result<Plan, Refusal> {
    match scenario.task.kind {
        _ if scenario.task.samples.is_some() => given(scenario, space),
        TaskKind::Given => given(scenario, space),
        TaskKind::Reactionless => held(scenario, space),
        TaskKind::MinimumNorm => along_parts(scenario, &|scenario| minimum_norm(scenario, space)),
        TaskKind::SameTip => along_parts(scenario, &|scenario| same_tip(scenario, space)),
        TaskKind::ChangeB => change_b(scenario, space),
        TaskKind::LeastReaction => least_reaction(scenario, space),
        TaskKind::ZeroMomentum => zero_momentum(scenario, space),
        TaskKind::TurnBase => turn_base(scenario, space),
    }
}

/// Completes the refusal of a task that leaves its plane. If the task's b does not reach A, proposes the nearest b at
/// which the task can be planned.
fn with_nearest_b(scenario: &Scenario, space: &PoseSpace, refusal: Refusal) -> Refusal {
    // The path does not depend on the time law.
    let law = TimeLaw::Quintic;
    let at = |b: f64| Scenario { task: Task { b, law, start: None, ..scenario.task.clone() }, ..scenario.clone() };
    tried_refusal(space, refusal, |b, _| directly(&at(b), Ok(space)).map(|_| ()))
}
