//! A line of an equation: terms, each with its number below, that light up the links they come from.

use egui::{CornerRadius, Rect, RichText, Role, Sense, Ui, Vec2, WidgetInfo, pos2, vec2};

use super::typeset::{set, words};
use crate::app::place;
use crate::app::theme::{colour, plain};
use crate::mechanics::machine::Machine;
use crate::picture::numbers::signed;
use crate::picture::scene::palette::{Palette, faded};
use crate::study::equations::{Cell, Line, Term, cells, plain as written};

/// Heights of symbols and of numbers, the room for a sign before either, between terms, and below a row, points.
const SYMBOLS: f32 = 17.0;
const NUMBERS: f32 = 15.0;
const SIGN: f32 = 12.0;
const GAP: f32 = 5.0;
const BELOW: f32 = 5.0;
/// The least room of a number: so that it does not move when it becomes longer.
const ROOM: &str = "00.0000";
/// Sizes of type.
const SYMBOL: f32 = 13.0;
const NUMBER: f32 = 12.0;
const SMALL: f32 = 10.5;
/// Decimals of numbers, and of parts.
const DECIMALS: usize = 4;
const FINE: usize = 6;

/// What a line is drawn with.
pub struct Pen<'a> {
    pub p: &'a Palette,
    pub machine: &'a Machine,
    /// The link under the pointer or in hand.
    pub hot: Option<usize>,
    /// Room for names of lines, points.
    pub gutter: f32,
}

/// Draws a line of the equation of a number.
pub fn show(ui: &mut Ui, pen: &Pen<'_>, number: &str, line: &Line) {
    let width = ui.available_width();
    let cells = cells(line, DECIMALS);
    let inner = width - pen.gutter;
    let room = words(ui, ROOM, (NUMBER, colour(pen.p.ink)), f32::INFINITY).size().x;
    let sizes: Vec<Vec2> = cells.iter().map(|cell| size(ui, pen.p, cell, (inner, room))).collect();
    let unit = words(ui, line.unit, (SMALL, colour(pen.p.dim)), f32::INFINITY);
    let (places, height) = flow(&sizes, unit.size().x, inner);
    let (rect, response) = ui.allocate_exact_size(vec2(width, height), Sense::hover());
    let said = format!("({number}) {}", aloud(line, &cells));
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, &said));
    let origin = rect.min + vec2(pen.gutter, 0.0);
    let mut end = origin;
    if !line.name.is_empty() {
        let label = words(ui, &line.name, (SMALL, colour(pen.p.dim)), pen.gutter - 4.0);
        ui.painter().galley(rect.min + vec2(0.0, 3.0), label, colour(pen.p.dim));
    }
    for ((cell, size), at) in cells.iter().zip(&sizes).zip(&places) {
        let place = Rect::from_min_size(origin + *at, *size);
        let behind = draw(ui, pen, cell, (place, room), line.unit);
        end = pos2(behind + 4.0, place.bottom() - NUMBERS + 1.5);
    }
    ui.painter().galley(end, unit, colour(pen.p.dim));
}

/// How wide the name of a line is.
pub fn label(ui: &Ui, line: &Line) -> f32 {
    words(ui, &line.name, (SMALL, egui::Color32::WHITE), f32::INFINITY).size().x
}

/// Room of a term.
fn size(ui: &Ui, p: &Palette, cell: &Cell<'_>, (most, room): (f32, f32)) -> Vec2 {
    if cell.symbol.is_empty() {
        return vec2(SIGN + GAP, SYMBOLS + NUMBERS);
    }
    let most = (most - SIGN - GAP).max(40.0);
    let symbol = set(ui, cell.symbol, (SYMBOL, colour(p.dim)), most).size();
    let number = words(ui, &cell.number, (NUMBER, colour(p.ink)), f32::INFINITY).size().x;
    let wide = symbol.x.max(number).max(room);
    vec2(before(cell) + wide + GAP, SYMBOLS.max(symbol.y) + NUMBERS)
}

/// Room for the sign before a term; the first has room for a minus too, which may come.
fn before(cell: &Cell<'_>) -> f32 {
    if cell.symbol.is_empty() { 0.0 } else { SIGN }
}

/// Where terms go, beside each other as far as there is room for them, and how high that is; the last with a unit behind.
fn flow(sizes: &[Vec2], unit: f32, width: f32) -> (Vec<Vec2>, f32) {
    let (mut at, mut row) = (Vec2::ZERO, 0.0_f32);
    let mut places = Vec::with_capacity(sizes.len());
    for (i, size) in sizes.iter().enumerate() {
        let behind = if i + 1 == sizes.len() { unit } else { 0.0 };
        if at.x > 0.0 && at.x + size.x + behind > width {
            at = vec2(0.0, at.y + row + BELOW);
            row = 0.0;
        }
        places.push(at);
        at.x += size.x;
        row = row.max(size.y);
    }
    (places, at.y + row + BELOW)
}

/// Draws a term; where its number ends.
fn draw(ui: &Ui, pen: &Pen<'_>, cell: &Cell<'_>, (rect, room): (Rect, f32), unit: &str) -> f32 {
    let p = pen.p;
    let (ink, dim) = (colour(p.ink), colour(p.dim));
    let is_under = cell.term.is_some() && ui.rect_contains_pointer(rect);
    let is_lit = is_under || pen.hot.is_some_and(|hot| brings(cell.term, hot));
    let back = rect.expand2(vec2(1.0, 1.0)).translate(vec2(-1.0, 0.0));
    if is_lit {
        ui.painter().rect_filled(
            back,
            CornerRadius::same(4),
            colour(faded(p.amber, if is_under { 0.3 } else { 0.18 })),
        );
    }
    let shift = before(cell);
    let lower = rect.bottom() - NUMBERS;
    let painter = ui.painter();
    let sign = |text: &str, y: f32, size: f32| {
        painter.galley(pos2(rect.left() + 1.0, y), words(ui, text, (size, ink), f32::INFINITY), ink)
    };
    sign(cell.sign, rect.top(), SYMBOL);
    sign(cell.number_sign, lower, NUMBER);
    let symbol = set(ui, cell.symbol, (SYMBOL, dim), (rect.width() - SIGN).max(40.0));
    painter.galley(pos2(rect.left() + shift, rect.top()), symbol, dim);
    let number = words(ui, &cell.number, (NUMBER, ink), f32::INFINITY);
    // Below each other by their last figures.
    let wide = number.size().x;
    let left = rect.left() + shift + (room - wide).max(0.0);
    painter.galley(pos2(left, lower), number, ink);
    if let Some(term) = cell.term.filter(|_| is_under) {
        place::light_links(ui.ctx(), term.links());
        tip(ui, pen, term, unit);
    }
    left + wide
}

/// Whether a link is in a term with more than rounding.
fn brings(term: Option<&Term>, link: usize) -> bool {
    let parts = || term.iter().flat_map(|term| &term.parts);
    let most = parts().fold(0.0_f64, |most, (_, part)| most.max(part.abs()));
    parts().any(|(origin, part)| origin.link() == Some(link) && part.abs() > 1e-9 * most)
}

/// The most parts that a tip names.
const NAMED: usize = 12;

fn tip(ui: &Ui, pen: &Pen<'_>, term: &Term, unit: &str) {
    let mut parts: Vec<_> = term.parts.iter().filter(|(_, part)| *part != 0.0).collect();
    parts.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
    let mut lines = vec![format!("{} = {} {unit}", written(&term.symbol), signed(term.value, FINE))];
    if term.is_negative {
        lines[0].insert_str(0, "− ");
    }
    let of = |(origin, part): &&(_, f64)| {
        let origin: &crate::study::equations::Origin = origin;
        format!("{}: {} {unit}", origin.words(pen.machine), signed(*part, FINE))
    };
    if parts.len() > 1 || parts.first().is_some_and(|(origin, _)| origin.link().is_none()) {
        lines.extend(parts.iter().take(NAMED).map(of));
    } else {
        lines.extend(parts.iter().map(|(origin, _)| origin.words(pen.machine)));
    }
    if parts.len() > NAMED {
        lines.push(format!("and {} more", parts.len() - NAMED));
    }
    let id = ui.scope_id().with("term");
    egui::Tooltip::always_open(ui.ctx().clone(), ui.layer_id(), id, egui::PopupAnchor::Pointer).gap(14.0).show(|ui| {
        for line in lines {
            ui.label(RichText::new(line.trim_end()).font(plain(12.0)));
        }
    });
}

/// A line for a screen reader.
fn aloud(line: &Line, cells: &[Cell<'_>]) -> String {
    let joined = |of: &dyn Fn(&Cell<'_>) -> String| cells.iter().map(of).collect::<Vec<_>>().join(" ");
    let symbols = joined(&|cell| format!("{} {}", cell.sign, written(cell.symbol)).trim().to_owned());
    let numbers = joined(&|cell| format!("{} {}", cell.number_sign, cell.number).trim().to_owned());
    let name = if line.name.is_empty() { String::new() } else { format!("{}: ", line.name) };
    format!("{name}{symbols}; {numbers} {}", line.unit)
}
