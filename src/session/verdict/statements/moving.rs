//! Queries about the machine of a run: its constants, and the statement on it as it moves.

use std::sync::Arc;

use super::{Statement, StatusLight};
use crate::Run;
use stillbase_mechanics::machine::{Inertia, Machine};
use stillbase_query::{QuickQuery, QuickWork};
use stillbase_simulation::frame::Frame;
use stillbase_simulation::plant::PlantDifferences;

/// Query for the constants of a machine.
struct ModelInertia;

impl QuickQuery for ModelInertia {
    type Input = Machine;
    type Answer = Inertia;

    fn answer(machine: &Machine) -> Inertia {
        Inertia::of(machine)
    }
}

/// Returns the constants of the machine of a run, from the run's cache of queries.
pub fn inertia_of(run: &Run) -> Arc<Inertia> {
    run.queries().ask::<QuickWork<ModelInertia>>(&run.scenario().machine)
}

/// Query for the statement whether a machine is balanced as it moves: with differences from the model and, if it is
/// held, with the payload that control does not know of.
struct MovingMachine;

impl QuickQuery for MovingMachine {
    /// The model, what differs from it, and whether the payload is held.
    type Input = (Machine, PlantDifferences, bool);
    type Answer = Statement;

    fn answer((model, plant, holds): &Self::Input) -> Statement {
        let stated = Statement::of_machine(&Inertia::of(model));
        if *plant == PlantDifferences::default() {
            return stated;
        }
        let built = plant.machine(model);
        let moving = built.and_then(|built| if *holds { plant.payload.held_by(&built) } else { Ok(built) });
        // A plant that is no valid machine is refused before a run begins.
        let Ok(moving) = moving else { return stated };
        let own = Statement::of_machine(&Inertia::of(&moving));
        let what = if *holds { "the payload that control does not know of" } else { "what differs from the model" };
        match (stated.outcome, own.outcome) {
            (StatusLight::Good, StatusLight::Bad) => Statement::new(
                StatusLight::Bad,
                format!("{} {}", own.words, if *holds { "with its payload" } else { "as built" }),
                format!("the model is balanced, but not the machine with {what}: {}", own.why),
            ),
            (StatusLight::Bad, StatusLight::Good) => Statement::new(
                StatusLight::Good,
                format!("balanced {}", if *holds { "with its payload" } else { "as built" }),
                format!("the model is not balanced, but the machine is with {what}: {}", own.why),
            ),
            _ => own,
        }
    }
}

/// Returns the statement whether the machine of a run is balanced as it moves at a frame, from the run's cache of
/// queries.
pub fn of_moving_machine(run: &Run, frame: &Frame) -> Arc<Statement> {
    let scenario = run.scenario();
    let (model, plant) = (&scenario.machine, &scenario.plant);
    let holds = plant.payload.is_held(frame.time, 0.5 * scenario.step);
    run.queries().ask_if::<QuickWork<MovingMachine>>(
        |(known_model, known_plant, known_holds)| *known_holds == holds && known_plant == plant && known_model == model,
        || (model.clone(), plant.clone(), holds),
    )
}
