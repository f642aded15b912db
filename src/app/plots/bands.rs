//! The chart *Which b?* for machines without planes in closed form: intervals of b at which the machine reaches each
//! point or the target.

use std::sync::Arc;

use egui::{RichText, Ui};
use egui_plot::{Line, PlotPoint, PlotPoints, Points, VLine};

use super::small::{SmallAxis, base_plot, small_axes, which_b_title};
use super::which_b::WhichB;
use crate::notation;
use crate::theme::{colour, plain};
use crate::widgets::name;
use crate::{Command, SessionCommand, set_b};
use stillbase_mechanics::planar::Vector;
use stillbase_planning::pose_constant::CommonB;
use stillbase_planning::pose_space::PoseSpace;
use stillbase_query::{ByIdentity, QuickWork};

/// Maximum number of bars; with more points, only the first and the last have one.
const MAX_BARS: usize = 8;
/// Bars narrower than this are drawn as dots, rad.
const MIN_BAR_RAD: f64 = 1e-3;

/// Draws a bar of the feasible b for each point, with b on the horizontal axis; a click chooses b.
pub fn bars(
    ui: &mut Ui,
    chart: WhichB<'_>,
    space: &Arc<PoseSpace>,
    mut points: Vec<(String, Vector)>,
    commands: &mut Vec<Command>,
) {
    let WhichB { session, queries, view_state, palette: p, height } = chart;
    let now = session.frame();
    if points.len() > MAX_BARS {
        points.drain(1..points.len() - 1);
    }
    let places: Vec<Vector> = points.iter().map(|(_, at)| *at).collect();
    let feasible = queries.ask_in_background::<QuickWork<CommonB>>(&(ByIdentity(space.clone()), places)).last;
    // While new intervals are computed, the last ones are shown, unless they belong to another number of points.
    let sets = feasible.as_ref().map(|feasible| &feasible.each[..]).filter(|sets| sets.len() == points.len());
    let unit = notation::of(ui.ctx()).unit_name("rad");
    which_b_title(ui, p, &format!("of each point, {unit}; click to choose"));
    let b_now = now.b_reference;
    let half = 0.5 * space.period();
    let count = points.len() as f64;
    let axis = SmallAxis::of_angle(ui).between(b_now - half, b_now + half);
    small_axes(ui);
    let response = base_plot("which b of points", p, height - 16.0)
        .show_axes([true, false])
        .show_grid([false, false])
        .x_grid_spacer(move |_| axis.marks(b_now - half, b_now + half))
        .x_axis_formatter(move |mark, _| axis.write(mark.value))
        .show(ui, |plot| {
            plot.set_plot_bounds_x(b_now - half..=b_now + half);
            plot.set_plot_bounds_y(-count..=0.4);
            for (i, ((name, _), set)) in points.iter().zip(sets.into_iter().flatten()).enumerate() {
                let y = -(i as f64) - 0.5;
                let near = set.as_ref().map(|set| set.shifted_near(b_now).intervals).unwrap_or_default();
                for [low, high] in &near {
                    if high - low < MIN_BAR_RAD {
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
        commands.extend([
            Command::Session(SessionCommand::Edit(set_b(session, view_state, b))),
            Command::Session(SessionCommand::EndGesture),
        ]);
    }
}
