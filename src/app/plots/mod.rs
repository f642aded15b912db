//! The panel on the right: signals over time with a common cursor, and the chart *Which b?*.

mod bands;
mod curve;
mod header;
mod hover;
mod menu;
mod prepared;
mod search;
mod shown;
mod small;
mod values;
mod which_b;
mod written;

use egui::{Frame, Margin, Panel, Ui};

use self::header::{HEADER_HEIGHT, STATISTICS_HEIGHT};
use super::{Command, Layout};
use stillbase_picture::charts::figure::{BOTTOM_MARGIN, LEFT_MARGIN, PlotContext};

pub use prepared::{extent, shown_signals};
pub use search::focus;
pub use search::is_looking;
pub use shown::DisplayContext;
pub use small::{base_plot, marks, small_axes, spaced};
pub use written::{figures, written};

/// Default width of the panel: a fraction of the window width, within bounds, points.
const WIDTH_FRACTION: f32 = 0.233;
const MIN_WIDTH_PT: f32 = 272.0;
const MAX_WIDTH_PT: f32 = 640.0;

/// Fraction and upper bound, points, in the layout that compares runs.
const COMPARE_WIDTH_FRACTION: f32 = 0.38;
const COMPARE_MAX_WIDTH_PT: f32 = 1100.0;

/// Space for the scroll bar, which grows when the pointer is near, points.
const SCROLL_BAR_WIDTH_PT: f32 = 12.0;

/// Returns the default width of the panel in a window, points.
fn usual(ui: &Ui, layout: Layout) -> f32 {
    let (share, widest) = if layout == Layout::Compare {
        (COMPARE_WIDTH_FRACTION, COMPARE_MAX_WIDTH_PT)
    } else {
        (WIDTH_FRACTION, MAX_WIDTH_PT)
    };
    (share * ui.ctx().content_rect().width()).clamp(MIN_WIDTH_PT, widest).round()
}

/// Draws this panel; returns the width set by the user, points, if any.
pub fn show(ui: &mut Ui, what: &DisplayContext<'_>, commands: &mut Vec<Command>) -> Option<f32> {
    let DisplayContext { session, queries, signals, view_state, .. } = *what;
    let p = view_state.palette();
    let frame = Frame::new().inner_margin(Margin { left: 14, right: 2, top: 10, bottom: 8 });
    let usual = usual(ui, view_state.arrangement.layout);
    let most = (0.6 * ui.available_width()).max(usual);
    let width = view_state.arrangement.now().plots.width.unwrap_or(usual).min(most);
    // The identifier contains the default width. When the size of the window changes the default, the width that egui
    // remembers no longer applies.
    let salt = ("plots", usual as u32, view_state.arrangement.swapped);
    let panel = if view_state.arrangement.swapped { Panel::left(salt) } else { Panel::right(salt) };
    let panel = panel.default_size(width).size_range(260.0..=most).resizable(true);
    let made = panel.frame(frame).show(ui, |ui| {
        let plots = view_state.plots(session.scenario(), signals);
        search::show(ui, what, &plots, SCROLL_BAR_WIDTH_PT as i8, commands);
        let columns = ((ui.available_width() - SCROLL_BAR_WIDTH_PT - LEFT_MARGIN) * ui.ctx().pixels_per_point())
            .clamp(16.0, 8192.0) as usize;
        let (lines, is_whole) = prepared::drawn(what, &plots, columns);
        if !is_whole {
            ui.ctx().request_repaint();
        }
        let statistics = if view_state.charts.statistics { STATISTICS_HEIGHT } else { 0.0 };
        let rows: usize = plots.iter().map(|plot| plot.shown().count()).sum();
        let taken = (HEADER_HEIGHT + BOTTOM_MARGIN + 13.0) * (plots.len() as f32 + 1.0) + statistics * rows as f32;
        let height = ((ui.available_height() - taken) / (plots.len() as f32 + 1.6)).max(56.0);
        let seen = hover::instant(ui, session);
        // The plots scroll if they do not fit.
        egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            ui.set_width(ui.available_width() - SCROLL_BAR_WIDTH_PT);
            ui.spacing_mut().item_spacing.y = 3.0;
            let mut over = None;
            for (plot, drawn) in plots.iter().zip(&*lines) {
                let marked = view_state.mark.map(|time| shown::instant(session, time));
                let newest = session.frames().last().unwrap_or(session.frame());
                let look =
                    PlotContext { palette: &p, peaks: &newest.peaks, now: session.frame(), mark: marked, hover: seen };
                header::show(ui, plot, drawn, &look, commands);
                let found = curve::show(ui, what, plot, drawn, &look, height + BOTTOM_MARGIN, commands);
                over = found.or(over);
                if view_state.charts.statistics {
                    header::statistics(ui, plot, drawn, &look);
                }
                ui.add_space(4.0);
            }
            hover::remember(ui, over);
            which_b::show(ui, which_b::WhichB { session, queries, view_state, palette: &p, height }, commands);
        });
    });
    view_state.arrangement.now().plots.stored_width(made.response.rect.width(), usual)
}
