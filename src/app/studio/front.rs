//! The Pareto front of added mass and inertia: sets of counterweights to choose from, each the lightest for its
//! inertia.

use egui::{Id, Rect, RichText, Sense, Ui, vec2};
use egui_plot::{HLine, Line, LineStyle, PlotPoint, PlotPoints, Points, VLine};

use super::facts::{DesignFacts, FrontMachine};
use super::other_fronts;
use crate::plots::{base_plot, marks, small_axes, spaced};
use crate::theme::{bold, colour, plain};
use crate::widgets::{heading, name, note};
use crate::{Command, SessionCommand, ViewChange, ViewState, lamp};
use stillbase_picture::numbers::signed;
use stillbase_picture::scene::Rgba;
use stillbase_picture::scene::palette::{Palette, faded, mix};
use stillbase_session::design::relaxations;
use stillbase_study::front_point::FrontMeasure;

const PLOT_HEIGHT_PT: f32 = 210.0;
/// Delay before progress of the search is shown, s.
const PROGRESS_DELAY_S: f32 = 0.4;
/// Distance within which a point is selected, points of the screen.
const SELECT_DISTANCE_PT: f32 = 14.0;
/// Counterweights lighter than this are treated as absent, kg.
const MIN_ADDED_MASS_KG: f64 = 1e-6;

/// Draws the Pareto front.
pub fn show(ui: &mut Ui, facts: &DesignFacts, view_state: &ViewState, commands: &mut Vec<Command>) {
    let p = &view_state.palette();
    ui.add_space(8.0);
    let under_way = facts.front_under_way();
    // Progress of a short search is not shown.
    let delay = ui.ctx().animate_bool_with_time(Id::unique("front under way"), under_way.is_some(), PROGRESS_DELAY_S);
    match under_way.filter(|_| delay >= 1.0) {
        Some(share) => heading(ui, p, "Counterweights", &format!("looking for them: {:.0} %", 100.0 * share)),
        None if facts.cut.is_some() => heading(ui, p, "Counterweights", "on cut bars; hover shows, click takes"),
        None => heading(ui, p, "Counterweights", "hover shows, click takes"),
    }
    let points = match facts.front() {
        Ok([]) => return,
        Ok(points) => points,
        Err(why) => {
            note(ui, p, &why.to_string());
            relaxations(why).iter().for_each(|relaxed| lamp::proposal(ui, relaxed, None, commands));
            return;
        }
    };
    if points.iter().all(|point| point.placed.added_mass < MIN_ADDED_MASS_KG) {
        return note(ui, p, "The links balance each other: nothing needs to be added.");
    }
    let [mass, inertia] = facts.now();
    let all: Vec<[f64; 2]> = points.iter().map(|point| [point.placed.added_mass, point.inertia]).collect();
    // The counterweights in use are marked in the plot.
    let shown = mass > MIN_ADDED_MASS_KG;
    let everything: Vec<[f64; 2]> = all.iter().copied().chain(other_fronts::places(facts)).collect();
    let of = |i: usize| everything.iter().map(move |at| at[i]);
    let ends = |i: usize, now: f64| {
        let (low, high) = of(i).fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        let (low, high) = if shown { (low.min(now), high.max(now)) } else { (low, high) };
        let room = 0.08 * (high - low).max(1e-3 * high.abs());
        [low - room, high + room]
    };
    let ([left, right], [low, high]) = (ends(0, mass), ends(1, inertia));
    let colours = facts.front_measure.as_ref().and_then(|measure| ColourScale::of(measure.measure, &measure.values));
    ui.horizontal(|ui| {
        ui.label(RichText::new("Σ D, kg m²").font(plain(11.0)).color(colour(p.dim)));
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| measure_choice(ui, view_state, commands));
    });
    small_axes(ui);
    let response = base_plot("front", p, PLOT_HEIGHT_PT)
        .show_axes([true, true])
        .show_grid([true, true])
        .x_grid_spacer(move |_| marks(&spaced(left, right), right - left))
        .y_grid_spacer(move |_| marks(&spaced(low, high), high - low))
        .x_axis_formatter(move |mark, _| signed(mark.value, decimals(right - left)))
        .y_axis_formatter(move |mark, _| signed(mark.value, decimals(high - low)))
        .show(ui, |plot| {
            plot.set_plot_bounds_x(left..=right);
            plot.set_plot_bounds_y(low..=high);
            if shown {
                let tone = colour(faded(p.amber, 0.7));
                let dashed = LineStyle::dashed_loose();
                plot.hline(HLine::new("now D", inertia).color(tone).width(1.0).style(dashed).allow_hover(false));
                plot.vline(VLine::new("now kg", mass).color(tone).width(1.0).style(dashed).allow_hover(false));
            }
            other_fronts::draw(plot, facts, p);
            let line = Line::new("front", PlotPoints::from(all.clone())).width(1.8).color(colour(p.zero));
            plot.line(line.allow_hover(false));
            for (i, at) in all.iter().enumerate() {
                let (radius, tone) =
                    colours.as_ref().and_then(|colours| colours.tone(i, p)).map_or((3.5, p.zero), |t| (5.0, t));
                let dot = Points::new("machines", PlotPoints::from(vec![*at])).radius(radius).color(colour(tone));
                plot.points(dot.allow_hover(false));
            }
            if let Some(at) = view_state.ghost.and_then(|i| all.get(i)) {
                let dot =
                    Points::new("under the pointer", PlotPoints::from(vec![*at])).radius(6.0).color(colour(p.ink));
                plot.points(dot.allow_hover(false));
            }
            if shown {
                let at = PlotPoints::from(vec![facts.now()]);
                // A machine that is not balanced is beside the curve, even where mass and inertia agree.
                let dot = Points::new("now", at).radius(6.0).filled(facts.is_balanced()).color(colour(p.amber));
                plot.points(dot.allow_hover(false));
            }
        });
    let near = response.response.hover_pos().and_then(|pos| {
        let off = |at: &[f64; 2]| response.transform.position_from_point(&PlotPoint::new(at[0], at[1])).distance(pos);
        let nearest = all.iter().enumerate().min_by(|a, b| off(a.1).total_cmp(&off(b.1)));
        nearest.filter(|(_, at)| off(at) < SELECT_DISTANCE_PT).map(|(i, _)| i)
    });
    if near != view_state.ghost {
        commands.push(ViewChange::Ghost(near).into());
    }
    if let Some(i) = near {
        ui.ctx().set_cursor_icon(egui::CursorIcon::PointingHand);
        if response.response.clicked() {
            commands.extend([Command::Session(SessionCommand::Take(i)), Command::Session(SessionCommand::EndGesture)]);
        }
    }
    name(&response.response, &words(&all));
    ui.horizontal(|ui| {
        if let Some(colours) = &colours {
            colours.scale(ui, p);
        }
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            ui.label(RichText::new("added mass, kg").font(plain(11.0)).color(colour(p.dim)));
        });
    });
    if let (Some(by), None) = (view_state.front_by, &colours) {
        let why = if by == FrontMeasure::Torque { "the run waits, or there is none" } else { "none of these has one" };
        note(ui, p, &format!("{}: {why}.", by.words()[0]));
    }
    summary(ui, points, near, colours.as_ref(), view_state, facts, commands);
    other_fronts::list(ui, facts, p, commands);
}

/// Returns the number of decimals for the marks of an axis of this length.
fn decimals(length: f64) -> usize {
    (1.0 - length.log10()).ceil().clamp(0.0, 6.0) as usize
}

fn words(all: &[[f64; 2]]) -> String {
    let end = |at: Option<&[f64; 2]>| {
        at.map_or(String::new(), |[mass, inertia]| {
            format!("{} kg with {} kg m²", signed(*mass, 2), signed(*inertia, 3))
        })
    };
    format!("Counterweights to choose from, added mass against Σ D: from {} to {}", end(all.first()), end(all.last()))
}

/// A measure of the machines in addition to mass and inertia, shown by colour.
struct ColourScale<'a> {
    measure: FrontMeasure,
    values: &'a [Option<f64>],
    /// Minimum and maximum of the values.
    ends: [f64; 2],
}

impl<'a> ColourScale<'a> {
    /// Returns the colour scale of a measure; `None` if no machine has a value.
    fn of(by: FrontMeasure, values: &'a [Option<f64>]) -> Option<Self> {
        let least = values.iter().flatten().fold(f64::INFINITY, |least, x| least.min(*x));
        let most = values.iter().flatten().fold(f64::NEG_INFINITY, |most, x| most.max(*x));
        (least <= most).then_some(Self { measure: by, values, ends: [least, most] })
    }

    /// Returns the colour of a machine.
    fn tone(&self, i: usize, p: &Palette) -> Option<Rgba> {
        let [least, most] = self.ends;
        let value = (*self.values.get(i)?)?;
        let share = if most > least { (value - least) / (most - least) } else { 0.5 };
        Some(tone(p, share as f32))
    }

    fn words(&self, value: f64) -> String {
        let decimals = decimals((self.ends[1] - self.ends[0]).max(1e-3 * self.ends[1].abs()));
        format!("{} {}", signed(value, decimals), self.measure.words()[1])
    }

    /// Draws the colour scale.
    fn scale(&self, ui: &mut Ui, p: &Palette) {
        let text = |ui: &mut Ui, words: String| ui.label(RichText::new(words).font(plain(11.0)).color(colour(p.dim)));
        text(ui, self.words(self.ends[0]));
        let (rect, _) = ui.allocate_exact_size(vec2(60.0, 8.0), Sense::hover());
        const STEPS: usize = 24;
        let width = rect.width() / STEPS as f32;
        for i in 0..STEPS {
            let left = rect.left() + width * i as f32;
            let step = Rect::from_x_y_ranges(left..=left + width + 0.5, rect.y_range());
            ui.painter().rect_filled(step, 0.0, colour(tone(p, i as f32 / (STEPS - 1) as f32)));
        }
        text(ui, self.words(self.ends[1]));
    }
}

/// Returns a colour between blue and amber, which are distinguishable with any colour vision.
fn tone(p: &Palette, share: f32) -> Rgba {
    mix(p.drives[0], p.amber, share)
}

/// Draws the choice of the measure shown by colour.
fn measure_choice(ui: &mut Ui, view_state: &ViewState, commands: &mut Vec<Command>) {
    let mut by = view_state.front_by;
    let words = |by: Option<FrontMeasure>| by.map_or("nothing more", |by| by.words()[0]);
    let list = egui::ComboBox::from_id_salt("front-by").selected_text(words(by)).width(150.0).show_ui(ui, |ui| {
        for one in std::iter::once(None).chain(FrontMeasure::ALL.map(Some)) {
            ui.selectable_value(&mut by, one, words(one));
        }
    });
    name(&list.response, "what the colours of the front tell");
    ui.label(RichText::new("colours tell").font(plain(11.0)).color(colour(view_state.palette().dim)));
    if by != view_state.front_by {
        commands.push(ViewChange::FrontBy(by).into());
    }
}

/// Draws the values of the machine under the pointer, or on display, and buttons that apply the first, middle and
/// last point of the front.
fn summary(
    ui: &mut Ui,
    points: &[FrontMachine],
    near: Option<usize>,
    colours: Option<&ColourScale<'_>>,
    view_state: &ViewState,
    facts: &DesignFacts,
    commands: &mut Vec<Command>,
) {
    let p = &view_state.palette();
    let at = near.or(view_state.ghost).filter(|i| *i < points.len());
    let (mass, inertia) = match at.map(|i| &points[i]) {
        Some(point) => (point.placed.added_mass, point.inertia),
        None => facts.now().into(),
    };
    let mut text = match at.is_none() && mass < MIN_ADDED_MASS_KG {
        true => "no counterweights yet".to_owned(),
        false => format!("{} kg added, Σ D {} kg m²", signed(mass, 2), signed(inertia, 3)),
    };
    if at.is_none() && mass >= MIN_ADDED_MASS_KG && !facts.is_balanced() {
        text.push_str(": not balanced, beside the curve");
    }
    if let Some((colours, value)) = colours.zip(at).and_then(|(colours, i)| Some((colours, (*colours.values.get(i)?)?)))
    {
        text.push_str(&format!(", {}", colours.words(value)));
    }
    let tone = match (at, mass < MIN_ADDED_MASS_KG) {
        (Some(_), _) => p.ink,
        (None, true) => p.dim,
        (None, false) if facts.is_balanced() => p.zero,
        (None, false) => p.amber,
    };
    ui.label(RichText::new(text).font(bold(13.0)).color(colour(tone)));
    let gap = points.iter().map(|point| point.placed.gap).fold(0.0, f64::max);
    let proof = format!("proved: every point of the curve is within {gap:.0e} of the least value of its objective");
    note(ui, p, &proof);
    ui.horizontal(|ui| {
        let last = points.len() - 1;
        for (words, i, tip) in [
            ("least mass", 0, "Take the lightest counterweights"),
            ("between", last / 2, "Take those halfway between the two ends"),
            ("least inertia", last, "Take those with which the drives have least to turn"),
        ] {
            let button = ui.button(RichText::new(words).font(plain(12.0))).on_hover_text(tip);
            if button.clicked() {
                commands
                    .extend([Command::Session(SessionCommand::Take(i)), Command::Session(SessionCommand::EndGesture)]);
            }
        }
    });
}
