//! The built-in machines as pictures to choose from.

use std::sync::LazyLock;

use egui::{Align2, Key, RichText, Sense, Stroke, TextStyle, TextWrapMode, Ui, WidgetText, vec2};

use super::theme::{bold, colour, plain};
use super::widgets::name;
use stillbase_mechanics::machine::{self, Machine};
use stillbase_picture::paint::portrait::Portrait;
use stillbase_picture::scene::palette::Palette;

/// Pictures of the built-in machines, in their order; drawn when the list is first opened.
static PORTRAITS: LazyLock<Vec<Portrait>> = LazyLock::new(|| machine::builtins().iter().map(Portrait::of).collect());

const CARD_SIZE: egui::Vec2 = vec2(282.0, 222.0);
const PICTURE_HEIGHT: f32 = 112.0;
const GAP: f32 = 8.0;
const MARGIN: f32 = 12.0;
/// Maximum number of columns.
const MAX_COLUMNS: f32 = 4.0;

/// Returns the maximum height of the list, points.
pub fn room(ui: &Ui) -> f32 {
    (ui.ctx().content_rect().height() - 76.0).clamp(160.0, 3.0 * (CARD_SIZE.y + GAP))
}

/// Draws the list; returns the machine that the user has chosen, if it differs from the present one.
pub fn show(ui: &mut Ui, present: &Machine, p: &Palette) -> Option<&'static Machine> {
    let wide = ui.ctx().content_rect().width() - 60.0;
    let columns = ((wide + GAP) / (CARD_SIZE.x + GAP)).floor().clamp(1.0, MAX_COLUMNS) as usize;
    ui.set_width(columns as f32 * (CARD_SIZE.x + GAP) - GAP);
    ui.spacing_mut().item_spacing = vec2(GAP, GAP);
    let opened = ui.ctx().memory(|memory| memory.focused()).is_none();
    let machines: Vec<_> = machine::builtins().iter().zip(PORTRAITS.iter()).collect();
    let mut cards = Vec::with_capacity(machines.len());
    for row in machines.chunks(columns) {
        ui.horizontal(|ui| {
            for (machine, portrait) in row {
                cards.push(card(ui, p, machine, portrait, machine.name() == present.name()));
            }
        });
    }
    let own = machines.iter().position(|(machine, _)| machine.name() == present.name());
    if opened {
        // Arrow keys start from the present machine.
        let card = &cards[own.unwrap_or(0)];
        card.request_focus();
        card.scroll_to_me(None);
    }
    if let Some(at) = cards.iter().position(egui::Response::has_focus) {
        move_focus(ui, &cards, at, columns);
    }
    let picked = cards.iter().position(egui::Response::clicked)?;
    ui.close();
    Some(machines[picked].0).filter(|machine| *machine != present)
}

/// Moves the keyboard focus between cards by the arrow keys, and consumes these keys.
fn move_focus(ui: &Ui, cards: &[egui::Response], at: usize, columns: usize) {
    let filter = egui::EventFilter { horizontal_arrows: true, vertical_arrows: true, ..Default::default() };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(cards[at].id, filter));
    let pressed = |key| ui.input_mut(|i| i.consume_key(egui::Modifiers::NONE, key));
    let steps = [
        (Key::ArrowLeft, at.checked_sub(1)),
        (Key::ArrowRight, Some(at + 1)),
        (Key::ArrowUp, at.checked_sub(columns)),
        (Key::ArrowDown, Some(at + columns)),
    ];
    for (key, to) in steps {
        if pressed(key)
            && let Some(next) = to.and_then(|to| cards.get(to))
        {
            next.request_focus();
            next.scroll_to_me(None);
        }
    }
}

fn card(ui: &mut Ui, p: &Palette, machine: &Machine, portrait: &Portrait, present: bool) -> egui::Response {
    let (rect, response) = ui.allocate_exact_size(CARD_SIZE, Sense::click());
    let drives = format!("{} {}", machine.drives(), if machine.drives() == 1 { "drive" } else { "drives" });
    let summary = &machine.spec().summary;
    let words = format!("{}, {drives}{}. {summary}", machine.name(), if present { ", on display" } else { "" });
    name(&response, &words);
    if !ui.is_rect_visible(rect) {
        return response;
    }
    let edge = match (response.has_focus(), present, response.hovered()) {
        (true, ..) => Stroke::new(2.0, colour(p.ink)),
        (_, true, _) => Stroke::new(2.0, colour(p.amber)),
        (.., true) => Stroke::new(1.0, colour(p.dim)),
        _ => Stroke::new(1.0, colour(p.line)),
    };
    let painter = ui.painter();
    painter.rect(rect, 8.0, colour(p.background), edge, egui::StrokeKind::Inside);
    let inner = rect.shrink(MARGIN);
    let picture = egui::Rect::from_min_size(inner.min, vec2(inner.width(), PICTURE_HEIGHT - MARGIN));
    portrait.paint(painter, picture.shrink2(vec2(8.0, 4.0)), p);
    let line = inner.top() + PICTURE_HEIGHT;
    let at = |x| egui::pos2(x, line);
    let title = if present { colour(p.amber) } else { colour(p.ink) };
    painter.text(at(inner.left()), Align2::LEFT_TOP, machine.name(), bold(13.5), title);
    painter.text(at(inner.right()), Align2::RIGHT_TOP, drives, plain(12.0), colour(p.dim));
    let about = RichText::new(summary).font(plain(11.5)).color(colour(p.dim));
    let about = WidgetText::from(about).into_galley(ui, Some(TextWrapMode::Wrap), inner.width(), TextStyle::Small);
    ui.painter().galley(egui::pos2(inner.left(), line + 20.0), about, colour(p.dim));
    response
}
