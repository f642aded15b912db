//! The panel on the right: signals over time with one cursor, and which b serves a target.

use egui::{Align, Color32, Frame, Layout, Margin, Panel, RichText, Ui};
use egui_plot::{GridMark, Line, LineStyle, Plot, PlotPoint, PlotPoints, Points, Span, VLine};

use super::theme::{bold, colour, plain};
use super::widgets::name;
use super::{Command, ViewState, set_b};
use crate::mechanics::planar::Vector;
use crate::picture::charts::{self, Chart, charts};
use crate::picture::numbers::{round_up, signed};
use crate::picture::scene::palette::{Palette, faded};
use crate::planning::reactionless::PlanePoint;
use crate::session::Session;
use crate::simulation::frame::Frame as Instant;
use crate::simulation::signals::Signal;
use crate::study::comparison::{Comparison, Difference};

/// How wide the panel is made by itself, points.
const USUAL: f32 = 336.0;
/// The least height of a plot that has three numbers beside it.
const THREE_NUMBERS: f32 = 50.0;
/// The longest stretch of time shown at once, s.
const WINDOW: f64 = 12.0;
/// The most points of a line.
const POINTS: usize = 600;

/// Draws this panel; how wide it was made.
pub fn show(
    ui: &mut Ui,
    session: &Session,
    signals: &[Signal],
    comparison: Option<&Comparison>,
    view_state: &ViewState,
    commands: &mut Vec<Command>,
) -> Option<f32> {
    let p = view_state.palette();
    let frame = Frame::new().fill(colour(p.panel)).inner_margin(Margin { left: 14, right: 14, top: 10, bottom: 8 });
    let most = (0.6 * ui.available_width()).max(USUAL);
    let width = view_state.plots.width.unwrap_or(USUAL).min(most);
    let panel = Panel::right("plots").default_size(width).size_range(260.0..=most).resizable(true);
    let shown = panel.frame(frame).show(ui, |ui| {
        let mut charts = charts(session.scenario());
        charts.retain(|chart| chart.in_window(view_state.pins));
        let rows = charts.len() as f32 + 1.6;
        let height = ((ui.available_height() - 32.0 * (charts.len() as f32 + 1.0)) / rows).max(44.0);
        let end = session.frames().last().map_or(0.0, |f| f.time).max(session.length());
        let end = if session.is_led() { end.max(1.0) } else { end };
        // Where an instant far back is shown, the plots show the time around it.
        let end = end.min((session.frame().time + 0.5 * WINDOW).max(WINDOW));
        let shown = (end - WINDOW).max(0.0)..=end;
        // Where there is no room for all of them, they scroll.
        egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            for chart in &charts {
                let lines: Vec<&Signal> = signals.iter().filter(|s| chart.holds(s)).collect();
                let marked = view_state.mark.map(|time| instant(session, time));
                header(ui, &p, chart, &lines, session.frame(), marked);
                time_plot(ui, &p, chart, &lines, session, comparison, view_state.mark, &shown, height, commands);
            }
            which_b(ui, &p, session, view_state, height * 1.6 + 14.0, commands);
        });
    });
    view_state.plots.made(shown.response.rect.width(), USUAL)
}

/// The frame at a time, s, or the nearest.
fn instant(session: &Session, time: f64) -> &Instant {
    let frames = session.frames();
    &frames[frames.partition_point(|f| f.time <= time + 1e-9).saturating_sub(1)]
}

/// Title and unit on the left; symbols in their colours with their values at the cursor on the right, or what they
/// differ by from the second cursor.
fn header(ui: &mut Ui, p: &Palette, chart: &Chart, lines: &[&Signal], now: &Instant, marked: Option<&Instant>) {
    let words = |signal: &Signal, fewer: usize| {
        // Of values in thousandths two digits do, and the plot says whose they are.
        let (symbol, decimals) = match chart.times == 1.0 {
            true => (signal.symbol.as_str(), 3 - fewer),
            false => (signal.symbol.trim_end_matches("_B"), 2 - fewer),
        };
        let meaning = format!("{}, {}", signal.label, unit_of(chart, signal));
        let shown = |value: f64, decimals| signed(chart.times * value, decimals);
        match marked.map(|marked| Difference::of(signal, marked, now)) {
            Some(d) => (
                format!("Δ{symbol} {}", shown(d.by(), decimals)),
                format!("{meaning}: {} at the second cursor, {} now", shown(d.from, 4), shown(d.to, 4)),
            ),
            None => (format!("{symbol} {}", shown(signal.value(now), decimals)), meaning),
        }
    };
    ui.horizontal(|ui| {
        ui.set_height(16.0);
        let gap = ui.spacing().item_spacing.x;
        let wide =
            |ui: &Ui, text: &str, font| gap + ui.painter().layout_no_wrap(text.into(), font, Color32::WHITE).size().x;
        let values = |ui: &Ui, fewer: usize| -> f32 {
            lines.iter().map(|signal| wide(ui, &words(signal, fewer).0, plain(11.5))).sum()
        };
        // Where there is no room for all, digits go first, then the unit, which the values tell under the pointer.
        let room = ui.available_width() - wide(ui, chart.title, bold(12.5));
        let unit = wide(ui, chart.unit, plain(11.5));
        let fewer = (0..=2).find(|fewer| values(ui, *fewer) + unit <= room).unwrap_or(2);
        ui.label(RichText::new(chart.title).font(bold(12.5)));
        if values(ui, fewer) + unit <= room {
            ui.label(RichText::new(chart.unit).font(plain(11.5)).color(colour(p.dim)));
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            for signal in lines.iter().rev() {
                let (text, meaning) = words(signal, fewer);
                let label = RichText::new(text).font(plain(11.5)).color(tone(p, signal, now));
                ui.add(egui::Label::new(label).truncate()).on_hover_text(meaning);
            }
        });
    });
}

/// The unit that a signal is shown in.
fn unit_of(chart: &Chart, signal: &Signal) -> String {
    if chart.times == 1e3 { format!("m{}", signal.unit) } else { signal.unit.into() }
}

/// A signal's colour, by the peaks up to an instant.
fn tone(p: &Palette, signal: &Signal, now: &Instant) -> Color32 {
    colour(charts::colour(signal, p, &now.peaks))
}

#[allow(clippy::too_many_arguments, reason = "each is one thing the plot shows")]
fn time_plot(
    ui: &mut Ui,
    p: &Palette,
    chart: &Chart,
    lines: &[&Signal],
    session: &Session,
    comparison: Option<&Comparison>,
    mark: Option<f64>,
    shown: &std::ops::RangeInclusive<f64>,
    height: f32,
    commands: &mut Vec<Command>,
) {
    let frames = visible(session, shown);
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    let mut drawn = Vec::new();
    for signal in lines {
        let points = thinned(frames, signal, chart.times);
        for [_, y] in &points {
            (low, high) = (low.min(*y), high.max(*y));
        }
        drawn.push((signal, points));
    }
    let mut laid_over = Vec::new();
    for (i, run) in comparison.iter().flat_map(|comparison| comparison.shown()) {
        for signal in lines {
            let frames = &run.frames[..run.frames.partition_point(|f| f.time <= *shown.end())];
            let points = thinned(frames, signal, chart.times);
            for [_, y] in &points {
                (low, high) = (low.min(*y), high.max(*y));
            }
            laid_over.push((i, signal, points));
        }
    }
    let [low, high] = chart.range(low, high);
    let amber = colour(p.amber);
    let decimals = if high - low < 0.05 {
        3
    } else if high - low < 0.5 {
        2
    } else {
        1
    };
    let middle = 0.5 * (low + high);
    let response = base_plot(chart.title, p, height)
        // Three numbers in so little room would run into each other.
        .y_grid_spacer(move |_| match height < THREE_NUMBERS {
            true => marks(&[low, high], high - low),
            false => marks(&[low, middle, high], high - low),
        })
        .x_grid_spacer(|_| Vec::new())
        .y_axis_formatter(move |mark, _| signed(mark.value, decimals))
        .show(ui, |plot| {
            plot.set_plot_bounds_x(shown.clone());
            let margin = 0.06 * (high - low);
            plot.set_plot_bounds_y(low - margin..=high + margin);
            let (now, newest) = (session.frame(), session.frames().last().unwrap_or(session.frame()));
            for (i, signal, points) in laid_over {
                let (style, strength) = super::compare::line_style(i);
                let tone = match signal.drive {
                    Some(k) => p.drive(k),
                    None => p.ink,
                };
                let line = Line::new(format!("{} {}", signal.symbol, i + 1), PlotPoints::from(points)).width(1.2);
                plot.line(line.color(colour(faded(tone, strength))).style(style).allow_hover(false));
            }
            for (signal, points) in drawn {
                let line = Line::new(signal.symbol.clone(), PlotPoints::from(points)).width(1.8);
                plot.line(line.color(tone(p, signal, newest)).allow_hover(false));
            }
            plot.vline(VLine::new("now", now.time).color(amber).width(1.0).allow_hover(false));
            if let Some(time) = mark {
                let line = VLine::new("mark", time).color(amber).width(1.0).style(LineStyle::dashed_dense());
                plot.vline(line.allow_hover(false));
            }
            pointer_time(plot)
        });
    name(&response.response, &format!("{} over time, {}", chart.title, chart.unit));
    let held = response.response.dragged() || response.response.clicked();
    if let (true, Some(time)) = (held, response.inner) {
        commands.push(match ui.input(|i| i.modifiers.shift) {
            true => Command::Mark(Some(time)),
            false => Command::Seek(time),
        });
    }
    ui.add_space(2.0);
}

fn pointer_time(plot: &egui_plot::PlotUi<'_>) -> Option<f64> {
    plot.pointer_coordinate().map(|c: PlotPoint| c.x.max(0.0))
}

pub(super) fn base_plot<'a>(id: &str, p: &Palette, height: f32) -> Plot<'a> {
    Plot::new(id.to_owned())
        .height(height)
        .show_background(false)
        .show_axes([false, true])
        .show_grid([false, true])
        .grid_color(colour(faded(p.line, 0.9)))
        .grid_fade(0.0)
        .show_x(false)
        .show_y(false)
        .allow_drag(false)
        .allow_zoom(false)
        .allow_scroll(false)
        .allow_boxed_zoom(false)
        .allow_double_click_reset(false)
        .sense(egui::Sense::click_and_drag())
        .y_axis_min_width(46.0)
        .set_margin_fraction(egui::Vec2::ZERO)
}

fn marks(values: &[f64], step: f64) -> Vec<GridMark> {
    values.iter().map(|v| GridMark { value: *v, step_size: step }).collect()
}

fn visible<'a>(session: &'a Session, shown: &std::ops::RangeInclusive<f64>) -> &'a [Instant] {
    let frames = session.frames();
    let from = frames.partition_point(|f| f.time < *shown.start());
    let to = frames.partition_point(|f| f.time <= *shown.end());
    &frames[from..to.max(from)]
}

/// At most [`POINTS`] points; of each bucket the least and the greatest, so that no peak is lost.
fn thinned(frames: &[Instant], signal: &Signal, times: f64) -> Vec<[f64; 2]> {
    let point = |f: &Instant| [f.time, times * signal.value(f)];
    if frames.len() <= POINTS {
        return frames.iter().map(point).collect();
    }
    let bucket = (2 * frames.len()).div_ceil(POINTS);
    let mut points = Vec::with_capacity(POINTS + 2);
    for chunk in frames.chunks(bucket) {
        let values = chunk.iter().map(point);
        let least = values.clone().min_by(|a, b| a[1].total_cmp(&b[1]));
        let greatest = values.max_by(|a, b| a[1].total_cmp(&b[1]));
        if let (Some(a), Some(b)) = (least, greatest) {
            points.extend(if a[0] <= b[0] { [a, b] } else { [b, a] });
        }
    }
    points.extend(frames.last().map(point));
    points
}

/// Fig. 3: q_1 against b for A and B, or for the target; a click chooses b.
fn which_b(
    ui: &mut Ui,
    p: &Palette,
    session: &Session,
    view_state: &ViewState,
    height: f32,
    commands: &mut Vec<Command>,
) {
    let Some(planes) = session.run().planes() else { return };
    let (task, now) = (&session.scenario().task, session.frame());
    let named: Vec<String> = (0..task.via.len() + 2).map(|i| task.name_of(i)).collect();
    let points: Vec<(&str, Vector)> = match session.is_led() {
        true => vec![("target", now.target.at)],
        false => named.iter().map(String::as_str).zip(task.points()).collect(),
    };
    ui.horizontal(|ui| {
        ui.set_height(16.0);
        ui.label(RichText::new("Which b?").font(bold(12.5)));
        let words = "q₁ against b, rad; click to choose";
        ui.label(RichText::new(words).font(plain(11.5)).color(colour(p.dim)));
    });
    let map = planes.map();
    let sets: Vec<_> = points.iter().filter_map(|(_, x)| map.reach(*x).ok()).collect();
    let curves: Vec<_> = points.iter().map(|(name, x)| (*name, map.self_motion(*x, 96))).collect();
    let common =
        (sets.len() == points.len()).then(|| crate::planning::reactionless::BSet::overlap(&sets).near(now.b_reference));
    let mut bounds = [f64::INFINITY, f64::NEG_INFINITY, f64::INFINITY, f64::NEG_INFINITY];
    let lines: Vec<(&str, Vec<[f64; 2]>)> = curves
        .iter()
        .flat_map(|(name, branches)| branches.iter().map(move |branch| (*name, branch)))
        .map(|(name, branch)| {
            // The whole turn nearest to the present b.
            let middle = branch.get(branch.len() / 2).map_or(0.0, |x| x.b);
            let lift = map.period() * ((now.b_reference - middle) / map.period()).round();
            let point = |x: &PlanePoint| {
                let x = PlanePoint { b: x.b + lift, ..*x };
                [x.b, map.lift(x)[0]]
            };
            (name, branch.iter().map(point).collect::<Vec<_>>())
        })
        .collect();
    for [b, q] in lines.iter().flat_map(|(_, l)| l) {
        bounds = [bounds[0].min(*b), bounds[1].max(*b), bounds[2].min(*q), bounds[3].max(*q)];
    }
    if lines.is_empty() {
        bounds = [0.0, map.period(), -1.0, 1.0];
    }
    let empty = lines.is_empty();
    let b_now = now.b_reference;
    let [b_low, b_high] = [bounds[0].min(b_now) - 0.15, bounds[1].max(b_now) + 0.15];
    let room = 0.18 * (bounds[3] - bounds[2]).max(0.5);
    let [q_low, q_high] = [bounds[2] - room, bounds[3] + room];
    let response = base_plot("which b", p, height - 16.0)
        .show_axes([true, true])
        .y_grid_spacer(move |_| marks(&spaced(q_low, q_high), q_high - q_low))
        .x_grid_spacer(move |_| marks(&spaced(b_low, b_high), b_high - b_low))
        .x_axis_formatter(|mark, _| signed(mark.value, 1))
        .y_axis_formatter(|mark, _| signed(mark.value, 1))
        .show(ui, |plot| {
            plot.set_plot_bounds_x(b_low..=b_high);
            plot.set_plot_bounds_y(q_low..=q_high);
            for [from, to] in common.iter().flat_map(|c| &c.intervals) {
                let fill = colour(faded(p.amber, 0.16));
                let clear = egui::Stroke::NONE;
                plot.span(Span::new("", *from..=*to).fill(fill).border(clear));
            }
            let last = points.len() - 1;
            for (name, line) in lines {
                // Of many points only the ends have room for a name.
                let named = points.len() <= 4 || name == points[0].0 || name == points[last].0;
                if let Some(end) = line.last().filter(|_| named) {
                    let text = RichText::new(name).font(plain(11.5));
                    let place = PlotPoint::new(end[0], end[1]);
                    let text = egui_plot::Text::new("name", place, text).color(colour(p.ink));
                    plot.text(text.anchor(egui::Align2::RIGHT_BOTTOM).allow_hover(false));
                }
                let line = Line::new(name.to_owned(), PlotPoints::from(line)).width(1.8);
                let line = line.color(colour(if named { p.ink } else { faded(p.dim, 0.6) }));
                plot.line(line.style(LineStyle::Solid).allow_hover(false));
            }
            if empty {
                let place = PlotPoint::new(0.5 * (b_low + b_high), 0.5 * (q_low + q_high));
                let text = RichText::new("no b reaches it").font(plain(12.0));
                plot.text(egui_plot::Text::new("none", place, text).color(colour(p.dim)).allow_hover(false));
            }
            plot.vline(VLine::new("b", b_now).color(colour(p.amber)).width(1.6).allow_hover(false));
            for (_, x) in &points {
                for pose in map.poses(*x, b_now).iter() {
                    let dot = vec![[b_now, map.lift(*pose)[0]]];
                    plot.points(Points::new("pose", dot).radius(4.0).color(colour(p.amber)).allow_hover(false));
                }
            }
            plot.pointer_coordinate().map(|c| c.x)
        });
    name(&response.response, "Which b: q1 against b of each point");
    let preview = response.inner.filter(|_| response.response.hovered());
    if preview != view_state.preview {
        commands.push(Command::Preview(preview));
    }
    let held = response.response.dragged() || response.response.clicked();
    if let (true, Some(b)) = (held, response.inner) {
        commands.push(Command::Edit(set_b(session, view_state, b)));
    }
    if response.response.drag_stopped() || response.response.clicked() {
        commands.push(Command::EndGesture);
    }
}

/// Some three to five round values between bounds.
fn spaced(low: f64, high: f64) -> Vec<f64> {
    let step = round_up((high - low) / 5.0);
    let first = (low / step).ceil() as i64;
    (first..first + 12).map(|i| i as f64 * step).take_while(|v| *v <= high).collect()
}
