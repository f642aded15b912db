//! Draws a [`Scene`] on the GPU: in a window's pass, or into a picture ([`offscreen`]).
//!
//! The renderer depends on scenes, not on mechanics. It draws into its own multisampled target and copies the result
//! pixel for pixel. So a window, a test and a recording show the same picture. Drawing order: background, opaque
//! solids, areas, shadows, depth-tested lines, shells, translucent solids, lines on top, markers. Labels are drawn by
//! egui, which has the fonts.
//!
//! Depth runs from 0 (near) to 1; colours are sRGB values with straight alpha, blended without conversion.

mod blit;
mod kit;
mod lines;
mod markers;
pub mod offscreen;
mod quality;
pub(super) mod shader;
mod shadows;
mod solids;
mod view;
mod workspace;

pub use quality::Quality;
pub use shader::SharedLayout;
pub use view::View;

use crate::scene::Scene;
use kit::Upload;
use wgpu::util::StagingBelt;

/// Pipelines and buffers that draw one scene at a time.
pub struct Renderer {
    kit: kit::SharedBindings,
    belt: StagingBelt,
    solids: solids::SolidRenderer,
    workspace: workspace::WorkspaceRenderer,
    shadows: shadows::ShadowRenderer,
    lines: lines::LineRenderer,
    markers: markers::MarkerRenderer,
    blit: blit::Blit,
    target: Option<blit::Framebuffer>,
}

impl Renderer {
    /// Creates a renderer of fine quality. `target_format` is the format of the pass that [`paint`](Self::paint) draws
    /// in; the pass has one sample and no depth.
    pub fn new(device: &wgpu::Device, target_format: wgpu::TextureFormat) -> Self {
        Self::drawing(device, target_format, Quality::Fine)
    }

    /// Creates a renderer of the given quality; see [`new`](Self::new).
    pub fn drawing(device: &wgpu::Device, target_format: wgpu::TextureFormat, quality: Quality) -> Self {
        let kit = kit::SharedBindings::new(device, quality);
        Self {
            belt: StagingBelt::new(device.clone(), 1 << 18),
            solids: solids::SolidRenderer::new(device, &kit),
            workspace: workspace::WorkspaceRenderer::new(device, &kit),
            shadows: shadows::ShadowRenderer::new(device, &kit),
            lines: lines::LineRenderer::new(device, &kit),
            markers: markers::MarkerRenderer::new(device, &kit),
            blit: blit::Blit::new(device, target_format),
            target: None,
            kit,
        }
    }

    /// Records the commands that draw `scene` into the renderer's own picture. The encoder must be submitted before the
    /// next call. Sizes are clamped to 1..=the largest texture size of the device.
    pub fn prepare(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        scene: &Scene,
        view: &View,
    ) {
        let most = device.limits().max_texture_dimension_2d;
        let view = &View { size_px: view.size_px.map(|n| n.clamp(1, most)), ..*view };
        self.blit.reload(device);
        let target = match self.target.take() {
            Some(target) if target.size_px == view.size_px => target,
            _ => self.blit.target(device, view.size_px, self.kit.quality.samples()),
        };
        let target = self.target.insert(target);

        let upload = &mut Upload { device, encoder, belt: &mut self.belt };
        self.kit.write_frame(upload, view, scene.background);
        self.solids.prepare(queue, &self.kit, upload, scene);
        self.workspace.prepare(&self.kit, upload, scene);
        self.shadows.prepare(&self.kit, upload, scene);
        self.lines.prepare(&self.kit, upload, scene, view);
        self.markers.prepare(&self.kit, upload, scene);

        let [r, g, b, a] = scene.background.map(f64::from);
        let background = wgpu::Color { r: r * a, g: g * a, b: b * a, a };
        // With several samples per pixel, only the resolved picture is stored.
        let store = if target.samples.is_some() { wgpu::StoreOp::Discard } else { wgpu::StoreOp::Store };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("scene"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: target.samples.as_ref().unwrap_or(&target.picture_view),
                depth_slice: None,
                resolve_target: target.samples.as_ref().map(|_| &target.picture_view),
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(background), store },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &target.depth,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(1.0), store: wgpu::StoreOp::Discard }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_bind_group(0, &self.kit.frame_group, &[]);
        self.solids.draw_opaque(&mut pass);
        self.workspace.draw(&mut pass);
        self.shadows.draw(&mut pass);
        self.lines.draw_tested(&mut pass);
        self.solids.draw_shells(&mut pass);
        self.solids.draw_translucent(&mut pass);
        self.lines.draw_on_top(&mut pass);
        self.markers.draw(&mut pass);
        drop(pass);
        self.belt.finish_and_recall_on_submit(encoder);
    }

    /// Copies the picture into the viewport of a pass, pixel for pixel if the sizes agree.
    pub fn paint(&self, pass: &mut wgpu::RenderPass) {
        if let Some(target) = &self.target {
            self.blit.paint(pass, target);
        }
    }

    /// The picture last drawn: Rgba8Unorm, sRGB values, premultiplied alpha.
    pub fn picture(&self) -> Option<&wgpu::Texture> {
        self.target.as_ref().map(|target| &target.picture)
    }
}

/// Memory layouts of all structs that Rust and WGSL share.
pub const TWINS: [SharedLayout; 7] = [
    kit::Frame::TWIN,
    solids::Vertex::TWIN,
    solids::Instance::TWIN,
    lines::Segment::TWIN,
    workspace::Area::TWIN,
    shadows::Shadow::TWIN,
    markers::Marker::TWIN,
];
