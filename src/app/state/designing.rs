//! What becomes of edits in the design view, and the counterweights that are taken there.

use super::AppState;
use crate::app::change::Change;
use crate::app::{FrontsCommand, studio};
use crate::mechanics::machine::Machine;
use crate::picture::scene::views::ViewKind;
use crate::session::Edit;
use crate::session::design::{briefed, weights_of};
use crate::session::scenario::Scenario;
use crate::study::fronts::FrontOf;

impl AppState {
    /// An edit with what follows from it where a machine that is designed is kept balanced.
    pub(super) fn designed(&mut self, edit: Edit) -> Result<Edit, String> {
        let Edit::Set { change } = &edit else { return Ok(edit) };
        if self.view_state.view != ViewKind::Design {
            return Ok(edit);
        }
        let scenario = self.session.scenario();
        if edit.sets_machine() {
            let start = self.designed_from.get_or_insert_with(|| scenario.machine.clone());
            return scenario.design.edit(&scenario.machine, start, change);
        }
        if edit.part("design").is_some() { briefed(scenario, change) } else { Ok(edit) }
    }

    /// Changes which fronts are drawn beside that of the machine that is designed.
    pub(super) fn change_fronts(&mut self, change: FrontsCommand) {
        let Scenario { machine, design, .. } = self.session.scenario();
        match change {
            FrontsCommand::Keep => self.fronts.push(FrontOf::of(machine.name(), machine, design)),
            FrontsCommand::Add(machine) => {
                self.fronts.push(FrontOf::of(machine.name(), &machine, design));
            }
            FrontsCommand::Remove(place) if place < self.fronts.len() => drop(self.fronts.remove(place)),
            FrontsCommand::Remove(_) => {}
        }
    }

    /// Takes the counterweights of a machine of the front, by its place.
    pub(super) fn take_of_front(&mut self, i: usize) {
        if let Some(machine) = studio::of_front(self.queries(), &self.session, i) {
            self.take_weights(&machine);
        }
    }

    /// Takes the counterweights and ratios of rotors with which the drives give least to the base.
    pub(super) fn take_stillest(&mut self) -> Result<(), String> {
        let scenario = self.session.scenario();
        let placed = scenario.design.stillest(&scenario.machine).map_err(|why| why.to_string())?;
        self.take_weights(&placed.machine);
        Ok(())
    }

    /// Takes the counterweights of another machine.
    fn take_weights(&mut self, of: &Machine) {
        let edit = weights_of(self.session.scenario(), of);
        self.change(Change::Edit(edit));
    }
}
