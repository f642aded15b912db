//! Plots in windows of their own: of the desktop, or where it shows one window only, over the scene. Their places are
//! saved with the session.

use egui::{CentralPanel, Color32, Context, Frame, Id, Rect, RichText, Ui, ViewportId, Window, pos2, vec2};

use super::shown::DisplayContext;
use super::{cell, hover, prepared};
use crate::theme::{bold, colour};
use crate::{Command, ViewChange};
use stillbase_picture::charts::choice::{Plot, PlotChange};
use stillbase_picture::charts::drawn::PlotLines;
use stillbase_settings::text::{cut_at_word, shorten_message};

/// Minimum width and height of a window, points.
pub const MIN_PLOT_WINDOW_PT: [f32; 2] = [260.0, 160.0];
/// Margin around the plot, points.
const MARGIN_PT: i8 = 8;
/// Width beside the title: margins and the button that closes the window, points.
const TITLE_MARGINS_PT: f32 = 64.0;
/// Least move of a window that is saved, points.
const MIN_MOVE_PT: f32 = 0.5;

/// What egui knows of a window.
#[derive(Clone, Copy, Default)]
struct KnownWindow {
    /// Its place that was saved last.
    saved: [f32; 4],
    /// Number of times that the session set another place. As part of the id it makes egui forget the old place.
    opened: u32,
}

/// A plot that has a window of the desktop.
#[derive(Clone, Debug, PartialEq)]
pub struct PlotWindow {
    /// Of the window, for egui.
    pub id: ViewportId,
    /// Name of the plot.
    pub name: String,
    /// Title of the window: the plot and the run.
    pub title: String,
    /// Left and top from the corner of the main window, width and height, points.
    pub place: [f32; 4],
    /// Left and top on the desktop, pixels, if it has had a place there.
    pub desktop: Option<[i32; 2]>,
}

impl PlotWindow {
    /// Returns the window of a plot of a run, if it has one.
    pub fn of(plot: &Plot<'_>, run: &str) -> Option<Self> {
        let place = plot.window?;
        let title = shorten_message(&format!("{} – {run}", plot.heading())).into();
        Some(Self { id: viewport(&plot.name), name: plot.name.clone(), title, place, desktop: plot.desktop })
    }
}

/// Returns the identifier of a plot's window of the desktop.
pub fn viewport(name: &str) -> ViewportId {
    ViewportId::from_hash_of(("plot in a window", name))
}

/// Draws the plot of a window of the desktop, which it fills.
pub fn alone(ui: &mut Ui, what: &DisplayContext<'_>, id: ViewportId, commands: &mut Vec<Command>) {
    let palette = what.view_state.palette();
    let plots = what.view_state.plots(what.session.scenario(), what.signals);
    let lines = prepared::of_last_width(ui.ctx(), what, &plots);
    let mut over = None;
    CentralPanel::default().frame(Frame::new().fill(colour(palette.panel)).inner_margin(MARGIN_PT)).show(ui, |ui| {
        let frames = cell::Frames::of(ui, what);
        ui.spacing_mut().item_spacing.y = 3.0;
        for (plot, drawn) in plots.iter().zip(&*lines).filter(|(plot, _)| viewport(&plot.name) == id) {
            over = cell::show(ui, what, plot, drawn, &frames.look(&palette), None, commands);
        }
    });
    hover::remember(ui, over);
}

/// Draws the plots that have windows over the scene; returns the time under the pointer, s, if it is over one of them.
pub fn show(
    ctx: &Context,
    what: &DisplayContext<'_>,
    plots: &[Plot<'_>],
    lines: &[PlotLines],
    commands: &mut Vec<Command>,
) -> Option<f64> {
    let mut over = None;
    if !ctx.embed_viewports() {
        return over;
    }
    for (plot, drawn) in plots.iter().zip(lines) {
        let Some(window) = plot.window else { continue };
        over = one(ctx, what, plot, window, drawn, commands).or(over);
    }
    over
}

fn one(
    ctx: &Context,
    what: &DisplayContext<'_>,
    plot: &Plot<'_>,
    window: [f32; 4],
    drawn: &PlotLines,
    commands: &mut Vec<Command>,
) -> Option<f64> {
    let id = Id::unique(("plot in a window", &plot.name));
    let mut known: KnownWindow = ctx.data(|data| data.get_temp(id)).unwrap_or_default();
    let differs = |a: [f32; 4], b: [f32; 4]| a.iter().zip(b).any(|(a, b)| (a - b).abs() > MIN_MOVE_PT);
    if differs(known.saved, window) {
        known = KnownWindow { saved: window, opened: known.opened + 1 };
    }
    let [left, top, width, height] = window;
    let (mut open, mut over) = (true, None);
    let heading = fitted_title(ctx, &plot.heading(), width - TITLE_MARGINS_PT);
    let frame = Frame::window(&ctx.global_style()).inner_margin(MARGIN_PT);
    let made = Window::new(RichText::new(heading).font(bold(12.5)))
        .id(id.with(known.opened))
        .open(&mut open)
        .collapsible(false)
        .frame(frame)
        .title_frame(frame)
        .default_rect(Rect::from_min_size(pos2(left, top), vec2(width, height)))
        .min_size(MIN_PLOT_WINDOW_PT)
        .show(ctx, |ui| {
            let frames = cell::Frames::of(ui, what);
            let palette = what.view_state.palette();
            ui.spacing_mut().item_spacing.y = 3.0;
            over = cell::show(ui, what, plot, drawn, &frames.look(&palette), None, commands);
        });
    let mut change = |window| commands.push(ViewChange::Charts(PlotChange::Window(plot.name.clone(), window)).into());
    if !open {
        change(None);
    } else if let Some(made) = made
        && !ctx.input(|i| i.pointer.any_down())
    {
        let rect = made.response.rect;
        let now = [rect.left(), rect.top(), rect.width(), rect.height()];
        if differs(known.saved, now) {
            known.saved = now;
            change(Some(now));
        }
    }
    ctx.data_mut(|data| data.insert_temp(id, known));
    over
}

/// Returns a title that fits a width, points, shortened at a word.
fn fitted_title(ctx: &Context, title: &str, room: f32) -> String {
    let width = |part: &str| {
        let part = part.to_owned();
        ctx.fonts_mut(|fonts| fonts.layout_no_wrap(part, bold(12.5), Color32::WHITE).size().x)
    };
    cut_at_word(title, |part| width(part) <= room).into_owned()
}
