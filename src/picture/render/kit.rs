//! Shared parts of the renderers: the uniform of the frame, the pipeline layout, and lists of items in GPU memory.

use std::num::NonZeroU64;

use bytemuck::{Pod, Zeroable as _};
use wgpu::util::StagingBelt;

use super::quality::Quality;
use super::shader::twin;
use super::view::View;
use crate::scene::Rgba;

/// Colours are sRGB values, which are written and blended without conversion.
pub(super) const COLOUR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
pub(super) const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

twin! {
    /// The view, for every shader: group 0, binding 0.
    struct Frame {
        clip_from_world: [[f32; 4]; 4],
        eye_direction: [f32; 3],
        pixels_per_point: f32,
        size_px: [f32; 2],
        _pad: [f32; 2],
        background: [f32; 4],
    }
}

/// Writes buffers through reused staging memory, which is allocated only if it must grow.
pub(super) struct Upload<'a> {
    pub(super) device: &'a wgpu::Device,
    pub(super) encoder: &'a mut wgpu::CommandEncoder,
    pub(super) belt: &'a mut StagingBelt,
}

impl Upload<'_> {
    fn write(&mut self, buffer: &wgpu::Buffer, bytes: &[u8]) {
        if let Some(size) = NonZeroU64::new(bytes.len() as u64) {
            self.belt.write_buffer(self.encoder, buffer, 0, size).copy_from_slice(bytes);
        }
    }
}

/// Bind group layouts and the frame's uniform.
pub(super) struct SharedBindings {
    pipeline_layout: wgpu::PipelineLayout,
    list_layout: wgpu::BindGroupLayout,
    frame: wgpu::Buffer,
    pub(super) frame_group: wgpu::BindGroup,
    pub(super) quality: Quality,
}

/// The default entry points of the vertex and the fragment stage.
pub(super) const ENTRIES: [&str; 2] = ["vertex", "fragment"];

/// The parameters in which pipelines differ.
pub(super) struct Recipe<'a> {
    pub(super) label: &'a str,
    pub(super) module: &'a wgpu::ShaderModule,
    /// Entry points of the vertex and the fragment stage.
    pub(super) entries: [&'a str; 2],
    /// Values of the shader's override constants.
    pub(super) constants: &'a [(&'a str, f64)],
    pub(super) vertices: Option<wgpu::VertexBufferLayout<'a>>,
    pub(super) topology: wgpu::PrimitiveTopology,
    pub(super) cull: Option<wgpu::Face>,
    pub(super) depth_write: bool,
    pub(super) depth_compare: wgpu::CompareFunction,
    /// `None` writes depth only.
    pub(super) blend: Option<wgpu::BlendState>,
}

impl<'a> Recipe<'a> {
    /// Returns the recipe for one quad per instance. The vertex shader computes its corners, and depth is not written.
    pub(super) fn quads(
        label: &'a str,
        module: &'a wgpu::ShaderModule,
        depth_compare: wgpu::CompareFunction,
        blend: wgpu::BlendState,
    ) -> Self {
        Self {
            label,
            module,
            entries: ENTRIES,
            constants: &[],
            vertices: None,
            topology: wgpu::PrimitiveTopology::TriangleStrip,
            cull: None,
            depth_write: false,
            depth_compare,
            blend: Some(blend),
        }
    }
}

impl SharedBindings {
    pub(super) fn new(device: &wgpu::Device, quality: Quality) -> Self {
        let layout = |label, visibility, ty| {
            device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                label: Some(label),
                entries: &[wgpu::BindGroupLayoutEntry {
                    binding: 0,
                    visibility,
                    ty: wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None },
                    count: None,
                }],
            })
        };
        let frame_layout = layout("frame", wgpu::ShaderStages::VERTEX_FRAGMENT, wgpu::BufferBindingType::Uniform);
        let list_layout =
            layout("list", wgpu::ShaderStages::VERTEX, wgpu::BufferBindingType::Storage { read_only: true });
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("frame and list"),
            bind_group_layouts: &[Some(&frame_layout), Some(&list_layout)],
            immediate_size: 0,
        });
        let frame = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("frame"),
            size: size_of::<Frame>() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let frame_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("frame"),
            layout: &frame_layout,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: frame.as_entire_binding() }],
        });
        Self { pipeline_layout, list_layout, frame, frame_group, quality }
    }

    pub(super) fn write_frame(&self, upload: &mut Upload, view: &View, background: Rgba) {
        let View { clip_from_world, eye_direction, size_px: [width, height], pixels_per_point } = *view;
        let size_px = [width as f32, height as f32];
        let frame = Frame { clip_from_world, eye_direction, pixels_per_point, size_px, background, ..Frame::zeroed() };
        upload.write(&self.frame, bytemuck::bytes_of(&frame));
    }

    /// Returns a function that builds pipelines; it does not borrow from `self`.
    pub(super) fn pipelines(&self) -> impl Fn(&wgpu::Device, Recipe) -> wgpu::RenderPipeline + Send + Sync + 'static {
        let (layout, samples) = (self.pipeline_layout.clone(), self.quality.samples());
        move |device, recipe| {
            let Recipe {
                label,
                module,
                entries: [vertex, fragment],
                constants,
                vertices,
                topology,
                cull,
                depth_write,
                depth_compare,
                blend,
            } = recipe;
            device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some(label),
                layout: Some(&layout),
                vertex: wgpu::VertexState {
                    module,
                    entry_point: Some(vertex),
                    compilation_options: wgpu::PipelineCompilationOptions { constants, ..Default::default() },
                    buffers: if vertices.is_some() { std::slice::from_ref(&vertices) } else { &[] },
                },
                primitive: wgpu::PrimitiveState { topology, cull_mode: cull, ..Default::default() },
                depth_stencil: Some(wgpu::DepthStencilState {
                    format: DEPTH,
                    depth_write_enabled: Some(depth_write),
                    depth_compare: Some(depth_compare),
                    stencil: Default::default(),
                    bias: Default::default(),
                }),
                multisample: wgpu::MultisampleState { count: samples, ..Default::default() },
                fragment: Some(wgpu::FragmentState {
                    module,
                    entry_point: Some(fragment),
                    compilation_options: Default::default(),
                    targets: &[Some(wgpu::ColorTargetState {
                        format: COLOUR,
                        blend,
                        write_mask: if blend.is_some() { wgpu::ColorWrites::ALL } else { wgpu::ColorWrites::empty() },
                    })],
                }),
                multiview_mask: None,
                cache: None,
            })
        }
    }
}

/// A list of `T` that a shader reads by instance: group 1, binding 0. The GPU buffer grows and never shrinks.
pub(super) struct List<T> {
    pub(super) items: Vec<T>,
    label: &'static str,
    buffer: wgpu::Buffer,
    pub(super) group: wgpu::BindGroup,
}

impl<T: Pod> List<T> {
    pub(super) fn new(device: &wgpu::Device, kit: &SharedBindings, label: &'static str) -> Self {
        let (buffer, group) = Self::room(device, kit, label, 16);
        Self { items: Vec::new(), label, buffer, group }
    }

    fn room(device: &wgpu::Device, kit: &SharedBindings, label: &str, count: usize) -> (wgpu::Buffer, wgpu::BindGroup) {
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size: (count * size_of::<T>()) as u64,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(label),
            layout: &kit.list_layout,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: buffer.as_entire_binding() }],
        });
        (buffer, group)
    }

    /// Copies the items to the GPU; items beyond the largest binding of the device are dropped.
    pub(super) fn upload(&mut self, kit: &SharedBindings, upload: &mut Upload) {
        let most = upload.device.limits().max_storage_buffer_binding_size as usize / size_of::<T>();
        self.items.truncate(most);
        if (self.buffer.size() as usize) < size_of_val(self.items.as_slice()) {
            let count = self.items.len().next_power_of_two().min(most);
            (self.buffer, self.group) = Self::room(upload.device, kit, self.label, count);
        }
        upload.write(&self.buffer, bytemuck::cast_slice(&self.items));
    }
}
