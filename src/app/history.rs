//! Everything that was done, as a list to go back and forth in.

use egui::{Popup, PopupCloseBehavior, RectAlign, RichText, ScrollArea, Ui, Vec2};

use super::actions::key_of;
use super::icon::{Icon, IconButton, dot};
use super::theme::{bold, colour, plain};
use super::widgets::name;
use super::{Command, ViewState};
use crate::picture::scene::palette::Palette;
use crate::session::Session;

/// How high the list grows before it scrolls, points.
const HIGHEST: f32 = 380.0;

/// Draws its button, and the list while it is open.
pub fn show(ui: &mut Ui, session: &Session, view_state: &ViewState, size: Vec2, commands: &mut Vec<Command>) {
    let p = view_state.palette();
    let key = key_of("History: what was done, to go back and forth in").unwrap_or_default();
    let tip = format!("history ({key})\nWhat was done, to go back and forth in; Ctrl Z undoes, Ctrl Y redoes");
    let on = Some(view_state.history);
    let button = IconButton { size, on, ..IconButton::of(Icon::History, "history", &tip) }.show(ui, &p);
    if button.clicked() {
        commands.push(Command::History(!view_state.history));
    }
    let mut open = view_state.history;
    let popup = Popup::from_response(&button).open_bool(&mut open).align(RectAlign::RIGHT_END).gap(8.0).width(270.0);
    popup.close_behavior(PopupCloseBehavior::CloseOnClickOutside).show(|ui| {
        ui.label(RichText::new("HISTORY").font(bold(11.0)).color(colour(p.dim)));
        ScrollArea::vertical().max_height(HIGHEST).show(ui, |ui| list(ui, session, &p, commands));
    });
    if view_state.history && !open && !button.clicked() {
        commands.push(Command::History(false));
    }
}

/// The state that was opened, then each edit; what was undone is dimmed.
fn list(ui: &mut Ui, session: &Session, p: &Palette, commands: &mut Vec<Command>) {
    ui.spacing_mut().item_spacing.y = 1.0;
    let present = session.undo_count();
    let titles = std::iter::once("as it was opened").chain(session.history());
    for (i, title) in titles.enumerate() {
        let tone = if i > present { p.dim } else { p.ink };
        let words = RichText::new(format!("     {title}")).font(plain(12.5)).color(colour(tone));
        let line = egui::Button::new(words).frame_when_inactive(false).truncate().min_size(egui::vec2(254.0, 22.0));
        let line = ui.add(line.right_text(""));
        if i == present {
            dot(ui, p, &line);
        }
        let state = if i == present {
            ", the present state"
        } else if i > present {
            ", undone"
        } else {
            ""
        };
        name(&line, &format!("Go to {i}: {title}{state}"));
        if i == present && ui.memory(|m| m.data.get_temp(seen_id()) != Some(present)) {
            line.scroll_to_me(None);
            ui.memory_mut(|m| m.data.insert_temp(seen_id(), present));
        }
        if line.clicked() && i != present {
            commands.push(Command::GoTo(i));
        }
    }
}

/// Where the list was scrolled to last.
fn seen_id() -> egui::Id {
    egui::Id::unique("history seen")
}
