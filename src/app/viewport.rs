//! The viewport: the scene, its labels, and the gestures on it.

use std::sync::Arc;

use egui::{
    CentralPanel, CursorIcon, Frame, LayerId, Order, PointerButton, PopupAnchor, Pos2, Rect, Sense, Tooltip, Ui, Vec2,
};

use super::card::Card;
use super::intro::Intro;
use super::measuring::MeasuredScene;
use super::menu::MenuSubject;
use super::pointing::{self, Pointed};
use super::scene_pointer::{PointedScene, ScenePointer};
use super::tour::Tour;
use super::widgets::name;
use super::{
    Command, Layout, SessionCommand, Switch, Tool, ViewChange, ViewState, coordinates, corner, framing, measuring,
    menu, notes, pair, present,
};
use crate::status::{self, news::News};
use stillbase_mechanics::planar::{DriveAngles, Vector};
use stillbase_picture::paint::labels::draw_labels;
use stillbase_picture::paint::{SceneViewport, paint};
use stillbase_picture::scene::Scene;
use stillbase_picture::scene::beside::Beside;
use stillbase_picture::scene::blocks::BlockStages;
use stillbase_picture::scene::camera::Camera;
use stillbase_picture::scene::exaggeration::{DrawnFrame, Exaggeration};
use stillbase_picture::scene::framing::ViewContent;
use stillbase_picture::scene::options::{Handle, OtherRun, ViewOptions, WeightOption};
use stillbase_picture::scene::pick::Pick;
use stillbase_picture::scene::views::{ViewKind, Views};
use stillbase_session::scenario::Task;
use stillbase_session::{Edit, Session};
use stillbase_study::comparison::Comparison;

/// What the scene shows.
#[derive(Clone, Copy)]
pub struct SceneContent<'a> {
    pub session: &'a Session,
    pub views: &'a Views,
    /// The other blocks of the assembly of which the machine is one; 3D shows them.
    pub blocks: Option<&'a BlockStages>,
    /// Factor by which the motion of the base is enlarged.
    pub exaggeration: f64,
    pub comparison: Option<&'a Comparison>,
    pub intro: Option<&'a Intro>,
    /// The run beside that on display, or why there is none; `None` while it is being made.
    pub other: Option<&'a Result<Beside, String>>,
    /// Counterweights of the point of the Pareto front that is under the pointer.
    pub weights: &'a [WeightOption],
    /// The problem message that covers the scene.
    pub news: Option<&'a News>,
}

impl<'a> SceneContent<'a> {
    /// Returns the other blocks, if the view shows them.
    fn blocks_in(&self, view: ViewKind) -> Option<&'a BlockStages> {
        self.blocks.filter(|_| view == ViewKind::Space)
    }

    /// Returns the points that the camera of a view has to show.
    fn points(&self, view: ViewKind) -> ViewContent {
        let (session, own) = (self.session, self.views.content(view, self.session.frame(), &motion(self.session)));
        match self.blocks_in(view) {
            Some(blocks) => {
                let floor = self.views.stage().linkage().floor();
                blocks.content((own, floor), session.frame(), session.others())
            }
            None => own,
        }
    }

    /// Returns the scene of a view.
    pub fn scene(&self, view: ViewKind, options: &ViewOptions, camera: &Camera) -> Scene {
        let (session, own) = (self.session, self.views.scene(view, self.session.frame(), options, camera));
        match self.blocks_in(view) {
            Some(blocks) => blocks.scene(own, session.frame(), session.others(), options),
            None => own,
        }
    }

    /// Returns the camera for the hand, which acts in the axes of the machine.
    fn hand_camera(&self, view_state: &ViewState) -> Camera {
        let (session, camera) = (self.session, *view_state.camera());
        match self.blocks_in(view_state.view) {
            Some(blocks) => camera.of_block(blocks.place(session.frame(), session.others())),
            None => camera,
        }
    }
}

/// Draws the scene and handles the pointer; returns the rectangle of the scene.
pub fn show(ui: &mut Ui, content: SceneContent<'_>, view_state: &mut ViewState, commands: &mut Vec<Command>) -> Rect {
    let SceneContent { session, views, exaggeration, comparison, intro, other, news, .. } = content;
    let shown = CentralPanel::default().frame(Frame::NONE).show(ui, |ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        let intro = intro.filter(|_| view_state.view.shows_machine());
        let pair = view_state.pair.clone().filter(|_| view_state.view.shows_machine());
        let usual = Exaggeration::Times(exaggeration);
        let beside = other.and_then(|other| other.as_ref().ok());
        let divided = pair.as_ref().and_then(|pair| pair.divide(ui.available_rect_before_wrap()));
        let both = pair.as_ref().zip(divided);
        let exaggeration = match &both {
            Some((pair, _)) if view_state.gesture.grabbed.is_none() => pair.exaggeration(beside, session, usual),
            _ => usual,
        };
        let rect = both.as_ref().map_or(ui.available_rect_before_wrap(), |(_, [_, own])| *own);
        if let Some((pair, [place, _])) = both {
            let other = pair::Other { pair, found: other, session, table: comparison, exaggeration };
            other.show(ui, place, view_state.camera(), view_state, commands);
        }
        let response = ui.allocate_rect(rect, Sense::click_and_drag());
        let mut covered = vec![corner::strip(rect)];
        covered.extend(intro.and_then(|intro| intro.covers(ui.ctx(), rect, session)));
        covered.extend(coordinates::covers(rect, views, view_state));
        let presents = view_state.arrangement.layout == Layout::Present;
        covered.extend(presents.then(|| present::covers(rect)));
        covered.extend(both.filter(|_| !presents).map(|_| pair::caption_covers(rect)));
        covered.extend(view_state.open.tour.as_ref().map(|_| Tour::covers(ui.ctx(), rect)));
        // A run that waits does so until something changes: its message must not cover the machine.
        let wait = news.filter(|news| news.says_wait()).and_then(|_| status::news::rect(ui.ctx()));
        covered.extend(wait);
        framing::keep_framed(rect, (&covered, wait), views, |view| content.points(view), view_state);
        name(&response, "Scene: the machine, its reactionless workspace and its target");
        // The pointer acts on the machine as drawn, including the enlarged motion of the base.
        let shown = DrawnFrame::of(session.frame(), exaggeration);
        let spot = SceneViewport { rect, camera: content.hand_camera(view_state) };
        if matches!(view_state.tool, Tool::Draw(_)) && view_state.view.shows_machine() {
            draw(ui, &response, &spot, views, view_state, commands);
        } else {
            let demonstrates = pair.as_ref().is_some_and(|pair| pair.demonstrates);
            let measured = MeasuredScene { spot: &spot, stage: views.stage(), shown: &shown };
            let hand = ScenePointer::over(
                ui,
                &response,
                &spot,
                PointedScene { session, shown: &shown, views, demonstrates },
                view_state,
            );
            if matches!(view_state.tool, Tool::Measure(_)) && view_state.view.shows_machine() {
                measuring::choose(ui, &response, measured, view_state);
            } else {
                hand.points(view_state, commands);
            }
            if view_state.view.shows_machine() {
                measuring::remove(ui, &response, measured, view_state, commands);
            }
            menu::show(&response, session, || menu_subject(&response, measured, view_state), commands);
            show_card(&response, session, views, view_state);
            // In the demonstration, a drag beside the machine does not move the view.
            if !(demonstrates && response.dragged_by(PointerButton::Primary)) {
                move_camera(ui, &response, rect, view_state);
            }
        }
        let options = ViewOptions {
            drag_position: view_state.gesture.position,
            stroke: drawn(&view_state.tool),
            refused: view_state.status.refused.as_ref().and_then(|r| r.curve.clone()),
            show_hints: session.can_be_dragged() && !matches!(view_state.tool, Tool::Measure(_)),
            snap: view_state.pointed.snap.clone(),
            compares: both.is_none(),
            exaggeration,
            ..options(content, view_state)
        };
        let scene = Arc::new(content.scene(view_state.view, &options, view_state.camera()));
        paint(ui, 0, rect, &scene, view_state.camera());
        let (hand, spot) = (spot, SceneViewport { rect, camera: *view_state.camera() });
        // Any other message covers the scene while it lasts.
        covered.extend(news.filter(|news| !news.says_wait()).and_then(|_| status::news::rect(ui.ctx())));
        if let Some((pair, _)) = both.filter(|_| !presents) {
            covered.push(pair::own_caption(ui, rect, session, pair, view_state));
        }
        if presents {
            covered.extend(present::show(ui, rect, session, view_state, commands));
        }
        let seen = |at: [f64; 3]| hand.screen(at).is_some_and(|at| rect.contains(at));
        let is_partly_out = view_state.view.shows_machine() && !views.stage().outline(&shown).all(seen);
        covered.extend(is_partly_out.then(|| corner::recentre_covers(rect)));
        let placed = draw_labels(ui, 0, &spot, &scene, &covered);
        notes::labels(ui, &placed.all, session, &view_state.tool, commands);
        let has_grid = content.blocks_in(view_state.view).is_none();
        corner::show(ui, rect, view_state, (views, has_grid), commands);
        coordinates::show(ui, rect, session, views, view_state, commands);
        if is_partly_out {
            corner::recentre_button(ui, rect, view_state, commands);
        }
        let tour = view_state.open.tour.as_ref();
        let things = tour.map(Tour::points_at).or(intro.map(Intro::points_at)).unwrap_or_default();
        let in_scene = |thing: Pointed| {
            let shows = view_state.view.shows_machine();
            thing.in_scene(&hand, views.stage(), &shown).filter(|place| shows && rect.contains(place.center()))
        };
        let mentioned: Vec<Rect> = things.iter().copied().filter_map(in_scene).collect();
        // A card leaves free the target, the ring of b and the base, too.
        let free = [Pointed::Target, Pointed::Ring, Pointed::Base].into_iter().filter_map(in_scene);
        let left_free: Vec<Rect> = mentioned.iter().copied().chain(free).collect();
        let widgets = pointing::widgets(ui.ctx(), things);
        if view_state.gesture.grabbed.is_none() {
            pointing::outline(ui.ctx(), &view_state.palette(), &[mentioned.as_slice(), &widgets].concat());
        }
        if let Some(tour) = tour {
            tour.show(ui.ctx(), rect, &left_free, session, view_state, commands);
        }
        if let Some(intro) = intro {
            intro.show_hint(ui.ctx(), rect, &left_free, session, view_state, commands);
        }
        rect
    });
    shown.inner
}

/// Returns the camera of a picture of a view alone, of a size in points. It shows areas of turns to their ends, the same
/// at every instant of the run.
pub fn camera(content: &SceneContent<'_>, view: ViewKind, size: [f32; 2]) -> Camera {
    let SceneContent { session, views, .. } = content;
    let camera = views.camera(view);
    let area = framing::area(Rect::from_min_size(egui::Pos2::ZERO, size.into()), &[]);
    if content.blocks_in(view).is_some() {
        return content.points(view).framed(camera, &area);
    }
    if !(view.shows_machine() && views.stage().has_turn_areas()) {
        return camera;
    }
    let start = session.frames().first().unwrap_or(session.frame());
    views.content(view, start, &motion(session)).framed(camera, &area)
}

/// Returns the scene on display without hints at gestures, framed for a picture of a size in points.
pub fn still(content: SceneContent<'_>, size: [f32; 2], view_state: &mut ViewState) -> (Scene, Camera) {
    let views = content.views;
    let rect = Rect::from_min_size(egui::Pos2::ZERO, size.into());
    framing::keep_framed(rect, (&[], None), views, |view| content.points(view), view_state);
    let options = ViewOptions { show_hints: false, ..options(content, view_state) };
    let camera = *view_state.camera();
    (content.scene(view_state.view, &options, &camera), camera)
}

/// Returns the options that the scene in the window and a still picture of it have in common.
fn options(content: SceneContent<'_>, view_state: &ViewState) -> ViewOptions {
    let SceneContent { session, exaggeration, comparison, weights, .. } = content;
    ViewOptions {
        theme: view_state.arrangement.theme,
        dexterity: view_state.dexterity,
        highlighted: view_state
            .gesture
            .grabbed
            .map(|pick| pick.handle)
            .or(view_state.pointed.object)
            .or(view_state.pointed.panel_object),
        preview_b: view_state.pointed.preview,
        snapshots: if view_state.snapshots { snapshots(session) } else { Vec::new() },
        others: comparison.map_or_else(Vec::new, |comparison| others(comparison, session.frame().time)),
        exaggeration: Exaggeration::Times(exaggeration),
        external_force: force(session),
        pin_forces: view_state.pins,
        limits: true,
        shadows: view_state.view == ViewKind::Space,
        weights: weights.to_vec(),
        links: view_state.pointed.lit_links.clone(),
        notation: view_state.arrangement.notation,
        notes: session.notes().to_vec(),
        measurements: view_state.drawn_measurements(),
        ..ViewOptions::default()
    }
}

/// Delay before the card of an object is shown, s.
const CARD_DELAY_S: f64 = 0.35;

/// Number of snapshots along a motion, as in Fig. 5.
const SNAPSHOT_COUNT: usize = 9;

/// Returns the poses that the view must contain: samples of the motion, none while the run waits.
fn motion(session: &Session) -> Vec<DriveAngles> {
    if session.run().waiting().is_some() { Vec::new() } else { snapshots(session) }
}

/// Returns poses at equal time intervals: of the plan, or of the run if the machine was dragged.
fn snapshots(session: &Session) -> Vec<DriveAngles> {
    let share = |i: usize| i as f64 / (SNAPSHOT_COUNT - 1) as f64;
    if session.is_dragged() {
        let frames = session.frames();
        let at = |i: usize| frames[(share(i) * (frames.len() - 1) as f64).round() as usize].q;
        return (0..SNAPSHOT_COUNT).map(at).collect();
    }
    let run = session.run();
    (0..SNAPSHOT_COUNT).map(|i| run.plan().motion.at(share(i) * run.planned_time()).q).collect()
}

/// Returns the frames of the runs shown in comparison, at `time`, s.
fn others(comparison: &Comparison, time: f64) -> Vec<OtherRun> {
    let other = |(i, run): (usize, &stillbase_study::comparison::ComparedRun)| {
        Some(OtherRun { name: (i + 1).to_string(), frame: *run.at(time)? })
    };
    comparison.shown().filter_map(other).collect()
}

/// Returns the force at the end effector, N; `None` if it is not known for the instant on display.
fn force(session: &Session) -> Option<[f64; 2]> {
    let lasting = !session.script().iter().any(|e| e.step > 0 && e.edit.pushes());
    Some(session.scenario().plant.force).filter(|_| lasting || session.is_at_end())
}

/// Whether nothing lies over the scene at a position: no window, dialog or menu.
pub(super) fn is_on_top(response: &egui::Response, pos: Pos2) -> bool {
    response.ctx.layer_id_at(pos).is_none_or(|layer| layer == response.layer_id)
}

/// Whether a dialog is open that takes clicks.
fn has_dialog(ctx: &egui::Context) -> bool {
    ctx.memory(|memory| {
        let on_top = |layer: &LayerId| memory.layer_id_at(memory.area_rect(layer.id)?.center());
        let takes_clicks = |layer: &LayerId| on_top(layer) == Some(*layer);
        let layers = memory.areas().visible_layer_ids();
        layers.iter().any(|layer| layer.order == Order::Foreground && takes_clicks(layer))
    })
}

/// Shows the card of the object under the pointer, after a delay.
fn show_card(response: &egui::Response, session: &Session, views: &Views, view_state: &ViewState) {
    let (ctx, id) = (&response.ctx, response.id.with("told of"));
    let tooltip = || Tooltip::always_open(ctx.clone(), response.layer_id, id, PopupAnchor::Pointer).gap(18.0);
    if let Some(Pick { handle: Handle::Link(i), .. }) = view_state.gesture.grabbed {
        if let Some(card) = Card::turned(i, session) {
            tooltip().show(|ui| card.show(ui, &view_state.palette()));
        }
        return;
    }
    let listed = egui::Popup::is_any_open(ctx) || has_dialog(ctx);
    let rests = view_state.gesture.grabbed.is_none() && !response.dragged() && !listed;
    let quiet = rests && response.hovered() && response.hover_pos().is_some_and(|pos| is_on_top(response, pos));
    let Some(thing) = view_state.pointed.object.filter(|_| quiet) else {
        ctx.data_mut(|data| data.remove_temp::<Option<(Handle, f64)>>(id));
        return;
    };
    let now = ctx.input(|i| i.time);
    let before =
        ctx.data(|data| data.get_temp::<Option<(Handle, f64)>>(id)).flatten().filter(|(before, _)| *before == thing);
    let since = before.map_or(now, |(_, since)| since);
    ctx.data_mut(|data| data.insert_temp(id, Some((thing, since))));
    let waits = since + CARD_DELAY_S - now;
    if waits > 0.0 {
        ctx.request_repaint_after_secs(waits as f32);
    } else if let Some(card) = Card::of(thing, session, views, view_state.arrangement.notation) {
        let p = view_state.palette();
        tooltip().show(|ui| card.show(ui, &p));
    }
}

/// Returns what is under the pointer, for the menu.
fn menu_subject(response: &egui::Response, scene: MeasuredScene<'_>, view_state: &ViewState) -> MenuSubject {
    let pos = response.interact_pointer_pos();
    let thing = view_state.pointed.object;
    let Some(pointer) = pos.filter(|_| view_state.view.shows_machine()).map(|pos| scene.spot.pointer(pos)) else {
        return MenuSubject { thing, pos, ..MenuSubject::default() };
    };
    MenuSubject {
        thing,
        at: pointer.ray().and_then(|ray| ray.at_height(scene.stage.handle_height())),
        point: scene.stage.snap(scene.shown, &pointer),
        measurement: view_state.pointed.measurement,
        pos,
    }
}

/// Returns the path drawn so far, m.
fn drawn(tool: &Tool) -> Vec<[f64; 2]> {
    match tool {
        Tool::Draw(stroke) => stroke.clone(),
        Tool::Hold | Tool::Push | Tool::Measure(_) => Vec::new(),
    }
}

/// Handles the drawing of a path, from the press of the button to its release.
fn draw(
    ui: &Ui,
    response: &egui::Response,
    spot: &SceneViewport,
    views: &Views,
    view_state: &mut ViewState,
    commands: &mut Vec<Command>,
) {
    ui.ctx().set_cursor_icon(CursorIcon::Crosshair);
    let Tool::Draw(stroke) = &mut view_state.tool else { return };
    let place = |pos| spot.pointer(pos).ray()?.at_height(views.stage().handle_height());
    if response.drag_started_by(PointerButton::Primary) {
        stroke.clear();
        stroke.extend(ui.input(|i| i.pointer.press_origin()).and_then(place));
    }
    // Esc gives up the stroke; another button does not end it.
    if ui.input(|i| i.key_pressed(egui::Key::Escape)) {
        stroke.clear();
        return;
    }
    let stops = response.drag_stopped_by(PointerButton::Primary);
    if response.dragged_by(PointerButton::Primary) || stops {
        let at = response.interact_pointer_pos().and_then(place);
        stroke.extend(at.filter(|at| stroke.last() != Some(at)));
    }
    if stops {
        let points: Vec<Vector> = stroke.iter().map(|[x, y]| Vector::new(*x, *y)).collect();
        commands.push(ViewChange::Switch(Switch::Drawing, false).into());
        if let Some(change) = Task::drawing(&points) {
            commands.extend([
                Command::Session(SessionCommand::Edit(Edit::of("task", change))),
                Command::Session(SessionCommand::EndGesture),
            ]);
        }
    }
}

/// Moves the camera with drags and the wheel.
pub(super) fn move_camera(ui: &Ui, response: &egui::Response, rect: Rect, view_state: &mut ViewState) {
    let height = f64::from(rect.height().max(1.0));
    let delta = response.drag_delta();
    if view_state.gesture.grabbed.is_none() && delta != Vec2::ZERO {
        let (x, y) = (f64::from(delta.x) / height, f64::from(delta.y) / height);
        let aspect = f64::from(rect.width()) / height;
        let pans = matches!(view_state.view, ViewKind::Flat | ViewKind::Design)
            || !response.dragged_by(PointerButton::Primary)
            || ui.input(|i| i.modifiers.shift);
        let camera = view_state.camera_mut();
        if pans {
            camera.pan(x, y, aspect);
        } else {
            camera.turn(-4.0 * x, 4.0 * y);
        }
    }
    if let Some(pos) = response.hover_pos() {
        let (scroll, pinch) = ui.input(|i| (i.smooth_scroll_delta.y, i.zoom_delta()));
        let factor = f64::from(pinch) * (f64::from(scroll) * 0.004).exp();
        if (factor - 1.0).abs() > 1e-6 {
            let place = (pos - rect.min) / rect.size();
            let aspect = f64::from(rect.width() / rect.height().max(1.0));
            view_state.camera_mut().zoom(factor, [f64::from(place.x), f64::from(place.y)], aspect);
        }
    }
}
