//! Plans the motion of a task: poses of its points, a path through them, and the timing. The same code plans for any
//! number of drives; the pose space says what a machine cannot do.

mod along;
mod change_b;
mod choose;
mod given;
mod held;
mod least_reaction;
mod momentum;
mod plan;
mod poses;
mod posture;
mod proposals;
mod rates;
mod too_far;
mod turn_base;

pub use along::curves;
pub(crate) use momentum::{momentum_model, rays_from};
pub(crate) use plan::carried;
pub use plan::{Plan, arm_on_base};

use crate::refusal::Refusal;
use crate::scenario::Scenario;
use plan::PlannerSpace;

/// Plans the motion of a task.
pub(super) fn plan(scenario: &Scenario, space: PlannerSpace<'_>) -> Result<Plan, Refusal> {
    choose::plan(scenario, space).map_err(|refusal| too_far::beyond_reach(scenario, &refusal).unwrap_or(refusal))
}
