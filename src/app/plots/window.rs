//! Plots in windows of their own, over the scene. Their places are saved with the session.

use egui::{Color32, Context, Id, Rect, RichText, Window, pos2, vec2};

use super::cell;
use super::shown::DisplayContext;
use crate::theme::bold;
use crate::{Command, ViewChange};
use stillbase_picture::charts::choice::{Plot, PlotChange};
use stillbase_picture::charts::drawn::PlotLines;
use stillbase_settings::text::cut_at_word;

/// Minimum width and height of a window, points.
const MIN_SIZE_PT: [f32; 2] = [260.0, 160.0];
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

/// Draws the plots that have windows of their own; returns the time under the pointer, s, if it is over one of them.
pub fn show(
    ctx: &Context,
    what: &DisplayContext<'_>,
    plots: &[Plot<'_>],
    lines: &[PlotLines],
    commands: &mut Vec<Command>,
) -> Option<f64> {
    let mut over = None;
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
    let frame = egui::Frame::window(&ctx.global_style()).inner_margin(8);
    let made = Window::new(RichText::new(heading).font(bold(12.5)))
        .id(id.with(known.opened))
        .open(&mut open)
        .collapsible(false)
        .frame(frame)
        .title_frame(frame)
        .default_rect(Rect::from_min_size(pos2(left, top), vec2(width, height)))
        .min_size(MIN_SIZE_PT)
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
