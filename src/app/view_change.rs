//! Application of a [`ViewChange`] to a [`ViewState`].

use super::{
    BottomPanel, Command, Finder, Framing, GuideStep, GuideView, Layout, PenTool, StatusMessage, Switch, Tool,
    ViewChange, ViewState, studio,
};
use stillbase_picture::scene::Measure;
use stillbase_picture::scene::views::ViewKind;
use stillbase_session::Session;

impl Switch {
    /// Whether only views of the machine have this switch.
    pub fn is_of_machine(self) -> bool {
        matches!(
            self,
            Self::Dexterity
                | Self::Snapshots
                | Self::Pair
                | Self::Holding
                | Self::Drawing
                | Self::Pushing
                | Self::Measuring
        )
    }
}

impl ViewState {
    /// Whether a switch is on.
    pub fn is_on(&self, switch: Switch) -> bool {
        match switch {
            Switch::Side => self.arrangement.now().side.shown,
            Switch::Plots => self.arrangement.now().plots.shown,
            Switch::Panels => {
                [self.arrangement.now().side, self.arrangement.now().plots].iter().any(|panel| panel.shown)
            }
            Switch::Swapped => self.arrangement.swapped,
            Switch::History => self.open.history,
            Switch::Compare => self.below == Some(BottomPanel::Runs),
            Switch::Pair => self.pair.is_some(),
            Switch::Study => self.below == Some(BottomPanel::Tolerances),
            Switch::Table => self.below == Some(BottomPanel::Table),
            Switch::Pins => self.pins,
            Switch::Snapshots => self.snapshots,
            Switch::Help => self.open.help,
            Switch::Guide => self.open.guide.is_some(),
            Switch::Settings => self.open.settings,
            Switch::Times => self.open.times,
            Switch::Finder => self.open.finder.is_some(),
            Switch::Equations => {
                self.view == ViewKind::Design && self.arrangement.now().plots.shown && self.arrangement.shows_equations
            }
            Switch::Sketching => self.drawing_pen().is_some(),
            Switch::Loop => self.loops,
            Switch::Exaggeration => self.exaggerates_base,
            Switch::TurnTask => self.turn_task,
            Switch::InSpace => self.in_space,
            Switch::Dexterity => self.dexterity.is_some(),
            Switch::Holding => self.tool == Tool::Hold,
            Switch::Drawing => matches!(self.tool, Tool::Draw(_)),
            Switch::Pushing => self.tool == Tool::Push,
            Switch::Measuring => matches!(self.tool, Tool::Measure(_)),
        }
    }

    /// Whether a switch can be toggled in the present state.
    pub fn has(&self, switch: Switch, session: &Session) -> bool {
        match switch {
            Switch::Exaggeration => session.scenario().base.moves(),
            Switch::History | Switch::Sketching => self.arrangement.layout != Layout::Present,
            _ => !switch.is_of_machine() || self.view.shows_machine(),
        }
    }

    /// Returns the command that toggles a switch.
    pub fn other(&self, switch: Switch) -> Command {
        ViewChange::Switch(switch, !self.is_on(switch)).into()
    }

    fn turn(&mut self, switch: Switch, on: bool) {
        match switch {
            Switch::Side => self.arrangement.now_mut().side.shown = on,
            Switch::Plots => self.arrangement.now_mut().plots.shown = on,
            Switch::Panels => {
                let panels = self.arrangement.now_mut();
                (panels.side.shown, panels.plots.shown) = (on, on);
            }
            Switch::Swapped => self.arrangement.swapped = on,
            Switch::History => self.open.history = on,
            Switch::Compare => self.put_below(BottomPanel::Runs, on),
            // The caller knows which run is to stand beside this one.
            Switch::Pair => self.pair = self.pair.take().filter(|_| on),
            Switch::Study => self.put_below(BottomPanel::Tolerances, on),
            Switch::Table => self.put_below(BottomPanel::Table, on),
            Switch::Pins => self.pins = on,
            Switch::Snapshots => self.snapshots = on,
            Switch::Help => {
                self.open.help = on;
                self.open.finder = self.open.finder.take().filter(|_| !on);
            }
            // The caller opens it at the page that belongs to what is on display.
            Switch::Guide => self.open.guide = self.open.guide.take().filter(|_| on),
            Switch::Settings => self.open.settings = on,
            Switch::Times => self.open.times = on,
            // A file dialog that is open keeps the keyboard.
            Switch::Finder => {
                self.open.finder = (on && self.open.dialog.is_none()).then(Finder::default);
                self.open.help &= !on;
            }
            Switch::Equations => {
                self.arrangement.shows_equations = on;
                // No point of the Pareto front is under the pointer any more.
                self.ghost = None;
                if on {
                    self.arrangement.now_mut().plots.shown = true;
                    self.view = ViewKind::Design;
                }
            }
            Switch::Sketching if on => self.begin_drawing(PenTool::Move),
            Switch::Sketching => {
                self.pen = None;
                self.framing[ViewKind::Design as usize] = Framing::Pending;
            }
            Switch::Loop => self.loops = on,
            Switch::Exaggeration => self.exaggerates_base = on,
            Switch::TurnTask => self.turn_task = on,
            Switch::InSpace => self.in_space = on,
            Switch::Dexterity => self.dexterity = on.then_some(Measure::Det),
            Switch::Holding => self.take_tool(Tool::Hold),
            Switch::Drawing if on => self.take_tool(Tool::Draw(Vec::new())),
            Switch::Pushing if on => self.take_tool(Tool::Push),
            Switch::Measuring if on => self.take_tool(Tool::Measure(Vec::new())),
            Switch::Drawing | Switch::Pushing | Switch::Measuring if self.is_on(switch) => self.take_tool(Tool::Hold),
            Switch::Drawing | Switch::Pushing | Switch::Measuring => {}
        }
    }

    /// Takes another tool; a measurement under way is kept.
    fn take_tool(&mut self, tool: Tool) {
        self.finish_measurement();
        self.pointed.snap = None;
        self.tool = tool;
    }

    /// Shows a panel below the scene in place of the present one, or closes the panel if it is on display.
    fn put_below(&mut self, thing: BottomPanel, on: bool) {
        match on {
            true => self.below = Some(thing),
            false if self.below == Some(thing) => self.below = None,
            false => {}
        }
    }

    /// Takes a step in the guide. Opens a closed guide only for a step to a place.
    fn read(&mut self, step: GuideStep) {
        (self.open.help, self.open.finder) = (false, None);
        match (&mut self.open.guide, step) {
            (Some(guide), step) => guide.take(step),
            (closed, GuideStep::Go(place)) => *closed = Some(GuideView::at(place)),
            (None, GuideStep::Back | GuideStep::Forward) => {}
        }
    }

    pub(super) fn apply(&mut self, change: ViewChange) {
        match change {
            ViewChange::Switch(switch, on) => self.turn(switch, on),
            ViewChange::Kind(view) => self.view = view,
            ViewChange::Layout(layout) => self.lay_out(layout),
            ViewChange::Theme(theme) => self.arrangement.theme = theme,
            ViewChange::Notation(notation) => {
                // Stored bounds of value axes are numbers in the old units.
                if notation != self.arrangement.notation {
                    self.charts.forget_values();
                }
                self.arrangement.notation = notation;
            }
            ViewChange::PutAway(problems) => {
                self.status = StatusMessage::default();
                self.put_away.extend(problems);
            }
            ViewChange::Pen(change) => self.pen.iter_mut().for_each(|pen| pen.apply(change.clone())),
            ViewChange::DrawAt(field) => {
                if self.drawing_pen().is_none() {
                    self.begin_drawing(PenTool::Move);
                }
                self.arrangement.now_mut().side.shown = true;
                self.asked_field = Some(field);
            }
            ViewChange::Speed(speed) => self.speed = speed,
            ViewChange::Dexterity(shown) => self.dexterity = shown,
            ViewChange::Fit => self.framing[self.view as usize] = Framing::Pending,
            ViewChange::Look(look) => self.look(look),
            ViewChange::Drives(drives) => {
                self.drives = drives;
                self.framing[ViewKind::Joints as usize].renew();
            }
            ViewChange::Mark(time) => self.mark = time,
            ViewChange::Charts(change) => self.charts.change(change),
            ViewChange::Preview(b) => self.pointed.preview = b,
            ViewChange::Ghost(i) => self.ghost = i,
            ViewChange::FrontBy(by) => self.front_by = by,
            ViewChange::Reveal(thing) => {
                self.arrangement.now_mut().side.shown = true;
                self.revealed = Some(thing);
            }
            ViewChange::LookUp(path) => {
                self.arrangement.now_mut().side.shown = true;
                if self.view == ViewKind::Design && !studio::holds(&path) {
                    self.view = ViewKind::Flat;
                }
                self.looked_up = Some(path);
            }
            ViewChange::LeaveNaming => self.open.naming = None,
            ViewChange::Guide(step) => self.read(step),
            ViewChange::Pair(pair) => self.pair = Some(pair),
            ViewChange::LeaveGuideSearch => self.open.guide.iter_mut().for_each(GuideView::leave_search),
            ViewChange::Dialog(dialog) => {
                self.open.finder = self.open.finder.take().filter(|_| dialog.is_none());
                self.open.dialog = dialog;
            }
            ViewChange::Report(report) => {
                // Whoever has read the faults of a file goes to mend them.
                let is_left = report.is_none();
                self.open.dialog = self.open.dialog.take().filter(|dialog| !(is_left && dialog.opens()));
                self.open.report = report;
            }
            ViewChange::Export(export) => self.open.export = export,
            ViewChange::WriteNote(draft) => self.open.note = draft,
            ViewChange::DropMeasurement(Some(i)) if i < self.measurements.len() => {
                self.measurements.remove(i);
                self.pointed.measurement = None;
            }
            ViewChange::DropMeasurement(Some(_)) => {}
            ViewChange::DropMeasurement(None) => self.measurements.clear(),
        }
    }
}
