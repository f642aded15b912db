//! The textures that a scene is drawn into, and the copy of that picture to the target of a window or figure.

use super::kit::{COLOUR, DEPTH};
use super::shader::{Shader, embedded};

/// Multisampled colour and depth, the picture they resolve to, and the picture's bind group.
pub(super) struct Framebuffer {
    pub(super) size_px: [u32; 2],
    /// Multisampled colour; `None` with one sample per pixel.
    pub(super) samples: Option<wgpu::TextureView>,
    pub(super) depth: wgpu::TextureView,
    pub(super) picture: wgpu::Texture,
    pub(super) picture_view: wgpu::TextureView,
    group: wgpu::BindGroup,
}

pub(super) struct Blit {
    shader: Shader<wgpu::RenderPipeline>,
    layout: wgpu::BindGroupLayout,
    sampler: wgpu::Sampler,
}

impl Blit {
    /// Creates the copy pipeline; `format` is the format of the target pass, which has one sample and no depth.
    pub(super) fn new(device: &wgpu::Device, format: wgpu::TextureFormat) -> Self {
        let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty,
            count: None,
        };
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("blit"),
            entries: &[
                entry(
                    0,
                    wgpu::BindingType::Texture {
                        sample_type: wgpu::TextureSampleType::Float { filterable: true },
                        view_dimension: wgpu::TextureViewDimension::D2,
                        multisampled: false,
                    },
                ),
                entry(1, wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering)),
            ],
        });
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("blit"),
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        let entry_point = if format.is_srgb() { "encoding" } else { "plain" };
        let build = move |device: &wgpu::Device, module: &wgpu::ShaderModule| {
            let blend = Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING);
            device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some("blit"),
                layout: Some(&pipeline_layout),
                vertex: wgpu::VertexState {
                    module,
                    entry_point: Some("vertex"),
                    compilation_options: Default::default(),
                    buffers: &[],
                },
                primitive: Default::default(),
                depth_stencil: None,
                multisample: Default::default(),
                fragment: Some(wgpu::FragmentState {
                    module,
                    entry_point: Some(entry_point),
                    compilation_options: Default::default(),
                    targets: &[Some(wgpu::ColorTargetState { format, blend, write_mask: wgpu::ColorWrites::ALL })],
                }),
                multiview_mask: None,
                cache: None,
            })
        };
        Self {
            shader: Shader::new(device, embedded!("blit"), Box::new(build)),
            layout,
            sampler: device.create_sampler(&wgpu::SamplerDescriptor::default()),
        }
    }

    pub(super) fn reload(&mut self, device: &wgpu::Device) {
        self.shader.reload(device);
    }

    pub(super) fn target(&self, device: &wgpu::Device, size_px: [u32; 2], samples: u32) -> Framebuffer {
        let [width, height] = size_px;
        let texture = |label, format, sample_count, usage| {
            device.create_texture(&wgpu::TextureDescriptor {
                label: Some(label),
                size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | usage,
                view_formats: &[],
            })
        };
        let only_here = wgpu::TextureUsages::empty();
        let depth = texture("scene depth", DEPTH, samples, only_here).create_view(&Default::default());
        let several = || texture("scene samples", COLOUR, samples, only_here).create_view(&Default::default());
        let samples = (samples > 1).then(several);
        let read = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_SRC;
        let picture = texture("scene", COLOUR, 1, read);
        let picture_view = picture.create_view(&Default::default());
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("blit"),
            layout: &self.layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(&picture_view) },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::Sampler(&self.sampler) },
            ],
        });
        Framebuffer { size_px, samples, depth, picture, picture_view, group }
    }

    pub(super) fn paint(&self, pass: &mut wgpu::RenderPass, target: &Framebuffer) {
        pass.set_pipeline(&self.shader);
        pass.set_bind_group(0, &target.group, &[]);
        pass.draw(0..3, 0..1);
    }
}
