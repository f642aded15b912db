//! The viewport: the scene, its words, and what can be done to it with the pointer.

use std::sync::Arc;

use egui::{Align2, CentralPanel, CursorIcon, Frame, PointerButton, Pos2, Rect, Sense, Ui, Vec2, pos2, vec2};

use super::theme::{colour, plain};
use super::top::name;
use super::{Command, Look, set_b};
use crate::render::{Renderer, View};
use crate::scene::camera::Camera;
use crate::scene::palette::faded;
use crate::scene::stage::{Handle, Stage, ViewOptions};
use crate::scene::{Anchor, Label, Scene};
use crate::session::{Edit, Session};

/// How near the pointer must be to take hold of a handle, px.
const GRIP: f32 = 20.0;

/// Draws it and reads the pointer.
pub fn show(ui: &mut Ui, session: &Session, stage: &Stage, look: &mut Look, commands: &mut Vec<Command>) {
    CentralPanel::default().frame(Frame::NONE).show(ui, |ui| {
        let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
        name(&response, "Scene: the machine, its reactionless workspace and its target");
        let frame = session.frame();
        let spot = Spot { rect, camera: *look.camera() };
        point_at(ui, &response, &spot, session, stage, look, commands);
        move_camera(ui, &response, rect, look);
        let options =
            ViewOptions { theme: look.theme, flat: look.flat, hot: look.grabbed.or(look.hot), held: look.held };
        let scene = Arc::new(stage.scene(frame, &options));
        paint(ui, rect, &scene, look.camera());
        words(ui, &Spot { rect, camera: *look.camera() }, &scene);
        views(ui, rect, look, commands);
        scale(ui, rect, look);
    });
}

/// A viewport and the camera in it.
struct Spot {
    rect: Rect,
    camera: Camera,
}

impl Spot {
    fn aspect(&self) -> f64 {
        f64::from(self.rect.width() / self.rect.height().max(1.0))
    }

    fn share(&self, pos: Pos2) -> [f64; 2] {
        let d = pos - self.rect.min;
        [f64::from(d.x / self.rect.width().max(1.0)), f64::from(d.y / self.rect.height().max(1.0))]
    }

    fn screen(&self, point: [f64; 3]) -> Option<Pos2> {
        let [x, y] = self.camera.project(point, self.aspect())?;
        Some(self.rect.min + vec2(x as f32 * self.rect.width(), y as f32 * self.rect.height()))
    }

    fn world(&self, pos: Pos2, z: f64) -> Option<[f64; 2]> {
        self.camera.ray(self.share(pos), self.aspect())?.at_height(z)
    }
}

fn point_at(
    ui: &Ui,
    response: &egui::Response,
    spot: &Spot,
    session: &Session,
    stage: &Stage,
    look: &mut Look,
    commands: &mut Vec<Command>,
) {
    let frame = session.frame();
    let z = stage.handle_height();
    let held = look.held;
    let under = |pos: Pos2| {
        let distance = |h: Handle| {
            let held = held.filter(|_| h == Handle::Target).map(|[x, y]| [x, y, z]);
            let at = held.or_else(|| stage.handle(h, frame));
            at.and_then(|p| spot.screen(p)).map(|p| p.distance(pos))
        };
        [Handle::Target, Handle::Ring]
            .into_iter()
            .filter_map(|h| Some((h, distance(h)?)))
            .filter(|(_, d)| *d < GRIP)
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .map(|(h, _)| h)
    };
    if look.grabbed.is_none() {
        look.hot = response.hover_pos().and_then(under);
    }
    if response.drag_started_by(PointerButton::Primary) {
        // A drag begins where the button went down, not where it was noticed.
        look.grabbed = ui.input(|i| i.pointer.press_origin()).and_then(under);
    }
    if let Some(handle) = look.grabbed {
        ui.ctx().set_cursor_icon(CursorIcon::Grabbing);
        // The last movement may come together with the release.
        let moved = response.drag_delta() != Vec2::ZERO || (look.dragged && response.drag_stopped());
        let at = response.interact_pointer_pos().and_then(|pos| spot.world(pos, z));
        match (handle, at) {
            (Handle::Target, Some([x, y])) if moved => {
                look.held = Some([x, y]);
                look.dragged = true;
                commands.push(Command::Edit(Edit::DragTarget { x, y }));
            }
            (Handle::Ring, Some(at)) if moved => {
                if let Some(b) = stage.ring_b(at, session.b_aim()) {
                    look.dragged = true;
                    commands.push(Command::Edit(set_b(session, b)));
                }
            }
            _ => {}
        }
        let let_go = ui.input(|i| i.key_pressed(egui::Key::Escape));
        if response.drag_stopped() || let_go {
            look.grabbed = None;
            commands.push(Command::EndGesture);
            if let_go && look.dragged {
                commands.push(Command::Undo);
            }
            look.dragged = false;
        }
    } else if look.hot.is_some() {
        ui.ctx().set_cursor_icon(CursorIcon::Grab);
    }
    if look.grabbed.is_none() {
        look.held = None;
    }
}

fn move_camera(ui: &Ui, response: &egui::Response, rect: Rect, look: &mut Look) {
    let height = f64::from(rect.height().max(1.0));
    let delta = response.drag_delta();
    if look.grabbed.is_none() && delta != Vec2::ZERO {
        let (x, y) = (f64::from(delta.x) / height, f64::from(delta.y) / height);
        let pans = look.flat || !response.dragged_by(PointerButton::Primary) || ui.input(|i| i.modifiers.shift);
        let camera = look.camera_mut();
        if pans {
            camera.pan(x, y);
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
            look.camera_mut().zoom(factor, [f64::from(place.x), f64::from(place.y)], aspect);
        }
    }
}

/// The scene as a callback that egui's renderer runs.
struct Paint {
    scene: Arc<Scene>,
    view: View,
}

impl egui_wgpu::CallbackTrait for Paint {
    fn prepare(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        _screen: &egui_wgpu::ScreenDescriptor,
        encoder: &mut wgpu::CommandEncoder,
        resources: &mut egui_wgpu::CallbackResources,
    ) -> Vec<wgpu::CommandBuffer> {
        if let Some(renderer) = resources.get_mut::<Renderer>() {
            renderer.prepare(device, queue, encoder, &self.scene, &self.view);
        }
        Vec::new()
    }

    fn paint(
        &self,
        _info: egui::PaintCallbackInfo,
        pass: &mut wgpu::RenderPass<'static>,
        resources: &egui_wgpu::CallbackResources,
    ) {
        if let Some(renderer) = resources.get::<Renderer>() {
            renderer.paint(pass);
        }
    }
}

/// Draws a scene into a rectangle; the [`Renderer`] must be among egui's callback resources.
pub fn paint(ui: &Ui, rect: Rect, scene: &Arc<Scene>, camera: &Camera) {
    let pixels = ui.ctx().pixels_per_point();
    let aspect = f64::from(rect.width() / rect.height().max(1.0));
    let view = View {
        clip_from_world: camera.clip_from_world(aspect),
        eye_direction: camera.eye_direction(),
        size_px: [(rect.width() * pixels).round() as u32, (rect.height() * pixels).round() as u32],
        pixels_per_point: pixels,
    };
    let paint = Paint { scene: scene.clone(), view };
    ui.painter().add(egui_wgpu::Callback::new_paint_callback(rect, paint));
}

/// A scene with its words, filling everything, that nobody can touch.
pub fn still(ui: &mut Ui, scene: &Arc<Scene>, camera: &Camera) {
    CentralPanel::default().frame(Frame::NONE).show(ui, |ui| {
        let rect = ui.max_rect();
        paint(ui, rect, scene, camera);
        words(ui, &Spot { rect, camera: *camera }, scene);
    });
}

/// The scene's labels.
fn words(ui: &Ui, spot: &Spot, scene: &Scene) {
    let painter = ui.painter().with_clip_rect(spot.rect);
    let galley = |l: &Label| painter.layout_no_wrap(l.text.clone(), plain(l.size), colour(l.colour));
    for label in &scene.labels {
        let Some(at) = spot.screen(label.at.map(f64::from)) else { continue };
        // Words about one point stay together.
        let together = scene.labels.iter().filter(|l| l.at == label.at);
        let widest = together.map(|l| galley(l).size().x).fold(0.0, f32::max);
        let galley = galley(label);
        let [x, y] = label.offset;
        let over = at.x + x + widest - (spot.rect.right() - 10.0);
        let (align, shift) = match label.anchor {
            // Words that would be cut off move back into view, below what they would cover.
            Anchor::Left if over > 0.0 && spot.rect.contains(at) => {
                (Align2::LEFT_CENTER, vec2(x - over, if over > x { y + 30.0 } else { y }))
            }
            Anchor::Left => (Align2::LEFT_CENTER, vec2(x, y)),
            Anchor::Centre => (Align2::CENTER_CENTER, vec2(x, y)),
            Anchor::Right => (Align2::RIGHT_CENTER, vec2(x, y)),
        };
        let mut place = align.anchor_size(at + shift, galley.size());
        if label.anchor == Anchor::Centre && spot.rect.contains(at) {
            let room = spot.rect.shrink(8.0);
            let over = (place.right() - room.right()).max(0.0) - (room.left() - place.left()).max(0.0);
            place = place.translate(vec2(-over, 0.0));
        }
        // A faint plate keeps words legible over bars and curves.
        painter.rect_filled(place.expand2(vec2(3.0, 0.0)), 3.0, colour(faded(scene.background, 0.55)));
        painter.galley(place.min, galley, colour(label.colour));
    }
}

/// 2D and 3D, at the top left.
fn views(ui: &mut Ui, rect: Rect, look: &Look, commands: &mut Vec<Command>) {
    let p = look.palette();
    let area = Rect::from_min_size(rect.min + vec2(14.0, 12.0), vec2(110.0, 30.0));
    let mut child = ui.new_child(egui::UiBuilder::new().max_rect(area));
    let frame = Frame::new().fill(colour(p.panel)).stroke((1.0, colour(p.line))).corner_radius(8).inner_margin(3);
    frame.show(&mut child, |ui| {
        ui.spacing_mut().item_spacing.x = 2.0;
        ui.horizontal(|ui| {
            for (flat, text) in [(true, "2D"), (false, "3D")] {
                let chosen = look.flat == flat;
                let ink = if chosen { p.ink } else { p.dim };
                let fill = if chosen { colour(p.line) } else { egui::Color32::TRANSPARENT };
                let button = egui::Button::new(egui::RichText::new(text).color(colour(ink)))
                    .fill(fill)
                    .stroke(egui::Stroke::NONE)
                    .min_size(vec2(40.0, 22.0));
                let response = ui.add(button).on_hover_text("Seen from above, or in perspective (V)");
                if response.clicked() {
                    commands.push(Command::Flat(flat));
                }
            }
        });
    });
}

fn scale(ui: &Ui, rect: Rect, look: &Look) {
    let p = look.palette();
    let at = pos2(rect.right() - 14.0, rect.bottom() - 16.0);
    ui.painter().text(at, Align2::RIGHT_CENTER, "0.1 m grid", plain(11.5), colour(p.dim));
}
