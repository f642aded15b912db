//! What a [`ViewChange`] does to a [`ViewState`].

use super::{Command, Finder, Framing, Layout, Switch, ViewChange, ViewState};
use crate::picture::scene::Measure;
use crate::picture::scene::views::ViewKind;
use crate::session::Session;

impl Switch {
    /// Whether only views of the machine have it.
    pub fn is_of_machine(self) -> bool {
        matches!(self, Self::Dexterity | Self::Snapshots | Self::Holding | Self::Drawing | Self::Pushing)
    }
}

impl ViewState {
    /// Whether something is on.
    pub fn is_on(&self, switch: Switch) -> bool {
        match switch {
            Switch::Side => self.side.shown,
            Switch::Plots => self.plots.shown,
            Switch::Panels => self.side.shown || self.plots.shown,
            Switch::Swapped => self.swapped,
            Switch::History => self.history,
            Switch::Compare => self.compare,
            Switch::Study => self.study,
            Switch::Pins => self.pins,
            Switch::Snapshots => self.snapshots,
            Switch::Help => self.help,
            Switch::Times => self.times,
            Switch::Finder => self.finder.is_some(),
            Switch::Equations => self.view == ViewKind::Design && self.plots.shown && self.learns,
            Switch::Loop => self.loops,
            Switch::Exaggeration => self.exaggerates_base,
            Switch::TurnTask => self.turn_task,
            Switch::Dexterity => self.dexterity.is_some(),
            Switch::Holding => self.stroke.is_none() && !self.pushing,
            Switch::Drawing => self.stroke.is_some(),
            Switch::Pushing => self.pushing,
        }
    }

    /// Whether something can be turned on and off as things are.
    pub fn has(&self, switch: Switch, session: &Session) -> bool {
        match switch {
            Switch::Exaggeration => session.scenario().base.moves(),
            Switch::History => self.layout != Layout::Present,
            _ => !switch.is_of_machine() || self.view.shows_machine(),
        }
    }

    /// Turns something off that is on, and on otherwise.
    pub fn other(&self, switch: Switch) -> Command {
        ViewChange::Switch(switch, !self.is_on(switch)).into()
    }

    fn turn(&mut self, switch: Switch, on: bool) {
        match switch {
            Switch::Side => self.side.shown = on,
            Switch::Plots => self.plots.shown = on,
            Switch::Panels => (self.side.shown, self.plots.shown) = (on, on),
            Switch::Swapped => self.swapped = on,
            Switch::History => self.history = on,
            // The window has room for one of the two panels.
            Switch::Compare => (self.compare, self.study) = (on, self.study && !on),
            Switch::Study => (self.study, self.compare) = (on, self.compare && !on),
            Switch::Pins => self.pins = on,
            Switch::Snapshots => self.snapshots = on,
            Switch::Help => self.help = on,
            Switch::Times => self.times = on,
            Switch::Finder => self.finder = on.then(Finder::default),
            Switch::Equations => {
                self.learns = on;
                // The front is out of sight.
                self.ghost = None;
                if on {
                    (self.plots.shown, self.view) = (true, ViewKind::Design);
                }
            }
            Switch::Loop => self.loops = on,
            Switch::Exaggeration => self.exaggerates_base = on,
            Switch::TurnTask => self.turn_task = on,
            Switch::Dexterity => self.dexterity = on.then_some(Measure::Det),
            Switch::Holding => (self.stroke, self.pushing) = (None, false),
            Switch::Drawing => {
                self.stroke = on.then(Vec::new);
                self.pushing &= !on;
            }
            Switch::Pushing => {
                self.pushing = on;
                self.stroke = self.stroke.take().filter(|_| !on);
            }
        }
    }

    pub(super) fn apply(&mut self, change: ViewChange) {
        match change {
            ViewChange::Switch(switch, on) => self.turn(switch, on),
            ViewChange::Kind(view) => self.view = view,
            ViewChange::Layout(layout) => self.lay_out(layout),
            ViewChange::Theme(theme) => self.theme = theme,
            ViewChange::Speed(speed) => self.speed = speed,
            ViewChange::Dexterity(shown) => self.dexterity = shown,
            ViewChange::Fit => self.framing[self.view as usize] = Framing::Wanted,
            ViewChange::Look(look) => self.look(look),
            ViewChange::Drives(drives) => {
                self.drives = drives;
                self.framing[ViewKind::Joints as usize].renew();
            }
            ViewChange::Mark(time) => self.mark = time,
            ViewChange::Charts(change) => self.charts.change(change),
            ViewChange::Preview(b) => self.preview = b,
            ViewChange::Ghost(i) => self.ghost = i,
            ViewChange::FrontBy(by) => self.front_by = by,
            ViewChange::Reveal(thing) => {
                self.side.shown = true;
                self.revealed = Some(thing);
            }
            ViewChange::LookUp(path) => {
                self.side.shown = true;
                if self.view == ViewKind::Design {
                    self.view = ViewKind::Flat;
                }
                self.looked_up = Some(path);
            }
            ViewChange::LeaveNaming => self.naming = None,
            ViewChange::Dialog(dialog) => self.dialog = dialog,
        }
    }
}
