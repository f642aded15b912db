//! What a window would show, drawn without one: figures, pictures in recordings, and tests.

use std::sync::Arc;

use super::paint::{self, words};
use super::render::offscreen::{Gpu, NoAdapter, NoPicture, Picture, surface};
use super::scene::Scene;
use super::scene::camera::Camera;

/// A surface that egui and the scene draw on, and that can be read back.
pub struct Canvas {
    gpu: Gpu,
    egui: egui_wgpu::Renderer,
    ctx: egui::Context,
    texture: wgpu::Texture,
    screen: egui_wgpu::ScreenDescriptor,
    fonts: bool,
}

impl Canvas {
    /// Of a size in physical pixels; `scale` of them make a logical one.
    ///
    /// # Errors
    /// If no adapter can draw; the text names what to install.
    pub fn new([width, height]: [u32; 2], scale: f32) -> Result<Self, NoAdapter> {
        let gpu = Gpu::new()?;
        let format = wgpu::TextureFormat::Rgba8Unorm;
        let device = gpu.device();
        let mut egui = egui_wgpu::Renderer::new(device, format, egui_wgpu::RendererOptions::PREDICTABLE);
        egui.callback_resources.insert(paint::Renderers::new(device, format));
        let most = device.limits().max_texture_dimension_2d;
        let (width, height) = (width.clamp(1, most), height.clamp(1, most));
        let texture = surface(device, [width, height], format);
        let screen = egui_wgpu::ScreenDescriptor { size_in_pixels: [width, height], pixels_per_point: scale };
        Ok(Self { gpu, egui, ctx: egui::Context::default(), texture, screen, fonts: false })
    }

    /// Draws what a function makes with egui.
    ///
    /// # Errors
    /// If the picture cannot be read back.
    pub fn draw(&mut self, mut draw: impl FnMut(&mut egui::Ui)) -> Result<Picture, NoPicture> {
        // The first passes load fonts and settle the layout; the last one counts.
        for _ in 0..4 {
            self.pass(&mut draw);
        }
        self.read()
    }

    /// A scene with its words and nothing around it.
    ///
    /// # Errors
    /// If the picture cannot be read back.
    pub fn scene(&mut self, scene: &Arc<Scene>, camera: &Camera) -> Result<Picture, NoPicture> {
        if !self.fonts {
            paint::install_fonts(&self.ctx);
            self.fonts = true;
            self.pass(|ui| words::still(ui, scene, camera));
        }
        self.pass(|ui| words::still(ui, scene, camera));
        self.read()
    }

    fn read(&mut self) -> Result<Picture, NoPicture> {
        self.gpu.readback(&self.texture)
    }

    fn pass(&mut self, draw: impl FnMut(&mut egui::Ui)) {
        let (device, queue) = (self.gpu.device().clone(), self.gpu.queue().clone());
        let scale = self.screen.pixels_per_point;
        let [width, height] = self.screen.size_in_pixels.map(|n| n as f32 / scale);
        let size = egui::vec2(width, height);
        let mut input = egui::RawInput {
            screen_rect: Some(egui::Rect::from_min_size(egui::Pos2::ZERO, size)),
            ..Default::default()
        };
        if let Some(root) = input.viewports.get_mut(&egui::ViewportId::ROOT) {
            root.native_pixels_per_point = Some(scale);
        }
        let mut output = self.ctx.run_ui(input, draw);
        for (id, deltas) in output.textures_delta.set.drain() {
            for delta in deltas {
                self.egui.update_texture(&device, &queue, id, &delta);
            }
        }
        let shapes = self.ctx.tessellate(output.shapes, output.pixels_per_point);
        let behind = self.ctx.global_style().visuals.panel_fill;
        draw_shapes(&mut self.egui, (&device, &queue), (&self.texture, behind), &shapes, &self.screen);
        for id in output.textures_delta.free.drain() {
            self.egui.free_texture(&id);
        }
    }
}

/// Draws what egui has made over a whole [`surface`] of one colour.
pub fn draw_shapes(
    egui: &mut egui_wgpu::Renderer,
    (device, queue): (&wgpu::Device, &wgpu::Queue),
    (texture, behind): (&wgpu::Texture, egui::Color32),
    shapes: &[egui::ClippedPrimitive],
    screen: &egui_wgpu::ScreenDescriptor,
) {
    let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
    let [r, g, b, a] = behind.to_normalized_gamma_f32().map(f64::from);
    let behind = wgpu::Color { r, g, b, a };
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let mut buffers = egui.update_buffers(device, queue, &mut encoder, shapes, screen);
    let mut target = encoder
        .begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("canvas"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(behind), store: wgpu::StoreOp::Store },
            })],
            ..Default::default()
        })
        .forget_lifetime();
    egui.render(&mut target, shapes, screen);
    drop(target);
    buffers.push(encoder.finish());
    queue.submit(buffers);
}
