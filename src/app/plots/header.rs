//! The line above a plot: title, unit, and the symbols of its curves with their values. A click on a symbol shows or
//! hides its curve.

use egui::accesskit::Role;
use egui::{Align, Button, CursorIcon, Label, Layout, RichText, Sense, TextWrapMode, Ui, WidgetInfo};

use super::place;
use crate::fit::{fitted, say, width_of};
use crate::theme::{bold, colour, plain};
use crate::{Command, ViewChange};
use stillbase_picture::charts::choice::{Plot, PlotChange, PlotCurve};
use stillbase_picture::charts::drawn::PlotLines;
use stillbase_picture::charts::figure::{PlotContext, pen};
use stillbase_picture::numbers::{at_step, signed};
use stillbase_study::comparison::SignalDifference;

/// Height of the line, points.
pub const HEADER_HEIGHT: f32 = 17.0;
/// Height of a row of statistics, points.
pub const STATISTICS_HEIGHT: f32 = 14.0;

/// Width of a symbol in a row of statistics, points.
const SYMBOL_WIDTH_PT: f32 = 28.0;

/// Width that a long title keeps beside the symbols, points.
const MIN_HEADING_PT: f32 = 100.0;

/// Number of digits omitted where space is short: from none to the number at which only symbols remain.
const ALL_DIGITS: usize = 0;
const SYMBOLS_ONLY: usize = 3;

/// Draws the line above a plot; `has_heading` says whether it has the title, by which the plot is dragged.
pub fn show(
    ui: &mut Ui,
    plot: &Plot<'_>,
    drawn: &PlotLines,
    look: &PlotContext<'_>,
    has_heading: bool,
    commands: &mut Vec<Command>,
) {
    let p = look.palette;
    ui.horizontal(|ui| {
        ui.set_height(HEADER_HEIGHT);
        let gap = ui.spacing().item_spacing.x;
        let wide = |ui: &Ui, text: &str, font| gap + width_of(ui, text, &font);
        let values = |ui: &Ui, fewer: usize| -> f32 {
            plot.curves.iter().map(|curve| wide(ui, &words(plot, curve, drawn, look, fewer), plain(11.5))).sum()
        };
        // Where space is short, digits are omitted first, then the unit, which the tooltips of the values still show.
        let parts = if has_heading { plot.heading_parts() } else { Default::default() };
        let heading = parts.concat();
        // The symbol that comes before a title stands for it.
        let least_heading = match parts[0].is_empty() {
            true => MIN_HEADING_PT,
            false => wide(ui, parts[0].trim_end(), bold(12.5)),
        };
        let unit = plot.unit();
        let room = ui.available_width() - if has_heading { wide(ui, &heading, bold(12.5)) } else { 0.0 };
        let unit_wide = wide(ui, &unit, plain(11.5));
        let fits = |fewer: &usize| values(ui, *fewer) + unit_wide <= room;
        let fewer = (ALL_DIGITS..SYMBOLS_ONLY).find(fits);
        let fewer = fewer.or((values(ui, 2) <= room).then_some(2));
        // Values are worth more than a whole title.
        let beside = |fewer: &usize| values(ui, *fewer) + least_heading <= ui.available_width();
        let fewer = fewer.or((ALL_DIGITS + 1..SYMBOLS_ONLY).find(beside)).unwrap_or(SYMBOLS_ONLY);
        // Where not even the symbols fit beside the title, the title is shortened, and the last symbols give way.
        let least = if has_heading { wide(ui, &heading, bold(12.5)).min(least_heading) } else { 0.0 };
        let mut seen = plot.curves.len();
        let symbols = |ui: &Ui, seen: usize| -> f32 {
            plot.curves[..seen].iter().map(|curve| wide(ui, &words(plot, curve, drawn, look, fewer), plain(11.5))).sum()
        };
        while seen > 0 && symbols(ui, seen) + least > ui.available_width() {
            seen -= 1;
        }
        let taken = symbols(ui, seen);
        if has_heading {
            title(ui, plot, &parts, ui.available_width() - taken, look);
        }
        if taken + unit_wide <= room {
            ui.label(RichText::new(unit).font(plain(11.5)).color(colour(p.dim)));
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            for (i, curve) in plot.curves.iter().enumerate().take(seen).rev() {
                switch(ui, plot, i, curve, words(plot, curve, drawn, look, fewer), look, commands);
            }
        });
    });
}

/// Draws the title in a room of this width, points. A drag of it moves the plot.
fn title(ui: &mut Ui, plot: &Plot<'_>, parts: &[String; 2], room: f32, look: &PlotContext<'_>) {
    let [symbol, words] = parts;
    let heading = parts.concat();
    let font = bold(12.5);
    let shown = fitted(ui, words, &font, room - width_of(ui, symbol, &font));
    let shown = format!("{symbol}{shown}");
    let label = Label::new(RichText::new(shown.trim_end()).font(bold(12.5)).color(colour(look.palette.ink)));
    let label = ui.add(label.wrap_mode(TextWrapMode::Extend).sense(Sense::drag()));
    say(&label, &heading);
    place::handle_drag(&label, plot);
    if !label.dragged() {
        label.on_hover_text(format!("{heading}\nDrag: to another place, or out of the panel into a window of its own"));
    }
}

/// Returns a curve's symbol with its value at the cursor, or with the difference from the second cursor; `fewer`
/// digits are omitted.
fn words(plot: &Plot<'_>, curve: &PlotCurve<'_>, drawn: &PlotLines, look: &PlotContext<'_>, fewer: usize) -> String {
    let signal = curve.signal;
    // The index B is omitted where the plot names the base.
    let symbol = if plot.chart.scale != 1.0 { signal.symbol.trim_end_matches("_B") } else { signal.symbol.as_str() };
    if fewer >= SYMBOLS_ONLY {
        return symbol.into();
    }
    let shown = |value: f64| match plot.added_by_user || curve.added {
        true => at_step(curve.scale * value, 5.0 * drawn.finest() * 10f64.powi(fewer as i32)),
        false => signed(curve.scale * value, curve.decimals.saturating_sub(fewer)),
    };
    match look.mark.map(|marked| SignalDifference::of(signal, marked, look.now)) {
        Some(d) => format!("Δ{symbol} {}", shown(d.difference())),
        None => format!("{symbol} {}", shown(signal.value(look.now))),
    }
}

/// Draws the symbol and value of a curve; a click shows or hides the curve.
fn switch(
    ui: &mut Ui,
    plot: &Plot<'_>,
    i: usize,
    curve: &PlotCurve<'_>,
    text: String,
    look: &PlotContext<'_>,
    commands: &mut Vec<Command>,
) {
    let (p, signal) = (look.palette, curve.signal);
    let tone = if curve.on { pen(plot, i, look).0 } else { p.dim };
    let label = RichText::new(&text).font(plain(11.5)).color(colour(tone));
    let label = if curve.on { label } else { label.strikethrough() };
    ui.spacing_mut().button_padding = egui::Vec2::ZERO;
    let button = ui.add(Button::new(label).frame(false).wrap_mode(TextWrapMode::Extend));
    let called = format!("{text}: {} in {}", signal.label, plot.title);
    button.widget_info(|| WidgetInfo::selected(Role::Switch, true, curve.on, &called));
    let at = |value: f64| signed(curve.scale * value, 4);
    let differs = look.mark.map_or_else(String::new, |marked| {
        let d = SignalDifference::of(signal, marked, look.now);
        format!(": {} at the second cursor, {} now", at(d.from), at(d.to))
    });
    let unit = if curve.unit.is_empty() { String::new() } else { format!(", {}", curve.unit) };
    let verb = if curve.on { "away" } else { "back" };
    let button = button.on_hover_cursor(CursorIcon::PointingHand);
    if button.on_hover_text(format!("{}{unit}{differs}\nClick: {verb}", signal.label)).clicked() {
        let change = PlotChange::Show(plot.name.clone(), signal.path.clone(), !curve.on);
        commands.push(ViewChange::Charts(change).into());
    }
}

/// Draws the statistics of the shown curves over the time range on display: one row each, in columns of equal
/// width.
pub fn statistics(ui: &mut Ui, plot: &Plot<'_>, drawn: &PlotLines, look: &PlotContext<'_>) {
    let p = look.palette;
    let wide = (ui.available_width() - SYMBOL_WIDTH_PT) / 4.0;
    let cell = |ui: &mut Ui, wide: f32, text: String, tone| {
        let label = Label::new(RichText::new(text).font(plain(10.0)).color(colour(tone))).truncate();
        ui.add_sized([wide, STATISTICS_HEIGHT], label.halign(Align::LEFT));
    };
    for (i, curve) in plot.curves.iter().enumerate().filter(|(_, curve)| curve.on) {
        let Some(Some(s)) = drawn.statistics.get(i) else { continue };
        ui.spacing_mut().interact_size.y = STATISTICS_HEIGHT;
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 0.0;
            cell(ui, SYMBOL_WIDTH_PT, curve.signal.symbol.clone(), pen(plot, i, look).0);
            for (word, value) in [("min", s.least), ("max", s.greatest), ("mean", s.mean), ("rms", s.rms)] {
                // Where space is short, digits are omitted.
                let written =
                    |fewer: i32| format!("{word} {}", at_step(value, 5.0 * drawn.finest() * 10f64.powi(fewer)));
                let text = (0..4).map(written).find(|text| width_of(ui, text, &plain(10.0)) <= wide - 2.0);
                cell(ui, wide, text.unwrap_or_else(|| written(4)), p.dim);
            }
        });
    }
}
