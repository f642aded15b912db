//! A line of an equation: its terms, with a number below each. A term under the pointer lights up its links.

use egui::{CornerRadius, Rect, RichText, Role, Sense, Ui, Vec2, WidgetInfo, pos2, vec2};

use super::typeset::{set, words};
use crate::place;
use crate::theme::{colour, plain};
use stillbase_mechanics::machine::Machine;
use stillbase_picture::numbers::signed;
use stillbase_picture::scene::palette::{Palette, faded};
use stillbase_study::equations::{Equality, EquationCell, Term, cells, plain as written};

/// Heights of symbols and of numbers, width of the sign before them, gaps between terms and below a row, points.
const SYMBOL_HEIGHT_PT: f32 = 17.0;
const NUMBER_HEIGHT_PT: f32 = 15.0;
const SIGN_WIDTH_PT: f32 = 12.0;
const TERM_GAP_PT: f32 = 5.0;
const ROW_GAP_PT: f32 = 5.0;
/// Text that sets the minimum width of a number, so that the terms do not move when a number becomes longer.
const WIDEST_NUMBER: &str = "00.0000";
/// Font sizes, points.
const SYMBOL_FONT_PT: f32 = 13.0;
const NUMBER_FONT_PT: f32 = 12.0;
const SMALL_FONT_PT: f32 = 10.5;
/// Decimals of numbers, and of numbers in tooltips.
const DECIMALS: usize = 4;
const TIP_DECIMALS: usize = 6;

/// Context in which lines are drawn.
pub struct TermPainter<'a> {
    pub p: &'a Palette,
    pub machine: &'a Machine,
    /// Index of the link that is dragged, under the pointer, or mentioned by a panel.
    pub highlighted_link: Option<usize>,
    /// Width for names of lines, points.
    pub gutter: f32,
}

/// Draws a line of the equation whose number in the paper is `number`.
pub fn show(ui: &mut Ui, pen: &TermPainter<'_>, number: &str, line: &Equality) {
    let width = ui.available_width();
    let cells = cells(line, DECIMALS);
    let inner = width - pen.gutter;
    let room = words(ui, WIDEST_NUMBER, NUMBER_FONT_PT, colour(pen.p.ink), f32::INFINITY).size().x;
    let sizes: Vec<Vec2> = cells.iter().map(|cell| size(ui, pen.p, cell, inner, room)).collect();
    let unit = words(ui, line.unit, SMALL_FONT_PT, colour(pen.p.dim), f32::INFINITY);
    let (places, height) = flow(&sizes, unit.size().x, inner);
    let (rect, response) = ui.allocate_exact_size(vec2(width, height), Sense::hover());
    let said = format!("({number}) {}", aloud(line, &cells));
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, &said));
    let origin = rect.min + vec2(pen.gutter, 0.0);
    let mut end = origin;
    if !line.name.is_empty() {
        let label = words(ui, &line.name, SMALL_FONT_PT, colour(pen.p.dim), pen.gutter - 4.0);
        ui.painter().galley(rect.min + vec2(0.0, 3.0), label, colour(pen.p.dim));
    }
    for ((cell, size), at) in cells.iter().zip(&sizes).zip(&places) {
        let place = Rect::from_min_size(origin + *at, *size);
        let behind = draw(ui, pen, cell, place, room, line.unit);
        end = pos2(behind + 4.0, place.bottom() - NUMBER_HEIGHT_PT + 1.5);
    }
    ui.painter().galley(end, unit, colour(pen.p.dim));
}

/// Returns the width of the name of a line, points.
pub fn label(ui: &Ui, line: &Equality) -> f32 {
    words(ui, &line.name, SMALL_FONT_PT, egui::Color32::WHITE, f32::INFINITY).size().x
}

/// Returns the size of a term, points.
fn size(ui: &Ui, p: &Palette, cell: &EquationCell<'_>, most: f32, room: f32) -> Vec2 {
    if cell.symbol.is_empty() {
        return vec2(SIGN_WIDTH_PT + TERM_GAP_PT, SYMBOL_HEIGHT_PT + NUMBER_HEIGHT_PT);
    }
    let most = (most - SIGN_WIDTH_PT - TERM_GAP_PT).max(40.0);
    let symbol = set(ui, cell.symbol, SYMBOL_FONT_PT, colour(p.dim), most).size();
    let number = words(ui, &cell.number, NUMBER_FONT_PT, colour(p.ink), f32::INFINITY).size().x;
    let wide = symbol.x.max(number).max(room);
    vec2(sign_width(cell) + wide + TERM_GAP_PT, SYMBOL_HEIGHT_PT.max(symbol.y) + NUMBER_HEIGHT_PT)
}

/// Returns the width of the sign before a term, points. The first term reserves it too, since the term may become
/// negative.
fn sign_width(cell: &EquationCell<'_>) -> f32 {
    if cell.symbol.is_empty() { 0.0 } else { SIGN_WIDTH_PT }
}

/// Returns the positions of terms, broken into rows of this width, and the total height, points. `unit` is the width
/// of the unit after the last term.
fn flow(sizes: &[Vec2], unit: f32, width: f32) -> (Vec<Vec2>, f32) {
    let (mut at, mut row) = (Vec2::ZERO, 0.0_f32);
    let mut places = Vec::with_capacity(sizes.len());
    for (i, size) in sizes.iter().enumerate() {
        let behind = if i + 1 == sizes.len() { unit } else { 0.0 };
        if at.x > 0.0 && at.x + size.x + behind > width {
            at = vec2(0.0, at.y + row + ROW_GAP_PT);
            row = 0.0;
        }
        places.push(at);
        at.x += size.x;
        row = row.max(size.y);
    }
    (places, at.y + row + ROW_GAP_PT)
}

/// Draws a term; returns the x coordinate of the right edge of its number, points.
fn draw(ui: &Ui, pen: &TermPainter<'_>, cell: &EquationCell<'_>, rect: Rect, room: f32, unit: &str) -> f32 {
    let p = pen.p;
    let (ink, dim) = (colour(p.ink), colour(p.dim));
    let is_under = cell.term.is_some() && ui.rect_contains_pointer(rect);
    let is_lit = is_under || pen.highlighted_link.is_some_and(|hot| contributes(cell.term, hot));
    let back = rect.expand2(vec2(1.0, 1.0)).translate(vec2(-1.0, 0.0));
    if is_lit {
        ui.painter().rect_filled(
            back,
            CornerRadius::same(4),
            colour(faded(p.amber, if is_under { 0.3 } else { 0.18 })),
        );
    }
    let shift = sign_width(cell);
    let lower = rect.bottom() - NUMBER_HEIGHT_PT;
    let painter = ui.painter();
    let sign = |text: &str, y: f32, size: f32| {
        painter.galley(pos2(rect.left() + 1.0, y), words(ui, text, size, ink, f32::INFINITY), ink)
    };
    sign(cell.sign, rect.top(), SYMBOL_FONT_PT);
    sign(cell.number_sign, lower, NUMBER_FONT_PT);
    let symbol = set(ui, cell.symbol, SYMBOL_FONT_PT, dim, (rect.width() - SIGN_WIDTH_PT).max(40.0));
    painter.galley(pos2(rect.left() + shift, rect.top()), symbol, dim);
    let number = words(ui, &cell.number, NUMBER_FONT_PT, ink, f32::INFINITY);
    // Numbers are right-aligned.
    let wide = number.size().x;
    let left = rect.left() + shift + (room - wide).max(0.0);
    painter.galley(pos2(left, lower), number, ink);
    if let Some(term) = cell.term.filter(|_| is_under) {
        place::highlight_links(ui.ctx(), term.links());
        tip(ui, pen, term, unit);
    }
    left + wide
}

/// Whether a link contributes to a term more than rounding errors.
fn contributes(term: Option<&Term>, link: usize) -> bool {
    let parts = || term.iter().flat_map(|term| &term.parts);
    let most = parts().fold(0.0_f64, |most, (_, part)| most.max(part.abs()));
    parts().any(|(origin, part)| origin.link() == Some(link) && part.abs() > 1e-9 * most)
}

/// Maximum number of parts in a tooltip.
const MAX_TIP_PARTS: usize = 12;

fn tip(ui: &Ui, pen: &TermPainter<'_>, term: &Term, unit: &str) {
    let mut parts: Vec<_> = term.parts.iter().filter(|(_, part)| *part != 0.0).collect();
    parts.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
    let mut lines = vec![format!("{} = {} {unit}", written(&term.symbol), signed(term.value, TIP_DECIMALS))];
    if term.is_negative {
        lines[0].insert_str(0, "− ");
    }
    let of = |(origin, part): &&(_, f64)| {
        let origin: &stillbase_study::equations::Origin = origin;
        format!("{}: {} {unit}", origin.words(pen.machine), signed(*part, TIP_DECIMALS))
    };
    if parts.len() > 1 || parts.first().is_some_and(|(origin, _)| origin.link().is_none()) {
        lines.extend(parts.iter().take(MAX_TIP_PARTS).map(of));
    } else {
        lines.extend(parts.iter().map(|(origin, _)| origin.words(pen.machine)));
    }
    if parts.len() > MAX_TIP_PARTS {
        lines.push(format!("and {} more", parts.len() - MAX_TIP_PARTS));
    }
    let id = ui.scope_id().with("term");
    egui::Tooltip::always_open(ui.ctx().clone(), ui.layer_id(), id, egui::PopupAnchor::Pointer).gap(14.0).show(|ui| {
        for line in lines {
            ui.label(RichText::new(line.trim_end()).font(plain(12.0)));
        }
    });
}

/// Returns the text of a line for a screen reader.
fn aloud(line: &Equality, cells: &[EquationCell<'_>]) -> String {
    let joined = |of: &dyn Fn(&EquationCell<'_>) -> String| cells.iter().map(of).collect::<Vec<_>>().join(" ");
    let symbols = joined(&|cell| format!("{} {}", cell.sign, written(cell.symbol)).trim().to_owned());
    let numbers = joined(&|cell| format!("{} {}", cell.number_sign, cell.number).trim().to_owned());
    let name = if line.name.is_empty() { String::new() } else { format!("{}: ", line.name) };
    format!("{name}{symbols}; {numbers} {}", line.unit)
}
