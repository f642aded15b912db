//! The viewport: the scene, its words, and what can be done to it with the pointer.

use std::sync::Arc;

use egui::{CentralPanel, CursorIcon, Frame, PointerButton, PopupAnchor, Pos2, Rect, Sense, Tooltip, Ui, Vec2};

use super::card::Card;
use super::intro::Intro;
use super::tour::Tour;
use super::widgets::{FINE, name};
use super::{Command, Layout, ViewState, coordinates, corner, framing, menu, place, present, set_b, status};
use crate::mechanics::planar::{DriveAngles, Vector};
use crate::picture::paint::words::words;
use crate::picture::paint::{Spot, paint};
use crate::picture::scene::exaggeration::{Exaggeration, Shown};
use crate::picture::scene::options::{Handle, Offered, Other, ViewOptions};
use crate::picture::scene::pick::{Aim, Pick};
use crate::picture::scene::stage::Stage;
use crate::picture::scene::views::{ViewKind, Views};
use crate::planning::pose_map::PoseMap;
use crate::session::design::length_of;
use crate::session::scenario::Task;
use crate::session::{Edit, Session};
use crate::study::comparison::Comparison;

/// Draws it and reads the pointer; where it is.
pub fn show(
    ui: &mut Ui,
    session: &Session,
    views: &Views,
    (comparison, intro, chosen): (Option<&Comparison>, Option<&Intro>, &[Offered]),
    view_state: &mut ViewState,
    commands: &mut Vec<Command>,
) -> Rect {
    let shown = CentralPanel::default().frame(Frame::NONE).show(ui, |ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        let mut room = ui.available_size();
        let intro = intro.filter(|_| view_state.view.shows_machine());
        let both = intro.filter(|intro| intro.shows_both(room.x));
        if let Some(intro) = both {
            room.x *= 0.5;
            let left = Rect::from_min_size(ui.cursor().min, room);
            intro.show_straight(ui, left, session.frame(), view_state.camera(), view_state);
        }
        let whole = ui.available_rect_before_wrap();
        let rect = Rect::from_min_max(whole.right_bottom() - room, whole.right_bottom());
        let response = ui.allocate_rect(rect, Sense::click_and_drag());
        let mut covered = vec![corner::strip(rect)];
        covered.extend(intro.into_iter().flat_map(|intro| intro.covers(ui.ctx(), rect, session, both.is_some())));
        covered.extend(coordinates::covers(rect, views, view_state));
        let presents = view_state.layout == Layout::Present;
        covered.extend(presents.then(|| present::covers(rect)));
        covered.extend(view_state.tour.as_ref().map(|_| Tour::covers(ui.ctx(), rect)));
        framing::keep(rect, &covered, (session, views), || motion(session), view_state);
        name(&response, "Scene: the machine, its reactionless workspace and its target");
        // The pointer works on the machine as it is drawn, enlarged motion of the base included.
        let exaggeration = Exaggeration::Times(view_state.base_exaggeration());
        let shown = Shown::of(session.frame(), exaggeration);
        let spot = Spot { rect, camera: *view_state.camera() };
        if view_state.stroke.is_some() && view_state.view.shows_machine() {
            draw(ui, &response, &spot, views, view_state, commands);
        } else {
            let demonstrates = intro.is_some_and(Intro::demonstrates);
            let how = (views, demonstrates);
            point_at(ui, &response, &spot, (session, &shown), how, view_state, commands);
            let place = |pos: Pos2| spot.pointer(pos).ray()?.at_height(views.stage().handle_height());
            let at = response.interact_pointer_pos().filter(|_| view_state.view.shows_machine()).and_then(place);
            menu::show(&response, session, (view_state.hot, at), commands);
            tell(&response, session, views, view_state);
            // What misses the machine in the demonstration moves nothing.
            if !(demonstrates && response.dragged_by(PointerButton::Primary)) {
                move_camera(ui, &response, rect, view_state);
            }
        }
        let options = ViewOptions {
            theme: view_state.theme,
            dexterity: view_state.dexterity,
            hot: view_state.grabbed.map(|pick| pick.handle).or(view_state.hot).or(view_state.lit),
            held: view_state.held,
            preview_b: view_state.preview,
            stroke: view_state.stroke.clone().unwrap_or_default(),
            refused: view_state.refused.as_ref().and_then(|r| r.curve.clone()),
            snapshots: if view_state.snapshots { snapshots(session) } else { Vec::new() },
            others: comparison.map_or_else(Vec::new, |comparison| others(comparison, session.frame().time)),
            exaggeration,
            push: force(session),
            pin_forces: view_state.pins,
            limits: true,
            shadows: view_state.view == ViewKind::Space,
            invites: session.follows_hands(),
            compares: both.is_none(),
            weights: chosen.to_vec(),
            links: view_state.lit_links.clone(),
            scale: None,
        };
        let scene = Arc::new(views.scene(view_state.view, session.frame(), &options, view_state.camera()));
        paint(ui, 0, rect, &scene, view_state.camera());
        let spot = Spot { rect, camera: *view_state.camera() };
        // Bad news lies over the scene for as long as it lasts.
        covered.extend(status::tells(session, view_state).then(|| status::news_rect(ui.ctx())).flatten());
        words(ui, &spot, &scene, &covered);
        corner::show(ui, rect, view_state, views, commands);
        coordinates::show(ui, rect, (session, views), view_state, commands);
        let seen = |at: [f64; 3]| spot.screen(at).is_some_and(|at| rect.contains(at));
        if view_state.view.shows_machine() && !views.stage().outline(&shown).all(seen) {
            corner::way_back(ui, rect, view_state, commands);
        }
        if presents {
            present::show(ui, rect, session, view_state, commands);
        }
        if let Some(intro) = both {
            intro.caption(ui, rect, session.frame(), view_state);
        }
        if let Some(tour) = &view_state.tour {
            tour.show(ui.ctx(), rect, session, view_state, commands);
        }
        if let Some(intro) = intro {
            let spoken_of = spoken_of(&spot, views.stage(), &shown);
            intro.show_hint(ui.ctx(), (rect, &spoken_of), session, view_state, commands);
        }
        rect
    });
    shown.inner
}

/// Where hints speak of something: the target, the arm's tip and the ring of b, on the screen.
fn spoken_of(spot: &Spot, stage: &Stage, shown: &Shown<'_>) -> Vec<Rect> {
    let ring = stage.handle(Handle::Ring, shown).and_then(|knob| {
        let middle = spot.screen([shown.base.at.re, shown.base.at.im, knob[2]])?;
        // Its name stands outside of it.
        let radius = 1.4 * (spot.screen(knob)? - middle).length();
        Some(Rect::from_center_size(middle, Vec2::splat(2.0 * radius)))
    });
    let target = stage.handle(Handle::Target, shown).and_then(|at| spot.screen(at));
    let target = target.map(|at| Rect::from_center_size(at, Vec2::splat(36.0)));
    ring.into_iter().chain(target).collect()
}

/// Smaller changes of the pulling force send no new edit, N.
const LEAST_PUSH: f64 = 0.02;

/// How long the pointer is on a thing before it is told what that is, s.
const TOLD_AFTER: f64 = 0.35;

/// From how far away the tip can be taken hold of while the demonstration goes on, points.
const GENEROUS: f64 = 60.0;

/// How many snapshots stand along a motion, as in Fig. 5.
const SNAPSHOTS: usize = 9;

/// Poses of the motion, as far as there is one, to be seen with everything else.
fn motion(session: &Session) -> Vec<DriveAngles> {
    if session.run().waiting().is_some() { Vec::new() } else { snapshots(session) }
}

/// Poses at equal intervals of time: as planned, or as run where the machine was led by hand.
fn snapshots(session: &Session) -> Vec<DriveAngles> {
    let share = |i: usize| i as f64 / (SNAPSHOTS - 1) as f64;
    if session.is_led() {
        let frames = session.frames();
        let at = |i: usize| frames[(share(i) * (frames.len() - 1) as f64).round() as usize].q;
        return (0..SNAPSHOTS).map(at).collect();
    }
    let run = session.run();
    (0..SNAPSHOTS).map(|i| run.plan().motion.at(share(i) * run.planned_time()).q).collect()
}

/// The runs that are laid over, at a time, s.
fn others(comparison: &Comparison, time: f64) -> Vec<Other> {
    let other = |(i, run): (usize, &crate::study::comparison::Compared)| {
        Some(Other { name: (i + 1).to_string(), frame: *run.at(time)? })
    };
    comparison.shown().filter_map(other).collect()
}

/// What pushes at the end effector, N, as far as it is known of the instant on display.
fn force(session: &Session) -> Option<[f64; 2]> {
    let lasting = !session.script().iter().any(|e| e.step > 0 && e.edit.pushes());
    Some(session.scenario().plant.force).filter(|_| lasting || session.is_at_end())
}

fn point_at(
    ui: &Ui,
    response: &egui::Response,
    spot: &Spot,
    (session, shown): (&Session, &Shown<'_>),
    (views, demonstrates): (&Views, bool),
    view_state: &mut ViewState,
    commands: &mut Vec<Command>,
) {
    let view = view_state.view;
    // Dragging pushes with Alt held, or after U.
    let pushes = view.shows_machine() && (view_state.pushing || ui.input(|i| i.modifiers.alt));
    // The demonstration's arm moves, so that its tip is hard to catch: any part of it will do.
    let arm = |pos: Pos2| {
        let near = demonstrates && view.shows_machine() && !pushes;
        near.then(|| views.pick_arm(shown, &spot.pointer(pos), GENEROUS)).flatten()
    };
    let under = |pos: Pos2| match pushes {
        true => views.pick_tip(shown, &spot.pointer(pos)),
        false => arm(pos).or_else(|| views.pick(view, shown, &spot.pointer(pos))),
    };
    // Nothing follows while the run waits, in joint space and tower either.
    let follows = |pick: &Pick| pick.handle != Handle::Target || session.follows_hands();
    let under = |pos: Pos2| under(pos).filter(follows);
    if view_state.grabbed.is_none() {
        let seen = |pos: Pos2| match pushes {
            true => under(pos).map(|pick| pick.handle),
            false => arm(pos).map(|pick| pick.handle).or_else(|| views.under(view, shown, &spot.pointer(pos))),
        };
        view_state.hot = response.hover_pos().and_then(seen);
    }
    if response.is_pointer_button_down_on() && ui.input(|i| i.pointer.primary_pressed()) {
        // What is held is what was there when the button went down: it may move on.
        let origin = ui.input(|i| i.pointer.press_origin());
        view_state.pressed = origin.and_then(under);
        if session.is_playing() && origin.and_then(arm).is_some() {
            commands.push(Command::TogglePlay);
        }
    }
    if response.drag_started_by(PointerButton::Primary) {
        // A drag begins where the button went down, not where it was noticed.
        let origin = ui.input(|i| i.pointer.press_origin());
        view_state.grabbed = view_state.pressed.take().or_else(|| origin.and_then(under));
        view_state.fine = [origin.unwrap_or_default().to_vec2(), Vec2::ZERO];
        view_state.force = Some(session.scenario().plant.force);
        view_state.undone_to = session.undo_count();
    }
    let (shift, snaps) = ui.input(|i| (i.modifiers.shift, i.modifiers.ctrl || i.modifiers.command));
    let ask = |pick: Pick, pos: Pos2, view_state: &mut ViewState| {
        let pick = Pick { grip: pick.grip.map(|grip| grip.snapping(snaps)), ..pick };
        let aim = views.aim(view, &pick, shown, &spot.pointer(pos), session.b_aim())?;
        let edit = match if snaps { aim.snapped() } else { aim } {
            Aim::Target([x, y]) => {
                view_state.held = Some([x, y]);
                Edit::DragTarget { x, y }
            }
            Aim::Angles([a1, a2]) => Edit::DragAngles { a1, a2 },
            Aim::Pull { link, along, at: [x, y] } => {
                let link = session.scenario().machine.links().get(link)?.name.clone();
                Edit::PullLink { link, along, x, y }
            }
            Aim::B(b) => set_b(session, view_state, b),
            Aim::Push([x, y]) => {
                let [now_x, now_y] = session.scenario().plant.force;
                if (x - now_x).hypot(y - now_y) < LEAST_PUSH {
                    return None;
                }
                Edit::Push { x, y }
            }
            Aim::Limit { angle, ends, .. } => {
                let name = &session.scenario().machine.angles().get(angle)?.name;
                Edit::at(&["limits", name], ends.to_vec())
            }
            Aim::Mass { link, to } => {
                Edit::at(&["link", &session.scenario().machine.links().get(link)?.name, "com"], to)
            }
            Aim::Weight { weight, to } => Edit::at(&["counterweight", &(weight + 1).to_string(), "at"], to),
            Aim::Length { link, to } => length_of(session.scenario().machine.spec().links.get(link)?, to),
            Aim::Payload(offset) => Edit::set("plant.payload.offset", offset.to_vec()),
            Aim::Waypoint(i, [x, y]) => {
                view_state.held = Some([x, y]);
                Edit::of("task", session.scenario().task.moving(i, Vector::new(x, y))?)
            }
        };
        Some(Command::Edit(edit))
    };
    if let Some(pick) = view_state.grabbed {
        ui.ctx().set_cursor_icon(cursor(pick.handle, true));
        // The last movement may come together with the release.
        let pushes = pick.handle == Handle::EndEffector;
        // A push goes on while the pointer stands still and the machine moves on.
        let pulls = pushes && session.is_moving();
        let moved = response.drag_delta() != Vec2::ZERO || (view_state.dragged && response.drag_stopped()) || pulls;
        if let Some(pos) = response.interact_pointer_pos().filter(|_| moved) {
            let [last, behind] = &mut view_state.fine;
            if shift {
                *behind += (1.0 - FINE) * (pos.to_vec2() - *last);
            }
            *last = pos.to_vec2();
            let at = pos - *behind;
            commands.extend(ask(pick, at, view_state));
            if pushes && !session.is_playing() {
                commands.push(Command::TogglePlay);
            }
        }
        let let_go = ui.input(|i| i.key_pressed(egui::Key::Escape));
        if response.drag_stopped() || let_go {
            view_state.grabbed = None;
            if pushes && view_state.dragged {
                // Back to the force that acted before the push.
                let [x, y] = view_state.force.take().unwrap_or_default();
                commands.push(Command::Edit(Edit::Push { x, y }));
            }
            commands.push(Command::EndGesture);
            if let_go && view_state.dragged {
                commands.push(Command::TakeBack(view_state.undone_to));
            }
            view_state.dragged = false;
        }
    } else if let Some(hot) = view_state.hot {
        let turns = session.follows_hands()
            && session.run().pose_map().is_ok_and(|map| map.holds() || matches!(map, PoseMap::Planes(_)));
        let hot = if matches!(hot, Handle::Link(_)) && !turns { Handle::Base } else { hot };
        ui.ctx().set_cursor_icon(cursor(hot, false));
    }
    // A bar needs no dragging: a click chooses.
    if let Some(pos) = response.interact_pointer_pos().filter(|_| response.clicked_by(PointerButton::Primary))
        && let Some(pick) = under(pos).filter(|pick| pick.handle == Handle::Bar)
        && let Some(edit) = ask(pick, pos, view_state)
    {
        commands.extend([edit, Command::EndGesture]);
    }
    if response.clicked_by(PointerButton::Primary)
        && let Some(thing) = view_state.hot.filter(|thing| place::is_in_panel(*thing))
    {
        commands.push(Command::Reveal(thing));
    }
    let task = &session.scenario().task;
    // A double click beside all handles adds a point to the path.
    let beside = !view_state.hot.is_some_and(Handle::can_be_dragged);
    let twice = response.double_clicked_by(PointerButton::Primary) && beside && view.shows_machine();
    if let Some(pos) = response.interact_pointer_pos().filter(|_| twice)
        && let Some([x, y]) = spot.pointer(pos).ray().and_then(|ray| ray.at_height(views.stage().handle_height()))
        && let Some(change) = task.adding(Vector::new(x, y))
    {
        commands.extend([Command::Edit(Edit::of("task", change)), Command::EndGesture]);
    }
    let typing = ui.ctx().egui_wants_keyboard_input();
    let out = !typing && ui.input(|i| i.key_pressed(egui::Key::Delete) || i.key_pressed(egui::Key::Backspace));
    if let (Some(Handle::Waypoint(i)), None, true) = (view_state.hot, view_state.grabbed, out)
        && let Some(change) = task.removing(i)
    {
        commands.extend([Command::Edit(Edit::of("task", change)), Command::EndGesture]);
        view_state.hot = None;
    }
    if view_state.grabbed.is_none() {
        view_state.held = None;
    }
}

/// Says what is under the pointer, once that has been so for a while.
fn tell(response: &egui::Response, session: &Session, views: &Views, view_state: &ViewState) {
    let (ctx, id) = (&response.ctx, response.id.with("told of"));
    let tooltip = || Tooltip::always_open(ctx.clone(), response.layer_id, id, PopupAnchor::Pointer).gap(18.0);
    if let Some(Pick { handle: Handle::Link(i), .. }) = view_state.grabbed {
        if let Some(card) = Card::turned(i, session) {
            tooltip().show(|ui| card.show(ui, &view_state.palette()));
        }
        return;
    }
    let listed = egui::Popup::is_any_open(ctx);
    let quiet = view_state.grabbed.is_none() && response.hovered() && !response.dragged() && !listed;
    let Some(thing) = view_state.hot.filter(|_| quiet) else {
        ctx.data_mut(|data| data.remove_temp::<Option<(Handle, f64)>>(id));
        return;
    };
    let now = ctx.input(|i| i.time);
    let before =
        ctx.data(|data| data.get_temp::<Option<(Handle, f64)>>(id)).flatten().filter(|(before, _)| *before == thing);
    let since = before.map_or(now, |(_, since)| since);
    ctx.data_mut(|data| data.insert_temp(id, Some((thing, since))));
    let waits = since + TOLD_AFTER - now;
    if waits > 0.0 {
        ctx.request_repaint_after_secs(waits as f32);
    } else if let Some(card) = Card::of(thing, session, views) {
        let p = view_state.palette();
        tooltip().show(|ui| card.show(ui, &p));
    }
}

/// A path drawn by hand: from where the button goes down to where it comes up.
fn draw(
    ui: &Ui,
    response: &egui::Response,
    spot: &Spot,
    views: &Views,
    view_state: &mut ViewState,
    commands: &mut Vec<Command>,
) {
    ui.ctx().set_cursor_icon(CursorIcon::Crosshair);
    let Some(stroke) = &mut view_state.stroke else { return };
    let place = |pos| spot.pointer(pos).ray()?.at_height(views.stage().handle_height());
    if response.drag_started_by(PointerButton::Primary) {
        stroke.clear();
        stroke.extend(ui.input(|i| i.pointer.press_origin()).and_then(place));
    }
    if response.dragged_by(PointerButton::Primary) || response.drag_stopped() {
        let at = response.interact_pointer_pos().and_then(place);
        stroke.extend(at.filter(|at| stroke.last() != Some(at)));
    }
    if response.drag_stopped() {
        let points: Vec<Vector> = stroke.iter().map(|[x, y]| Vector::new(*x, *y)).collect();
        commands.push(Command::Draw(false));
        if let Some(change) = Task::drawing(&points) {
            commands.extend([Command::Edit(Edit::of("task", change)), Command::EndGesture]);
        }
    }
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

fn move_camera(ui: &Ui, response: &egui::Response, rect: Rect, view_state: &mut ViewState) {
    let height = f64::from(rect.height().max(1.0));
    let delta = response.drag_delta();
    if view_state.grabbed.is_none() && delta != Vec2::ZERO {
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
