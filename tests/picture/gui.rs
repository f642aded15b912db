//! What egui has made comes out as it says: colours on any target, textures that change, what is clipped.

use std::sync::Arc;

use egui::epaint::{ImageData, ImageDelta};
use egui::{Color32, ColorImage, Pos2, Rect, TextureId, TextureOptions, TexturesDelta, pos2, vec2};
use stillbase::picture::gui::{GuiRenderer, RenderTarget};
use stillbase::picture::render::offscreen::{Picture, surface};

use crate::Test;
use crate::gpu::{fresh, gpu};

pub const TESTS: &[Test] = tests![
    colours_are_the_same_on_every_target,
    a_texture_is_taken_over_changed_in_part_and_freed,
    a_shape_ends_where_it_is_clipped,
    twice_as_many_pixels_show_the_same,
    nothing_and_too_much_are_survived,
];

const SIZE: [u32; 2] = [40, 30];
const BEHIND: Color32 = Color32::from_rgb(18, 52, 86);

/// Where a shape is shown, and what it is.
type Clipped = (Rect, egui::Shape);

fn everywhere() -> Rect {
    Rect::from_min_size(Pos2::ZERO, vec2(40.0, 30.0))
}

fn fill(min: [f32; 2], max: [f32; 2], colour: Color32) -> egui::Shape {
    egui::Shape::rect_filled(Rect::from_min_max(min.into(), max.into()), 0, colour)
}

/// Draws shapes as a window would, feathered edges aside.
fn drawn(format: wgpu::TextureFormat, scale: u32, shapes: Vec<Clipped>) -> Picture {
    let mut gpu = gpu();
    let mut gui = GuiRenderer::new(gpu.device(), gpu.queue(), format);
    let size_px = SIZE.map(|n| n * scale);
    let texture = surface(gpu.device(), size_px, format);
    let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
    let ctx = egui::Context::default();
    let mut output = ctx.run_ui(egui::RawInput::default(), |_| {});
    ctx.tessellation_options_mut(|o| o.feathering = false);
    let list = shapes.into_iter().map(|(clip, shape)| egui::epaint::ClippedShape::new(clip, shape)).collect();
    let list = ctx.tessellate(list, scale as f32);
    let sheet = RenderTarget { view: &view, size_px, pixels_per_point: scale as f32, behind: BEHIND };
    gui.draw(&sheet, &mut output.textures_delta, &list);
    gpu.readback(&texture).expect("it reads")
}

fn near(a: [u8; 4], b: [u8; 4]) -> bool {
    a.iter().zip(b).all(|(a, b)| a.abs_diff(b) <= 1)
}

fn colours_are_the_same_on_every_target() {
    use wgpu::TextureFormat::{Bgra8Unorm, Bgra8UnormSrgb, Rgba8Unorm, Rgba8UnormSrgb};
    let colours = [[255, 255, 255], [200, 100, 50], [3, 7, 11], [0, 0, 0], [128, 127, 254]];
    let column = |k: usize| [8.0 * k as f32, 8.0 * (k + 1) as f32];
    let shapes = || {
        let one = |(k, [r, g, b]): (usize, [u8; 3])| {
            let [left, right] = column(k);
            (everywhere(), fill([left, 4.0], [right, 20.0], Color32::from_rgb(r, g, b)))
        };
        colours.into_iter().enumerate().map(one).collect::<Vec<_>>()
    };
    for format in [Rgba8Unorm, Bgra8Unorm, Rgba8UnormSrgb, Bgra8UnormSrgb] {
        let picture = drawn(format, 1, shapes());
        for (k, [r, g, b]) in colours.into_iter().enumerate() {
            let seen = picture.pixel(8 * k as u32 + 4, 12).expect("inside");
            assert!(near(seen, [r, g, b, 255]), "{format:?}: {seen:?} of {r} {g} {b}");
        }
        let seen = picture.pixel(20, 25).expect("inside");
        assert!(near(seen, BEHIND.to_array()), "{format:?}: {seen:?} behind");
    }
}

fn image(size: [usize; 2], colour: Color32) -> ImageData {
    ImageData::Color(Arc::new(ColorImage::filled(size, colour)))
}

fn a_texture_is_taken_over_changed_in_part_and_freed() {
    let mut gpu = fresh();
    let format = wgpu::TextureFormat::Rgba8Unorm;
    let mut gui = GuiRenderer::new(gpu.device(), gpu.queue(), format);
    let texture = surface(gpu.device(), SIZE, format);
    let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
    let sheet = RenderTarget { view: &view, size_px: SIZE, pixels_per_point: 1.0, behind: BEHIND };
    let id = TextureId::User(7);
    let mut mesh = egui::Mesh::with_texture(id);
    let whole = Rect::from_min_max(Pos2::ZERO, pos2(1.0, 1.0));
    mesh.add_rect_with_uv(Rect::from_min_size(pos2(10.0, 10.0), vec2(8.0, 8.0)), whole, Color32::WHITE);
    let shape =
        egui::epaint::ClippedPrimitive { clip_rect: everywhere(), primitive: egui::epaint::Primitive::Mesh(mesh) };
    let mut look = |delta: &mut TexturesDelta| {
        gui.draw(&sheet, delta, std::slice::from_ref(&shape));
        assert!(delta.is_empty(), "all of it was taken over");
        let picture = gpu.readback(&texture).expect("it reads");
        [[11, 11], [16, 16], [25, 25]].map(|[x, y]| picture.pixel(x, y).expect("inside"))
    };
    let (red, blue, behind) = (Color32::RED.to_array(), Color32::BLUE.to_array(), BEHIND.to_array());
    assert_eq!(look(&mut TexturesDelta::default()), [behind; 3], "no texture yet");
    let mut delta = TexturesDelta::default();
    delta.push(id, ImageDelta::full(image([8, 8], Color32::RED), TextureOptions::NEAREST));
    assert_eq!(look(&mut delta), [red, red, behind]);
    delta.push(id, ImageDelta::partial([4, 4], image([4, 4], Color32::BLUE), TextureOptions::NEAREST));
    assert_eq!(look(&mut delta), [red, blue, behind]);
    // Read otherwise from now on, and what it holds stays.
    delta.push(id, ImageDelta::partial([0, 0], image([1, 1], Color32::RED), TextureOptions::LINEAR));
    assert_eq!(look(&mut delta), [red, blue, behind]);
    // It goes after it was drawn once more.
    delta.free(id);
    assert_eq!(look(&mut delta), [red, blue, behind]);
    assert_eq!(look(&mut delta), [behind; 3]);
}

fn a_shape_ends_where_it_is_clipped() {
    let clip = Rect::from_min_max(pos2(10.0, 10.0), pos2(20.0, 15.0));
    let picture = drawn(wgpu::TextureFormat::Rgba8Unorm, 1, vec![(clip, fill([0.0, 0.0], [40.0, 30.0], Color32::RED))]);
    for x in 0..40 {
        for y in 0..30 {
            let inside = (10..20).contains(&x) && (10..15).contains(&y);
            let colour = if inside { Color32::RED } else { BEHIND };
            assert_eq!(picture.pixel(x, y), Some(colour.to_array()), "{x} {y}");
        }
    }
}

fn twice_as_many_pixels_show_the_same() {
    let shapes = || vec![(everywhere(), fill([5.0, 6.0], [25.0, 16.0], Color32::GREEN))];
    let format = wgpu::TextureFormat::Rgba8Unorm;
    let (once, twice) = (drawn(format, 1, shapes()), drawn(format, 2, shapes()));
    for x in 0..80 {
        for y in 0..60 {
            assert_eq!(twice.pixel(x, y), once.pixel(x / 2, y / 2), "{x} {y}");
        }
    }
}

fn nothing_and_too_much_are_survived() {
    let format = wgpu::TextureFormat::Rgba8Unorm;
    let bare = drawn(format, 1, Vec::new());
    assert_eq!(bare.pixel(3, 3), Some(BEHIND.to_array()));
    let far = Rect::from_min_max(pos2(-1e9, -1e9), pos2(1e9, 1e9));
    let (inside_out, beside) = (Rect::NOTHING, far.translate(vec2(3e9, 0.0)));
    let red = || fill([-1e6, -1e6], [1e6, 1e6], Color32::RED);
    assert_eq!(drawn(format, 1, vec![(inside_out, red()), (beside, red())]).rgba, bare.rgba);
    let all = drawn(format, 1, vec![(far, red())]);
    assert!(all.rgba.as_chunks::<4>().0.iter().all(|pixel| *pixel == Color32::RED.to_array()));
}
