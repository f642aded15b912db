//! The place of a plot: a drag of its heading moves it among the others, or out of the panel into a window of its own.

use egui::{CursorIcon, DragAndDrop, Rect, Response, Stroke, Ui};

use crate::theme::colour;
use crate::{Command, ViewChange};
use stillbase_picture::charts::choice::{Plot, PlotChange};
use stillbase_picture::scene::palette::Palette;

/// Width and height of the window of a plot at first, points.
const WINDOW_SIZE_PT: [f32; 2] = [460.0, 260.0];

/// The plot whose heading is dragged, by name.
struct DraggedPlot(String);

/// Begins a drag of a plot by its heading.
pub fn handle_drag(heading: &Response, plot: &Plot<'_>) {
    heading.dnd_set_drag_payload(DraggedPlot(plot.name.clone()));
    if heading.hovered() {
        heading.ctx.set_cursor_icon(CursorIcon::Grab);
    }
}

/// Marks where the dragged plot would go, and puts it there at the release. `places` are the plots of the panel with
/// their rectangles.
pub fn handle_drop(
    ui: &Ui,
    p: &Palette,
    places: &[(String, Rect)],
    columns: usize,
    panel: Rect,
    commands: &mut Vec<Command>,
) {
    let (Some(dragged), Some(pos)) =
        (DragAndDrop::payload::<DraggedPlot>(ui.ctx()), ui.input(|i| i.pointer.hover_pos()))
    else {
        return;
    };
    ui.ctx().set_cursor_icon(CursorIcon::Grabbing);
    let name = &dragged.0;
    let released = ui.input(|i| i.pointer.any_released());
    if released {
        DragAndDrop::clear_payload(ui.ctx());
    }
    if !panel.expand(8.0).contains(pos) {
        if released {
            let [width, height] = WINDOW_SIZE_PT;
            let window = [pos.x - 40.0, pos.y - 12.0, width, height];
            commands.push(ViewChange::Charts(PlotChange::Window(name.clone(), Some(window))).into());
        }
        return;
    }
    // In one column, the halves of a plot are above each other.
    let is_beyond = |rect: &Rect| match columns {
        1 => pos.y > rect.center().y,
        _ => pos.y > rect.bottom() || (pos.y >= rect.top() && pos.x > rect.center().x),
    };
    let before = places.iter().position(|(_, rect)| !is_beyond(rect)).unwrap_or(places.len());
    if released {
        let mut order: Vec<String> = places.iter().map(|(name, _)| name.clone()).collect();
        order.insert(before, String::new());
        order.retain(|other| other != name);
        let put = order.iter().position(String::is_empty).map(|at| std::mem::replace(&mut order[at], name.clone()));
        commands.extend(put.map(|_| Command::View(ViewChange::Charts(PlotChange::Order(order)))));
        return;
    }
    let stroke = Stroke::new(2.0, colour(p.amber));
    let edge = places.get(before).map(|(_, rect)| (rect, false));
    let Some((rect, is_after)) = edge.or(places.last().map(|(_, rect)| (rect, true))) else { return };
    if columns == 1 {
        let y = if is_after { rect.bottom() + 2.0 } else { rect.top() - 2.0 };
        ui.painter().hline(rect.x_range(), y, stroke);
    } else {
        let x = if is_after { rect.right() + 4.0 } else { rect.left() - 5.0 };
        ui.painter().vline(x, rect.y_range(), stroke);
    }
}

/// Returns the order in which a plot has changed places with its neighbour among the plots of the panel; `None` if there
/// is no neighbour on that side.
pub fn moved(plots: &[Plot<'_>], name: &str, down: bool) -> Option<PlotChange> {
    let mut order: Vec<String> =
        plots.iter().filter(|plot| plot.window.is_none()).map(|plot| plot.name.clone()).collect();
    let at = order.iter().position(|other| other == name)?;
    let to = if down { at + 1 } else { at.checked_sub(1)? };
    (to < order.len()).then(|| order.swap(at, to))?;
    Some(PlotChange::Order(order))
}

/// Returns the change that gives a plot a window of its own, beside its place in the panel, `rect`.
pub fn pulled_out(name: &str, rect: Rect) -> PlotChange {
    let [width, height] = WINDOW_SIZE_PT;
    let left = rect.left() - width - 60.0;
    let left = if left > 0.0 { left } else { rect.right() + 40.0 };
    PlotChange::Window(name.to_owned(), Some([left, rect.top().max(60.0), width, height]))
}
