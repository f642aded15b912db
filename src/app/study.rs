//! The study of tolerances at the bottom: tolerances, base moment of many machines, contribution of each tolerance to
//! its variance, spectrum of base reactions.

use egui::{Align, Color32, Frame, Label, Layout, Margin, Panel, RichText, ScrollArea, Sense, Ui, vec2};
use egui_plot::{Bar, BarChart, FilledArea, GridMark, Line, LineStyle, Plot, PlotPoints, VLine};

use super::plots::{base_plot, marks, small_axes, spaced};
use super::theme::{bold, colour, plain};
use super::widgets::{NumberRow, name, send};
use super::{Command, GuidePage, Switch, ViewChange, ViewState, fit, focus, guide};
use stillbase_picture::numbers::{at_step, round_up, signed};
use stillbase_picture::scene::palette::{Palette, faded};
use stillbase_session::Edit;
use stillbase_session::scenario::{Amount, Spread, TaskChange, Value, name_of};
use stillbase_settings::number::counted;
use stillbase_study::tolerance::Study;

const HEIGHT_PT: f32 = 288.0;
/// Widths of the columns of tolerances and of their shares, and of a number with its sign and unit, points.
const SPREADS_WIDTH_PT: f32 = 312.0;
const SHARES_WIDTH_PT: f32 = 244.0;
const NUMBER_WIDTH_PT: f32 = 136.0;

/// Draws this panel.
pub fn show(
    ui: &mut Ui,
    study: Option<&Result<Study, String>>,
    time: f64,
    view_state: &ViewState,
    commands: &mut Vec<Command>,
) {
    let p = view_state.palette();
    let frame = Frame::new().inner_margin(Margin { left: 16, right: 16, top: 8, bottom: 8 });
    let height = HEIGHT_PT.min(0.45 * ui.available_height());
    Panel::bottom("study").exact_size(height).resizable(false).frame(frame).show(ui, |ui| {
        ui.horizontal(|ui| {
            ui.label(RichText::new("Tolerances").font(bold(13.5)));
            guide::button(ui, &p, "tolerances", GuidePage::Tolerances, commands);
            let words = match study {
                Some(Ok(study)) => summary(study),
                Some(Err(_)) => String::new(),
                None => "sampling machines …".into(),
            };
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                if ui.button("Close").on_hover_text("T").clicked() {
                    commands.push(ViewChange::Switch(Switch::Study, false).into());
                }
                ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                    fit::label(ui, &words, plain(11.5), colour(p.dim));
                });
            });
        });
        match study {
            None => {}
            Some(Err(why)) => {
                ui.label(RichText::new(why).color(colour(p.reaction)));
            }
            Some(Ok(study)) => {
                ScrollArea::horizontal().auto_shrink([false, false]).show(ui, |ui| {
                    ui.horizontal_top(|ui| columns(ui, &p, study, time, commands));
                });
            }
        }
    });
}

/// Returns the title line: number of machines, yield, and validity of the first-order estimate.
fn summary(study: &Study) -> String {
    let [machines, numbers] = [counted(study.samples, "machine"), counted(study.parameters, "number")];
    let mut text = format!("{machines}, varied in {numbers} each");
    if let Some(yields) = &study.yields {
        let [low, high] = yields.interval.map(|x| 100.0 * x);
        text += &format!("  ·  {:.1} % keep within limits ({low:.1} to {high:.1} %)", 100.0 * yields.share);
    }
    let (n, f) = (&study.agreement.moment_deviation, &study.agreement.force_mean);
    text += &match n.largest <= study.agreement.tolerance {
        true => "  ·  first order holds for n_B".into(),
        false => format!("  ·  first order is off by {:.2} σ for n_B at {:.3} s", n.largest, n.time),
    };
    if f.largest > study.agreement.sampled_tolerance {
        text += ", not for the mean of |f_B|, which is a norm";
    }
    if !study.left_out.is_empty() {
        text += &format!(
            "  ·  left out: {}; on the command line, tolerance --simulate includes it",
            study.left_out.join(", ")
        );
    }
    text
}

fn columns(ui: &mut Ui, p: &Palette, study: &Study, time: f64, commands: &mut Vec<Command>) {
    let height = ui.available_height() - 4.0;
    let column = |ui: &mut Ui, width: f32, add: &mut dyn FnMut(&mut Ui)| {
        ui.allocate_ui_with_layout(vec2(width, height), Layout::top_down(Align::LEFT), |ui| {
            ui.set_width(width);
            add(ui);
        });
        ui.add_space(10.0);
    };
    let rest = ((ui.available_width() - SPREADS_WIDTH_PT - SHARES_WIDTH_PT - 90.0) / 3.0).max(220.0);
    column(ui, SPREADS_WIDTH_PT, &mut |ui| spreads(ui, p, study, commands));
    column(ui, rest, &mut |ui| band(ui, p, study, time));
    column(ui, rest, &mut |ui| peaks(ui, p, study));
    column(ui, SHARES_WIDTH_PT, &mut |ui| contributions(ui, p, study));
    column(ui, rest, &mut |ui| spectrum(ui, p, study));
}

fn title(ui: &mut Ui, p: &Palette, title: &str, rest: &str) {
    ui.horizontal(|ui| {
        ui.set_height(16.0);
        ui.label(RichText::new(title).font(bold(12.5)));
        fit::label(ui, rest, plain(11.5), colour(p.dim));
    });
}

/// Returns the unit of a tolerance, and the factor from its value to this unit.
fn unit_of(key: &str, amount: Amount) -> (&'static str, f64) {
    let metres = key.starts_with("length") || key.contains(".com");
    match amount {
        Amount::Percent(_) => ("%", 1.0),
        Amount::Absolute(_) if metres => ("mm", 1e3),
        Amount::Absolute(_) if key.ends_with("mass") => ("g", 1e3),
        Amount::Absolute(_) => ("kg m²", 1.0),
    }
}

/// Draws the tolerances, one row each, and the limit on |n_B|.
fn spreads(ui: &mut Ui, p: &Palette, study: &Study, commands: &mut Vec<Command>) {
    title(ui, p, "What varies", "deviation σ, half-width ±");
    let spreads = &study.spreads;
    ScrollArea::vertical().id_salt("spreads").auto_shrink([false, false]).show(ui, |ui| {
        for (key, spread) in spreads {
            let amount = spread.amount();
            let (unit, times) = unit_of(key, amount);
            let (Amount::Absolute(size) | Amount::Percent(size)) = amount;
            let mut value = size * times;
            let sign = if matches!(spread, Spread::Normal(_)) { "σ" } else { "±" };
            let response = row(ui, p, (&name_of(key), sign), unit, key, &mut value);
            send(commands, &[response], || {
                let amount = match amount {
                    Amount::Percent(_) => Amount::Percent(value / times),
                    Amount::Absolute(_) => Amount::Absolute(value / times),
                };
                // The edit contains all tolerances, so that the defaults of the others stay.
                let mut change: TaskChange =
                    spreads.iter().map(|(key, spread)| (key.clone(), spread.to_value())).collect();
                change.insert(key.clone(), spread.with_amount(amount).to_value());
                Edit::of("tolerance", change)
            });
        }
        let mut limit = study.tolerance.moment_limit.unwrap_or(0.0);
        let label = ("limit of the moment, |n_B|", "");
        let response = row(ui, p, label, "N m", "moment_limit: zero for none", &mut limit);
        send(commands, &[response], || {
            let value = if limit > 0.0 { Value::from(limit) } else { Value::from("default") };
            Edit::set("tolerance.moment_limit", value)
        });
        focus::keep_in_view(ui);
    });
}

fn row(
    ui: &mut Ui,
    p: &Palette,
    (label, sign): (&str, &str),
    unit: &str,
    tip: &str,
    value: &mut f64,
) -> egui::Response {
    ui.horizontal(|ui| {
        let room = ui.available_width() - NUMBER_WIDTH_PT;
        fit::label_within(ui, label, plain(11.5), colour(p.ink), room).on_hover_text(tip);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let text = RichText::new(unit).font(plain(11.5)).color(colour(p.dim));
            ui.add_sized([42.0, 18.0], Label::new(text).halign(Align::LEFT));
            let called = format!("Spread of {label}");
            let row =
                NumberRow { label: &called, unit, tip, decimals: 3, speed: 0.01, range: 0.0..=1e3, slide: 0.0..=1e3 };
            let number = row.number(ui, value);
            ui.label(RichText::new(sign).font(plain(11.5)).color(colour(p.dim)));
            number
        })
        .inner
    })
    .inner
}

/// Returns a plot that cannot be dragged or zoomed, with some space above and below.
pub(super) fn bare<'a>(id: &str, p: &Palette, height: f32) -> Plot<'a> {
    base_plot(id, p, height).sense(Sense::hover()).set_margin_fraction(vec2(0.0, 0.05))
}

/// Returns marks at round values of an axis.
fn round_marks(grid: egui_plot::GridInput) -> Vec<GridMark> {
    let [low, high] = [grid.bounds.0, grid.bounds.1];
    // Each mark gets the whole range as its step size, so that egui labels all marks.
    marks(&spaced(low, high), high - low)
}

/// Writes the value of a mark, with as many decimals as the axis needs.
fn round_number(mark: GridMark, range: &std::ops::RangeInclusive<f64>) -> String {
    at_step(mark.value, round_up((range.end() - range.start()) / 5.0))
}

/// Plots the deviation of n_B from that of the nominal machine, N m, over time, s. It shows percentiles 5 to 95 and
/// 25 to 75 over the machines, mean, and first-order standard deviation.
fn band(ui: &mut Ui, p: &Palette, study: &Study, time: f64) {
    title(ui, p, "Moment off nominal", "5–95, 25–75 %");
    let (x, band) = (&study.bands.time, &study.bands.moment);
    let tone = colour(p.reaction);
    let end = x.last().copied().unwrap_or(1.0) + x.first().copied().unwrap_or(0.0);
    small_axes(ui);
    let axes = bare("bands", p, ui.available_height()).show_axes([true, true]);
    let axes = axes.x_grid_spacer(round_marks).x_axis_formatter(round_number);
    let response = axes.x_axis_label("time, s").y_axis_label("n_B, N m").show(ui, |plot| {
        plot.set_plot_bounds_x(0.0..=end);
        for (i, strength) in [(0, 0.16), (1, 0.28)] {
            let [low, high] = [i, 4 - i].map(|i| {
                let off = band.percentiles[i].iter().zip(&band.nominal);
                off.map(|(n, nominal)| n - nominal).collect::<Vec<f64>>()
            });
            let fill = colour(faded(p.reaction, strength));
            plot.add(FilledArea::new("band", x, &low, &high).fill_color(fill).allow_hover(false));
        }
        let line = |y: &dyn Fn(usize) -> f64| PlotPoints::from((0..x.len()).map(|i| [x[i], y(i)]).collect::<Vec<_>>());
        plot.line(
            Line::new("mean", line(&|i| band.mean[i] - band.nominal[i])).color(tone).width(1.6).allow_hover(false),
        );
        for side in [-1.0, 1.0] {
            let sigma = line(&|i| side * band.first_order_deviation[i]);
            let sigma = Line::new("σ", sigma).color(colour(p.ink)).width(1.0).style(LineStyle::dashed_dense());
            plot.line(sigma.allow_hover(false));
        }
        plot.vline(VLine::new("now", time).color(colour(p.amber)).width(1.0).allow_hover(false));
    });
    name(&response.response, "Band of the turning moment on the base over time, N m");
    response.response.on_hover_text(
        "The moment minus the nominal one.\nPale: 5 to 95 % of the machines; full: 25 to 75 %; line: mean; \
         dashed: σ to first order",
    );
}

/// Plots the histogram of peak |n_B|, N m, over the machines.
fn peaks(ui: &mut Ui, p: &Palette, study: &Study) {
    let [_, half, most, nearly] = study.moment.values[..] else { return };
    title(ui, p, "Peak moment", &format!("95 % below {most:.4} N m"));
    let histogram = &study.moment_histogram;
    let within = |x: f64| study.tolerance.moment_limit.is_none_or(|limit| x <= limit);
    let bars = histogram.counts.iter().zip(histogram.edges.windows(2)).map(|(count, w)| {
        let middle = 0.5 * (w[0] + w[1]);
        let tone = if within(middle) { p.dim } else { p.reaction };
        Bar::new(middle, *count as f64).width(0.92 * (w[1] - w[0])).fill(colour(faded(tone, 0.7)))
    });
    let bars: Vec<Bar> = bars.collect();
    small_axes(ui);
    let axes = bare("peaks", p, ui.available_height()).show_axes([true, true]).include_x(0.0).include_y(0.0);
    let axes = axes.x_grid_spacer(round_marks).x_axis_formatter(round_number);
    let response = axes.x_axis_label("peak of |n_B|, N m").y_axis_label("machines").show(ui, |plot| {
        plot.bar_chart(BarChart::new("machines", bars).allow_hover(false));
        plot.vline(VLine::new("half", half).color(colour(p.ink)).width(1.0).allow_hover(false));
        if let Some(limit) = study.tolerance.moment_limit {
            plot.vline(VLine::new("limit", limit).color(colour(p.amber)).width(1.4).allow_hover(false));
        }
    });
    let words = format!("half below {half:.5}, 95 % below {most:.5}, 99 % below {nearly:.5} N m");
    name(&response.response, "Histogram of peaks of the turning moment on the base over machines, N m");
    response.response.on_hover_text(words);
}

/// Draws the contributions of the tolerances: fractions of the first-order variance of n_B, summed over the motion.
fn contributions(ui: &mut Ui, p: &Palette, study: &Study) {
    title(ui, p, "To blame", "share of the variance of n_B");
    let width = ui.available_width();
    ScrollArea::vertical().id_salt("blame").auto_shrink([false, false]).show(ui, |ui| {
        for share in study.shares.iter().take(20).filter(|s| s.moment_share > 5e-4) {
            let (rect, response) = ui.allocate_exact_size(vec2(width - 8.0, 16.0), Sense::hover());
            let bar =
                egui::Rect::from_min_size(rect.min, vec2(rect.width() * share.moment_share as f32, rect.height()));
            ui.painter().rect_filled(bar, 3.0, colour(faded(p.amber, 0.35)));
            let (left, right) = (egui::Align2::LEFT_CENTER, egui::Align2::RIGHT_CENTER);
            let (font, ink) = (plain(11.5), colour(p.ink));
            let percent = format!("{:.1} %", 100.0 * share.moment_share);
            let called = name_of(&share.key);
            let room = rect.width() - fit::width_of(ui, &percent, &font) - 14.0;
            let words = fit::fitted(ui, &called, &font, room);
            ui.painter().text(rect.left_center() + vec2(4.0, 0.0), left, words, font.clone(), ink);
            ui.painter().text(rect.right_center() - vec2(4.0, 0.0), right, percent, font, colour(p.dim));
            let slope = signed(share.moment_slope, 4);
            let unit = share.unit;
            name(&response, &format!("{called} {:.1} %", 100.0 * share.moment_share));
            let deviation = share.deviation;
            response.on_hover_text(format!(
                "{called}, {}\nσ = {deviation:.3e} {unit}; greatest |∂n_B|: {slope} N m/{unit}",
                share.key
            ));
        }
    });
}

/// Plots the amplitude spectral densities of base force, N/√Hz, and base moment, N m/√Hz, over frequency, Hz; both
/// axes are logarithmic.
fn spectrum(ui: &mut Ui, p: &Palette, study: &Study) {
    title(ui, p, "Spectrum", "moment red, forces grey");
    let Some([fx, fy, n]) = &study.spectra else {
        ui.label(RichText::new("this run is too short for it").color(colour(p.dim)));
        return;
    };
    const FLOOR: f64 = 1e-9;
    let line = |s: &stillbase_study::spectrum::Spectrum| {
        let points = s.frequency.iter().zip(&s.density).skip(1);
        points.map(|(f, d)| [f.log10(), d.max(FLOOR).log10()]).collect::<Vec<_>>()
    };
    let lines = [(line(fx), p.dim, "f_x"), (line(fy), p.dim, "f_y"), (line(n), p.reaction, "n")];
    let decade = |mark: GridMark, _: &std::ops::RangeInclusive<f64>| format!("1e{:.0}", mark.value);
    let hertz = |mark: GridMark, _: &std::ops::RangeInclusive<f64>| format!("{}", 10f64.powf(mark.value));
    let whole = |from: f64, to: f64, step: i32| -> Vec<GridMark> {
        let (from, to) = (from.ceil() as i32, to.floor() as i32);
        let marks = (from..=to).filter(|i| i.rem_euclid(step) == 0);
        marks.map(|i| GridMark { value: f64::from(i), step_size: 4.0 }).collect()
    };
    small_axes(ui);
    let response = bare("spectrum", p, ui.available_height())
        .show_axes([true, true])
        .x_grid_spacer(move |g| whole(g.bounds.0, g.bounds.1, 1))
        .y_grid_spacer(move |g| whole(g.bounds.0, g.bounds.1, 2))
        .x_axis_label("frequency, Hz")
        .y_axis_label("N m/√Hz, N/√Hz")
        .x_axis_formatter(hertz)
        .y_axis_formatter(decade)
        .include_y(0.0)
        .include_y(-6.0)
        .show(ui, |plot| {
            for (points, tone, label) in lines {
                let tone: Color32 = colour(tone);
                let style = if label == "f_y" { LineStyle::dashed_dense() } else { LineStyle::Solid };
                let line = Line::new(label, PlotPoints::from(points)).color(tone).width(1.4).style(style);
                plot.line(line.allow_hover(false));
            }
        });
    name(&response.response, "Amplitude spectral density of base force and moment");
    response.response.on_hover_text("Red: turning moment, N m/√Hz; grey: force along x, dashed along y, N/√Hz");
}
