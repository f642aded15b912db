//! The imbalance: each line of Eqs. (7) and (8) as a bar, composed of the contributions of the links.

use egui::{Align2, CornerRadius, Rect, RichText, Sense, Stroke, StrokeKind, Ui, pos2, vec2};

use super::facts::{BalanceBars, DesignFacts};
use crate::theme::{bold, colour, plain};
use crate::widgets::heading;
use crate::{ViewState, place};
use stillbase_mechanics::machine::Machine;
use stillbase_picture::numbers::signed;
use stillbase_picture::scene::options::Handle;
use stillbase_picture::scene::palette::{Palette, mix};
use stillbase_session::Session;

/// Heights of a row and of its bar, and widths on the left for the symbol and on the right for the residual, points.
const ROW_HEIGHT_PT: f32 = 38.0;
const BAR_HEIGHT_PT: f32 = 18.0;
const SYMBOL_WIDTH_PT: f32 = 62.0;
const RESIDUAL_WIDTH_PT: f32 = 76.0;

/// Draws the bars.
pub fn show(ui: &mut Ui, session: &Session, facts: &DesignFacts, view_state: &ViewState) {
    let p = &view_state.palette();
    heading(ui, p, "(7) and (8)", "part of each link; below: the residual");
    let hot = hot_link(view_state, session);
    for term in facts.terms.iter() {
        row(ui, p, &facts.machine, term, hot);
    }
    if facts.terms.iter().any(|term| term.residual[1].abs() > 1e-9) {
        let words = "Some masses lie off the axes of their links; the bars show only the components along the axes.";
        ui.label(RichText::new(words).font(plain(11.0)).color(colour(p.dim)));
    }
}

/// Returns the index of the link that is dragged, under the pointer, or mentioned by a panel.
pub(super) fn hot_link(view_state: &ViewState, session: &Session) -> Option<usize> {
    let hot = view_state
        .gesture
        .grabbed
        .map(|pick| pick.handle)
        .or(view_state.pointed.object)
        .or(view_state.pointed.panel_object);
    hot.and_then(|handle| link_of(handle, session))
}

/// Returns the index of the link to which an object of the scene belongs.
fn link_of(handle: Handle, session: &Session) -> Option<usize> {
    let spec = session.scenario().machine.spec();
    match handle {
        Handle::Link(i) | Handle::Mass(i) | Handle::End(i) => Some(i),
        Handle::Weight(i) => {
            let weight = spec.counterweights.get(i)?;
            spec.link_index(&weight.link)
        }
        Handle::Lump(i) => {
            let lump = spec.lumps.get(i)?;
            spec.link_index(&lump.link)
        }
        _ => None,
    }
}

fn row(ui: &mut Ui, p: &Palette, machine: &Machine, term: &BalanceBars, hot: Option<usize>) {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), ROW_HEIGHT_PT), Sense::hover());
    let painter = ui.painter();
    let top = rect.top() + 3.0;
    let middle = top + 0.5 * BAR_HEIGHT_PT;
    painter.text(pos2(rect.left(), middle), Align2::LEFT_CENTER, &term.symbol, bold(13.0), colour(p.ink));
    let below = rect.top() + BAR_HEIGHT_PT + 12.0;
    painter.text(pos2(rect.left(), below), Align2::LEFT_CENTER, term.meaning, plain(10.5), colour(p.dim));
    let tone = colour(if term.is_balanced { p.zero } else { p.reaction });
    let size = term.residual[0].hypot(term.residual[1]);
    let text = match (term.is_balanced, term.residual[1] == 0.0) {
        (true, _) => "0".to_owned(),
        (false, true) => signed(term.residual[0], 4),
        (false, false) => format!("|{}|", signed(size, 4)),
    };
    painter.text(pos2(rect.right(), middle), Align2::RIGHT_CENTER, &text, bold(12.5), tone);
    painter.text(pos2(rect.right(), below), Align2::RIGHT_CENTER, term.unit, plain(10.5), colour(p.dim));
    let bar = Rect::from_min_max(
        pos2(rect.left() + SYMBOL_WIDTH_PT, top),
        pos2(rect.right() - RESIDUAL_WIDTH_PT, top + BAR_HEIGHT_PT),
    );
    let zero = bar.center().x;
    let greatest = term.greatest();
    if greatest > 0.0 {
        let scale = f64::from(0.5 * bar.width()) / greatest;
        let mut ends = [zero, zero];
        for (link, part) in &term.parts {
            let side = usize::from(*part > 0.0);
            let next = ends[side] + (part * scale) as f32;
            let segment = Rect::from_x_y_ranges(ends[side].min(next)..=ends[side].max(next), bar.y_range());
            ends[side] = next;
            draw_segment(ui, p, machine, segment, &LinkPart { link: *link, value: *part, unit: term.unit }, hot);
        }
        // The residual is drawn on the side that predominates.
        if !term.is_balanced {
            let outweighed = zero - (term.residual[0] * scale) as f32;
            let from =
                if term.residual[0] > 0.0 { ends[1] + (outweighed - zero) } else { ends[0] + (outweighed - zero) };
            let to = if term.residual[0] > 0.0 { ends[1] } else { ends[0] };
            let left = Rect::from_x_y_ranges(from.min(to)..=from.max(to), bar.bottom() + 2.0..=bar.bottom() + 5.0);
            ui.painter().rect_filled(left, 1.0, colour(p.ink));
        }
    }
    let centre = [pos2(zero, bar.top() - 3.0), pos2(zero, bar.bottom() + 3.0)];
    ui.painter().line_segment(centre, Stroke::new(1.5, colour(p.ink)));
    let of: Vec<String> = term
        .parts
        .iter()
        .map(|(link, part)| format!("link {} {}", machine.links()[*link].name, signed(*part, 4)))
        .collect();
    let words = format!("{}, {}: residual {} {}; {}", term.symbol, term.meaning, text, term.unit, of.join(", "));
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, &words));
}

/// The contribution of one link to a term.
struct LinkPart<'a> {
    link: usize,
    value: f64,
    unit: &'a str,
}

/// Draws the contribution of one link; `hot` is the highlighted link.
fn draw_segment(ui: &Ui, p: &Palette, machine: &Machine, rect: Rect, part: &LinkPart<'_>, hot: Option<usize>) {
    let LinkPart { link, value, unit } = *part;
    let tone = p.drive(machine.resolved_links()[link].drive);
    let tone = if hot == Some(link) { tone } else { mix(tone, p.panel, 0.38) };
    let inner = rect.shrink2(vec2(if rect.width() > 3.0 { 0.75 } else { 0.0 }, 0.0));
    ui.painter().rect_filled(inner, CornerRadius::same(2), colour(tone));
    if hot == Some(link) {
        ui.painter().rect_stroke(inner, CornerRadius::same(2), Stroke::new(1.5, colour(p.ink)), StrokeKind::Inside);
    }
    let words = &machine.links()[link].name;
    if rect.width() > 9.0 + 6.0 * words.chars().count() as f32 {
        ui.painter().text(rect.center(), Align2::CENTER_CENTER, words, bold(10.5), colour(p.background));
    }
    if ui.rect_contains_pointer(rect) {
        place::highlight(ui.ctx(), Handle::Link(link));
        let tip = format!("link {words}: {} {unit}", signed(value, 6));
        egui::Tooltip::always_open(
            ui.ctx().clone(),
            ui.layer_id(),
            ui.scope_id().with("bar"),
            egui::PopupAnchor::Pointer,
        )
        .gap(14.0)
        .show(|ui| ui.label(RichText::new(tip).font(plain(12.0))));
    }
}
