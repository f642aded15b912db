//! [`Screen`]: the graphics device of all windows, and the [`Canvas`] of each.

use std::num::NonZeroU32;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use egui::TexturesDelta;
use egui::epaint::{ClippedPrimitive, ImageDelta, TextureAtlas};
use winit::event_loop::OwnedDisplayHandle;
use winit::window::Window;

use stillbase_picture::gui::{GuiRenderer, RenderTarget};
use stillbase_picture::render::offscreen::NoAdapter;

/// The device that draws on the windows. It may be lost at any time, with the card, its driver or a remote display.
pub struct Screen {
    instance: wgpu::Instance,
    adapter: wgpu::Adapter,
    device: wgpu::Device,
    queue: wgpu::Queue,
    /// Format of every canvas.
    format: wgpu::TextureFormat,
    gui: GuiRenderer,
    is_software: bool,
    lost: Arc<AtomicBool>,
    /// Pending changes of egui's textures.
    textures: TexturesDelta,
}

/// The surface of a window.
pub struct Canvas {
    surface: wgpu::Surface<'static>,
    config: wgpu::SurfaceConfiguration,
}

/// What a picture is drawn from.
pub struct Drawing<'a> {
    /// Shapes of egui as triangles.
    pub shapes: &'a [ClippedPrimitive],
    /// Pixels per point.
    pub pixels_per_point: f32,
    /// Colour behind them.
    pub behind: egui::Color32,
}

/// Outcome of drawing a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PaintOutcome {
    /// The picture was presented, or the window is hidden.
    Done,
    /// The picture was not presented, for example because the surface has changed: draw again.
    Again,
}

impl Screen {
    /// Creates the device for a window, and the window's canvas; `changed` is called from any thread when the device is
    /// lost.
    ///
    /// # Errors
    /// If no adapter can draw in the window.
    pub fn new(
        window: &Arc<Window>,
        display: OwnedDisplayHandle,
        changed: impl Fn() + Send + Sync + 'static,
    ) -> Result<(Self, Canvas), NoAdapter> {
        // The environment may choose the driver, as for any program that draws with wgpu.
        let instance = wgpu::Instance::new(
            wgpu::InstanceDescriptor {
                backends: wgpu::Backends::PRIMARY,
                ..wgpu::InstanceDescriptor::new_with_display_handle(Box::new(display))
            }
            .with_env(),
        );
        let missing = |why: String| NoAdapter::Missing(why);
        let surface = instance.create_surface(window.clone()).map_err(|why| missing(why.to_string()))?;
        let asked = wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            compatible_surface: Some(&surface),
            ..Default::default()
        };
        let adapter = pollster::block_on(instance.request_adapter(&asked)).map_err(|why| missing(why.to_string()))?;
        let info = adapter.get_info();
        let unfit = |why: String| NoAdapter::Unfit { name: info.name.clone(), why };
        // The adapter's largest textures are allowed: windows may grow.
        let required_limits = wgpu::Limits::default().using_resolution(adapter.limits());
        let asked = wgpu::DeviceDescriptor { required_limits, ..Default::default() };
        let (device, queue) =
            pollster::block_on(adapter.request_device(&asked)).map_err(|why| unfit(why.to_string()))?;

        let lost = Arc::new(AtomicBool::new(false));
        let tells = lost.clone();
        device.set_device_lost_callback(move |_, _| {
            tells.store(true, Ordering::Release);
            changed();
        });
        let knows = lost.clone();
        // Requests to a lost device fail in many ways, all of them irrelevant.
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            assert!(knows.load(Ordering::Acquire), "wgpu error: {error}");
        }));

        let usual = usual_config(&surface, &adapter, window);
        let config = usual.ok_or_else(|| unfit("it cannot draw in this window".into()))?;
        // Colours are blended as sRGB values: a format without conversion is preferred.
        let plain = |format: &wgpu::TextureFormat| {
            matches!(format, wgpu::TextureFormat::Rgba8Unorm | wgpu::TextureFormat::Bgra8Unorm)
        };
        let format = surface.get_capabilities(&adapter).formats.into_iter().find(plain).unwrap_or(config.format);
        let present_mode = wgpu::PresentMode::AutoVsync;
        let config = wgpu::SurfaceConfiguration { format, present_mode, ..config };
        surface.configure(&device, &config);
        let gui = GuiRenderer::new(&device, &queue, format);
        let is_software = info.device_type == wgpu::DeviceType::Cpu;
        let textures = TexturesDelta::default();
        let screen = Self { instance, adapter, device, queue, format, gui, is_software, lost, textures };
        Ok((screen, Canvas { surface, config }))
    }

    /// Creates the canvas of a further window. It never waits for the monitor, as the first one does: the windows are
    /// drawn one after the other.
    ///
    /// # Errors
    /// If the device cannot draw in the window.
    pub fn canvas(&self, window: &Arc<Window>) -> Result<Canvas, NoAdapter> {
        let unfit = |why: String| NoAdapter::Unfit { name: self.adapter.get_info().name, why };
        let surface = self.instance.create_surface(window.clone()).map_err(|why| unfit(why.to_string()))?;
        let can = surface.get_capabilities(&self.adapter);
        let usual = usual_config(&surface, &self.adapter, window).filter(|_| can.formats.contains(&self.format));
        let config = usual.ok_or_else(|| unfit("it cannot draw in a further window".into()))?;
        let modes = [wgpu::PresentMode::Mailbox, wgpu::PresentMode::Immediate];
        let present_mode = modes.into_iter().find(|mode| can.present_modes.contains(mode));
        let present_mode = present_mode.unwrap_or(wgpu::PresentMode::Fifo);
        let config = wgpu::SurfaceConfiguration { format: self.format, present_mode, ..config };
        surface.configure(&self.device, &config);
        Ok(Canvas { surface, config })
    }

    /// Whether the device is a software renderer.
    pub fn is_software(&self) -> bool {
        self.is_software
    }

    /// Returns the maximum side of a texture, pixels.
    pub fn longest_side(&self) -> usize {
        self.device.limits().max_texture_dimension_2d as usize
    }

    /// Whether the device is lost.
    pub fn is_lost(&self) -> bool {
        self.lost.load(Ordering::Acquire)
    }

    /// Destroys the device, as a failing driver would: for tests.
    pub fn destroy(&self) {
        self.device.destroy();
        // The loss is reported after all earlier requests have finished.
        let _ = self.device.poll(wgpu::PollType::wait_indefinitely());
    }

    /// Resizes a canvas, pixels; ignores a zero size, as of a minimised window.
    pub fn resize(&self, canvas: &mut Canvas, [width, height]: [u32; 2]) {
        let (Some(width), Some(height)) = (NonZeroU32::new(width), NonZeroU32::new(height)) else { return };
        let most = self.device.limits().max_texture_dimension_2d;
        (canvas.config.width, canvas.config.height) = (width.get().min(most), height.get().min(most));
        self.configure(canvas);
    }

    fn configure(&self, canvas: &Canvas) {
        if !self.is_lost() {
            canvas.surface.configure(&self.device, &canvas.config);
        }
    }

    /// Sends the font texture again, to a new device.
    pub fn send_letters(&mut self, ctx: &egui::Context) {
        let letters = ctx.fonts(|fonts| fonts.image());
        self.textures.push(egui::TextureId::default(), ImageDelta::full(letters, TextureAtlas::texture_options()));
    }

    /// Adds changes of egui's textures, whether or not a picture is drawn.
    pub fn take_textures(&mut self, textures: TexturesDelta) {
        self.textures.append(textures);
    }

    /// Draws egui's shapes and presents the picture.
    pub fn draw(&mut self, canvas: &Canvas, window: &Window, what: &Drawing<'_>) -> PaintOutcome {
        // A driver may panic in the middle of drawing when its device is lost.
        let drawn = catch_unwind(AssertUnwindSafe(|| self.draw_on(canvas, window, what)));
        drawn.unwrap_or_else(|panic| match self.is_lost() {
            true => PaintOutcome::Again,
            false => resume_unwind(panic),
        })
    }

    fn draw_on(&mut self, canvas: &Canvas, window: &Window, what: &Drawing<'_>) -> PaintOutcome {
        use wgpu::CurrentSurfaceTexture::{Lost, Occluded, Outdated, Suboptimal, Success, Timeout, Validation};
        let (frame, fits) = match canvas.surface.get_current_texture() {
            Success(frame) => (frame, true),
            Suboptimal(frame) => (frame, false),
            Outdated | Lost => {
                self.configure(canvas);
                return PaintOutcome::Again;
            }
            Timeout => return PaintOutcome::Again,
            Occluded | Validation => return PaintOutcome::Done,
        };
        let view = frame.texture.create_view(&wgpu::TextureViewDescriptor::default());
        let size_px = [frame.texture.width(), frame.texture.height()];
        let Drawing { shapes, pixels_per_point, behind } = *what;
        let sheet = RenderTarget { view: &view, size_px, pixels_per_point, behind };
        self.gui.draw(&sheet, &mut self.textures, shapes);
        window.pre_present_notify();
        self.queue.present(frame);
        if !fits {
            self.configure(canvas);
        }
        PaintOutcome::Done
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        // egui asserts that no texture changes are dropped, but a dropped screen needs none.
        self.textures.clear();
    }
}

/// Returns the usual configuration of a surface for the size of its window; `None` if the adapter cannot draw on it.
fn usual_config(
    surface: &wgpu::Surface<'static>,
    adapter: &wgpu::Adapter,
    window: &Window,
) -> Option<wgpu::SurfaceConfiguration> {
    let size = window.inner_size();
    let config = surface.get_default_config(adapter, size.width.max(1), size.height.max(1))?;
    Some(wgpu::SurfaceConfiguration { view_formats: Vec::new(), ..config })
}
