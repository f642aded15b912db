//! Reactionless workspaces, evaluated on the GPU over a grid of (a_1, a_2).

use super::kit::{ENTRIES, List, Recipe, SharedBindings, Upload};
use super::shader::{Shader, embedded, twin};
use crate::scene::{self, Scene};
use bytemuck::Zeroable as _;
use wgpu::util::DeviceExt as _;

twin! {
    /// Coefficients of an area; `u1` and `u2` are the columns of u.
    struct Area {
        world_from_plane: [[f32; 4]; 4],
        c: [f32; 3],
        turn: f32,
        u1: [f32; 3],
        z: f32,
        u2: [f32; 3],
        x: f32,
        v: [f32; 3],
        y: f32,
        a_min: [f32; 2],
        a_max: [f32; 2],
        colour: [f32; 4],
        shade: [f32; 4],
        full: f32,
        empty: f32,
        measure: u32,
        _pad0: f32,
    }
}

pub(super) struct WorkspaceRenderer {
    shader: Shader<wgpu::RenderPipeline>,
    list: List<Area>,
    /// Vertex indices, two triangles per cell; each vertex of the grid is evaluated once.
    triangles: wgpu::Buffer,
    corners: u32,
}

impl WorkspaceRenderer {
    pub(super) fn new(device: &wgpu::Device, kit: &SharedBindings) -> Self {
        let (pipeline, cells) = (kit.pipelines(), kit.quality.cells());
        let build = move |device: &wgpu::Device, module: &wgpu::ShaderModule| {
            let recipe = Recipe {
                label: "workspace",
                module,
                entries: ENTRIES,
                constants: &[("CELLS", f64::from(cells))],
                vertices: None,
                topology: wgpu::PrimitiveTopology::TriangleList,
                cull: None,
                depth_write: false,
                depth_compare: wgpu::CompareFunction::LessEqual,
                blend: Some(wgpu::BlendState::ALPHA_BLENDING),
            };
            pipeline(device, recipe)
        };
        let vertex = |column: u16, row: u16| row * (cells + 1) + column;
        let cell = |column, row| {
            let [a, b] = [vertex(column, row), vertex(column + 1, row)];
            let [c, d] = [vertex(column, row + 1), vertex(column + 1, row + 1)];
            [a, b, d, a, d, c]
        };
        let corners: Vec<u16> =
            (0..cells).flat_map(|row| (0..cells).flat_map(move |column| cell(column, row))).collect();
        Self {
            shader: Shader::new(device, embedded!("workspace"), Box::new(build)),
            list: List::new(device, kit, "areas"),
            triangles: device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some("workspace grid"),
                contents: bytemuck::cast_slice(&corners),
                usage: wgpu::BufferUsages::INDEX,
            }),
            corners: corners.len() as u32,
        }
    }

    pub(super) fn prepare(&mut self, kit: &SharedBindings, upload: &mut Upload, scene: &Scene) {
        self.shader.reload(upload.device);
        self.list.items.clear();
        self.list.items.extend(scene.areas.iter().map(|area| {
            let &scene::Area { name: _, c, u, v, a_min, a_max, turn, at: [x, y], z, world_from_plane, colour, shade } =
                area;
            let [u1, u2] = [0, 1].map(|i| u.map(|u_k| u_k[i]));
            // Without a shade, both ends of the colour scale are the colour of the area.
            let (shade, [empty, full], measure) =
                shade.map_or((colour, [0.0, 1.0], 0), |s| (s.colour, [s.empty, s.full], s.measure as u32));
            let spread = Area { c, turn, u1, z, u2, x, v, y, a_min, a_max, ..Area::zeroed() };
            Area { world_from_plane, colour, shade, full, empty, measure, ..spread }
        }));
        self.list.upload(kit, upload);
    }

    pub(super) fn draw(&self, pass: &mut wgpu::RenderPass) {
        if !self.list.items.is_empty() {
            pass.set_pipeline(&self.shader);
            pass.set_bind_group(1, &self.list.group, &[]);
            pass.set_index_buffer(self.triangles.slice(..), wgpu::IndexFormat::Uint16);
            pass.draw_indexed(0..self.corners, 0, 0..self.list.items.len() as u32);
        }
    }
}
