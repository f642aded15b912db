//! Soft shadows of bars on the plane below them.

use super::kit::{List, Recipe, SharedBindings, Upload};
use super::shader::{Shader, embedded, twin};
use crate::scene::{self, Scene};

twin! {
    /// Shadow of a bar.
    struct Shadow {
        root: [f32; 2],
        tip: [f32; 2],
        z: f32,
        core: f32,
        reach: f32,
        strength: f32,
    }
}

pub(super) struct ShadowRenderer {
    shader: Shader<wgpu::RenderPipeline>,
    list: List<Shadow>,
}

impl ShadowRenderer {
    pub(super) fn new(device: &wgpu::Device, kit: &SharedBindings) -> Self {
        let pipeline = kit.pipelines();
        let build = move |device: &wgpu::Device, module: &wgpu::ShaderModule| {
            use wgpu::{BlendState, CompareFunction};
            let (compare, blend) = (CompareFunction::LessEqual, BlendState::ALPHA_BLENDING);
            pipeline(device, Recipe::quads("shadows", module, compare, blend))
        };
        Self {
            shader: Shader::new(device, embedded!("shadows"), Box::new(build)),
            list: List::new(device, kit, "shadows"),
        }
    }

    pub(super) fn prepare(&mut self, kit: &SharedBindings, upload: &mut Upload, scene: &Scene) {
        self.shader.reload(upload.device);
        self.list.items.clear();
        self.list.items.extend(scene.shadows.iter().map(|shadow| {
            let &scene::Shadow { ends: [root, tip], z, core, reach, strength } = shadow;
            Shadow { root, tip, z, core, reach, strength }
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
