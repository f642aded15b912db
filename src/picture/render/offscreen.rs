//! Rendering without a window.

use std::io;

use super::{Renderer, View};
use crate::scene::Scene;

/// Reasons why no GPU adapter can be used.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoAdapter {
    /// No driver offers a GPU or a software adapter.
    #[error(
        "no GPU adapter found; one in software is enough and comes, on Debian and its kin, with `apt-get install \
         mesa-vulkan-drivers` ({0})"
    )]
    Missing(String),
    /// There is an adapter, but it lacks a required feature.
    #[error(
        "GPU adapter {name} cannot be used: {why}; a software one comes with `apt-get install mesa-vulkan-drivers`"
    )]
    Unfit {
        /// Name of the adapter.
        name: String,
        /// Message of the failed device request.
        why: String,
    },
}

/// Reasons why a picture cannot be made.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoPicture {
    /// A side is 0 pixels, or longer than the largest texture.
    #[error("a picture of {width} x {height} pixels cannot be drawn: sides run from 1 to {most}")]
    Size {
        /// Requested width.
        width: u32,
        /// Requested height.
        height: u32,
        /// Longest possible side.
        most: u32,
    },
    /// Format other than 8-bit RGBA or BGRA.
    #[error("pixels of format {0} cannot be read back: Rgba8Unorm or Bgra8Unorm is expected")]
    Format(String),
    /// The device was lost, or the pixels could not be mapped.
    #[error("the GPU was lost while a picture was read back: {0}")]
    Lost(String),
}

/// Pixels in rows from the top: red, green, blue and straight alpha, sRGB.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Pixels per row.
    pub width: u32,
    /// Number of rows.
    pub height: u32,
    /// `4 · width · height` bytes.
    pub rgba: Vec<u8>,
}

impl Picture {
    /// Red, green, blue and alpha at column `x` of row `y`, both counted from 0 at the top left.
    pub fn pixel(&self, x: u32, y: u32) -> Option<[u8; 4]> {
        let at = 4 * (y as usize * self.width as usize + x as usize);
        let pixel = self.rgba.get(at..at + 4).filter(|_| x < self.width)?;
        pixel.try_into().ok()
    }

    /// Encodes as PNG. Fails if `rgba` does not have `4 · width · height` bytes or the picture is empty.
    pub fn to_png(&self) -> io::Result<Vec<u8>> {
        let mut bytes = Vec::new();
        self.encode(&mut bytes)?;
        Ok(bytes)
    }

    /// Decodes a PNG file of 8-bit RGBA; `None` for any other file.
    pub fn from_png(file: &[u8]) -> Option<Self> {
        let mut reader = png::Decoder::new(io::Cursor::new(file)).read_info().ok()?;
        let mut rgba = vec![0; reader.output_buffer_size()?];
        let info = reader.next_frame(&mut rgba).ok()?;
        let is_rgba = (info.color_type, info.bit_depth) == (png::ColorType::Rgba, png::BitDepth::Eight);
        is_rgba.then_some(Self { width: info.width, height: info.height, rgba })
    }

    /// Returns width and height of a PNG file, pixels, from its head; `None` if it is no PNG file.
    pub fn size_of_png(file: &[u8]) -> Option<[u32; 2]> {
        let reader = png::Decoder::new(io::Cursor::new(file)).read_info().ok()?;
        Some([reader.info().width, reader.info().height])
    }

    /// Returns the picture at half the size: each pixel is the mean of four. An odd row or column at the end is left out.
    pub fn halved(&self) -> Self {
        let [width, height] = [self.width / 2, self.height / 2];
        let row = 4 * self.width as usize;
        let mean = |i: usize| {
            let (y, x) = (i / (4 * width as usize), i % (4 * width as usize));
            let at = 2 * y * row + 8 * (x / 4) + x % 4;
            let sum: u16 = [at, at + 4, at + row, at + row + 4].iter().map(|i| u16::from(self.rgba[*i])).sum();
            ((sum + 2) / 4) as u8
        };
        Self { width, height, rgba: (0..4 * width as usize * height as usize).map(mean).collect() }
    }

    fn encode(&self, to: &mut Vec<u8>) -> Result<(), png::EncodingError> {
        let mut writer = png_encoder(to, [self.width, self.height]).write_header()?;
        writer.write_image_data(&self.rgba)?;
        writer.finish()
    }
}

/// Returns a PNG encoder for pictures of this size in pixels.
pub(crate) fn png_encoder<'a, W: io::Write>(to: W, [width, height]: [u32; 2]) -> png::Encoder<'a, W> {
    let mut encoder = png::Encoder::new(to, width, height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::RelativeColorimetric);
    encoder
}

/// Returns the scale, pixels per point, at which a picture of this height in pixels is 800 points high.
/// It is at least 0.5, so that labels are legible.
pub fn legible_scale(height: u32) -> f32 {
    (height as f32 / 800.0).max(0.5)
}

/// Creates a texture, size in pixels, that can be drawn on and read back.
pub fn surface(device: &wgpu::Device, [width, height]: [u32; 2], format: wgpu::TextureFormat) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("canvas"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    })
}

/// A GPU device without a window, and a renderer on it.
pub struct Gpu {
    adapter: wgpu::Adapter,
    device: wgpu::Device,
    queue: wgpu::Queue,
    renderer: Renderer,
    /// Buffer through which textures are read back; it grows.
    staging: Option<wgpu::Buffer>,
}

impl Gpu {
    /// Opens the adapter that the system prefers.
    pub fn new() -> Result<Self, NoAdapter> {
        // Only Vulkan, Metal and DirectX 12 are used. Tests compare pictures byte by byte, and a fallback would draw
        // slightly differently.
        let backends = wgpu::Backends::PRIMARY;
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
            backends,
            ..wgpu::InstanceDescriptor::new_without_display_handle()
        });
        let adapter = pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()))
            .map_err(|error| NoAdapter::Missing(error.to_string()))?;
        let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default()))
            .map_err(|error| NoAdapter::Unfit { name: adapter.get_info().name, why: error.to_string() })?;
        let renderer = Renderer::new(&device, wgpu::TextureFormat::Rgba8Unorm);
        Ok(Self { adapter, device, queue, renderer, staging: None })
    }

    /// Returns the name of the adapter.
    pub fn name(&self) -> String {
        self.adapter.get_info().name
    }

    /// The adapter.
    pub fn adapter(&self) -> &wgpu::Adapter {
        &self.adapter
    }

    /// The device, for drawing other than that of scenes.
    pub fn device(&self) -> &wgpu::Device {
        &self.device
    }

    /// The device's queue.
    pub fn queue(&self) -> &wgpu::Queue {
        &self.queue
    }

    /// Draws a scene and waits for its pixels.
    pub fn picture(&mut self, scene: &Scene, view: &View) -> Result<Picture, NoPicture> {
        let ([width, height], most) = (view.size_px, self.device.limits().max_texture_dimension_2d);
        if width.min(height) == 0 || width.max(height) > most {
            return Err(NoPicture::Size { width, height, most });
        }
        let mut encoder = self.device.create_command_encoder(&Default::default());
        self.renderer.prepare(&self.device, &self.queue, &mut encoder, scene, view);
        self.queue.submit([encoder.finish()]);
        let texture = self.renderer.picture().cloned();
        // The size is valid, so prepare has made a target.
        texture.map_or(Err(NoPicture::Size { width, height, most }), |texture| self.readback(&texture))
    }

    /// Reads back a texture with usage `COPY_SRC`, four bytes per pixel and premultiplied alpha.
    pub fn readback(&mut self, texture: &wgpu::Texture) -> Result<Picture, NoPicture> {
        use wgpu::TextureFormat::{Bgra8Unorm, Bgra8UnormSrgb, Rgba8Unorm, Rgba8UnormSrgb};
        let swap = match texture.format() {
            Rgba8Unorm | Rgba8UnormSrgb => false,
            Bgra8Unorm | Bgra8UnormSrgb => true,
            other => return Err(NoPicture::Format(format!("{other:?}"))),
        };
        let (width, height) = (texture.width(), texture.height());
        let row = 4 * width as usize;
        let stride = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT as usize);
        let size = stride as u64 * u64::from(height);
        let staging = match self.staging.take() {
            Some(buffer) if buffer.size() >= size => buffer,
            _ => self.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("readback"),
                size,
                usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            }),
        };
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let layout =
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(stride as u32), rows_per_image: None };
        encoder.copy_texture_to_buffer(
            texture.as_image_copy(),
            wgpu::TexelCopyBufferInfo { buffer: &staging, layout },
            wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        );
        self.queue.submit([encoder.finish()]);

        let lost = |error: &dyn std::fmt::Display| NoPicture::Lost(error.to_string());
        let (mapped, outcome) = std::sync::mpsc::channel();
        staging.map_async(wgpu::MapMode::Read, ..size, move |result| _ = mapped.send(result));
        self.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|error| lost(&error))?;
        match outcome.try_recv() {
            Ok(result) => result.map_err(|error| lost(&error))?,
            Err(error) => return Err(lost(&error)),
        }
        let mut rgba = Vec::with_capacity(row * height as usize);
        {
            let bytes = staging.get_mapped_range(..size).map_err(|error| lost(&error))?;
            bytes.chunks_exact(stride).for_each(|line| rgba.extend_from_slice(&line[..row]));
        }
        staging.unmap();
        self.staging = Some(staging);

        for pixel in rgba.as_chunks_mut::<4>().0 {
            if swap {
                pixel.swap(0, 2);
            }
            let alpha = u16::from(pixel[3]);
            if alpha != 0 && alpha != 255 {
                let straight = |c: u8| ((u16::from(c) * 255 + alpha / 2) / alpha).min(255) as u8;
                *pixel = [straight(pixel[0]), straight(pixel[1]), straight(pixel[2]), pixel[3]];
            }
        }
        Ok(Picture { width, height, rgba })
    }
}
