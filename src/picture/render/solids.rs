//! Bars, joints and base: instanced meshes with diffuse lighting.

use std::mem::offset_of;
use std::ops::Range;
use std::sync::Arc;

use bytemuck::Zeroable as _;

use super::kit::{ENTRIES, List, Recipe, SharedBindings, Upload};
use super::quality::Quality;
use super::shader::{Shader, embedded, twin};
use crate::scene::{MeshSet, Scene};

twin! {
    /// A vertex of a mesh, padded as WGSL lays it out.
    struct Vertex {
        position: [f32; 3],
        _pad0: f32,
        normal: [f32; 3],
        _pad1: f32,
    }
}

twin! {
    /// Pose and colour of a solid.
    struct Instance {
        world_from_mesh: [[f32; 4]; 4],
        colour: [f32; 4],
    }
}

const ATTRIBUTES: [wgpu::VertexAttribute; 2] = [
    wgpu::VertexAttribute {
        format: wgpu::VertexFormat::Float32x3,
        offset: offset_of!(Vertex, position) as u64,
        shader_location: 0,
    },
    wgpu::VertexAttribute {
        format: wgpu::VertexFormat::Float32x3,
        offset: offset_of!(Vertex, normal) as u64,
        shader_location: 1,
    },
];

struct Pipelines {
    opaque: wgpu::RenderPipeline,
    /// Thin outline in the background colour around each opaque solid.
    casing: wgpu::RenderPipeline,
    /// Writes the depth of the nearest translucent surface, so that only this surface of a translucent solid is drawn.
    front: wgpu::RenderPipeline,
    translucent: wgpu::RenderPipeline,
    /// Open surfaces, all layers and both sides; they write no depth.
    shell: wgpu::RenderPipeline,
}

/// The meshes of a model in one pair of buffers.
struct Meshes {
    /// Kept alive, so that no other model can have the same address.
    model: Arc<MeshSet>,
    vertices: wgpu::Buffer,
    triangles: wgpu::Buffer,
    /// Index range and first vertex of each mesh.
    parts: Vec<(Range<u32>, i32)>,
}

/// Consecutive instances of one mesh.
struct Run {
    mesh: usize,
    instances: Range<u32>,
}

pub(super) struct SolidRenderer {
    shader: Shader<Pipelines>,
    meshes: Option<Meshes>,
    list: List<Instance>,
    /// Indices of the solids in drawing order: opaque, shells, translucent, and within these by mesh.
    order: Vec<usize>,
    runs: Vec<Run>,
    opaque_runs: usize,
    shell_runs: usize,
}

/// Drawing order of solids.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Layer {
    Opaque,
    Shell,
    Translucent,
}

impl SolidRenderer {
    pub(super) fn new(device: &wgpu::Device, kit: &SharedBindings) -> Self {
        let pipeline = kit.pipelines();
        let build = move |device: &wgpu::Device, module: &wgpu::ShaderModule| {
            let recipe = |label, entries, cull, depth_write, depth_compare, blend| {
                let recipe = Recipe {
                    label,
                    module,
                    entries,
                    constants: &[],
                    vertices: Some(wgpu::VertexBufferLayout {
                        array_stride: size_of::<Vertex>() as u64,
                        step_mode: wgpu::VertexStepMode::Vertex,
                        attributes: &ATTRIBUTES,
                    }),
                    topology: wgpu::PrimitiveTopology::TriangleList,
                    cull,
                    depth_write,
                    depth_compare,
                    blend,
                };
                pipeline(device, recipe)
            };
            use wgpu::{BlendState, CompareFunction, Face::*};
            let plain = Some(BlendState::REPLACE);
            let blend = Some(BlendState::ALPHA_BLENDING);
            let (back, front) = (Some(Back), Some(Front));
            let shell = ["vertex", "shell_fragment"];
            let casing = ["casing_vertex", "casing_fragment"];
            Pipelines {
                opaque: recipe("opaque solids", ENTRIES, back, true, CompareFunction::Less, plain),
                casing: recipe("casing of solids", casing, front, true, CompareFunction::Less, plain),
                front: recipe("front of translucent solids", ENTRIES, back, true, CompareFunction::Less, None),
                translucent: recipe("translucent solids", ENTRIES, back, false, CompareFunction::Equal, blend),
                shell: recipe("shells", shell, None, false, CompareFunction::LessEqual, blend),
            }
        };
        Self {
            shader: Shader::new(device, embedded!("solids"), Box::new(build)),
            meshes: None,
            list: List::new(device, kit, "solids"),
            order: Vec::new(),
            runs: Vec::new(),
            opaque_runs: 0,
            shell_runs: 0,
        }
    }

    pub(super) fn prepare(&mut self, queue: &wgpu::Queue, kit: &SharedBindings, upload: &mut Upload, scene: &Scene) {
        self.shader.reload(upload.device);
        if !self.meshes.as_ref().is_some_and(|meshes| Arc::ptr_eq(&meshes.model, &scene.model)) {
            self.meshes = Some(Meshes::new(upload.device, queue, &scene.model, kit.quality, self.meshes.take()));
        }
        let solids = &scene.solids;
        let layer = |k: &usize| match (&scene.model.meshes[solids[*k].mesh], solids[*k].colour[3] < 1.0) {
            (mesh, _) if mesh.shell => Layer::Shell,
            (_, true) => Layer::Translucent,
            (_, false) => Layer::Opaque,
        };
        self.order.clear();
        self.order.extend(
            (0..solids.len()).filter(|&k| solids[k].mesh < scene.model.meshes.len() && solids[k].colour[3] > 0.0),
        );
        self.order.sort_unstable_by_key(|k| (layer(k), solids[*k].mesh, *k));

        self.list.items.clear();
        self.runs.clear();
        (self.opaque_runs, self.shell_runs) = (0, 0);
        let mut last = None;
        for k in &self.order {
            let (mesh, at) = (solids[*k].mesh, self.list.items.len() as u32);
            self.list.items.push(Instance { world_from_mesh: solids[*k].world_from_item, colour: solids[*k].colour });
            match self.runs.last_mut() {
                Some(run) if last == Some((layer(k), mesh)) => run.instances.end = at + 1,
                _ => self.runs.push(Run { mesh, instances: at..at + 1 }),
            }
            last = Some((layer(k), mesh));
            match layer(k) {
                Layer::Opaque => (self.opaque_runs, self.shell_runs) = (self.runs.len(), self.runs.len()),
                Layer::Shell => self.shell_runs = self.runs.len(),
                Layer::Translucent => {}
            }
        }
        self.list.upload(kit, upload);
    }

    pub(super) fn draw_opaque(&self, pass: &mut wgpu::RenderPass) {
        let runs = &self.runs[..self.opaque_runs];
        self.draw(pass, &self.shader.opaque, runs);
        self.draw(pass, &self.shader.casing, runs);
    }

    pub(super) fn draw_shells(&self, pass: &mut wgpu::RenderPass) {
        self.draw(pass, &self.shader.shell, &self.runs[self.opaque_runs..self.shell_runs]);
    }

    pub(super) fn draw_translucent(&self, pass: &mut wgpu::RenderPass) {
        let runs = &self.runs[self.shell_runs..];
        self.draw(pass, &self.shader.front, runs);
        self.draw(pass, &self.shader.translucent, runs);
    }

    fn draw(&self, pass: &mut wgpu::RenderPass, pipeline: &wgpu::RenderPipeline, runs: &[Run]) {
        let Some(meshes) = self.meshes.as_ref().filter(|_| !runs.is_empty()) else { return };
        pass.set_pipeline(pipeline);
        pass.set_bind_group(1, &self.list.group, &[]);
        pass.set_vertex_buffer(0, meshes.vertices.slice(..));
        pass.set_index_buffer(meshes.triangles.slice(..), wgpu::IndexFormat::Uint32);
        for Run { mesh, instances } in runs {
            let (triangles, first) = meshes.parts[*mesh].clone();
            pass.draw_indexed(triangles, first, instances.clone());
        }
    }
}

impl Meshes {
    /// Copies the meshes of a model to the GPU; reuses the buffers of `old` if they are large enough.
    fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        model: &Arc<MeshSet>,
        quality: Quality,
        old: Option<Self>,
    ) -> Self {
        let (mut vertices, mut triangles, mut parts) = (Vec::new(), Vec::<[u32; 3]>::new(), Vec::new());
        for mesh in &model.meshes {
            let mesh = mesh.coarse.as_deref().filter(|_| quality == Quality::Draft).unwrap_or(mesh);
            let (first_vertex, first_index) = (vertices.len(), 3 * triangles.len() as u32);
            let corners = mesh.positions.iter().zip(&mesh.normals);
            vertices.extend(corners.map(|(&position, &normal)| Vertex { position, normal, ..Vertex::zeroed() }));
            // A triangle with an index out of range would read the vertices of another mesh.
            let here = (vertices.len() - first_vertex) as u32;
            triangles.extend(mesh.triangles.iter().filter(|t| t.iter().all(|&k| k < here)));
            parts.push((first_index..3 * triangles.len() as u32, first_vertex as i32));
        }
        let (old_vertices, old_triangles) = old.map(|old| (old.vertices, old.triangles)).unzip();
        let write = |label, usage, bytes: &[u8], old: Option<wgpu::Buffer>| {
            let buffer = old.filter(|old| old.size() >= bytes.len() as u64).unwrap_or_else(|| {
                device.create_buffer(&wgpu::BufferDescriptor {
                    label: Some(label),
                    size: bytes.len().max(32) as u64,
                    usage: usage | wgpu::BufferUsages::COPY_DST,
                    mapped_at_creation: false,
                })
            });
            queue.write_buffer(&buffer, 0, bytes);
            buffer
        };
        Self {
            model: model.clone(),
            vertices: write("vertices", wgpu::BufferUsages::VERTEX, bytemuck::cast_slice(&vertices), old_vertices),
            triangles: write("triangles", wgpu::BufferUsages::INDEX, bytemuck::cast_slice(&triangles), old_triangles),
            parts,
        }
    }
}
