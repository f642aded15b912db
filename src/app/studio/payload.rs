//! The plot of the residual of the balance against the payload.

use egui::{RichText, Ui};
use egui_plot::{Line, PlotPoints, VLine};

use super::facts::DesignFacts;
use crate::plots::{base_plot, marks, small_axes, spaced};
use crate::theme::{colour, plain};
use crate::widgets::{heading, name, note};
use stillbase_picture::numbers::signed;
use stillbase_picture::scene::palette::{Palette, faded};

const PLOT_HEIGHT_PT: f32 = 96.0;

/// Draws the plot, if the design brief has an interval of payloads; `held` is the present payload, kg.
pub fn show(ui: &mut Ui, facts: &DesignFacts, held: f64, p: &Palette) {
    let Some(payloads) = &facts.payloads else { return };
    let Some((first, last)) = payloads.first().zip(payloads.last()) else { return };
    ui.add_space(8.0);
    heading(ui, p, "Over the payloads", "imbalance of this machine");
    let worst = payloads.iter().fold([0.0_f64; 2], |most, at| [most[0].max(at.force), most[1].max(at.coupling)]);
    let ([left, right], top) = ([first.payload, last.payload], (1.1 * worst[0]).max(1e-6));
    ui.label(RichText::new("greatest |g|, kg m").font(plain(11.0)).color(colour(p.dim)));
    small_axes(ui);
    let response = base_plot("payloads", p, PLOT_HEIGHT_PT)
        .show_axes([true, true])
        .show_grid([true, true])
        .x_grid_spacer(move |_| marks(&spaced(left, right), right - left))
        .y_grid_spacer(move |_| marks(&spaced(0.0, top), top))
        .x_axis_formatter(|mark, _| signed(mark.value, 2))
        .y_axis_formatter(|mark, _| if mark.value > 0.0 { signed(mark.value, 3) } else { String::new() })
        .show(ui, |plot| {
            plot.set_plot_bounds_x(left..=right);
            plot.set_plot_bounds_y(0.0..=top);
            plot.vline(VLine::new("held", held).color(colour(faded(p.amber, 0.7))).width(1.0).allow_hover(false));
            let points: Vec<[f64; 2]> = payloads.iter().map(|at| [at.payload, at.force]).collect();
            let line = Line::new("left", PlotPoints::from(points)).width(1.8).color(colour(p.reaction));
            plot.line(line.allow_hover(false));
        });
    let words = format!(
        "at worst {} kg m of (7) and {} kg m² of (8); it holds {} kg now",
        signed(worst[0], 4),
        signed(worst[1], 4),
        signed(held, 3)
    );
    name(&response.response, &format!("Imbalance over the payloads: {words}"));
    ui.horizontal(|ui| {
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            ui.label(RichText::new("payload, kg").font(plain(11.0)).color(colour(p.dim)));
        });
    });
    note(ui, p, &words);
}
