//! What a window draws on where there is none.

use std::sync::Arc;

use egui::mutex::RwLock;
use egui_kittest::TestRenderer;
use egui_wgpu::{RenderState, Renderer, RendererOptions, ScreenDescriptor};
use stillbase::picture::canvas::draw_shapes;
use stillbase::picture::render::offscreen::{Gpu, surface};

/// A GPU of its own for each window: a renderer keeps what was drawn on it.
pub struct Screen {
    gpu: Gpu,
    state: RenderState,
}

impl Screen {
    pub fn new() -> Self {
        let (gpu, target_format) = (crate::gpu::fresh(), wgpu::TextureFormat::Rgba8Unorm);
        let (device, queue) = (gpu.device().clone(), gpu.queue().clone());
        let renderer = Renderer::new(&device, target_format, RendererOptions::PREDICTABLE);
        let state = RenderState {
            adapter: gpu.adapter().clone(),
            available_adapters: Vec::new(),
            instance: wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle()),
            device,
            queue,
            target_format,
            renderer: Arc::new(RwLock::new(renderer)),
        };
        Self { gpu, state }
    }

    /// What it draws with.
    pub fn device(&self) -> &wgpu::Device {
        &self.state.device
    }
}

impl TestRenderer for Screen {
    fn setup_eframe(&self, cc: &mut eframe::CreationContext<'_>, frame: &mut eframe::Frame) {
        cc.wgpu_render_state = Some(self.state.clone());
        frame.wgpu_render_state = Some(self.state.clone());
    }

    fn handle_delta(&mut self, delta: &mut egui::TexturesDelta) {
        let mut renderer = self.state.renderer.write();
        for (id, images) in delta.set.drain() {
            images.iter().for_each(|image| renderer.update_texture(&self.state.device, &self.state.queue, id, image));
        }
        delta.free.drain().for_each(|id| renderer.free_texture(&id));
    }

    fn render(&mut self, ctx: &egui::Context, output: &egui::FullOutput) -> Result<image::RgbaImage, String> {
        let RenderState { device, queue, target_format, renderer, .. } = &self.state;
        let size = ctx.content_rect().size() * ctx.pixels_per_point();
        let [width, height] = [size.x.round() as u32, size.y.round() as u32];
        let screen = ScreenDescriptor { size_in_pixels: [width, height], pixels_per_point: ctx.pixels_per_point() };
        let texture = surface(device, [width, height], *target_format);
        let shapes = ctx.tessellate(output.shapes.clone(), ctx.pixels_per_point());
        draw_shapes(
            &mut renderer.write(),
            (device, queue),
            (&texture, ctx.global_style().visuals.panel_fill),
            &shapes,
            &screen,
        );
        let picture = self.gpu.readback(&texture).map_err(|why| why.to_string())?;
        image::RgbaImage::from_raw(picture.width, picture.height, picture.rgba).ok_or_else(|| "no pixels".into())
    }
}
