//! Small plots of the panels: style and axis marks.

use egui::{RichText, TextStyle, Ui};
use egui_plot::{GridMark, Plot};

use crate::theme::{bold, colour, plain};
use crate::{fit, notation};
use stillbase_picture::numbers::{round_up, signed};
use stillbase_picture::scene::palette::{Palette, faded};

/// Font size of the axis numbers, points.
const AXIS_FONT_PT: f32 = 10.5;

/// Maximum number of decimals of a mark.
const MAX_DECIMALS: f64 = 9.0;

/// Draws the title of the chart *Which b?*.
pub fn which_b_title(ui: &mut Ui, p: &Palette, words: &str) {
    ui.horizontal(|ui| {
        ui.set_height(16.0);
        ui.label(RichText::new("Which b?").font(bold(12.5)));
        fit::label(ui, words, plain(11.5), colour(p.dim));
    });
}

/// Returns a plot in the style of the panels: without vertical grid lines, and without dragging and zooming.
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

/// Sets the small font of the signal plots for the axes that follow.
pub fn small_axes(ui: &mut Ui) {
    ui.style_mut().text_styles.insert(TextStyle::Body, plain(AXIS_FONT_PT));
}

/// An axis of angles in the user's unit; its coordinates are in radians.
#[derive(Clone, Copy)]
pub struct SmallAxis {
    factor: f64,
    decimals: usize,
}

impl SmallAxis {
    /// Returns the axis of the present notation.
    pub fn of_angle(ui: &Ui) -> Self {
        match notation::of(ui.ctx()).shown_unit("rad") {
            Some(unit) => Self { factor: unit.factor, decimals: unit.decimals(1) },
            None => Self { factor: 1.0, decimals: 1 },
        }
    }

    /// Returns the axis with as many decimals as tell the marks between two bounds apart.
    pub fn between(self, low: f64, high: f64) -> Self {
        let step = step(self.factor * low, self.factor * high);
        let needed = (-step.log10() - 1e-9).ceil().clamp(0.0, MAX_DECIMALS) as usize;
        Self { decimals: self.decimals.max(needed), ..self }
    }

    /// Returns marks at values that are round in the user's unit.
    pub fn marks(self, low: f64, high: f64) -> Vec<GridMark> {
        let round: Vec<f64> =
            spaced(self.factor * low, self.factor * high).iter().map(|value| value / self.factor).collect();
        marks(&round, high - low)
    }

    /// Writes a value, rad, in the user's unit.
    pub fn write(self, value: f64) -> String {
        signed(self.factor * value, self.decimals)
    }
}

/// Returns axis marks at these values; egui draws marks of a larger `step` more strongly.
pub fn marks(values: &[f64], step: f64) -> Vec<GridMark> {
    values.iter().map(|v| GridMark { value: *v, step_size: step }).collect()
}

/// Returns the distance of the values of [`spaced`].
fn step(low: f64, high: f64) -> f64 {
    round_up((high - low) / 5.0)
}

/// Returns about three to five round, evenly spaced values between two bounds.
pub fn spaced(low: f64, high: f64) -> Vec<f64> {
    let step = step(low, high);
    let first = (low / step).ceil() as i64;
    (first..first + 12).map(|i| i as f64 * step).take_while(|v| *v <= high).collect()
}
