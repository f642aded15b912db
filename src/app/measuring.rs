//! The measuring tool: clicks choose points, and Delete removes the measurement under the pointer.

use egui::{CursorIcon, InputState, Key, PointerButton, Response, Ui};

use super::{Command, Tool, ViewChange, ViewState};
use stillbase_picture::paint::SceneViewport;
use stillbase_picture::scene::exaggeration::DrawnFrame;
use stillbase_picture::scene::measurement::{ANGLE_POINTS, Measurement};
use stillbase_picture::scene::options::Handle;
use stillbase_picture::scene::stage::Stage;
use stillbase_session::scenario::SnapPoint;

/// The scene in which the pointer measures.
#[derive(Clone, Copy)]
pub struct MeasuredScene<'a> {
    pub spot: &'a SceneViewport,
    pub stage: &'a Stage,
    pub shown: &'a DrawnFrame<'a>,
}

/// Handles the pointer while it measures: the points that it snaps to and chooses.
pub fn choose(ui: &Ui, response: &Response, scene: MeasuredScene<'_>, view_state: &mut ViewState) {
    let snap = |pos| scene.stage.snap(scene.shown, &scene.spot.pointer(pos));
    view_state.pointed.object = None;
    view_state.pointed.snap = response.hover_pos().and_then(snap);
    if response.hovered() {
        ui.ctx().set_cursor_icon(CursorIcon::Crosshair);
    }
    let clicked = response.interact_pointer_pos().filter(|_| response.clicked_by(PointerButton::Primary));
    if let Some(point) = clicked.and_then(snap) {
        view_state.measure(point);
    }
    let typing = ui.ctx().egui_wants_keyboard_input();
    if !typing && ui.input(|i| i.key_pressed(Key::Enter)) {
        view_state.finish_measurement();
    }
}

/// Finds the measurement under the pointer, and removes it on Delete or Backspace.
pub fn remove(
    ui: &Ui,
    response: &Response,
    scene: MeasuredScene<'_>,
    view_state: &mut ViewState,
    commands: &mut Vec<Command>,
) {
    let under = |pos| scene.stage.measurement_at(&view_state.measurements, scene.shown, &scene.spot.pointer(pos));
    view_state.pointed.measurement = response.hover_pos().and_then(under);
    let key = |i: &InputState| i.key_pressed(Key::Delete) || i.key_pressed(Key::Backspace);
    // A point of the path under the pointer is removed first.
    let is_free =
        !matches!(view_state.pointed.object, Some(Handle::Waypoint(_))) && view_state.gesture.grabbed.is_none();
    if let Some(i) = view_state.pointed.measurement
        && is_free
        && !ui.ctx().egui_wants_keyboard_input()
        && ui.input(key)
    {
        commands.push(ViewChange::DropMeasurement(Some(i)).into());
    }
}

impl ViewState {
    /// Chooses the next point of the measurement under way. The third one, or the second one again, finishes it.
    fn measure(&mut self, point: SnapPoint) {
        let Tool::Measure(points) = &mut self.tool else { return };
        let again = points.last() == Some(&point);
        if !again {
            points.push(point);
        }
        let ends = points.len() == ANGLE_POINTS || (again && points.len() + 1 == ANGLE_POINTS);
        if ends {
            self.finish_measurement();
        }
    }

    /// Keeps the measurement under way, if it has enough points, and begins another one.
    pub(super) fn finish_measurement(&mut self) {
        let Tool::Measure(points) = &mut self.tool else { return };
        let done = Measurement::of(std::mem::take(points));
        if done.is_whole() {
            self.measurements.push(done);
        }
    }

    /// Returns all measurements for drawing: the one under the pointer highlighted, and that under way with the point
    /// under the pointer.
    pub(super) fn drawn_measurements(&self) -> Vec<Measurement> {
        let under = |i| self.pointed.measurement == Some(i);
        let whole = self.measurements.iter().cloned().enumerate();
        let mut all: Vec<Measurement> = whole.map(|(i, one)| Measurement { highlighted: under(i), ..one }).collect();
        if let Tool::Measure(points) = &self.tool {
            let next = self.pointed.snap.iter().filter(|snap| points.last() != Some(*snap));
            all.push(Measurement::of(points.iter().chain(next).cloned().collect()));
        }
        all
    }
}
