//! Which b reach the points of the task, or the target, of a machine of other than three drives.

use egui::{RichText, Ui};
use egui_plot::{Line, PlotPoint, PlotPoints, Points, VLine};

use super::which_b::{base_plot, marks, small_axes, spaced};
use crate::app::theme::{bold, colour, plain};
use crate::app::widgets::name;
use crate::app::{Command, ViewState, set_b};
use crate::mechanics::planar::Vector;
use crate::picture::numbers::signed;
use crate::picture::scene::palette::Palette;
use crate::planning::pose_map::{BOfPoints, PoseMap};
use crate::query::{Queries, Whole};
use crate::session::Session;

/// The most points that have a bar.
const MOST: usize = 8;
/// Bars narrower than this are a dot, rad.
const DOT: f64 = 1e-3;

/// A bar for each point, with b across; a click chooses b.
pub fn show(
    ui: &mut Ui,
    p: &Palette,
    (session, queries): (&Session, &Queries),
    view_state: &ViewState,
    height: f32,
    commands: &mut Vec<Command>,
) {
    let Ok(map) = session.run().pose_map() else { return };
    if map.angles() == 0 || matches!(map, PoseMap::Planes(_)) {
        return;
    }
    let (task, now) = (&session.scenario().task, session.frame());
    let mut points: Vec<(String, Vector)> = match session.is_led() {
        true => vec![("target".to_owned(), now.target.at)],
        false => task.points().into_iter().enumerate().map(|(i, at)| (task.name_of(i), at)).collect(),
    };
    if points.len() > MOST {
        points.drain(1..points.len() - 1);
    }
    let places: Vec<Vector> = points.iter().map(|(_, at)| *at).collect();
    let serving = queries.ask_beside::<Whole<BOfPoints>>(&(session.run().shared_pose_map(), places)).last;
    // While they are being found, those of other points do not stand for these.
    let sets = serving.as_ref().map(|serving| &serving.each[..]).filter(|sets| sets.len() == points.len());
    ui.horizontal(|ui| {
        ui.set_height(16.0);
        ui.label(RichText::new("Which b?").font(bold(12.5)));
        let words = "of each point, rad; click to choose";
        ui.add(egui::Label::new(RichText::new(words).font(plain(11.5)).color(colour(p.dim))).truncate());
    });
    let b_now = now.b_reference;
    let half = 0.5 * map.period();
    let count = points.len() as f64;
    small_axes(ui);
    let response = base_plot("which b of points", p, height - 16.0)
        .show_axes([true, false])
        .show_grid([false, false])
        .x_grid_spacer(move |_| marks(&spaced(b_now - half, b_now + half), half))
        .x_axis_formatter(|mark, _| signed(mark.value, 1))
        .show(ui, |plot| {
            plot.set_plot_bounds_x(b_now - half..=b_now + half);
            plot.set_plot_bounds_y(-count..=0.4);
            for (i, ((name, _), set)) in points.iter().zip(sets.into_iter().flatten()).enumerate() {
                let y = -(i as f64) - 0.5;
                let near = set.as_ref().map(|set| set.near(b_now).intervals).unwrap_or_default();
                for [low, high] in &near {
                    if high - low < DOT {
                        let dot = vec![[0.5 * (low + high), y]];
                        plot.points(Points::new("b", dot).radius(4.0).color(colour(p.zero)).allow_hover(false));
                    } else {
                        let bar = Line::new(name.clone(), PlotPoints::from(vec![[*low, y], [*high, y]]));
                        plot.line(bar.width(6.0).color(colour(p.zero)).allow_hover(false));
                    }
                }
                let words = if near.is_empty() { format!("{name}: no b reaches it") } else { name.clone() };
                let place = PlotPoint::new(b_now - 0.97 * half, y);
                let text = egui_plot::Text::new("name", place, RichText::new(words).font(plain(11.5)));
                plot.text(text.anchor(egui::Align2::LEFT_CENTER).color(colour(p.ink)).allow_hover(false));
            }
            plot.vline(VLine::new("b", b_now).color(colour(p.amber)).width(1.6).allow_hover(false));
            plot.pointer_coordinate().map(|at| at.x)
        });
    name(&response.response, "Which b: the b that reach each point");
    if response.response.clicked()
        && let Some(b) = response.inner
    {
        commands.extend([Command::Edit(set_b(session, view_state, b)), Command::EndGesture]);
    }
}
