//! Polylines as antialiased ribbons of constant width on the screen.

use super::kit::{List, Recipe, SharedBindings, Upload};
use super::quality::Quality;
use super::shader::{Shader, embedded, twin};
use super::view::View;
use crate::scene::thin::for_each_kept;
use crate::scene::{IN_PLACE, Polyline, Scene, place};

/// Distance of dropped vertices from a line in draft quality, physical pixels.
const DRAFT_TOLERANCE_PX: f32 = 0.25;

twin! {
    /// One segment from `a` to `b`, with the vertices before and after it.
    struct Segment {
        a: [f32; 3],
        width: f32,
        b: [f32; 3],
        arc: f32,
        before: [f32; 3],
        dash: f32,
        after: [f32; 3],
        gap: f32,
        colour: [f32; 4],
    }
}

struct Pipelines {
    tested: wgpu::RenderPipeline,
    on_top: wgpu::RenderPipeline,
}

pub(super) struct LineRenderer {
    shader: Shader<Pipelines>,
    /// Segments; the depth-tested ones come first.
    list: List<Segment>,
    tested: u32,
    /// Vertices of the current line, without repetitions.
    path: Vec<[f32; 3]>,
    /// The same vertices on the screen, physical pixels.
    on_screen: Vec<[f32; 2]>,
}

impl LineRenderer {
    pub(super) fn new(device: &wgpu::Device, kit: &SharedBindings) -> Self {
        let pipeline = kit.pipelines();
        let build = move |device: &wgpu::Device, module: &wgpu::ShaderModule| {
            let recipe = |label, compare| {
                pipeline(device, Recipe::quads(label, module, compare, wgpu::BlendState::ALPHA_BLENDING))
            };
            Pipelines {
                tested: recipe("lines", wgpu::CompareFunction::LessEqual),
                on_top: recipe("lines on top", wgpu::CompareFunction::Always),
            }
        };
        Self {
            shader: Shader::new(device, embedded!("lines"), Box::new(build)),
            list: List::new(device, kit, "lines"),
            tested: 0,
            path: Vec::new(),
            on_screen: Vec::new(),
        }
    }

    pub(super) fn prepare(&mut self, kit: &SharedBindings, upload: &mut Upload, scene: &Scene, view: &View) {
        self.shader.reload(upload.device);
        self.list.items.clear();
        let quality = kit.quality;
        scene.lines.iter().filter(|line| !line.on_top).for_each(|line| self.add(line, view, quality));
        self.tested = self.list.items.len() as u32;
        scene.lines.iter().filter(|line| line.on_top).for_each(|line| self.add(line, view, quality));
        self.list.upload(kit, upload);
        self.tested = self.tested.min(self.list.items.len() as u32);
    }

    fn add(&mut self, line: &Polyline, view: &View, quality: Quality) {
        if line.width.is_nan() || line.width <= 0.0 || line.colour[3] <= 0.0 {
            return;
        }
        line.strips.iter().for_each(|strip| self.add_strip(strip, line, view, quality));
    }

    fn add_strip(&mut self, strip: &[[f32; 3]], line: &Polyline, view: &View, quality: Quality) {
        let Polyline { name: _, strips: _, world_from_item, width, colour, dash, on_top: _, changes: _ } = line;
        self.path.clear();
        self.path.extend(strip.iter().filter(|p| p.iter().all(|x| x.is_finite())));
        if *world_from_item != IN_PLACE {
            self.path.iter_mut().for_each(|p| *p = place(world_from_item, *p));
        }
        self.path.dedup();
        if quality == Quality::Draft {
            self.simplify(view);
        }
        let path = &self.path;
        let n = path.len();
        if n < 2 {
            return;
        }
        let closed = n > 2 && path[0] == path[n - 1];
        let [dash_length, gap] = dash.unwrap_or_default();
        let mut arc = 0.0;
        for (k, ends) in path.windows(2).enumerate() {
            let [a, b] = [ends[0], ends[1]];
            self.list.items.push(Segment {
                a,
                width: *width,
                b,
                arc,
                before: if k > 0 {
                    path[k - 1]
                } else if closed {
                    path[n - 2]
                } else {
                    a
                },
                dash: dash_length,
                after: if k + 2 < n {
                    path[k + 2]
                } else if closed {
                    path[1]
                } else {
                    b
                },
                gap,
                colour: *colour,
            });
            if dash.is_some() {
                arc += view.pixels_between(a, b);
            }
        }
    }

    /// Drops vertices of the current line whose loss is not seen. A line that is partly behind the eye is kept whole.
    fn simplify(&mut self, view: &View) {
        self.on_screen.clear();
        self.on_screen.extend(self.path.iter().map_while(|point| view.project(*point)));
        if self.on_screen.len() < self.path.len() {
            return;
        }
        let mut count = 0;
        for_each_kept(&self.on_screen, DRAFT_TOLERANCE_PX, |i| {
            self.path[count] = self.path[i];
            count += 1;
        });
        self.path.truncate(count);
    }

    pub(super) fn draw_tested(&self, pass: &mut wgpu::RenderPass) {
        self.draw(pass, &self.shader.tested, 0..self.tested);
    }

    pub(super) fn draw_on_top(&self, pass: &mut wgpu::RenderPass) {
        self.draw(pass, &self.shader.on_top, self.tested..self.list.items.len() as u32);
    }

    fn draw(&self, pass: &mut wgpu::RenderPass, pipeline: &wgpu::RenderPipeline, segments: std::ops::Range<u32>) {
        if !segments.is_empty() {
            pass.set_pipeline(pipeline);
            pass.set_bind_group(1, &self.list.group, &[]);
            pass.draw(0..4, segments);
        }
    }
}
