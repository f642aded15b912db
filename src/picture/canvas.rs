//! Drawing without a window, for figures, pictures in recordings, and tests.

use std::sync::Arc;

use super::charts::figure::Figure;
use super::gui::{GuiRenderer, RenderTarget};
use super::paint::figure::paint_figure;
use super::paint::{self, labels};
use super::render::offscreen::{Gpu, NoAdapter, NoPicture, Picture, surface};
use super::scene::Scene;
use super::scene::camera::Camera;

/// A texture that egui and the scene renderer draw on, and that can be read back.
pub struct Canvas {
    gpu: Gpu,
    gui: GuiRenderer,
    ctx: egui::Context,
    texture: wgpu::Texture,
    size_px: [u32; 2],
    pixels_per_point: f32,
    fonts: bool,
}

impl Canvas {
    /// Creates a canvas of the given size in physical pixels, or of the largest that the GPU allows; `scale` is the
    /// number of physical pixels per logical point.
    ///
    /// # Errors
    /// If there is no usable GPU adapter; the message names the package to install.
    pub fn new([width, height]: [u32; 2], scale: f32) -> Result<Self, NoAdapter> {
        let gpu = Gpu::new()?;
        let format = wgpu::TextureFormat::Rgba8Unorm;
        let device = gpu.device();
        let gui = GuiRenderer::new(device, gpu.queue(), format);
        let most = device.limits().max_texture_dimension_2d;
        let (width, height) = (width.clamp(1, most), height.clamp(1, most));
        let size_px = [width, height];
        let texture = surface(device, size_px, format);
        let ctx = egui::Context::default();
        Ok(Self { gpu, gui, ctx, texture, size_px, pixels_per_point: scale, fonts: false })
    }

    /// Draws the user interface that `draw` builds with egui.
    ///
    /// # Errors
    /// If the picture cannot be read back.
    pub fn draw(&mut self, mut draw: impl FnMut(&mut egui::Ui)) -> Result<Picture, NoPicture> {
        // The first passes load fonts and settle the layout; only the picture of the last pass is used.
        for _ in 0..4 {
            self.pass(None, &mut draw);
        }
        self.read()
    }

    /// Forgets where the labels of a scene stood, so that the next picture does not depend on the one before.
    pub fn forget_labels(&self) {
        labels::forget(&self.ctx, 0);
    }

    /// Draws a scene with its labels over the whole canvas. Labels stay where they stood in the picture before, if they
    /// can, so that they stand still in films.
    ///
    /// # Errors
    /// If the picture cannot be read back.
    pub fn scene(&mut self, scene: &Arc<Scene>, camera: &Camera) -> Result<Picture, NoPicture> {
        self.scene_beside(scene, camera, &[])
    }

    /// Draws a scene as [`scene`](Self::scene) does, left of figures, each with its upper left corner, points.
    ///
    /// # Errors
    /// If the picture cannot be read back.
    pub fn scene_beside(
        &mut self,
        scene: &Arc<Scene>,
        camera: &Camera,
        figures: &[([f32; 2], Figure)],
    ) -> Result<Picture, NoPicture> {
        let behind = Some(paint::colour(scene.background));
        let draw = |ui: &mut egui::Ui| {
            labels::paint_still(ui, scene, camera, figures.first().map(|([left, _], _)| *left));
            paint_figures(ui, figures);
        };
        if !self.fonts {
            paint::install_fonts(&self.ctx);
            self.fonts = true;
            self.pass(behind, draw);
            self.forget_labels();
        }
        self.pass(behind, draw);
        self.read()
    }

    /// Draws figures with their upper left corners, points, over a colour of their own.
    ///
    /// # Errors
    /// If the picture cannot be read back.
    pub fn figures(&mut self, figures: &[([f32; 2], Figure)]) -> Result<Picture, NoPicture> {
        let behind = figures.first().map(|(_, figure)| paint::colour(figure.background));
        self.load_fonts(behind);
        self.pass(behind, |ui| paint_figures(ui, figures));
        self.read()
    }

    /// Loads the fonts, which are there from the next pass on.
    fn load_fonts(&mut self, behind: Option<egui::Color32>) {
        if !std::mem::replace(&mut self.fonts, true) {
            paint::install_fonts(&self.ctx);
            self.pass(behind, |_| ());
        }
    }

    fn read(&mut self) -> Result<Picture, NoPicture> {
        self.gpu.readback(&self.texture)
    }

    /// Draws one pass over the colour `behind`; if it is `None`, over the colour of panels.
    fn pass(&mut self, behind: Option<egui::Color32>, draw: impl FnMut(&mut egui::Ui)) {
        let scale = self.pixels_per_point;
        let [width, height] = self.size_px.map(|n| n as f32 / scale);
        let size = egui::vec2(width, height);
        let mut input = egui::RawInput {
            screen_rect: Some(egui::Rect::from_min_size(egui::Pos2::ZERO, size)),
            ..Default::default()
        };
        if let Some(root) = input.viewports.get_mut(&egui::ViewportId::ROOT) {
            root.native_pixels_per_point = Some(scale);
        }
        let mut output = self.ctx.run_ui(input, draw);
        let shapes = self.ctx.tessellate(output.shapes, output.pixels_per_point);
        let view = self.texture.create_view(&wgpu::TextureViewDescriptor::default());
        let behind = behind.unwrap_or_else(|| self.ctx.global_style().visuals.panel_fill);
        let sheet = RenderTarget { view: &view, size_px: self.size_px, pixels_per_point: scale, behind };
        self.gui.draw(&sheet, &mut output.textures_delta, &shapes);
    }
}

fn paint_figures(ui: &egui::Ui, figures: &[([f32; 2], Figure)]) {
    for (corner, figure) in figures {
        paint_figure(ui.painter(), (*corner).into(), figure);
    }
}
