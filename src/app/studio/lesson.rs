//! [`Lesson`]: the equations of the machine on display with its numbers, found when these change.

use crate::mechanics::balance::Preset;
use crate::mechanics::machine::Machine;
use crate::session::Session;
use crate::study::equations::{Equation, State, When, equations};

/// Of the machine and the instant on display.
#[derive(Default)]
pub struct Lesson {
    of: Option<(Machine, State, Preset)>,
    equations: Vec<Equation>,
}

impl Lesson {
    /// Finds them, if the machine, the instant or the penalties of (10) have changed.
    pub fn follow(&mut self, session: &Session, penalties: Preset) {
        let (machine, state) = (&session.scenario().machine, State::of(session.run(), session.frame()));
        let is_known = self
            .of
            .as_ref()
            .is_some_and(|(known, then, how)| *known == *machine && *then == state && *how == penalties);
        // A run that waits may be of a machine with fewer drives.
        if is_known || state.q.len() != machine.drives() {
            return;
        }
        self.equations = equations(machine, &state, penalties);
        self.of = Some((machine.clone(), state, penalties));
    }

    /// In the order of the paper.
    pub(super) fn equations(&self) -> &[Equation] {
        &self.equations
    }

    /// The instant.
    pub(super) fn when(&self) -> Option<When> {
        self.of.as_ref().map(|(_, state, _)| state.when)
    }
}
