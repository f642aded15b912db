//! What less inertia costs in mass: counterweights to choose from, each as light as its inertia lets it be.

use egui::{RichText, Ui};
use egui_plot::{HLine, Line, LineStyle, PlotPoint, PlotPoints, Points, VLine};

use super::facts::{Facts, Point};
use crate::app::command::DesignCommand;
use crate::app::plots::{base_plot, marks, small_axes, spaced};
use crate::app::theme::{bold, colour, plain};
use crate::app::widgets::{heading, name, note};
use crate::app::{Command, ViewState};
use crate::picture::numbers::signed;
use crate::picture::scene::palette::{Palette, faded};

const HEIGHT: f32 = 210.0;
/// A point is chosen from so near, points of the screen.
const NEAR: f32 = 14.0;
/// Counterweights below this are none, kg.
const NOTHING: f64 = 1e-6;

/// Draws it.
pub fn show(ui: &mut Ui, facts: &Facts, view_state: &ViewState, commands: &mut Vec<Command>) {
    let p = &view_state.palette();
    ui.add_space(8.0);
    heading(ui, p, "Counterweights", "hover shows them, click takes them");
    let points = match facts.front() {
        Ok([]) => return,
        Ok(points) => points,
        Err(why) => return note(ui, p, why),
    };
    if points.iter().all(|point| point.placed.added_mass < NOTHING) {
        return note(ui, p, "The links balance each other: nothing needs to be added.");
    }
    let [mass, inertia] = facts.now;
    let all: Vec<[f64; 2]> = points.iter().map(|point| [point.placed.added_mass, point.inertia]).collect();
    // Taken counterweights are shown among the others, where they are within reach of them.
    let shown = mass > NOTHING;
    let of = |i: usize| all.iter().map(move |at| at[i]);
    let ends = |i: usize, now: f64| {
        let (low, high) = of(i).fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        let (low, high) = if shown { (low.min(now), high.max(now)) } else { (low, high) };
        let room = 0.08 * (high - low).max(1e-3 * high.abs());
        [low - room, high + room]
    };
    let ([left, right], [low, high]) = (ends(0, mass), ends(1, inertia));
    ui.label(RichText::new("Σ D, kg m²").font(plain(11.0)).color(colour(p.dim)));
    small_axes(ui);
    let response = base_plot("front", p, HEIGHT)
        .show_axes([true, true])
        .show_grid([true, true])
        .x_grid_spacer(move |_| marks(&spaced(left, right), right - left))
        .y_grid_spacer(move |_| marks(&spaced(low, high), high - low))
        .x_axis_formatter(move |mark, _| signed(mark.value, decimals(right - left)))
        .y_axis_formatter(move |mark, _| signed(mark.value, decimals(high - low)))
        .show(ui, |plot| {
            plot.set_plot_bounds_x(left..=right);
            plot.set_plot_bounds_y(low..=high);
            if shown {
                let tone = colour(faded(p.amber, 0.7));
                let dashed = LineStyle::dashed_loose();
                plot.hline(HLine::new("now D", inertia).color(tone).width(1.0).style(dashed).allow_hover(false));
                plot.vline(VLine::new("now kg", mass).color(tone).width(1.0).style(dashed).allow_hover(false));
            }
            let line = Line::new("front", PlotPoints::from(all.clone())).width(1.8).color(colour(p.zero));
            plot.line(line.allow_hover(false));
            let dots = Points::new("machines", PlotPoints::from(all.clone())).radius(3.5).color(colour(p.zero));
            plot.points(dots.allow_hover(false));
            if let Some(at) = view_state.ghost.and_then(|i| all.get(i)) {
                let dot =
                    Points::new("under the pointer", PlotPoints::from(vec![*at])).radius(6.0).color(colour(p.ink));
                plot.points(dot.allow_hover(false));
            }
            if shown {
                let at = PlotPoints::from(vec![facts.now]);
                plot.points(Points::new("now", at).radius(6.0).color(colour(p.amber)).allow_hover(false));
            }
        });
    let near = response.response.hover_pos().and_then(|pos| {
        let off = |at: &[f64; 2]| response.transform.position_from_point(&PlotPoint::new(at[0], at[1])).distance(pos);
        let nearest = all.iter().enumerate().min_by(|a, b| off(a.1).total_cmp(&off(b.1)));
        nearest.filter(|(_, at)| off(at) < NEAR).map(|(i, _)| i)
    });
    if near != view_state.ghost {
        commands.push(Command::Design(DesignCommand::Ghost(near)));
    }
    if let Some(i) = near {
        ui.ctx().set_cursor_icon(egui::CursorIcon::PointingHand);
        if response.response.clicked() {
            commands.extend([Command::Design(DesignCommand::Take(i)), Command::EndGesture]);
        }
    }
    name(&response.response, &words(&all));
    ui.horizontal(|ui| {
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            ui.label(RichText::new("added mass, kg").font(plain(11.0)).color(colour(p.dim)));
        });
    });
    told(ui, p, points, near, view_state, facts, commands);
}

/// Digits that tell the marks of an axis of a length apart.
fn decimals(length: f64) -> usize {
    (1.0 - length.log10()).ceil().clamp(0.0, 6.0) as usize
}

fn words(all: &[[f64; 2]]) -> String {
    let end = |at: Option<&[f64; 2]>| {
        at.map_or(String::new(), |[mass, inertia]| {
            format!("{} kg with {} kg m²", signed(*mass, 2), signed(*inertia, 3))
        })
    };
    format!("Counterweights to choose from, added mass against Σ D: from {} to {}", end(all.first()), end(all.last()))
}

/// What the machine under the pointer, or on display, comes to, and the two ends of the front to take.
fn told(
    ui: &mut Ui,
    p: &Palette,
    points: &[Point],
    near: Option<usize>,
    view_state: &ViewState,
    facts: &Facts,
    commands: &mut Vec<Command>,
) {
    let at = near.or(view_state.ghost).and_then(|i| points.get(i));
    let (mass, inertia) = match at {
        Some(point) => (point.placed.added_mass, point.inertia),
        None => (facts.now[0], facts.now[1]),
    };
    let text = match at.is_none() && mass < NOTHING {
        true => "no counterweights yet".to_owned(),
        false => format!("{} kg added, Σ D {} kg m²", signed(mass, 2), signed(inertia, 3)),
    };
    let tone = if at.is_some() { p.ink } else { p.amber };
    ui.label(RichText::new(text).font(bold(13.0)).color(colour(tone)));
    let gap = points.iter().map(|point| point.placed.gap).fold(0.0, f64::max);
    let proof = format!("proved: below the curve there is nothing, give or take {gap:.0e} kg or kg m²");
    note(ui, p, &proof);
    ui.horizontal(|ui| {
        let last = points.len() - 1;
        for (words, i, tip) in [
            ("least mass", 0, "Take the lightest counterweights"),
            ("between", last / 2, "Take those halfway between the two ends"),
            ("least inertia", last, "Take those with which the drives have least to turn"),
        ] {
            let button = ui.button(RichText::new(words).font(plain(12.0))).on_hover_text(tip);
            if button.clicked() {
                commands.extend([Command::Design(DesignCommand::Take(i)), Command::EndGesture]);
            }
        }
    });
}
