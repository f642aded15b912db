//! Paints a scene and its labels with egui: in the window, in figures and in the pictures of recordings.

pub mod figure;
pub mod labels;
mod portrait;
pub mod thumbnail;

use std::sync::Arc;

use egui::{Color32, FontData, FontDefinitions, FontFamily, FontId, PaintCallback, Pos2, Rect, Ui, Vec2, vec2};

use super::render::{Quality, Renderer, View};
use super::scene::camera::Camera;
use super::scene::pointer::Pointer;
use super::scene::{Rgba, Scene};

/// Converts a colour of the palette to one of egui.
pub fn colour([r, g, b, a]: Rgba) -> Color32 {
    let byte = |x: f32| (x * 255.0).round() as u8;
    Color32::from_rgba_unmultiplied(byte(r), byte(g), byte(b), byte(a))
}

/// Bold font of the given size, points.
pub fn bold(size: f32) -> FontId {
    FontId::new(size, FontFamily::Name("bold".into()))
}

/// Regular font of the given size, points.
pub fn plain(size: f32) -> FontId {
    FontId::new(size, FontFamily::Proportional)
}

/// Font of code, of letters with equal widths, of the given size, points.
pub fn code(size: f32) -> FontId {
    FontId::new(size, FontFamily::Name("code".into()))
}

/// The fonts: regular, bold, of code, and of signs that the others lack.
pub const FONT_FILES: [(&str, &[u8]); 4] = [
    ("sans", include_bytes!("../../assets/fonts/Inter-Regular.ttf")),
    ("sans-bold", include_bytes!("../../assets/fonts/Inter-SemiBold.ttf")),
    ("mono", include_bytes!("../../assets/fonts/DejaVuSansMono-text.ttf")),
    ("signs", include_bytes!("../../assets/fonts/DejaVuSans-signs.ttf")),
];

/// Installs the font Inter, with digits of equal width; glyphs that it lacks come from DejaVu Sans. Code is set
/// in DejaVu Sans Mono.
pub fn install_fonts(ctx: &egui::Context) {
    let mut fonts = FontDefinitions::default();
    for (name, bytes) in FONT_FILES {
        fonts.font_data.insert(name.into(), Arc::new(FontData::from_static(bytes)));
    }
    let first = |own: &str| [own.into(), "signs".into()];
    for family in [FontFamily::Proportional, FontFamily::Monospace] {
        fonts.families.entry(family).or_default().splice(0..0, first("sans"));
    }
    fonts.families.insert(FontFamily::Name("bold".into()), first("sans-bold").to_vec());
    let code = ["mono", "sans", "signs"].map(Into::into);
    fonts.families.insert(FontFamily::Name("code".into()), code.to_vec());
    ctx.set_fonts(fonts);
}

/// A viewport and the camera in it.
pub struct SceneViewport {
    /// Rectangle on the screen, points.
    pub rect: Rect,
    /// Camera of the viewport.
    pub camera: Camera,
}

impl SceneViewport {
    /// Converts a point of the screen to a pointer in the scene.
    pub fn pointer(&self, pos: Pos2) -> Pointer {
        let at = pos - self.rect.min;
        let pair = |v: Vec2| [f64::from(v.x), f64::from(v.y)];
        Pointer { camera: self.camera, size: pair(self.rect.size()), at: pair(at) }
    }

    /// Projects a point, m, onto the screen; `None` if the camera does not see it.
    pub fn screen(&self, point: [f64; 3]) -> Option<Pos2> {
        let [x, y] = self.pointer(self.rect.min).project(point)?;
        Some(self.rect.min + vec2(x as f32, y as f32))
    }
}

/// The renderers of each scene of a window.
pub(super) struct Renderers {
    device: wgpu::Device,
    format: wgpu::TextureFormat,
    all: Vec<Place>,
}

/// The renderers of one scene, one for each quality in use.
#[derive(Default)]
struct Place {
    fine: Option<Renderer>,
    draft: Option<Renderer>,
    /// Scene, view and quality that were drawn last.
    last: Option<(Arc<Scene>, View, Quality)>,
}

impl Renderers {
    /// Creates an empty set; `format` is the format of the render pass that they draw in.
    pub(super) fn new(device: &wgpu::Device, format: wgpu::TextureFormat) -> Self {
        Self { device: device.clone(), format, all: Vec::new() }
    }

    /// Draws the requested scene, unless it is the last one that was drawn. Renderers are created on first use.
    pub(super) fn prepare(&mut self, queue: &wgpu::Queue, encoder: &mut wgpu::CommandEncoder, request: &PaintedScene) {
        while self.all.len() <= request.number {
            self.all.push(Place::default());
        }
        let place = &mut self.all[request.number];
        let is_there = place.last.as_ref().is_some_and(|(scene, view, quality)| {
            Arc::ptr_eq(scene, &request.scene) && *view == request.view && *quality == request.quality
        });
        if is_there {
            return;
        }
        let renderer = match request.quality {
            Quality::Fine => &mut place.fine,
            Quality::Draft => &mut place.draft,
        };
        renderer.get_or_insert_with(|| Renderer::drawing(&self.device, self.format, request.quality)).prepare(
            &self.device,
            queue,
            encoder,
            &request.scene,
            &request.view,
        );
        place.last = Some((request.scene.clone(), request.view, request.quality));
    }

    /// Copies the last picture of the requested scene into the viewport of a pass.
    pub(super) fn paint(&self, pass: &mut wgpu::RenderPass, request: &PaintedScene) {
        let Some(Place { fine, draft, last: Some((.., quality)) }) = self.all.get(request.number) else { return };
        let renderer = match quality {
            Quality::Fine => fine.as_ref(),
            Quality::Draft => draft.as_ref(),
        };
        if let Some(renderer) = renderer {
            renderer.paint(pass);
        }
    }
}

/// Request to draw a scene; a paint callback among egui's shapes.
pub(super) struct PaintedScene {
    number: usize,
    scene: Arc<Scene>,
    view: View,
    quality: Quality,
}

/// Makes all scenes appear in draft quality while they change; for software rendering.
pub fn enable_draft_quality(ctx: &egui::Context) {
    ctx.data_mut(|data| data.insert_temp(drafts_id(), true));
}

fn drafts_id() -> egui::Id {
    egui::Id::unique("what moves is drawn in draft")
}

/// Time without change after which a scene is drawn in fine quality, s.
const REST_TIME_S: f64 = 0.12;

/// Scene and view of the previous pass, and the time, s, of their last change.
#[derive(Clone)]
struct Unchanged {
    scene: Arc<Scene>,
    view: View,
    since: f64,
}

/// Returns the scene to draw and its quality. If the scene looks the same as in the previous pass, the previous scene
/// is returned.
fn settle(ctx: &egui::Context, number: usize, scene: &Arc<Scene>, view: &View) -> (Arc<Scene>, Quality) {
    let id = egui::Id::unique("what a scene looked like").with(number);
    let (now, before) = (ctx.input(|i| i.time), ctx.data(|data| data.get_temp::<Unchanged>(id)));
    let same = before.filter(|before| before.view == *view && before.scene.looks_like(scene));
    let current = same.unwrap_or_else(|| Unchanged { scene: scene.clone(), view: *view, since: now });
    let rest = REST_TIME_S - (now - current.since);
    let drafts = ctx.data(|data| data.get_temp(drafts_id()).unwrap_or(false));
    let quality = if drafts && rest > 0.0 { Quality::Draft } else { Quality::Fine };
    if quality == Quality::Draft {
        ctx.request_repaint_after_secs(rest as f32);
    }
    let scene = current.scene.clone();
    ctx.data_mut(|data| data.insert_temp(id, current));
    (scene, quality)
}

/// Draws a scene into a rectangle. Scenes of one window are numbered from 0.
pub fn paint(ui: &Ui, number: usize, rect: Rect, scene: &Arc<Scene>, camera: &Camera) {
    let pixels = ui.ctx().pixels_per_point();
    let aspect = f64::from(rect.width() / rect.height().max(1.0));
    let view = View {
        clip_from_world: camera.clip_from_world(aspect),
        eye_direction: camera.eye_direction(),
        size_px: [(rect.width() * pixels).round() as u32, (rect.height() * pixels).round() as u32],
        pixels_per_point: pixels,
    };
    let (scene, quality) = settle(ui.ctx(), number, scene, &view);
    let paint = PaintedScene { number, scene, view, quality };
    ui.painter().add(PaintCallback { rect, callback: Arc::new(paint) });
}
