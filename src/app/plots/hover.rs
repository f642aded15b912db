//! The values at the time under the pointer, shown by all plots at once.

use egui::{Grid, Id, RichText, Ui, ViewportId};

use super::shown::{DisplayContext, nearest};
use crate::theme::{bold, colour, plain};
use stillbase_picture::charts::choice::Plot;
use stillbase_picture::charts::drawn::PlotLines;
use stillbase_picture::charts::figure::{PlotContext, pen};
use stillbase_picture::numbers::{at_step, signed};
use stillbase_session::Session;
use stillbase_simulation::frame::Frame;

fn id() -> Id {
    Id::unique("time under the pointer")
}

/// Returns the frame nearest to the time under the pointer in the last pass.
pub fn instant<'a>(ui: &Ui, session: &'a Session) -> Option<&'a Frame> {
    let (_, time): Pointed = ui.data(|data| data.get_temp(id()))?;
    Some(nearest(session, time))
}

/// The window in which the pointer is over a plot, and the time there, s.
type Pointed = (ViewportId, f64);

/// Stores the time under the pointer in this window for the next pass, in which the plots of all windows show it.
pub fn remember(ui: &Ui, over: Option<f64>) {
    let here = ui.ctx().viewport_id();
    let known: Option<Pointed> = ui.data(|data| data.get_temp(id()));
    let now = match (known, over) {
        // The pointer may be in another window.
        (Some((window, _)), None) if window != here => return,
        (_, over) => over.map(|time| (here, time)),
    };
    if known != now {
        ui.data_mut(|data| match now {
            Some(pointed) => _ = data.insert_temp(id(), pointed),
            None => data.remove::<Pointed>(id()),
        });
        // The other windows are drawn after the main one.
        ui.ctx().request_repaint_of(ViewportId::ROOT);
    }
}

/// Draws the values of all curves that are on at an instant, in a card.
pub fn card(
    ui: &mut Ui,
    shown: &DisplayContext<'_>,
    plot: &Plot<'_>,
    drawn: &PlotLines,
    look: &PlotContext<'_>,
    frame: &Frame,
) {
    let p = look.palette;
    let dim = |text: String| RichText::new(text).font(plain(11.5)).color(colour(p.dim));
    let number = |x: f64| at_step(x, drawn.finest());
    let step = shown.session.scenario().step;
    ui.horizontal(|ui| {
        ui.label(RichText::new(format!("{} s", at_step(frame.time, step))).font(bold(11.5)));
        if let Some(marked) = look.mark {
            ui.label(dim(format!("Δt {} s", at_step(frame.time - marked.time, step))));
        }
    });
    Grid::new("values").num_columns(4).spacing([8.0, 2.0]).min_row_height(0.0).show(ui, |ui| {
        if let Some(against) = plot.against {
            ui.label(RichText::new(&against.signal.symbol).font(bold(11.5)).color(colour(p.amber)));
            ui.label(RichText::new(signed(against.value(frame), 4)).font(plain(11.5)));
            ui.label(dim(against.unit.into()));
            ui.end_row();
        }
        for (i, curve) in plot.curves.iter().enumerate().filter(|(_, curve)| curve.on) {
            let tone = colour(pen(plot, i, look).0);
            let value = |frame: &Frame| curve.value(frame);
            ui.label(RichText::new(&curve.signal.symbol).font(bold(11.5)).color(tone));
            ui.label(RichText::new(number(value(frame))).font(plain(11.5)));
            ui.label(dim(curve.unit.into()));
            if let Some(marked) = look.mark {
                ui.label(dim(format!("Δ {}", number(value(frame) - value(marked)))));
            }
            ui.end_row();
        }
    });
    let others = shown.comparison.into_iter().flat_map(|comparison| comparison.shown());
    for (place, run) in others {
        let Some(there) = run.at(frame.time) else { continue };
        let each = plot.shown().filter_map(|curve| {
            // The machine of another run may lack this drive.
            let has = curve.signal.drive.is_none_or(|k| k < run.machine().drives());
            let value = curve.value(there);
            has.then(|| format!("{} {}", curve.signal.symbol, number(value)))
        });
        ui.label(dim(format!("run {}: {}", place + 1, each.collect::<Vec<_>>().join("  "))));
    }
}
