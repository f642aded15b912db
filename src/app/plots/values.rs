//! Gestures on the axis numbers beside a plot, which zoom and pan its value range.

use egui::{CursorIcon, Key, PointerButton, Pos2, Rect, Response, Sense, Ui, pos2};

use crate::{Command, ViewChange};
use stillbase_picture::charts::choice::{Plot, PlotChange};
use stillbase_picture::charts::drawn::PlotLines;
use stillbase_picture::charts::figure::{Axes, LEFT_MARGIN};

/// Minimum and maximum of the visible value range, as fractions of the range of all values.
const MIN_SPAN: f64 = 1e-3;
const MAX_SPAN: f64 = 30.0;
/// Logarithm of the zoom factor for each point of scrolling.
const LOG_ZOOM_PER_PT: f64 = 0.004;

const TIP: &str = "Drag: along the values\nCtrl wheel, or Alt wheel on the plot: closer\nDouble click: all of them";

/// Handles the gestures; returns whether the pointer is on the numbers or drags them.
pub fn handle_gestures(
    ui: &Ui,
    plot: &Plot<'_>,
    drawn: &PlotLines,
    axes: &Axes,
    response: &Response,
    commands: &mut Vec<Command>,
) -> bool {
    let rect = response.rect;
    let numbers = Rect::from_min_max(rect.min, pos2(rect.left() + LEFT_MARGIN - 2.0, rect.bottom()));
    let id = response.id.with("values");
    let mut ask = |values: Option<[f64; 2]>| {
        commands.push(ViewChange::Charts(PlotChange::Values(plot.name.clone(), values)).into());
    };
    let [low, high] = drawn.y;
    let [_, top, _, bottom] = axes.sides;
    // The value range at the start of the drag, if a drag is under way.
    let mut held: Option<Option<[f64; 2]>> = ui.data(|data| data.get_temp(id));
    let origin = ui.input(|i| i.pointer.press_origin());
    if response.drag_started_by(PointerButton::Primary) && origin.is_some_and(|at| numbers.contains(at)) {
        held = Some(plot.values);
        ui.data_mut(|data| data.insert_temp(id, plot.values));
    }
    if let Some(before) = held {
        ui.ctx().set_cursor_icon(CursorIcon::Grabbing);
        let by = f64::from(response.drag_delta().y / (bottom - top).max(1.0)) * (high - low);
        if by != 0.0 {
            ask(Some([low + by, high + by]));
        }
        let cancelled = ui.input(|i| i.key_pressed(Key::Escape));
        if cancelled {
            ask(before);
        }
        if cancelled || response.drag_stopped() || !response.dragged() {
            ui.data_mut(|data| data.remove::<Option<[f64; 2]>>(id));
        }
        return true;
    }
    let Some(pos) = response.hover_pos() else { return false };
    let on = numbers.contains(pos);
    let factor = wheel_zoom(ui, on);
    if (factor - 1.0).abs() > 1e-6 {
        ask(zoomed(drawn, axes.y_at(pos.y - rect.top()), factor));
    }
    if on {
        ui.interact(numbers, id.with("numbers"), Sense::hover()).on_hover_text(TIP);
        ui.ctx().set_cursor_icon(CursorIcon::ResizeVertical);
        if response.double_clicked_by(PointerButton::Primary) {
            ask(None);
        }
    }
    on
}

/// Returns the factor by which the wheel zooms the values; 1 if it does not. The plain wheel scrolls the panel.
fn wheel_zoom(ui: &Ui, on_numbers: bool) -> f64 {
    ui.input_mut(|i| {
        if on_numbers && i.zoom_delta() != 1.0 {
            return f64::from(i.zoom_delta());
        }
        if !i.modifiers.alt {
            return 1.0;
        }
        let by = f64::from(std::mem::take(&mut i.smooth_scroll_delta.y));
        (LOG_ZOOM_PER_PT * by).exp()
    })
}

/// Returns the value range zoomed by a factor about a value, which keeps its position; `None` if the range is not
/// finite.
fn zoomed(drawn: &PlotLines, about: f64, factor: f64) -> Option<[f64; 2]> {
    let [low, high] = drawn.y;
    let all = drawn.all[1] - drawn.all[0];
    let span = ((high - low) / factor.max(1e-6)).clamp(MIN_SPAN * all, MAX_SPAN * all);
    let share = ((about - low) / (high - low)).clamp(0.0, 1.0);
    let from = about.clamp(low, high) - share * span;
    let values = [from, from + span];
    values.iter().all(|x| x.is_finite()).then_some(values)
}

/// Whether a position is on the axis numbers of a plot.
pub fn are_at(response: &Response, pos: Pos2) -> bool {
    pos.x < response.rect.left() + LEFT_MARGIN - 2.0
}
