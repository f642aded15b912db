//! The plan of a task, by its kind.

use super::along::{along, tried};
use super::plan::Plan;
use super::{any_drives, given, off_plane};
use crate::planning::pose_constant::Planes;
use crate::planning::timing::TimeLaw;

use crate::session::refusal::{Refusal, allowed};
use crate::session::scenario::{Scenario, Task, TaskKind};

/// Plans the task of a scenario.
///
/// # Errors
/// Which point, part of the path or setting is in the way, and what would do.
pub fn plan(scenario: &Scenario, planes: Option<&Planes>) -> Result<Plan, Refusal> {
    let task = &scenario.task;
    let given = task.samples.is_some();
    let leaves_plane = !given && matches!(task.kind, TaskKind::MinimumNorm | TaskKind::LeastReaction);
    let plan = match planes {
        None => any_drives::plan(scenario)?,
        Some(planes) => directly(scenario, planes).map_err(|refusal| match leaves_plane {
            true => elsewhere(scenario, planes, refusal),
            false => refusal,
        })?,
    };
    let found = task.law.is_fastest() || (task.kind == TaskKind::ChangeB && task.moment_limit.is_some());
    let time = plan.motion.duration();
    // A path that goes nowhere takes no time.
    if found && time != 0.0 && time < scenario.step {
        return Err(Refusal::Task(format!(
            "the limits let the motion take {time:.1e} s: want at least one step, {} s, with lower limits or a smaller \
             step",
            scenario.step
        )));
    }
    allowed(time).map(|()| plan)
}

/// The same, where a refusal proposes nothing that has to be planned first.
fn directly(scenario: &Scenario, planes: &Planes) -> Result<Plan, Refusal> {
    let task = &scenario.task;
    if task.samples.is_some() || task.kind == TaskKind::Given {
        given::given(scenario, Some(planes))
    } else {
        match task.kind {
            TaskKind::ChangeB => off_plane::change_b(scenario, planes),
            TaskKind::LeastReaction => off_plane::least_reaction(scenario, planes),
            TaskKind::ZeroMomentum => off_plane::zero_momentum(scenario, planes),
            TaskKind::Reactionless | TaskKind::MinimumNorm | TaskKind::SameTip | TaskKind::Given => {
                along(scenario, planes)
            }
        }
    }
}

/// A refusal for a b that does not reach A, of a task that leaves its plane: the b nearest to it with which it can be
/// planned.
fn elsewhere(scenario: &Scenario, planes: &Planes, refusal: Refusal) -> Refusal {
    // Where a path goes does not depend on the time law.
    let law = TimeLaw::Quintic;
    let at = |b: f64| Scenario { task: Task { b, law, ..scenario.task.clone() }, ..scenario.clone() };
    tried(planes.map(), refusal, |b, _| directly(&at(b), planes).map(|_| ()))
}
