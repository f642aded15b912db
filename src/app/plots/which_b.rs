//! The chart *Which b?*: values of b at which the machine reaches a target, or the points of the task.

use std::sync::Arc;

use egui::{RichText, Ui};
use egui_plot::{Line, LineStyle, PlotPoint, PlotPoints, Points, Span, VLine};

use super::bands::bars;
use super::small::{SmallAxis, base_plot, small_axes, which_b_title};
use crate::notation;
use crate::theme::{colour, plain};
use crate::widgets::name;
use crate::{Command, SessionCommand, ViewChange, ViewState, set_b};
use stillbase_mechanics::planar::Vector;
use stillbase_picture::charts::figure::BOTTOM_MARGIN;
use stillbase_picture::scene::palette::{Palette, faded};
use stillbase_planning::pose_constant::CommonB;
use stillbase_planning::pose_space::{Planes, PoseSpace};
use stillbase_planning::reactionless::PlanePoint;
use stillbase_query::{ByIdentity, Queries, QuickQuery, QuickWork};
use stillbase_session::Session;
use stillbase_study::pose_curves::lifted;

/// Query for the branches of the self-motion at each of the given points, sampled on the planes of joint space.
pub struct Branches;

impl QuickQuery for Branches {
    type Input = (ByIdentity<Planes>, Vec<Vector>);
    type Answer = Vec<Vec<Vec<PlanePoint>>>;

    fn answer((ByIdentity(planes), points): &Self::Input) -> Self::Answer {
        points.iter().map(|x| planes.map().self_motion(*x, 96)).collect()
    }
}

/// Context of the chart.
#[derive(Clone, Copy)]
pub struct WhichB<'a> {
    /// The session whose b the chart shows.
    pub session: &'a Session,
    /// Queries about the session.
    pub queries: &'a Queries,
    /// The view state, with the b under the pointer.
    pub view_state: &'a ViewState,
    /// Colours.
    pub palette: &'a Palette,
    /// Height of the chart, points.
    pub height: f32,
}

/// Draws the chart. With planes in closed form, it plots q_1 against b for each point; otherwise it draws a bar of
/// each point's feasible b. A click chooses b.
pub fn show(ui: &mut Ui, chart: WhichB<'_>, commands: &mut Vec<Command>) {
    let WhichB { session, height, .. } = chart;
    let Ok(space) = session.run().pose_space() else { return };
    let (task, at) = (&session.scenario().task, session.frame().target_in_base());
    let points: Vec<(String, Vector)> = match session.is_dragged() {
        true => vec![("target".to_owned(), at)],
        false => task.points().into_iter().enumerate().map(|(i, at)| (task.name_of(i), at)).collect(),
    };
    match space.planes() {
        Ok(planes) => {
            let height = height * 1.6 + BOTTOM_MARGIN;
            lines(ui, WhichB { height, ..chart }, space, planes, &points, commands);
        }
        Err(_) if space.joints().is_empty() => {}
        Err(_) => bars(ui, WhichB { height: height + BOTTOM_MARGIN, ..chart }, space, points, commands),
    }
}

/// Space above the letters of a name, points.
const ABOVE_LETTERS_PT: f32 = 3.5;

/// Draws Fig. 3 of the paper: q_1 against b, rad, for the points of the task, or for the target.
fn lines(
    ui: &mut Ui,
    chart: WhichB<'_>,
    space: &Arc<PoseSpace>,
    planes: &Arc<Planes>,
    points: &[(String, Vector)],
    commands: &mut Vec<Command>,
) {
    let WhichB { session, queries, view_state, palette: p, height } = chart;
    let now = session.frame();
    let places: Vec<Vector> = points.iter().map(|(_, x)| *x).collect();
    let branches = queries.ask::<QuickWork<Branches>>(&(ByIdentity(planes.clone()), places.clone()));
    let feasible = queries.ask::<QuickWork<CommonB>>(&(ByIdentity(space.clone()), places));
    let unit = notation::of(ui.ctx()).unit_name("rad");
    which_b_title(ui, p, &format!("q₁ against b, {unit}; click to choose"));
    let map = planes.map();
    let common = feasible.all.as_ref().map(|common| common.shifted_near(now.b_reference));
    let mut bounds = [f64::INFINITY, f64::NEG_INFINITY, f64::INFINITY, f64::NEG_INFINITY];
    let lines: Vec<(&str, Vec<[f64; 2]>)> = points
        .iter()
        .zip(&*branches)
        .flat_map(|((name, _), branches)| branches.iter().map(move |branch| (name.as_str(), branch)))
        .map(|(name, branch)| (name, lifted(map, branch, now.b_reference)))
        .collect();
    for [b, q] in lines.iter().flat_map(|(_, l)| l) {
        bounds = [bounds[0].min(*b), bounds[1].max(*b), bounds[2].min(*q), bounds[3].max(*q)];
    }
    if lines.is_empty() {
        bounds = [0.0, map.period(), -1.0, 1.0];
    }
    let empty = lines.is_empty();
    let b_now = now.b_reference;
    let [b_low, b_high] = [bounds[0].min(b_now) - 0.15, bounds[1].max(b_now) + 0.15];
    let room = 0.18 * (bounds[3] - bounds[2]).max(0.5);
    let [q_low, q_high] = [bounds[2] - room, bounds[3] + room];
    let axis = SmallAxis::of_angle(ui);
    let (across, up) = (axis.between(b_low, b_high), axis.between(q_low, q_high));
    small_axes(ui);
    let response = base_plot("which b", p, height - 16.0)
        .show_axes([true, true])
        .y_grid_spacer(move |_| up.marks(q_low, q_high))
        .x_grid_spacer(move |_| across.marks(b_low, b_high))
        .x_axis_formatter(move |mark, _| across.write(mark.value))
        .y_axis_formatter(move |mark, _| up.write(mark.value))
        .show(ui, |plot| {
            plot.set_plot_bounds_x(b_low..=b_high);
            plot.set_plot_bounds_y(q_low..=q_high);
            for [from, to] in common.iter().flat_map(|c| &c.intervals) {
                let fill = colour(faded(p.amber, 0.16));
                let clear = egui::Stroke::NONE;
                plot.span(Span::new("", *from..=*to).fill(fill).border(clear));
            }
            let last = points.len() - 1;
            for (name, line) in lines {
                // Of more than four points, only the first and the last are named.
                let named = points.len() <= 4 || name == points[0].0 || name == points[last].0;
                if let Some(end) = line.last().filter(|_| named) {
                    let place = PlotPoint::new(end[0], end[1]);
                    let size = plot
                        .ctx()
                        .fonts_mut(|fonts| fonts.layout_no_wrap(name.to_owned(), plain(11.5), colour(p.ink)).size());
                    // The name stands on the other side where it would leave the chart.
                    let frame = plot.response().rect;
                    let share = [(end[0] - b_low) / (b_high - b_low), (q_high - end[1]) / (q_high - q_low)];
                    let at = frame.lerp_inside(share.map(|share| share as f32));
                    let (is_left, is_top) =
                        (at.x - size.x < frame.left(), at.y - size.y + ABOVE_LETTERS_PT < frame.top());
                    let anchor = [
                        [egui::Align2::RIGHT_BOTTOM, egui::Align2::RIGHT_TOP],
                        [egui::Align2::LEFT_BOTTOM, egui::Align2::LEFT_TOP],
                    ][usize::from(is_left)][usize::from(is_top)];
                    let text = RichText::new(name).font(plain(11.5));
                    let text = egui_plot::Text::new("name", place, text).color(colour(p.ink));
                    plot.text(text.anchor(anchor).allow_hover(false));
                }
                let line = Line::new(name.to_owned(), PlotPoints::from(line)).width(1.8);
                let line = line.color(colour(if named { p.ink } else { faded(p.dim, 0.6) }));
                plot.line(line.style(LineStyle::Solid).allow_hover(false));
            }
            if empty {
                let place = PlotPoint::new(0.5 * (b_low + b_high), 0.5 * (q_low + q_high));
                let text = RichText::new("no b reaches it").font(plain(12.0));
                plot.text(egui_plot::Text::new("none", place, text).color(colour(p.dim)).allow_hover(false));
            }
            plot.vline(VLine::new("b", b_now).color(colour(p.amber)).width(1.6).allow_hover(false));
            for (_, x) in points {
                for pose in map.poses(*x, b_now).iter() {
                    let dot = vec![[b_now, map.lift(*pose)[0]]];
                    plot.points(Points::new("pose", dot).radius(4.0).color(colour(p.amber)).allow_hover(false));
                }
            }
            plot.pointer_coordinate().map(|c| c.x)
        });
    name(&response.response, "Which b: q1 against b of each point");
    let preview = response.inner.filter(|_| response.response.hovered());
    if preview != view_state.pointed.preview {
        commands.push(ViewChange::Preview(preview).into());
    }
    let held = response.response.dragged() || response.response.clicked();
    if let (true, Some(b)) = (held, response.inner) {
        commands.push(SessionCommand::Edit(set_b(session, view_state, b)).into());
    }
    if response.response.drag_stopped() || response.response.clicked() {
        commands.push(SessionCommand::EndGesture.into());
    }
}
