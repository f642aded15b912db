//! A plot with its curves, and its pointer gestures: a click shows an instant, the wheel with Ctrl zooms.

use egui::accesskit::Role;
use egui::{CursorIcon, Id, PointerButton, Response, Sense, Ui, vec2};

use super::prepared::extent;
use super::shown::DisplayContext;
use super::{hover, menu, values};
use crate::theme::colour;
use crate::{Command, SessionCommand, ViewChange};
use stillbase_picture::charts::choice::{Plot, PlotChange};
use stillbase_picture::charts::drawn::PlotLines;
use stillbase_picture::charts::figure::{Axes, FigureItem, PlotContext, body};
use stillbase_picture::numbers::at_step;
use stillbase_picture::paint::figure::items;
use stillbase_picture::scene::palette::faded;

/// Distance within which a cursor can be grabbed, points.
const GRAB_DISTANCE_PT: f32 = 5.0;

/// Object of a drag in a plot.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Hold {
    /// The cursor at the time on display.
    Now,
    /// The second cursor.
    Mark,
    /// The plot, which pans.
    Plot,
    /// The selection of a time range that begins at this time, s.
    Range(f64),
}

/// Draws a plot. Returns the time under the pointer, s, if it is over the curves and the horizontal axis is time.
pub fn show(
    ui: &mut Ui,
    shown: &DisplayContext<'_>,
    plot: &Plot<'_>,
    drawn: &PlotLines,
    look: &PlotContext<'_>,
    height: f32,
    commands: &mut Vec<Command>,
) -> Option<f64> {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), height), Sense::click_and_drag());
    let axes = Axes::within([0.0, 2.0, rect.width(), rect.height()], drawn);
    let p = look.palette;
    let time_at = |pos: egui::Pos2| match plot.against {
        None => axes.x_at(pos.x - rect.left()).clamp(axes.x[0], axes.x[1]).max(0.0),
        Some(_) => shown.session.frame().time,
    };
    describe(&response, plot, look);
    if ui.is_rect_visible(rect) {
        let painter = ui.painter_at(rect.expand2(vec2(10.0, 2.0)));
        if let Some(Hold::Range(from)) = held(ui, &response)
            && let Some(pos) = response.interact_pointer_pos()
        {
            let [a, b] = [from, time_at(pos)].map(|time| axes.place([time, 0.0])[0]);
            let sides = [a.min(b), axes.sides[1], a.max(b), axes.sides[3]];
            items(&painter, rect.min, &axes, &[FigureItem::Rectangle { sides, colour: faded(p.amber, 0.18) }]);
        }
        items(&painter, rect.min, &axes, &body(plot, drawn, &axes, look));
        if response.has_focus() {
            let stroke = egui::Stroke::new(1.0, colour(p.amber));
            painter.rect_stroke(rect.shrink(0.5), 4.0, stroke, egui::StrokeKind::Inside);
        }
    }
    // Gestures on the axis numbers change the value range; all others change the time.
    let on_values =
        held(ui, &response).is_none() && values::handle_gestures(ui, plot, drawn, &axes, &response, commands);
    if !on_values {
        if plot.against.is_none() {
            drag(ui, shown, &response, &axes, time_at, commands);
        }
        zoom(ui, shown, &response, time_at, commands);
        if plot.values.is_some() && response.double_clicked_by(PointerButton::Primary) {
            commands.push(ViewChange::Charts(PlotChange::Values(plot.name.clone(), None)).into());
        }
    }
    menu::show(ui, shown, plot, &response, commands);
    let over = response.hover_pos().filter(|_| plot.against.is_none() && !response.context_menu_opened());
    let over = over.filter(|pos| !values::are_at(&response, *pos));
    if let (Some(_), Some(frame)) = (over, look.hover)
        && !response.dragged()
    {
        response.clone().on_hover_ui_at_pointer(|ui| hover::card(ui, shown, plot, drawn, look, frame));
    }
    over.map(time_at)
}

/// Describes the plot to a screen reader: the title, and the values at the time on display.
fn describe(response: &Response, plot: &Plot<'_>, look: &PlotContext<'_>) {
    let over = plot.against.map_or_else(|| "over time".into(), |across| format!("over {}", across.signal.label));
    let label = format!("{} {over}, {}", plot.title, plot.unit());
    let value = |curve: &stillbase_picture::charts::choice::PlotCurve<'_>| {
        format!("{} {}", curve.signal.symbol, at_step(curve.value(look.now), 1e-3))
    };
    let values: Vec<String> = plot.shown().map(value).collect();
    let at = format!("at {} s: {}", at_step(look.now.time, 1e-3), values.join(", "));
    response.ctx.accesskit_node_builder(response.id, |node| {
        node.set_role(Role::Figure);
        node.set_label(label);
        node.set_value(at);
    });
}

fn hold_id() -> Id {
    Id::unique("hold on a plot")
}

/// Returns the object of the present drag, if the drag began in this plot.
fn held(ui: &Ui, response: &Response) -> Option<Hold> {
    let (of, hold): (Id, Hold) = ui.data(|data| data.get_temp(hold_id()))?;
    (of == response.id).then_some(hold)
}

fn drag(
    ui: &Ui,
    shown: &DisplayContext<'_>,
    response: &Response,
    axes: &Axes,
    time_at: impl Fn(egui::Pos2) -> f64,
    commands: &mut Vec<Command>,
) {
    let (session, view_state) = (shown.session, shown.view_state);
    let extent = extent(session);
    let shift = ui.input(|i| i.modifiers.shift);
    let is_near = |time: f64, pos: egui::Pos2| {
        (axes.place([time, 0.0])[0] + response.rect.left() - pos.x).abs() <= GRAB_DISTANCE_PT
    };
    // If both cursors coincide, the second one is dragged.
    let hold_at = |pos: egui::Pos2| match view_state.mark {
        _ if shift => Hold::Range(time_at(pos)),
        Some(mark) if is_near(mark, pos) => Hold::Mark,
        _ if is_near(session.frame().time, pos) || extent.is_all(axes.x) => Hold::Now,
        _ => Hold::Plot,
    };
    if response.drag_started_by(PointerButton::Primary)
        && let Some(origin) = ui.input(|i| i.pointer.press_origin())
    {
        ui.data_mut(|data| data.insert_temp(hold_id(), (response.id, hold_at(origin))));
    }
    if ui.input(|i| i.key_pressed(egui::Key::Escape)) {
        ui.data_mut(|data| data.remove::<(Id, Hold)>(hold_id()));
    }
    let hold = held(ui, response);
    if let Some(pos) = response.hover_pos() {
        ui.ctx().set_cursor_icon(match hold.unwrap_or_else(|| hold_at(pos)) {
            Hold::Plot if hold.is_some() => CursorIcon::Grabbing,
            Hold::Plot => CursorIcon::Grab,
            Hold::Range(_) => CursorIcon::Crosshair,
            Hold::Now | Hold::Mark if is_near(session.frame().time, pos) || hold.is_some() => {
                CursorIcon::ResizeHorizontal
            }
            Hold::Mark => CursorIcon::ResizeHorizontal,
            Hold::Now => CursorIcon::Default,
        });
    }
    if let (Some(hold), Some(pos)) = (hold, response.interact_pointer_pos())
        && (response.dragged_by(PointerButton::Primary) || response.drag_stopped_by(PointerButton::Primary))
    {
        match hold {
            Hold::Now => commands.push(SessionCommand::Seek(time_at(pos)).into()),
            Hold::Mark => commands.push(ViewChange::Mark(Some(time_at(pos))).into()),
            Hold::Plot if response.drag_delta().x != 0.0 => {
                let [left, _, right, _] = axes.sides;
                let by = -f64::from(response.drag_delta().x / (right - left)) * (axes.x[1] - axes.x[0]);
                commands.push(ViewChange::Charts(PlotChange::Range(Some(extent.panned(axes.x, by)))).into());
            }
            Hold::Range(from) if response.drag_stopped() => {
                let range = extent.between(from, time_at(pos));
                commands.extend(range.map(|range| Command::View(ViewChange::Charts(PlotChange::Range(Some(range))))));
            }
            Hold::Plot | Hold::Range(_) => {}
        }
    }
    if response.drag_stopped() {
        ui.data_mut(|data| data.remove::<(Id, Hold)>(hold_id()));
    }
    if response.double_clicked_by(PointerButton::Primary) && !shift {
        commands.push(ViewChange::Charts(PlotChange::Range(extent.all(view_state.charts.range))).into());
    } else if let Some(pos) = response.interact_pointer_pos().filter(|_| response.clicked_by(PointerButton::Primary)) {
        commands.push(match shift {
            true => Command::View(ViewChange::Mark(Some(time_at(pos)))),
            false => Command::Session(SessionCommand::Seek(time_at(pos))),
        });
    }
}

/// Ctrl and the wheel, or a pinch, zoom about the time under the pointer; the wheel sideways, or with Shift, pans. The
/// plain wheel scrolls the panel.
fn zoom(
    ui: &Ui,
    shown: &DisplayContext<'_>,
    response: &Response,
    time_at: impl Fn(egui::Pos2) -> f64,
    commands: &mut Vec<Command>,
) {
    let Some(pos) = response.hover_pos() else { return };
    let extent = extent(shown.session);
    let chosen = shown.view_state.charts.range;
    let range = extent.shown(chosen);
    let (zoom, across) = ui.input(|i| (f64::from(i.zoom_delta()), f64::from(i.smooth_scroll_delta().x)));
    let mut next = chosen;
    if (zoom - 1.0).abs() > 1e-6 {
        next = extent.zoomed(range, time_at(pos), zoom);
    } else if across != 0.0 && !extent.is_all(range) {
        let by = -across / f64::from(response.rect.width().max(1.0)) * (range[1] - range[0]);
        next = Some(extent.panned(range, by));
    }
    if next != chosen {
        commands.push(ViewChange::Charts(PlotChange::Range(next)).into());
    }
}
