//! Draws the output of egui: its triangles, and the scenes between them.

use std::collections::HashMap;
use std::ops::Range;

use egui::epaint::{ClippedPrimitive, ImageData, ImageDelta, PaintCallbackInfo, Primitive, Vertex};
use egui::{Color32, Rect, TextureFilter, TextureId, TextureOptions, TextureWrapMode, TexturesDelta};

use super::paint::{PaintedScene, Renderers};
use super::render::SharedLayout;
use super::render::shader::{Shader, embedded, twin};

twin! {
    /// Width and height of the surface, logical points.
    struct Screen {
        size: [f32; 2],
    }
}

/// Memory layouts of the structs of this file that Rust and WGSL share.
pub const TWINS: [SharedLayout; 1] = [Screen::TWIN];

/// The surface that the interface is drawn on.
#[derive(Clone, Copy, Debug)]
pub struct RenderTarget<'a> {
    /// View of the target texture, in the format of the renderer.
    pub view: &'a wgpu::TextureView,
    /// Width and height, physical pixels.
    pub size_px: [u32; 2],
    /// Physical pixels per logical point.
    pub pixels_per_point: f32,
    /// Background colour.
    pub behind: Color32,
}

/// Pipelines and buffers that draw the output of egui.
///
/// The shader multiplies one texel by the vertex colour. In software rendering this takes a fraction of the time of
/// egui's own shader, which filters textures in shader code.
pub struct GuiRenderer {
    device: wgpu::Device,
    queue: wgpu::Queue,
    format: wgpu::TextureFormat,
    shader: Shader<wgpu::RenderPipeline>,
    image_layout: wgpu::BindGroupLayout,
    screen: wgpu::Buffer,
    screen_group: wgpu::BindGroup,
    samplers: HashMap<TextureOptions, wgpu::Sampler>,
    images: HashMap<TextureId, Image>,
    vertices: Memory<Vertex>,
    indices: Memory<u32>,
    /// Index range and first vertex of each mesh of the pass, in order.
    meshes: Vec<(Range<u32>, i32)>,
    scenes: Renderers,
}

struct Image {
    texture: wgpu::Texture,
    options: TextureOptions,
    group: wgpu::BindGroup,
}

/// A GPU buffer that grows, and the items to be copied into it.
struct Memory<T> {
    label: &'static str,
    usage: wgpu::BufferUsages,
    buffer: Option<wgpu::Buffer>,
    list: Vec<T>,
}

impl<T: bytemuck::NoUninit> Memory<T> {
    fn new(label: &'static str, usage: wgpu::BufferUsages) -> Self {
        Self { label, usage: usage | wgpu::BufferUsages::COPY_DST, buffer: None, list: Vec::new() }
    }

    /// Copies the list to the GPU and returns the buffer; `None` if the list is empty.
    fn send(&mut self, device: &wgpu::Device, queue: &wgpu::Queue) -> Option<&wgpu::Buffer> {
        let bytes: &[u8] = bytemuck::cast_slice(&self.list);
        let size = bytes.len() as u64;
        if size == 0 {
            return None;
        }
        let fits = self.buffer.take_if(|buffer| buffer.size() >= size);
        let (label, usage) = (Some(self.label), self.usage);
        let roomy =
            || wgpu::BufferDescriptor { label, usage, size: size.next_power_of_two(), mapped_at_creation: false };
        let buffer = self.buffer.insert(fits.unwrap_or_else(|| device.create_buffer(&roomy())));
        queue.write_buffer(buffer, 0, bytes);
        Some(buffer)
    }
}

impl GuiRenderer {
    /// Creates a renderer for surfaces of the given format.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue, format: wgpu::TextureFormat) -> Self {
        let layout = |label, entries: &[wgpu::BindGroupLayoutEntry]| {
            device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(label), entries })
        };
        let entry = |binding, visibility, ty| wgpu::BindGroupLayoutEntry { binding, visibility, ty, count: None };
        let uniform = wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: wgpu::BufferSize::new(Screen::TWIN.size as u64),
        };
        let picture = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: true },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
        let (vertex, fragment) = (wgpu::ShaderStages::VERTEX, wgpu::ShaderStages::FRAGMENT);
        let screen_layout = layout("gui screen", &[entry(0, vertex, uniform)]);
        let image_layout = layout("gui image", &[entry(0, fragment, picture), entry(1, fragment, sampler)]);
        let screen = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("gui screen"),
            size: Screen::TWIN.size as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let screen_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("gui screen"),
            layout: &screen_layout,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: screen.as_entire_binding() }],
        });
        let layouts = [Some(&screen_layout), Some(&image_layout)];
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("gui"),
            bind_group_layouts: &layouts,
            immediate_size: 0,
        });
        let build = move |device: &wgpu::Device, module: &wgpu::ShaderModule| {
            pipeline(device, module, &pipeline_layout, format)
        };
        Self {
            device: device.clone(),
            queue: queue.clone(),
            format,
            shader: Shader::new(device, embedded!("gui"), Box::new(build)),
            image_layout,
            screen,
            screen_group,
            samplers: HashMap::new(),
            images: HashMap::new(),
            vertices: Memory::new("gui vertices", wgpu::BufferUsages::VERTEX),
            indices: Memory::new("gui indices", wgpu::BufferUsages::INDEX),
            meshes: Vec::new(),
            scenes: Renderers::new(device, format),
        }
    }

    /// Applies the changes of egui's textures, draws its shapes on the whole surface, and submits the commands.
    pub fn draw(&mut self, sheet: &RenderTarget, textures: &mut TexturesDelta, shapes: &[ClippedPrimitive]) {
        self.shader.reload(&self.device);
        for (id, deltas) in textures.set.drain() {
            deltas.iter().for_each(|delta| self.update(id, delta));
        }
        let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        self.gather(shapes);
        for paint in shapes.iter().filter_map(scene) {
            self.scenes.prepare(&self.queue, &mut encoder, paint);
        }
        let [width, height] = sheet.size_px.map(|n| n as f32 / sheet.pixels_per_point);
        let screen = Screen { size: [width, height] };
        self.queue.write_buffer(&self.screen, 0, bytemuck::bytes_of(&screen));
        let (device, queue) = (&self.device, &self.queue);
        let lists = self.vertices.send(device, queue).zip(self.indices.send(device, queue));
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("gui"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: sheet.view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(clear_colour(sheet.behind, self.format)),
                    store: wgpu::StoreOp::Store,
                },
            })],
            ..Default::default()
        });
        let mut meshes = self.meshes.iter();
        // Whether viewport, pipeline and buffers of the pass are set for meshes.
        let mut is_ready = false;
        for shape in shapes {
            let clip = pixels(shape.clip_rect, sheet);
            match &shape.primitive {
                Primitive::Mesh(mesh) => {
                    let (Some((range, first)), Some((vertices, indices))) = (meshes.next(), lists) else { continue };
                    let (Some([x, y, w, h]), Some(image)) = (clip, self.images.get(&mesh.texture_id)) else { continue };
                    if !is_ready {
                        let [width, height] = sheet.size_px.map(|n| n as f32);
                        pass.set_viewport(0.0, 0.0, width, height, 0.0, 1.0);
                        pass.set_pipeline(&self.shader);
                        pass.set_bind_group(0, &self.screen_group, &[]);
                        pass.set_vertex_buffer(0, vertices.slice(..));
                        pass.set_index_buffer(indices.slice(..), wgpu::IndexFormat::Uint32);
                        is_ready = true;
                    }
                    pass.set_scissor_rect(x, y, w, h);
                    pass.set_bind_group(1, &image.group, &[]);
                    pass.draw_indexed(range.clone(), *first, 0..1);
                }
                Primitive::Callback(callback) => {
                    let Some(([x, y, w, h], paint)) = clip.zip(scene(shape)) else { continue };
                    let info = PaintCallbackInfo {
                        viewport: callback.rect,
                        clip_rect: shape.clip_rect,
                        pixels_per_point: sheet.pixels_per_point,
                        screen_size_px: sheet.size_px,
                    };
                    let to = info.viewport_in_pixels();
                    if to.width_px > 0 && to.height_px > 0 {
                        let [left, top, width, height] =
                            [to.left_px, to.top_px, to.width_px, to.height_px].map(|n| n as f32);
                        pass.set_viewport(left, top, width, height, 0.0, 1.0);
                        pass.set_scissor_rect(x, y, w, h);
                        self.scenes.paint(&mut pass, paint);
                        is_ready = false;
                    }
                }
            }
        }
        drop(pass);
        self.queue.submit([encoder.finish()]);
        for id in textures.free.drain() {
            self.images.remove(&id);
        }
    }

    /// Concatenates the triangles of all meshes.
    fn gather(&mut self, shapes: &[ClippedPrimitive]) {
        let (vertices, indices) = (&mut self.vertices.list, &mut self.indices.list);
        vertices.clear();
        indices.clear();
        self.meshes.clear();
        for shape in shapes {
            if let Primitive::Mesh(mesh) = &shape.primitive {
                let (begin, first) = (indices.len() as u32, vertices.len() as i32);
                vertices.extend_from_slice(&mesh.vertices);
                indices.extend_from_slice(&mesh.indices);
                self.meshes.push((begin..indices.len() as u32, first));
            }
        }
    }

    /// Creates a texture, or writes the changed part of a texture.
    fn update(&mut self, id: TextureId, delta: &ImageDelta) {
        let ImageData::Color(image) = &delta.image;
        let [width, height] = image.size.map(|n| n as u32);
        let size = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
        let is_whole = delta.pos.is_none();
        if is_whole || self.images.get(&id).is_some_and(|image| image.options != delta.options) {
            let there = self.images.remove(&id).filter(|_| !is_whole).map(|image| image.texture);
            let texture = there.unwrap_or_else(|| {
                self.device.create_texture(&wgpu::TextureDescriptor {
                    label: Some("gui image"),
                    size,
                    mip_level_count: 1,
                    sample_count: 1,
                    dimension: wgpu::TextureDimension::D2,
                    // Not an sRGB format: values are sampled without conversion.
                    format: wgpu::TextureFormat::Rgba8Unorm,
                    usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
                    view_formats: &[],
                })
            });
            let group = self.group(&texture, delta.options);
            self.images.insert(id, Image { texture, options: delta.options, group });
        }
        // A partial update of an unknown texture is ignored.
        let Some(Image { texture, .. }) = self.images.get(&id) else { return };
        let [x, y] = delta.pos.unwrap_or_default().map(|n| n as u32);
        self.queue.write_texture(
            wgpu::TexelCopyTextureInfo {
                texture,
                mip_level: 0,
                origin: wgpu::Origin3d { x, y, z: 0 },
                aspect: wgpu::TextureAspect::All,
            },
            bytemuck::cast_slice(&image.pixels),
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * width), rows_per_image: Some(height) },
            size,
        );
    }

    fn group(&mut self, texture: &wgpu::Texture, options: TextureOptions) -> wgpu::BindGroup {
        let sampler = self.samplers.entry(options).or_insert_with(|| self.device.create_sampler(&sampler(options)));
        self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("gui image"),
            layout: &self.image_layout,
            entries: &[
                wgpu::BindGroupEntry {
                    binding: 0,
                    resource: wgpu::BindingResource::TextureView(&texture.create_view(&Default::default())),
                },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::Sampler(sampler) },
            ],
        })
    }
}

/// Returns the scene of a shape that is a paint callback; `None` for meshes.
fn scene(shape: &ClippedPrimitive) -> Option<&PaintedScene> {
    match &shape.primitive {
        Primitive::Callback(callback) => callback.callback.downcast_ref(),
        Primitive::Mesh(_) => None,
    }
}

/// Returns the pixels of a surface that a rectangle in points covers: left, top, width, height; `None` if it is empty.
fn pixels(rect: Rect, sheet: &RenderTarget) -> Option<[u32; 4]> {
    let [width, height] = sheet.size_px;
    let at = |x: f32, most: u32| (x * sheet.pixels_per_point).round().clamp(0.0, most as f32) as u32;
    let (left, right) = (at(rect.min.x, width), at(rect.max.x, width));
    let (top, bottom) = (at(rect.min.y, height), at(rect.max.y, height));
    (left < right && top < bottom).then(|| [left, top, right - left, bottom - top])
}

/// Returns the clear value of a colour for a target of the given format.
fn clear_colour(colour: Color32, format: wgpu::TextureFormat) -> wgpu::Color {
    let parts = match format.is_srgb() {
        true => egui::Rgba::from(colour).to_array(),
        false => colour.to_normalized_gamma_f32(),
    };
    let [r, g, b, a] = parts.map(f64::from);
    wgpu::Color { r, g, b, a }
}

fn sampler(options: TextureOptions) -> wgpu::SamplerDescriptor<'static> {
    let filter = |filter| match filter {
        TextureFilter::Nearest => wgpu::FilterMode::Nearest,
        TextureFilter::Linear => wgpu::FilterMode::Linear,
    };
    let mode = match options.wrap_mode {
        TextureWrapMode::ClampToEdge => wgpu::AddressMode::ClampToEdge,
        TextureWrapMode::Repeat => wgpu::AddressMode::Repeat,
        TextureWrapMode::MirroredRepeat => wgpu::AddressMode::MirrorRepeat,
    };
    wgpu::SamplerDescriptor {
        label: Some("gui image"),
        mag_filter: filter(options.magnification),
        min_filter: filter(options.minification),
        address_mode_u: mode,
        address_mode_v: mode,
        ..Default::default()
    }
}

fn pipeline(
    device: &wgpu::Device,
    module: &wgpu::ShaderModule,
    layout: &wgpu::PipelineLayout,
    format: wgpu::TextureFormat,
) -> wgpu::RenderPipeline {
    // Colours are blended over the colours behind them; the alpha of the surface never decreases.
    let blend = wgpu::BlendState {
        color: wgpu::BlendComponent::OVER,
        alpha: wgpu::BlendComponent {
            src_factor: wgpu::BlendFactor::OneMinusDstAlpha,
            dst_factor: wgpu::BlendFactor::One,
            operation: wgpu::BlendOperation::Add,
        },
    };
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("gui"),
        layout: Some(layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("vertex"),
            compilation_options: Default::default(),
            buffers: &[Some(wgpu::VertexBufferLayout {
                array_stride: size_of::<Vertex>() as u64,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &wgpu::vertex_attr_array![0 => Float32x2, 1 => Float32x2, 2 => Unorm8x4],
            })],
        },
        primitive: Default::default(),
        depth_stencil: None,
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some(if format.is_srgb() { "encoding" } else { "plain" }),
            compilation_options: Default::default(),
            targets: &[Some(wgpu::ColorTargetState { format, blend: Some(blend), write_mask: wgpu::ColorWrites::ALL })],
        }),
        multiview_mask: None,
        cache: None,
    })
}
