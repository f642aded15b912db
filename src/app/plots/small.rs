//! Small plots of the panels: how they look, and what is marked on their axes.

use egui::{RichText, TextStyle, Ui};
use egui_plot::{GridMark, Plot};

use crate::app::theme::{bold, colour, plain};
use crate::picture::numbers::round_up;
use crate::picture::scene::palette::{Palette, faded};

/// Size of the figures at axes.
const FIGURES: f32 = 10.5;

/// Over the plots of which b serves: what they show.
pub fn which_b_title(ui: &mut Ui, p: &Palette, words: &str) {
    ui.horizontal(|ui| {
        ui.set_height(16.0);
        ui.label(RichText::new("Which b?").font(bold(12.5)));
        ui.add(egui::Label::new(RichText::new(words).font(plain(11.5)).color(colour(p.dim))).truncate());
    });
}

/// A plot as the panels have it: without grid across, and without hands.
pub fn base_plot<'a>(id: &str, p: &Palette, height: f32) -> Plot<'a> {
    Plot::new(id.to_owned())
        .height(height)
        .show_background(false)
        .show_axes([false, true])
        .show_grid([false, true])
        .grid_color(colour(faded(p.line, 0.9)))
        .grid_fade(0.0)
        .show_x(false)
        .show_y(false)
        .allow_drag(false)
        .allow_zoom(false)
        .allow_scroll(false)
        .allow_boxed_zoom(false)
        .allow_double_click_reset(false)
        .sense(egui::Sense::click_and_drag())
        .y_axis_min_width(46.0)
        .set_margin_fraction(egui::Vec2::ZERO)
}

/// The axes of the plots that follow have figures as small as those of the signals.
pub fn small_axes(ui: &mut Ui) {
    ui.style_mut().text_styles.insert(TextStyle::Body, plain(FIGURES));
}

/// Values to mark on an axis.
pub fn marks(values: &[f64], step: f64) -> Vec<GridMark> {
    values.iter().map(|v| GridMark { value: *v, step_size: step }).collect()
}

/// Some three to five round values between bounds.
pub fn spaced(low: f64, high: f64) -> Vec<f64> {
    let step = round_up((high - low) / 5.0);
    let first = (low / step).ceil() as i64;
    (first..first + 12).map(|i| i as f64 * step).take_while(|v| *v <= high).collect()
}
