//! Both themes from the smallest window to a large screen, at scales 1 and 2: pictures compared, and nothing cut off.

use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use image::{Rgba, RgbaImage};
use stillbase::app::AppState;
use stillbase::app::window::{App, Clock};
use stillbase::picture::scene::palette::Theme;
use stillbase::session::scenario::Scenario;

use super::Window;
use super::screen::{Screen, whole};
use crate::Test;

pub const TESTS: &[Test] = tests![the_smallest_window, a_usual_window, a_sharp_screen, a_large_screen];

fn the_smallest_window() {
    look_at("small", [960, 600], 1, 1);
}

fn a_usual_window() {
    look_at("usual", [1440, 900], 1, 2);
}

fn a_sharp_screen() {
    look_at("sharp", [1920, 1080], 2, 4);
}

fn a_large_screen() {
    look_at("large", [3840, 2160], 1, 4);
}

fn window(size: [u16; 2], scale: u8, theme: Theme) -> Window {
    let scenario = Scenario::builtin("case-3").expect("built in");
    let app_state = AppState::new(scenario, theme).expect("it starts");
    Harness::builder()
        .with_size(size.map(f32::from))
        .with_pixels_per_point(f32::from(scale))
        .with_step_dt(0.02)
        .renderer(Screen::new())
        .build_ui_state(whole, App::new(app_state, Clock::Fixed(0.02)))
}

/// Every so many pixels along and across become one: what is compared is small, and one stray pixel is no difference.
fn shrunk(picture: &RgbaImage, times: u32) -> RgbaImage {
    RgbaImage::from_fn(picture.width() / times, picture.height() / times, |x, y| {
        let all = (0..times * times).map(|i| picture.get_pixel(x * times + i % times, y * times + i / times));
        let sum = all.fold([0_u32; 4], |sum, pixel| std::array::from_fn(|k| sum[k] + u32::from(pixel[k])));
        Rgba(sum.map(|channel| (channel / (times * times)) as u8))
    })
}

fn look_at(name: &str, size: [u16; 2], scale: u8, times: u32) {
    for (theme, word) in [(Theme::Dark, "dark"), (Theme::Light, "light")] {
        let mut h = window(size, scale, theme);
        h.run_steps(2);
        h.key_press(egui::Key::Space);
        h.run_steps(32);
        h.key_press(egui::Key::Space);
        h.run_steps(4);
        nothing_is_cut_off(&h, size);
        let picture = h.render().expect("drawn");
        assert_eq!([picture.width(), picture.height()], size.map(|side| u32::from(side) * u32::from(scale)));
        egui_kittest::image_snapshot(&shrunk(&picture, times), format!("size-{name}-{word}"));
    }
}

/// What stands along the edges is whole, and nothing there lies over something else.
fn nothing_is_cut_off(h: &Window, [width, height]: [u16; 2]) {
    let whole = egui::Rect::from_min_size(egui::Pos2::ZERO, egui::vec2(f32::from(width), f32::from(height)));
    let top = ["Machine", "Scenario", "Start", "Play", "Step", "Speed", "Time", "loop", "Record", "Help"];
    let rail = ["2D", "3D", "Joints", "Tower", "take hold", "history"];
    for names in [&top[..], &rail[..]] {
        let rects: Vec<egui::Rect> = names.iter().map(|name| h.get_by_label(name).rect()).collect();
        for (i, rect) in rects.iter().enumerate() {
            assert!(whole.contains_rect(*rect) && rect.area() > 50.0, "{}: {rect} in {whole}", names[i]);
            for (k, other) in rects.iter().enumerate().skip(i + 1) {
                assert!(!rect.shrink(1.0).intersects(other.shrink(1.0)), "{} and {}", names[i], names[k]);
            }
        }
    }
    let scene = h.get_by_label_contains("Scene:").rect();
    assert!(whole.contains_rect(scene) && scene.width() > 0.35 * whole.width(), "{scene} in {whole}");
}
