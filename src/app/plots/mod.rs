//! The panel on the right: signals over time with a common cursor, and the chart *Which b?*.

mod bands;
mod cell;
mod curve;
mod header;
mod hover;
mod legend;
mod menu;
mod place;
mod prepared;
mod search;
mod shown;
mod small;
mod values;
mod which_b;
mod window;
mod written;

use egui::{Frame, Margin, Panel, Rect, Ui, vec2};

use self::header::{HEADER_HEIGHT, STATISTICS_HEIGHT};
use super::side::is_narrow;
use super::sketching::waits;
use super::{Command, Layout, focus};
use stillbase_picture::charts::choice::Plot;
use stillbase_picture::charts::drawn::PlotLines;
use stillbase_picture::charts::figure::BOTTOM_MARGIN;

pub use prepared::{extent, shown_signals};
pub use search::focus;
pub use search::is_looking;
pub use shown::DisplayContext;
pub use small::{base_plot, marks, small_axes, spaced};
pub use window::{MIN_PLOT_WINDOW_PT, PlotWindow, alone};
pub use written::{figure, figures, no_plot, values};

/// Default width of the panel: a fraction of the window width, within bounds, points.
const WIDTH_FRACTION: f32 = 0.233;
const MIN_WIDTH_PT: f32 = 272.0;
const MAX_WIDTH_PT: f32 = 640.0;
/// Minimum of the default width in a window that is narrow, points.
const NARROW_WIDTH_PT: f32 = 240.0;

/// Fraction and upper bound, points, in the layout that compares runs.
const COMPARE_WIDTH_FRACTION: f32 = 0.45;
const COMPARE_MAX_WIDTH_PT: f32 = 1400.0;

/// Minimum width of a column of plots, points, and maximum number of columns.
const MIN_COLUMN_PT: f32 = 308.0;
const MAX_COLUMNS: f32 = 4.0;
/// Space between the items of a line, and between columns of plots, points.
const ITEM_GAP_PT: f32 = 8.0;
const COLUMN_GAP_PT: f32 = 12.0;

/// Minimum width that the user can give the panel, points.
const MIN_PANEL_PT: f32 = 232.0;

/// Space for the scroll bar, which grows when the pointer is near, points.
const SCROLL_BAR_WIDTH_PT: f32 = 12.0;

/// Returns the default width of the panel in a window, points.
fn usual(ui: &Ui, layout: Layout) -> f32 {
    let (share, widest) = if layout == Layout::Compare {
        (COMPARE_WIDTH_FRACTION, COMPARE_MAX_WIDTH_PT)
    } else {
        (WIDTH_FRACTION, MAX_WIDTH_PT)
    };
    let least = if is_narrow(ui) { NARROW_WIDTH_PT } else { MIN_WIDTH_PT };
    (share * ui.ctx().content_rect().width()).clamp(least, widest).round()
}

/// Returns the number of columns in which plots fill a width, points.
fn columns_in(width: f32) -> usize {
    (width / MIN_COLUMN_PT).floor().clamp(1.0, MAX_COLUMNS) as usize
}

/// Draws the plots of the main window: those with windows in it, and in the panel the others. Returns the width of the panel set by
/// the user, points, if any.
pub fn show(ui: &mut Ui, what: &DisplayContext<'_>, has_panel: bool, commands: &mut Vec<Command>) -> Option<f32> {
    let DisplayContext { session, signals, view_state, .. } = *what;
    let plots = view_state.plots(session.scenario(), signals);
    let arrangement = &view_state.arrangement;
    let usual = usual(ui, arrangement.layout);
    let most = (0.6 * ui.available_width()).max(usual);
    let stored = arrangement.now().plots.width;
    if !has_panel {
        if ui.ctx().embed_viewports() && plots.iter().any(|plot| plot.window.is_some()) {
            let lines = prepared::of_width(ui.ctx(), what, &plots, 0.0);
            let over = window::show(ui.ctx(), what, &plots, &lines, commands);
            hover::remember(ui, over);
            focus::keep_in_view(ui);
        }
        return stored;
    }
    // The identifier contains the default width. When the size of the window changes the default, the width that egui
    // remembers no longer applies.
    let salt = ("plots", usual as u32, arrangement.swapped);
    let panel = if arrangement.swapped { Panel::left(salt) } else { Panel::right(salt) };
    let panel = panel.default_size(stored.unwrap_or(usual).min(most)).size_range(MIN_PANEL_PT..=most).resizable(true);
    let frame = Frame::new().inner_margin(Margin { left: 14, right: 2, top: 10, bottom: 8 });
    let made = panel.frame(frame).show(ui, |ui| {
        if session.run().unfinished().is_some() {
            ui.set_max_width(ui.available_width() - SCROLL_BAR_WIDTH_PT);
            waits::panel(ui, "Its plots stand", &view_state.palette());
            return;
        }
        search::show(ui, what, &plots, SCROLL_BAR_WIDTH_PT as i8, commands);
        let room = ui.available_width() - SCROLL_BAR_WIDTH_PT;
        legend::show(ui, what, room);
        let columns = columns_in(room);
        let width = (room - (columns - 1) as f32 * COLUMN_GAP_PT) / columns as f32;
        let lines = prepared::of_width(ui.ctx(), what, &plots, width);
        let over = window::show(ui.ctx(), what, &plots, &lines, commands);
        let whole = ui.available_rect_before_wrap();
        // The plots scroll if they do not fit.
        egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            ui.set_width(room);
            let all: Vec<_> = plots.iter().zip(&*lines).filter(|(plot, _)| plot.window.is_none()).collect();
            let over = panel_plots(ui, what, &all, columns, whole, commands).or(over);
            hover::remember(ui, over);
        });
    });
    arrangement.now().plots.stored_width(made.response.rect.width(), usual)
}

/// Draws the plots of the panel in columns, and the chart *Which b?* after them. Returns the time under the pointer, s,
/// if it is over a plot.
fn panel_plots(
    ui: &mut Ui,
    what: &DisplayContext<'_>,
    all: &[(&Plot<'_>, &PlotLines)],
    columns: usize,
    panel: Rect,
    commands: &mut Vec<Command>,
) -> Option<f64> {
    let DisplayContext { session, queries, view_state, .. } = *what;
    let p = view_state.palette();
    let statistics = if view_state.charts.statistics { STATISTICS_HEIGHT } else { 0.0 };
    let curves: usize = all.iter().map(|(plot, _)| plot.shown().count()).sum();
    let rows = (all.len() + 1).div_ceil(columns) as f32;
    let taken = (HEADER_HEIGHT + BOTTOM_MARGIN + 13.0) * rows + statistics * curves as f32 / columns as f32;
    let height = ((panel.height() - taken) / (rows + 0.6)).max(56.0);
    let frames = cell::Frames::of(ui, what);
    let mut over = None;
    let mut places = Vec::with_capacity(all.len());
    ui.spacing_mut().item_spacing = vec2(COLUMN_GAP_PT, 3.0);
    ui.columns(columns, |uis| {
        for (i, (plot, drawn)) in all.iter().enumerate() {
            let ui = &mut uis[i % columns];
            ui.spacing_mut().item_spacing.x = ITEM_GAP_PT;
            let look = frames.look(&p);
            let shown = ui.scope(|ui| cell::show(ui, what, plot, drawn, &look, Some(height + BOTTOM_MARGIN), commands));
            over = shown.inner.or(over);
            places.push((plot.name.clone(), shown.response.rect));
            ui.add_space(4.0);
        }
        let ui = &mut uis[all.len() % columns];
        ui.spacing_mut().item_spacing.x = ITEM_GAP_PT;
        which_b::show(ui, which_b::WhichB { session, queries, view_state, palette: &p, height }, commands);
    });
    place::handle_drop(ui, &p, &places, columns, panel, commands);
    over
}
