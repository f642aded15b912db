//! The [`ScenePointer`]: the pointer over the scene, the object that it drags, and the edit of the drag.

use egui::{CursorIcon, PointerButton, Pos2, Response, Ui, Vec2};

use super::viewport::is_on_top;
use super::widgets::FINE_DRAG_FACTOR;
use super::{Command, DragGesture, SessionCommand, Tool, ViewChange, ViewState, place, set_b};
use stillbase_mechanics::planar::Vector;
use stillbase_picture::paint::{SceneViewport, labels};
use stillbase_picture::scene::exaggeration::DrawnFrame;
use stillbase_picture::scene::options::Handle;
use stillbase_picture::scene::pick::{DragAction, Pick};
use stillbase_picture::scene::views::{ViewKind, Views};
use stillbase_session::design::length_edit;
use stillbase_session::parts::move_lump;
use stillbase_session::{Edit, Session};

/// Distance from the target within which it can be grabbed during the demonstration, points.
const DEMO_GRAB_DISTANCE_PT: f64 = 60.0;
/// Smaller changes of the pushing force send no new edit, N.
const MIN_FORCE_CHANGE_N: f64 = 0.02;

/// The pointer over a scene.
pub struct ScenePointer<'a> {
    ui: &'a Ui,
    response: &'a Response,
    spot: &'a SceneViewport,
    session: &'a Session,
    shown: &'a DrawnFrame<'a>,
    views: &'a Views,
    view: ViewKind,
    /// Whether any part of the arm can be grabbed: in the demonstration its tip moves and is hard to catch.
    catches_arm: bool,
    /// Whether a drag pushes the end effector.
    pushes: bool,
}

/// The scene under the pointer.
#[derive(Clone, Copy)]
pub struct PointedScene<'a> {
    pub session: &'a Session,
    pub shown: &'a DrawnFrame<'a>,
    pub views: &'a Views,
    /// Whether it is the scene of the demonstration.
    pub demonstrates: bool,
}

impl<'a> ScenePointer<'a> {
    /// Creates the pointer over a scene.
    pub fn over(
        ui: &'a Ui,
        response: &'a Response,
        spot: &'a SceneViewport,
        scene: PointedScene<'a>,
        view_state: &ViewState,
    ) -> Self {
        let PointedScene { session, shown, views, demonstrates } = scene;
        let view = view_state.view;
        // Dragging pushes with Alt held, or with the push tool.
        let pushes = view.shows_machine() && (view_state.tool == Tool::Push || ui.input(|i| i.modifiers.alt));
        let catches_arm = demonstrates && view.shows_machine() && !pushes;
        Self { ui, response, spot, session, shown, views, view, catches_arm, pushes }
    }

    /// Handles grabbing, dragging, release, clicks, and the key that removes a point.
    pub fn points(&self, view_state: &mut ViewState, commands: &mut Vec<Command>) {
        self.update_hot(view_state);
        self.grab(view_state, commands);
        match view_state.gesture.grabbed {
            Some(pick) => self.drag(pick, view_state, commands),
            None => self.set_cursor(view_state),
        }
        self.handle_clicks(view_state, commands);
        self.remove_point(view_state, commands);
    }

    /// Returns the target of the demonstration if a position is on a link or near the target.
    fn arm(&self, pos: Pos2) -> Option<Pick> {
        let near = || self.views.pick_arm(self.shown, &self.spot.pointer(pos), DEMO_GRAB_DISTANCE_PT);
        self.catches_arm.then(near).flatten()
    }

    /// Returns the object whose label is at a position, where it was drawn last.
    fn named(&self, pos: Pos2) -> Option<Pick> {
        let handle = labels::last(self.ui.ctx(), 0).filter(|_| self.view.shows_machine())?.handle_at(pos)?;
        Some(Pick::of(handle, self.views.stage().handle(handle, self.shown)?))
    }

    /// Returns the object at a position that can be dragged.
    fn under(&self, pos: Pos2) -> Option<Pick> {
        let pointer = self.spot.pointer(pos);
        let pick = match self.pushes {
            true => self.views.pick_tip(self.shown, &pointer),
            false => {
                let pulled = || self.views.pick(self.view, self.shown, &pointer);
                // The knob of b may lie over a link, which the demonstration would take for the arm.
                let ring = || pulled().filter(|pick| pick.handle == Handle::Ring);
                self.named(pos).or_else(ring).or_else(|| self.arm(pos)).or_else(pulled)
            }
        };
        // Targets cannot be dragged while the run waits, in any view.
        pick.filter(|pick| pick.handle != Handle::Target || self.session.can_be_dragged())
    }

    /// Stores the object under the pointer.
    fn update_hot(&self, view_state: &mut ViewState) {
        if view_state.gesture.grabbed.is_some() {
            return;
        }
        let seen = |pos: Pos2| match self.pushes {
            true => self.under(pos).map(|pick| pick.handle),
            false => {
                let under = || self.views.under(self.view, self.shown, &self.spot.pointer(pos));
                let ring = || under().filter(|handle| *handle == Handle::Ring);
                let named = self.named(pos).map(|pick| pick.handle).or_else(ring);
                named.or_else(|| self.arm(pos).map(|pick| pick.handle)).or_else(under)
            }
        };
        // The reaction of a block alone is not drawn.
        let is_drawn = |handle: &Handle| {
            self.session.run().shared().is_none() || !matches!(handle, Handle::Force | Handle::Moment)
        };
        view_state.pointed.object = self.response.hover_pos().and_then(seen).filter(is_drawn);
    }

    /// Grabs the object that was under the pointer when the button was pressed; either may have moved since.
    fn grab(&self, view_state: &mut ViewState, commands: &mut Vec<Command>) {
        let origin = || self.ui.input(|i| i.pointer.press_origin());
        if self.response.is_pointer_button_down_on() && self.ui.input(|i| i.pointer.primary_pressed()) {
            let origin = origin();
            view_state.gesture.pressed = origin.and_then(|pos| self.under(pos));
            if self.session.is_playing() && origin.and_then(|pos| self.arm(pos)).is_some() {
                commands.push(SessionCommand::TogglePlay.into());
            }
        }
        if self.response.drag_started_by(PointerButton::Primary) {
            // A drag begins where the button was pressed, not where the drag was noticed.
            let origin = origin();
            view_state.gesture = DragGesture {
                grabbed: view_state.gesture.pressed.or_else(|| origin.and_then(|pos| self.under(pos))),
                last_pointer: origin.unwrap_or_default().to_vec2(),
                force: self.session.scenario().plant.force,
                undo_entries: self.session.undo_count(),
                ..DragGesture::default()
            };
        }
    }

    /// Returns the command for dragging an object to a position.
    fn drag_command(&self, pick: Pick, pos: Pos2, view_state: &mut ViewState) -> Option<Command> {
        let (session, pointer) = (self.session, self.spot.pointer(pos));
        let snaps = self.ui.input(|i| i.modifiers.ctrl || i.modifiers.command);
        let pick = Pick { grip: pick.grip.map(|grip| grip.snapping(snaps)), ..pick };
        let in_space = view_state.in_space && pick.handle == Handle::Target && leads_in_space(session);
        let aim = match in_space && self.view == ViewKind::Space {
            true => self.views.aim_in_space(self.shown, &pointer)?,
            false => self.views.aim(self.view, &pick, self.shown, &pointer, session.b_aim())?,
        };
        let aim = if snaps { aim.snapped() } else { aim };
        match aim {
            DragAction::Target([x, y]) if self.view.shows_machine() => {
                let at = self.shown.near_target(Vector::new(x, y));
                view_state.gesture.position = Some([at.re, at.im]);
            }
            DragAction::Target(at) | DragAction::Waypoint(_, at) => view_state.gesture.position = Some(at),
            _ => {}
        }
        edit_of(aim, session, view_state).map(|it| Command::Session(SessionCommand::Edit(it)))
    }

    /// Drags the grabbed object, and ends the drag.
    fn drag(&self, pick: Pick, view_state: &mut ViewState, commands: &mut Vec<Command>) {
        let response = self.response;
        self.ui.ctx().set_cursor_icon(cursor(pick.handle, true));
        let pushes = pick.handle == Handle::EndEffector;
        // A push continues while the pointer stands still and the machine moves.
        let lasts = pushes && self.session.is_moving();
        // The last movement may come together with the release.
        let moved =
            response.drag_delta() != Vec2::ZERO || (view_state.gesture.dragged && response.drag_stopped()) || lasts;
        // What is dragged stays in sight: it stops at the edges of the scene and at windows over it.
        let inside = |pos: Pos2| pos.clamp(self.spot.rect.min, self.spot.rect.max);
        let pos = response.interact_pointer_pos().filter(|_| moved).map(inside);
        if let Some(pos) = pos.filter(|pos| is_on_top(response, *pos)) {
            let DragGesture { last_pointer, pointer_offset, .. } = &mut view_state.gesture;
            if self.ui.input(|i| i.modifiers.shift) {
                *pointer_offset += (1.0 - FINE_DRAG_FACTOR) * (pos.to_vec2() - *last_pointer);
            }
            *last_pointer = pos.to_vec2();
            let at = pos - *pointer_offset;
            commands.extend(self.drag_command(pick, at, view_state));
            if pushes && !self.session.is_playing() {
                commands.push(SessionCommand::TogglePlay.into());
            }
        }
        let gives_up = self.ui.input(|i| i.key_pressed(egui::Key::Escape));
        if response.drag_stopped() || gives_up {
            let DragGesture { dragged, undo_entries, force: [x, y], .. } = std::mem::take(&mut view_state.gesture);
            if pushes && dragged {
                // The end of the push restores the force that acted before it.
                commands.push(SessionCommand::Edit(Edit::Push { x, y }).into());
            }
            commands.push(SessionCommand::EndGesture.into());
            if gives_up && dragged {
                commands.push(SessionCommand::TakeBack(undo_entries).into());
            }
        }
    }

    /// Sets the cursor icon, which shows whether the object under the pointer can be dragged or clicked.
    fn set_cursor(&self, view_state: &ViewState) {
        let Some(hot) = view_state.pointed.object else { return };
        let turns = self.session.can_be_dragged()
            && self.session.run().pose_space().is_ok_and(|map| map.leaves_freedoms() || map.planes().is_ok());
        let hot = if matches!(hot, Handle::Link(_)) && !turns { Handle::Base } else { hot };
        self.ui.ctx().set_cursor_icon(cursor(hot, false));
    }

    /// Handles clicks. A click on a bar chooses its b; a click on an object with rows in the panel shows them. A
    /// double click where no object can be dragged adds a point to the path.
    fn handle_clicks(&self, view_state: &mut ViewState, commands: &mut Vec<Command>) {
        let clicked = self.response.clicked_by(PointerButton::Primary);
        let pos = self.response.interact_pointer_pos();
        if let Some(pos) = pos.filter(|_| clicked)
            && let Some(pick) = self.under(pos).filter(|pick| pick.handle == Handle::Bar)
            && let Some(edit) = self.drag_command(pick, pos, view_state)
        {
            commands.extend([edit, Command::Session(SessionCommand::EndGesture)]);
        }
        if clicked && let Some(thing) = view_state.pointed.object.filter(|thing| place::is_in_panel(*thing)) {
            commands.push(ViewChange::Reveal(thing).into());
        }
        let beside = !view_state.pointed.object.is_some_and(Handle::can_be_dragged);
        let twice = self.response.double_clicked_by(PointerButton::Primary) && beside && self.view.shows_machine();
        let height = self.views.stage().handle_height();
        if let Some(pos) = pos.filter(|_| twice)
            && let Some([x, y]) = self.spot.pointer(pos).ray().and_then(|ray| ray.at_height(height))
            && let Some(change) = self.session.scenario().task.adding(Vector::new(x, y))
        {
            commands.extend([
                Command::Session(SessionCommand::Edit(Edit::of("task", change))),
                Command::Session(SessionCommand::EndGesture),
            ]);
        }
    }

    /// Removes the point of the path under the pointer, on Delete or Backspace.
    fn remove_point(&self, view_state: &mut ViewState, commands: &mut Vec<Command>) {
        let typing = self.ui.ctx().egui_wants_keyboard_input();
        let key = |i: &egui::InputState| i.key_pressed(egui::Key::Delete) || i.key_pressed(egui::Key::Backspace);
        let out = !typing && self.ui.input(key);
        if let (Some(Handle::Waypoint(i)), None, true) = (view_state.pointed.object, view_state.gesture.grabbed, out)
            && let Some(change) = self.session.scenario().task.removing(i)
        {
            commands.extend([
                Command::Session(SessionCommand::Edit(Edit::of("task", change))),
                Command::Session(SessionCommand::EndGesture),
            ]);
            view_state.pointed.object = None;
        }
    }
}

/// Returns the edit for a drag action; `None` if its object does not exist, or if the pushing force hardly changes.
fn edit_of(aim: DragAction, session: &Session, view_state: &ViewState) -> Option<Edit> {
    let machine = &session.scenario().machine;
    Some(match aim {
        DragAction::Target([x, y]) => Edit::DragTarget { x, y },
        DragAction::InSpace(at) => session.edit_in_space(at)?,
        DragAction::Angles([a1, a2]) => Edit::DragAngles { a1, a2 },
        DragAction::Pull { link, along, at: [x, y] } => {
            let link = machine.links().get(link)?.name.clone();
            Edit::PullLink { link, along, x, y }
        }
        DragAction::B(b) => set_b(session, view_state, b),
        DragAction::Push([x, y]) => {
            let [now_x, now_y] = session.scenario().plant.force;
            if (x - now_x).hypot(y - now_y) < MIN_FORCE_CHANGE_N {
                return None;
            }
            Edit::Push { x, y }
        }
        DragAction::Limit { angle, ends, .. } => {
            Edit::at(&["limits", &machine.angles().get(angle)?.name], ends.to_vec())
        }
        DragAction::Mass { link, to } => Edit::at(&["link", &machine.links().get(link)?.name, "com"], to),
        DragAction::Weight { weight, to } => session.scenario().design.weight_edit(machine, weight, to),
        DragAction::Lump { lump, to } => move_lump(lump, to),
        DragAction::Length { link, to } => length_edit(machine.spec().links.get(link)?, to),
        DragAction::Payload(offset) => Edit::set("plant.payload.offset", offset.to_vec()),
        DragAction::Waypoint(i, [x, y]) => Edit::of("task", session.scenario().task.moving(i, Vector::new(x, y))?),
    })
}

/// Returns whether the led block sits on another one, which can move with it.
pub fn leads_in_space(session: &Session) -> bool {
    let block = session.scenario().assembly.as_ref();
    block.is_some_and(|own| own.scenario.assembly.blocks()[own.block].mount.on.is_some())
}

fn cursor(handle: Handle, held: bool) -> CursorIcon {
    match (handle, held) {
        (Handle::Bar, _) => CursorIcon::PointingHand,
        (Handle::Plane, _) => CursorIcon::ResizeVertical,
        (thing, true) if thing.can_be_dragged() => CursorIcon::Grabbing,
        (thing, false) if thing.can_be_dragged() => CursorIcon::Grab,
        (thing, _) if place::is_in_panel(thing) => CursorIcon::PointingHand,
        _ => CursorIcon::Default,
    }
}
