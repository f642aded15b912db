//! The equations of the paper with the present numbers of the machine.

use egui::style::ScrollAnimation;
use egui::{Align, Label, Rect, RichText, Role, ScrollArea, Sense, Ui, WidgetInfo, pos2, vec2};

use super::bars::hot_link;
use super::lesson::MachineEquations;
use super::terms::{self, TermPainter};
use super::typeset::set;
use crate::ViewState;
use crate::fit;
use crate::side::SCROLL_BAR_WIDTH;
use crate::theme::{bold, colour, plain};
use crate::widgets::{name, note};
use stillbase_picture::numbers::{at_step, signed};
use stillbase_picture::scene::Rgba;
use stillbase_picture::scene::palette::Palette;
use stillbase_session::Session;
use stillbase_study::equations::{Equality, Equation, InstantKind};

/// Maximum width of the names of an equation's lines, points.
const MAX_NAME_WIDTH_PT: f32 = 48.0;

/// Draws the equations: an index of their numbers on top, and a scrolling list below.
pub fn show(ui: &mut Ui, session: &Session, lesson: &MachineEquations, view_state: &ViewState) {
    let p = &view_state.palette();
    note(ui, p, &when(lesson, session));
    let wanted = ui.scope(|ui| index(ui, p, &lesson.equations)).inner;
    ui.add_space(2.0);
    let machine = &session.scenario().machine;
    let pen = TermPainter { p, machine, highlighted_link: hot_link(view_state, session), gutter: 0.0 };
    ScrollArea::vertical().id_salt("equations").auto_shrink(false).show(ui, |ui| {
        ui.set_width(ui.available_width() - SCROLL_BAR_WIDTH);
        ui.spacing_mut().item_spacing.y = 2.0;
        let mut heights = Heights::of(ui);
        for (i, equation) in lesson.equations.iter().enumerate() {
            let top = ui.cursor().min;
            // An equation out of sight is not drawn; it only takes up its space.
            let known = heights.known(i);
            let there = known.map(|height| Rect::from_min_size(top, vec2(ui.available_width(), height)));
            match there {
                Some(rect) if !ui.is_rect_visible(rect) => {
                    ui.allocate_rect(rect, Sense::hover());
                }
                _ => {
                    ui.push_id(equation.number, |ui| block(ui, equation, &pen));
                    heights.record(i, ui.min_rect().bottom() - top.y);
                }
            }
            if wanted == Some(i) {
                let rect = Rect::from_min_max(top, pos2(top.x + 1.0, top.y + 1.0));
                ui.scroll_to_rect_animation(rect, Some(Align::TOP), ScrollAnimation::none());
            }
        }
        heights.store(ui);
        // Space below the last equation, so that it too can be scrolled up.
        ui.add_space(0.5 * ui.clip_rect().height());
    });
}

/// Heights of the equations when they were drawn last in a panel of this width, points.
struct Heights {
    width: f32,
    all: Vec<f32>,
}

impl Heights {
    fn id() -> egui::Id {
        egui::Id::unique("heights of equations")
    }

    fn of(ui: &Ui) -> Self {
        let width = ui.available_width();
        let kept = ui.data(|data| data.get_temp::<(f32, Vec<f32>)>(Self::id()));
        let all = kept.filter(|(then, _)| *then == width).map_or_else(Vec::new, |(_, all)| all);
        Self { width, all }
    }

    fn known(&self, i: usize) -> Option<f32> {
        self.all.get(i).copied()
    }

    fn record(&mut self, i: usize, height: f32) {
        if i == self.all.len() {
            self.all.push(height);
        } else if let Some(known) = self.all.get_mut(i) {
            *known = height;
        }
    }

    fn store(self, ui: &Ui) {
        ui.data_mut(|data| data.insert_temp(Self::id(), (self.width, self.all)));
    }
}

/// Returns a sentence about the instant to which the numbers belong.
fn when(lesson: &MachineEquations, session: &Session) -> String {
    let instant = match lesson.when {
        InstantKind::Plan(time) => format!("Numbers of the plan at {} s, because the machine rests.", signed(time, 3)),
        InstantKind::Run(time) => format!("Numbers at {} s.", signed(time, 3)),
        InstantKind::Given => String::new(),
    };
    match session.scenario().base.moves() {
        true => format!("{instant} As on a base that stands still."),
        false => format!("{instant} The pointer on a term lights up its links."),
    }
}

/// Returns the colour that shows whether an equation holds.
fn tone(equation: &Equation, p: &Palette) -> Rgba {
    match equation.holds() {
        Some(true) => p.zero,
        Some(false) if !equation.is_choice() => p.reaction,
        _ => p.dim,
    }
}

/// Draws the numbers of all equations; returns the index of the clicked one.
fn index(ui: &mut Ui, p: &Palette, all: &[Equation]) -> Option<usize> {
    let mut wanted = None;
    ui.set_max_width(ui.available_width() - SCROLL_BAR_WIDTH);
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = vec2(3.0, 1.0);
        ui.spacing_mut().button_padding = vec2(3.0, 1.0);
        for (i, equation) in all.iter().enumerate() {
            let text = RichText::new(equation.number).font(bold(11.5)).color(colour(tone(equation, p)));
            let button = ui.add(egui::Button::new(text).frame(false).min_size(vec2(15.0, 18.0)));
            name(&button, &format!("Equation {}", equation.number));
            let button =
                button.on_hover_text(format!("({}) {}: {}", equation.number, equation.title, verdict(equation)));
            wanted = if button.clicked() { Some(i) } else { wanted };
        }
    });
    wanted
}

/// Returns in a few words whether both sides of an equation agree.
fn verdict(equation: &Equation) -> String {
    let Some(worst) = equation.least_accurate() else { return "not for this machine".into() };
    match equation.holds() {
        Some(true) => "holds".into(),
        _ if equation.is_choice() => "another choice".into(),
        _ => {
            let off = worst.residual().abs();
            let size = if off > 0.0 { 10f64.powf(off.log10().floor() - 2.0) } else { 1.0 };
            format!("off by {} {}", at_step(off, size), worst.unit).trim_end().to_owned()
        }
    }
}

fn block(ui: &mut Ui, equation: &Equation, pen: &TermPainter<'_>) {
    let p = pen.p;
    ui.add_space(9.0);
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 6.0;
        ui.label(RichText::new(format!("({})", equation.number)).font(bold(13.0)).color(colour(p.amber)));
        let title = ui.label(RichText::new(equation.title).font(bold(13.0)).color(colour(p.ink)));
        let said = format!("({}) {}: {}", equation.number, equation.title, verdict(equation));
        title.widget_info(|| WidgetInfo::labeled(Role::Label, true, &said));
        ui.with_layout(egui::Layout::right_to_left(Align::Center), |ui| {
            fit::label(ui, &verdict(equation), plain(11.5), colour(tone(equation, p)));
        });
    });
    symbols(ui, equation.says, 11.0, colour(p.dim));
    if !equation.form.is_empty() {
        symbols(ui, equation.form, 13.0, colour(p.ink));
    }
    match &equation.lines {
        Ok(lines) => {
            let pen = TermPainter { gutter: gutter(ui, lines), ..*pen };
            ui.add_space(2.0);
            for line in lines {
                terms::show(ui, &pen, equation.number, line);
            }
        }
        Err(why) => {
            let words = format!("Not for this machine: {why}.");
            ui.add(Label::new(RichText::new(words).font(plain(11.5)).color(colour(p.ink))).wrap());
        }
    }
    for words in &equation.notes {
        symbols(ui, words, 10.5, colour(p.dim));
    }
}

/// Returns the width for the names of lines, points.
fn gutter(ui: &Ui, lines: &[Equality]) -> f32 {
    let names = lines.iter().filter(|line| !line.name.is_empty());
    names.map(|line| terms::label(ui, line) + 4.0).fold(0.0, f32::max).min(MAX_NAME_WIDTH_PT)
}

/// Draws a symbol or a sentence with symbols, wrapped at the available width.
fn symbols(ui: &mut Ui, text: &str, size: f32, tone: egui::Color32) {
    let galley = set(ui, text, size, tone, ui.available_width());
    let (rect, _) = ui.allocate_exact_size(galley.size(), Sense::hover());
    ui.painter().galley(rect.min, galley, tone);
}
