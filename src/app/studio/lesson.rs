//! [`MachineEquations`]: the equations with the numbers of the machine on display.

use std::sync::Arc;

use stillbase_mechanics::balance::Preset;
use stillbase_mechanics::machine::Machine;
use stillbase_query::{Queries, QuickQuery, QuickWork};
use stillbase_session::Session;
use stillbase_study::equations::{DriveState, Equation, InstantKind, equations};

/// The equations of a machine at an instant.
pub struct MachineEquations {
    /// The equations in the order of the paper.
    pub(super) equations: Vec<Equation>,
    /// The instant.
    pub(super) when: InstantKind,
}

impl QuickQuery for MachineEquations {
    /// The machine, the instant, and the penalties of (10).
    type Input = (Machine, DriveState, Preset);
    type Answer = Self;

    fn answer((machine, state, penalties): &Self::Input) -> Self {
        Self { equations: equations(machine, state, *penalties), when: state.when }
    }
}

impl MachineEquations {
    /// Queries the equations for the machine and the instant on display.
    pub fn of(queries: &Queries, session: &Session, penalties: Preset) -> Option<Arc<Self>> {
        let (machine, state) = (&session.scenario().machine, DriveState::of(session.run(), session.frame()));
        // The frame of a waiting run may belong to a machine with another number of drives.
        match state.q.len() == machine.drives() {
            true => Some(queries.ask::<QuickWork<Self>>(&(machine.clone(), state, penalties))),
            false => queries.last::<QuickWork<Self>>(),
        }
    }
}
