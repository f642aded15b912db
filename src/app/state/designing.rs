//! Edits in the design view, and the counterweights applied there.

use super::AppState;
use crate::change::SessionChange;
use crate::{FrontsCommand, studio};
use stillbase_mechanics::counterweights::{MATERIALS, Objective};
use stillbase_mechanics::machine::Machine;
use stillbase_picture::scene::views::ViewKind;
use stillbase_query::{Query, Shared};
use stillbase_session::Edit;
use stillbase_session::design::{brief_edit, counterweights_edit, machine_edit};
use stillbase_session::parts::set_heights;
use stillbase_session::scenario::Scenario;
use stillbase_study::fronts::{FrontCase, Fronts};
use stillbase_study::lengths::{LengthSearch, LengthsQuery};

impl AppState {
    /// Extends an edit of the machine in the design view by the changes that keep the machine balanced, if the user
    /// has chosen that.
    pub(super) fn with_balance(&mut self, edit: Edit) -> Result<Edit, String> {
        let Edit::Set { change } = &edit else { return Ok(edit) };
        if self.view_state.view != ViewKind::Design {
            return Ok(edit);
        }
        let scenario = self.session.scenario();
        if edit.sets_machine() {
            let start = self.designed_from.get_or_insert_with(|| scenario.machine.clone());
            return scenario.design.edit(&scenario.machine, start, change);
        }
        if edit.part("design").is_some() { brief_edit(scenario, change) } else { Ok(edit) }
    }

    /// Stops unfinished searches for Pareto fronts that are not on display any more. If no other machine's front is
    /// listed, the cached fronts of other machines are removed.
    pub(super) fn refresh_fronts(&mut self) {
        if self.view_state.view != ViewKind::Design || self.view_state.arrangement.shows_equations {
            studio::leave(self.queries());
        } else if self.fronts.is_empty() {
            self.queries().forget::<Fronts>();
        }
    }

    /// Adds or removes a Pareto front that is drawn beside that of the machine being designed.
    pub(super) fn change_fronts(&mut self, change: FrontsCommand) {
        let Scenario { machine, design, .. } = self.session.scenario();
        match change {
            FrontsCommand::Keep => {
                let material = MATERIALS.iter().find(|(_, density)| *density == design.density);
                let material = material.map_or_else(|| format!("{} kg/m³", design.density), |(name, _)| (*name).into());
                let name = format!("{}, {material}, reach {:.2} m", machine.name(), machine.reach());
                self.fronts.push(FrontCase::of(name, machine, design));
            }
            FrontsCommand::Add(other) => self.fronts.push(FrontCase::of(other.name(), &other, design)),
            FrontsCommand::Remove(place) if place < self.fronts.len() => drop(self.fronts.remove(place)),
            FrontsCommand::Remove(_) => {}
        }
    }

    /// Returns the request of a search for link lengths with the present design brief; `None` if the machine is not
    /// valid without its counterweights.
    fn length_search_input(&self, objective: Objective) -> Option<<LengthsQuery as Query>::Input> {
        let Scenario { machine, design, .. } = self.session.scenario();
        let bare = machine.without_counterweights().ok()?;
        let request = LengthSearch::of(design, &bare, objective);
        Some((Shared(bare.into()), request))
    }

    /// Starts a new search for link lengths.
    pub(super) fn seek(&mut self, objective: Objective) {
        self.queries().forget::<LengthsQuery>();
        self.seeking = self.length_search_input(objective);
    }

    /// Continues the search for link lengths, or drops it if its request has changed.
    pub(super) fn refresh_seeking(&mut self) {
        let Some(seeking) = self.seeking.take() else { return };
        self.seeking = self.length_search_input(seeking.1.spec.objective.clone()).filter(|now| *now == seeking);
        match &self.seeking {
            Some(seeking) => drop(self.queries().ask_in_background::<LengthsQuery>(seeking)),
            None => self.queries().forget::<LengthsQuery>(),
        }
    }

    /// Applies the link lengths found to the machine, with their counterweights.
    pub(super) fn take_lengths(&mut self) -> Result<(), String> {
        let found = self.seeking.as_ref().and_then(|seeking| self.queries().known::<LengthsQuery>(seeking));
        let found = found.as_deref().and_then(|found| found.as_ref().ok()).ok_or("no lengths were found yet")?;
        let edit =
            machine_edit(self.session.scenario(), &found.placed.machine).ok_or("the machine has these lengths")?;
        self.change(SessionChange::Edit(edit));
        Ok(())
    }

    /// Makes the machine of the bars that are weighed, with their counterweights.
    pub(super) fn take_cut(&mut self) -> Result<(), String> {
        let found = studio::as_cut(self.queries(), &self.session).ok_or("the machine is not weighed as it is cut")?;
        let found = found.as_ref().as_ref().map_err(ToString::to_string)?;
        let edit =
            machine_edit(self.session.scenario(), &found.placed.machine).ok_or("the machine is cut like this")?;
        self.change(SessionChange::Edit(edit));
        Ok(())
    }

    /// Gives the links the heights of the layers in which no two parts meet.
    pub(super) fn take_heights(&mut self) -> Result<(), String> {
        let found = studio::layers_of(self.queries(), &self.session);
        let machine = &self.session.scenario().machine;
        let why = || found.within_limits.as_ref().err().map_or_else(String::new, ToString::to_string);
        let report = found.report().ok_or_else(why)?;
        if report.is_used_by(machine) {
            return Err("the machine has the heights of its layers already".into());
        }
        let edit = set_heights(machine, &report.machine);
        self.change(SessionChange::Edit(edit));
        Ok(())
    }

    /// Applies the counterweights of point `i` of the Pareto front.
    pub(super) fn take_of_front(&mut self, i: usize) {
        let Some(machine) = studio::of_front(self.queries(), &self.session, i) else { return };
        // On bars that are cut, the machine is that of these bars.
        match self.session.scenario().design.as_cut {
            true => {
                if let Some(edit) = machine_edit(self.session.scenario(), &machine) {
                    self.change(SessionChange::Edit(edit));
                }
            }
            false => self.take_weights(&machine),
        }
    }

    /// Applies the counterweights and rotor ratios with the least Σ |D_k|, the momentum that the drives give to the
    /// base.
    pub(super) fn take_stillest(&mut self) -> Result<(), String> {
        let scenario = self.session.scenario();
        let placed = scenario.design.least_momentum(&scenario.machine).map_err(|why| why.to_string())?;
        self.take_weights(&placed.machine);
        Ok(())
    }

    /// Applies the counterweights of another machine.
    fn take_weights(&mut self, of: &Machine) {
        let edit = counterweights_edit(self.session.scenario(), of);
        self.change(SessionChange::Edit(edit));
    }
}
