//! Discs and rings of constant size on the screen, over everything.

use super::kit::{List, Recipe, SharedBindings, Upload};
use super::shader::{Shader, embedded, twin};
use crate::scene::{self, Scene};
use bytemuck::Zeroable as _;

twin! {
    /// A disc with an edge.
    struct Marker {
        at: [f32; 3],
        radius: f32,
        fill: [f32; 4],
        stroke: [f32; 4],
        stroke_width: f32,
        _pad: [f32; 3],
    }
}

pub(super) struct MarkerRenderer {
    shader: Shader<wgpu::RenderPipeline>,
    list: List<Marker>,
}

impl MarkerRenderer {
    pub(super) fn new(device: &wgpu::Device, kit: &SharedBindings) -> Self {
        let pipeline = kit.pipelines();
        let build = move |device: &wgpu::Device, module: &wgpu::ShaderModule| {
            use wgpu::{BlendState, CompareFunction};
            let (compare, blend) = (CompareFunction::Always, BlendState::PREMULTIPLIED_ALPHA_BLENDING);
            pipeline(device, Recipe::quads("markers", module, compare, blend))
        };
        Self {
            shader: Shader::new(device, embedded!("markers"), Box::new(build)),
            list: List::new(device, kit, "markers"),
        }
    }

    pub(super) fn prepare(&mut self, kit: &SharedBindings, upload: &mut Upload, scene: &Scene) {
        self.shader.reload(upload.device);
        self.list.items.clear();
        self.list.items.extend(scene.markers.iter().map(|marker| {
            let &scene::Marker { name: _, at, radius, fill, stroke, stroke_width } = marker;
            Marker { at, radius, fill, stroke, stroke_width, ..Marker::zeroed() }
        }));
        self.list.upload(kit, upload);
    }

    pub(super) fn draw(&self, pass: &mut wgpu::RenderPass) {
        if !self.list.items.is_empty() {
            pass.set_pipeline(&self.shader);
            pass.set_bind_group(1, &self.list.group, &[]);
            pass.draw(0..4, 0..self.list.items.len() as u32);
        }
    }
}
