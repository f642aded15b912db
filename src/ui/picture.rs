//! The whole desk drawn without a window: figures of the README, and tests.

use super::Desk;
use crate::render::Renderer;
use crate::render::offscreen::{Gpu, NoPicture, Picture};

/// Draws a desk at a size in physical pixels; `scale` physical pixels make a logical one.
///
/// # Errors
/// If the picture cannot be made: its size is beyond the adapter's.
pub fn draw(gpu: &mut Gpu, desk: &mut Desk, [width, height]: [u32; 2], scale: f32) -> Result<Picture, NoPicture> {
    let format = wgpu::TextureFormat::Rgba8Unorm;
    let (device, queue) = (gpu.device().clone(), gpu.queue().clone());
    let mut renderer = egui_wgpu::Renderer::new(&device, format, egui_wgpu::RendererOptions::PREDICTABLE);
    renderer.callback_resources.insert(Renderer::new(&device, format));
    let most = device.limits().max_texture_dimension_2d;
    let size = wgpu::Extent3d {
        width: width.clamp(1, most),
        height: height.clamp(1, most),
        depth_or_array_layers: 1,
    };
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("desk"),
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
    let screen = egui_wgpu::ScreenDescriptor { size_in_pixels: [size.width, size.height], pixels_per_point: scale };
    let ctx = egui::Context::default();
    let points = egui::vec2(size.width as f32, size.height as f32) / scale;
    // The first passes load fonts and settle the layout; the last one counts.
    for pass in 0..4 {
        let mut input = egui::RawInput {
            screen_rect: Some(egui::Rect::from_min_size(egui::Pos2::ZERO, points)),
            time: Some(f64::from(pass)),
            ..Default::default()
        };
        if let Some(root) = input.viewports.get_mut(&egui::ViewportId::ROOT) {
            root.native_pixels_per_point = Some(scale);
        }
        let mut output = ctx.run_ui(input, |ui| desk.ui(ui));
        for (id, deltas) in output.textures_delta.set.drain() {
            for delta in deltas {
                renderer.update_texture(&device, &queue, id, &delta);
            }
        }
        let shapes = ctx.tessellate(output.shapes, output.pixels_per_point);
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let mut buffers = renderer.update_buffers(&device, &queue, &mut encoder, &shapes, &screen);
        let mut target = encoder
            .begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("desk"),
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &view,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store },
                })],
                ..Default::default()
            })
            .forget_lifetime();
        renderer.render(&mut target, &shapes, &screen);
        drop(target);
        buffers.push(encoder.finish());
        queue.submit(buffers);
        for id in output.textures_delta.free.drain() {
            renderer.free_texture(&id);
        }
    }
    gpu.readback(&texture)
}
