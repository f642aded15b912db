//! What a whole frame costs on the adapter at hand: the three cases in motion, two runs side by side, at rest with the
//! pointer moving, and the tower, at 1440 × 900 and twice that.
//!
//! `cargo bench --bench frame` prints the median of each part: the interface (the steps of the simulation that are due,
//! panels, plots and scene), its shapes, what is sent to the adapter, and what the adapter draws, waited for; then the
//! mean of the processor's time for a frame, all threads together, where the system tells it. The last column is the
//! scene alone, drawn finely at the size it has in the window.

use std::time::{Duration, Instant};

use egui::epaint::Primitive;
use stillbase::app::{AppState, SessionCommand, Switch, ViewChange};
use stillbase::picture::gui::{GuiRenderer, RenderTarget};
use stillbase::picture::paint::{enable_draft_quality, install_fonts};
use stillbase::picture::render::offscreen::{Gpu, surface};
use stillbase::picture::render::{Renderer, View};
use stillbase::picture::scene::options::ViewOptions;
use stillbase::picture::scene::palette::Theme;
use stillbase::picture::scene::views::{ViewKind, Views};
use stillbase::session::scenario::Scenario;

/// Between two frames.
const PACE: f64 = 1.0 / 60.0;

const FRAMES: usize = 60;

/// What is done in a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Doing {
    /// The motion plays.
    Plays,
    /// The motion plays beside another run.
    PlaysBeside,
    /// Nothing but the pointer moves.
    Rests,
}

fn main() {
    // Others of cargo's words are for benches with a harness.
    let gpu = match Gpu::new() {
        Ok(gpu) => gpu,
        Err(why) => return println!("no frame is drawn: {why}"),
    };
    println!("{}; medians of {FRAMES} frames, ms", gpu.name());
    let part = ["interface", "shapes", "upload", "draw", "frame", "processor", "scene alone"]
        .map(|name| format!("{name:>11}"));
    println!("{:34} {}", "", part.join(" "));
    for (size, scale) in [([1440, 900], 1.0), ([2880, 1800], 2.0)] {
        for case in ["case-1", "case-2", "case-3"] {
            measure(&gpu, case, ViewKind::Flat, Doing::Plays, size, scale);
        }
        measure(&gpu, "case-3", ViewKind::Flat, Doing::PlaysBeside, size, scale);
        measure(&gpu, "case-3", ViewKind::Space, Doing::Plays, size, scale);
        measure(&gpu, "case-3", ViewKind::Space, Doing::Rests, size, scale);
        measure(&gpu, "case-3", ViewKind::Tower, Doing::Plays, size, scale);
    }
}

fn measure(gpu: &Gpu, case: &str, view: ViewKind, doing: Doing, size: [u32; 2], scale: f32) {
    let scenario = Scenario::builtin(case).expect("built in");
    let mut app_state = AppState::new(scenario, Theme::Dark).expect("it starts");
    app_state.carry_out(ViewChange::Kind(view));
    app_state.carry_out(ViewChange::Switch(Switch::Pair, doing == Doing::PlaysBeside));
    let mut screen = Screen::new(gpu, size, scale);
    for i in 0..10 {
        screen.frame(&mut app_state, i);
    }
    if doing != Doing::Rests {
        app_state.carry_out(SessionCommand::TogglePlay);
    }
    let mut all: [Vec<Duration>; 5] = Default::default();
    let begun = processor_time();
    for i in 0..FRAMES {
        let parts = screen.frame(&mut app_state, i);
        let whole = parts.iter().sum();
        let [interface, shapes, upload, draw] = parts;
        for (list, took) in all.iter_mut().zip([interface, shapes, upload, draw, whole]) {
            list.push(took);
        }
    }
    let spent = processor_time().zip(begun).map(|(now, begun)| (now - begun) / FRAMES as f64);
    let alone: Vec<Duration> = (0..20).map(|_| screen.scene_alone(&app_state)).collect();
    let median = |mut list: Vec<Duration>| {
        list.sort_unstable();
        format!("{:11.2}", list[list.len() / 2].as_secs_f64() * 1e3)
    };
    let spent = spent.map_or_else(|| format!("{:>11}", "-"), |ms| format!("{ms:11.2}"));
    let [width, height] = size;
    let name = format!("{case} {view:?} {doing:?} {width}x{height}");
    println!("{name:34} {} {spent} {}", all.map(median).join(" "), median(alone));
}

/// The processor's time of all threads of this program so far, ms; Linux counts it in hundredths of a second.
fn processor_time() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/self/stat").ok()?;
    let fields: Vec<&str> = text.rsplit_once(')')?.1.split_whitespace().collect();
    let ticks = |i: usize| fields.get(i)?.parse::<f64>().ok();
    Some(10.0 * (ticks(11)? + ticks(12)?))
}

struct Screen<'a> {
    gpu: &'a Gpu,
    gui: GuiRenderer,
    ctx: egui::Context,
    texture: wgpu::Texture,
    size_px: [u32; 2],
    pixels_per_point: f32,
    alone: Renderer,
    viewport: egui::Rect,
    now: f64,
}

impl<'a> Screen<'a> {
    fn new(gpu: &'a Gpu, size: [u32; 2], scale: f32) -> Self {
        let format = wgpu::TextureFormat::Rgba8Unorm;
        let ctx = egui::Context::default();
        install_fonts(&ctx);
        // As the window does.
        if gpu.adapter().get_info().device_type == wgpu::DeviceType::Cpu {
            enable_draft_quality(&ctx);
        }
        Self {
            gpu,
            gui: GuiRenderer::new(gpu.device(), gpu.queue(), format),
            ctx,
            texture: surface(gpu.device(), size, format),
            size_px: size,
            pixels_per_point: scale,
            alone: Renderer::new(gpu.device(), format),
            viewport: egui::Rect::NOTHING,
            now: 0.0,
        }
    }

    fn wait(&self) {
        self.gpu.device().poll(wgpu::PollType::wait_indefinitely()).expect("it draws");
    }

    /// Interface, shapes, upload and draw.
    fn frame(&mut self, app_state: &mut AppState, i: usize) -> [Duration; 4] {
        let begun = Instant::now();
        app_state.pass(PACE);
        let [width, height] = self.size_px.map(|n| n as f32 / self.pixels_per_point);
        let mut input = egui::RawInput {
            screen_rect: Some(egui::Rect::from_min_size(egui::Pos2::ZERO, egui::vec2(width, height))),
            time: Some(self.now),
            ..Default::default()
        };
        self.now += PACE;
        // Over the plots, where nothing is under it that a click would change.
        input.events.push(egui::Event::PointerMoved(egui::pos2(0.3 * width + i as f32, 0.95 * height)));
        if let Some(root) = input.viewports.get_mut(&egui::ViewportId::ROOT) {
            root.native_pixels_per_point = Some(self.pixels_per_point);
        }
        let mut output = self.ctx.run_ui(input, |ui| app_state.ui(ui));
        let interface = begun.elapsed();

        let begun = Instant::now();
        let shapes = self.ctx.tessellate(output.shapes, output.pixels_per_point);
        let took = begun.elapsed();
        for shape in &shapes {
            if let Primitive::Callback(callback) = &shape.primitive {
                self.viewport = callback.rect;
            }
        }

        let begun = Instant::now();
        let behind = self.ctx.global_style().visuals.panel_fill;
        let view = self.texture.create_view(&wgpu::TextureViewDescriptor::default());
        let sheet =
            RenderTarget { view: &view, size_px: self.size_px, pixels_per_point: self.pixels_per_point, behind };
        self.gui.draw(&sheet, &mut output.textures_delta, &shapes);
        let upload = begun.elapsed();

        let begun = Instant::now();
        self.wait();
        let drawn = begun.elapsed();
        [interface, took, upload, drawn]
    }

    /// The scene once more, without the panels.
    fn scene_alone(&mut self, app_state: &AppState) -> Duration {
        let (session, view_state) = (app_state.session(), app_state.view_state());
        let views = Views::of(session.run());
        let options = ViewOptions { theme: Theme::Dark, ..ViewOptions::default() };
        let camera = view_state.camera();
        let scene = views.scene(view_state.view, session.frame(), &options, camera);
        let (size, scale) = (self.viewport.size(), self.pixels_per_point);
        let view = View {
            clip_from_world: camera.clip_from_world(f64::from(size.x / size.y)),
            eye_direction: camera.eye_direction(),
            size_px: [size.x, size.y].map(|n| (n * scale).round() as u32),
            pixels_per_point: scale,
        };
        let begun = Instant::now();
        let mut encoder = self.gpu.device().create_command_encoder(&Default::default());
        self.alone.prepare(self.gpu.device(), self.gpu.queue(), &mut encoder, &scene, &view);
        self.gpu.queue().submit([encoder.finish()]);
        self.wait();
        begun.elapsed()
    }
}
