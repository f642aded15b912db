//! What a window draws on where there is none.

use egui::TexturesDelta;
use egui_kittest::TestRenderer;
use stillbase::app::window::App;
use stillbase::picture::gui::{GuiRenderer, RenderTarget};
use stillbase::picture::render::offscreen::{Gpu, surface};

/// Shows an application over the whole window; kittest would leave a margin around it.
pub fn whole(ui: &mut egui::Ui, app: &mut App) {
    let rect = ui.ctx().content_rect();
    let mut ui = ui.new_child(egui::UiBuilder::new().max_rect(rect));
    ui.set_clip_rect(rect);
    app.ui(&mut ui);
}

/// A GPU of its own for each window: a renderer keeps what was drawn on it.
pub struct Screen {
    gpu: Gpu,
    gui: GuiRenderer,
    textures: TexturesDelta,
}

impl Screen {
    pub fn new() -> Self {
        let gpu = crate::gpu::fresh();
        let gui = GuiRenderer::new(gpu.device(), gpu.queue(), wgpu::TextureFormat::Rgba8Unorm);
        Self { gpu, gui, textures: TexturesDelta::default() }
    }
}

impl TestRenderer for Screen {
    fn handle_delta(&mut self, delta: &mut TexturesDelta) {
        self.textures.append(std::mem::take(delta));
    }

    fn render(&mut self, ctx: &egui::Context, output: &egui::FullOutput) -> Result<image::RgbaImage, String> {
        let size = ctx.content_rect().size() * ctx.pixels_per_point();
        let size_px = [size.x.round() as u32, size.y.round() as u32];
        let texture = surface(self.gpu.device(), size_px, wgpu::TextureFormat::Rgba8Unorm);
        let shapes = ctx.tessellate(output.shapes.clone(), ctx.pixels_per_point());
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        let behind = ctx.global_style().visuals.panel_fill;
        let sheet = RenderTarget { view: &view, size_px, pixels_per_point: ctx.pixels_per_point(), behind };
        self.gui.draw(&sheet, &mut self.textures, &shapes);
        let picture = self.gpu.readback(&texture).map_err(|why| why.to_string())?;
        image::RgbaImage::from_raw(picture.width, picture.height, picture.rgba).ok_or_else(|| "no pixels".into())
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        self.textures.clear();
    }
}
