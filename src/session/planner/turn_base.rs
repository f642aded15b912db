//! Closed motions of the arm that turn a free base.

use std::sync::Arc;

use super::along::in_rounds;
use super::momentum::momentum_model;
use super::plan::{Plan, PlannerSpace, arm_on_base};
use super::poses::start;
use crate::refusal::Refusal;
use crate::scenario::{MAX_CYCLES, Scenario};
use stillbase_mechanics::machine::Inertia;
use stillbase_planning::curves::Path;
use stillbase_planning::off_plane::base_forecast::BaseForecast;
use stillbase_planning::off_plane::momentum::TipFrame;
use stillbase_planning::off_plane::turning_loop::{NoLoop, TurningLoop};

/// Number of counts of loops that are tried for a proposal.
const MAX_TRIES: usize = 3;

/// Checks that some loop of the drives may turn the base by the angle of the task, wherever it starts.
pub(super) fn may_turn_base(scenario: &Scenario) -> Result<(), Refusal> {
    if !scenario.base.floats() {
        return Err(Refusal::Task(
            "an arm turns only a base that floats: want base.kind = free, and no wheel that holds it".into(),
        ));
    }
    if scenario.task.base_turn == 0.0 {
        return Err(Refusal::Task("a base that stays needs no motion: want task.base_turn other than 0".into()));
    }
    match NoLoop::of(&Inertia::of(&scenario.machine)) {
        Some(why) => Err(Refusal::Loop { why, cycles: None }),
        None => Ok(()),
    }
}

/// Plans the shortest loop of the drives found that turns the base by the angle of the task, as often as the task says.
pub(super) fn turn_base(scenario: &Scenario, space: PlannerSpace<'_>) -> Result<Plan, Refusal> {
    let task = &scenario.task;
    let start = start(scenario, space, &task.points())?;
    let model = momentum_model(scenario, &start, TipFrame::Space);
    let shortest = |cycles: u32| {
        let wanted = task.base_turn.to_radians() / f64::from(cycles);
        TurningLoop::shortest(&model, scenario.machine.angles(), &start, wanted)
    };
    let found = shortest(task.cycles).map_err(|why| match why {
        NoLoop::Short { turn } if turn > 0.0 => {
            let least = (task.base_turn.to_radians().abs() / turn).ceil().min(1e9) as u32;
            let counts = (least.max(task.cycles + 1)..=MAX_CYCLES).take(MAX_TRIES);
            let cycles = counts.into_iter().find(|cycles| shortest(*cycles).is_ok());
            Refusal::Loop { why, cycles }
        }
        why => Refusal::Loop { why, cycles: None },
    })?;
    let plan = in_rounds(scenario, start, &|q, _| Ok((vec![(Path::Table(found.path.clone()), found.length)], q)))?;
    let base_turn = BaseForecast::of(&arm_on_base(scenario), &plan.motion).map(Arc::new);
    Ok(Plan { beside_base: Some(Arc::new(model)), base_turn, loop_length: Some(found.length), ..plan })
}
