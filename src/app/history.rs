//! The list of changes, to undo and redo.

use egui::{Popup, PopupCloseBehavior, RectAlign, RichText, ScrollArea, Ui, Vec2, vec2};

use super::actions::key_of_switch;
use super::icon::{Icon, IconButton, dot};
use super::notation;
use super::theme::{bold, colour, plain};
use super::widgets::name;
use super::{Command, SessionCommand, Switch, ViewChange, ViewState};
use super::{fit, focus};
use stillbase_picture::scene::palette::Palette;
use stillbase_session::{Fork, Session};

/// Maximum height of the list, points; above it the list scrolls.
const MAX_HEIGHT_PT: f32 = 380.0;
/// Width of an entry, points: that of a point with where it was and where it is.
const WIDTH_PT: f32 = 340.0;
/// Height of a branch in its list, points.
const BRANCH_HEIGHT_PT: f32 = 38.0;

/// Draws the button of the list, and the list while it is open.
pub fn show(
    ui: &mut Ui,
    session: &Session,
    branches: &[Fork],
    view_state: &ViewState,
    size: Vec2,
    commands: &mut Vec<Command>,
) {
    let p = view_state.palette();
    let key = key_of_switch(Switch::History).unwrap_or_default();
    let tip = format!("history ({key})\nWhat was done, to go back and forth in; Ctrl Z undoes, Ctrl Y redoes");
    let on = Some(view_state.open.history);
    let button = IconButton { size, on, ..IconButton::of(Icon::History, "history", &tip) }.show(ui, &p);
    if button.clicked() {
        commands.push(ViewChange::Switch(Switch::History, !view_state.open.history).into());
    }
    let mut open = view_state.open.history;
    let popup =
        Popup::from_response(&button).open_bool(&mut open).align(RectAlign::RIGHT_END).gap(8.0).width(WIDTH_PT + 16.0);
    popup.close_behavior(PopupCloseBehavior::CloseOnClickOutside).show(|ui| {
        ui.label(RichText::new("HISTORY").font(bold(11.0)).color(colour(p.dim)));
        let room = MAX_HEIGHT_PT
            - if branches.is_empty() { 0.0 } else { 30.0 + BRANCH_HEIGHT_PT * branches.len().min(4) as f32 };
        ScrollArea::vertical().max_height(room).show(ui, |ui| list(ui, session, &p, commands));
        if !branches.is_empty() {
            ui.add_space(6.0);
            let tip = "How the run went on before you went back and did something else";
            ui.label(RichText::new("BRANCHES").font(bold(11.0)).color(colour(p.dim))).on_hover_text(tip);
            let area = ScrollArea::vertical().id_salt("branches").max_height(4.0 * BRANCH_HEIGHT_PT);
            area.show(ui, |ui| list_branches(ui, branches, &p, commands));
        }
    });
    if view_state.open.history && !open && !button.clicked() {
        commands.push(ViewChange::Switch(Switch::History, false).into());
    }
}

/// Draws the opened state, then each edit; undone edits are dimmed.
fn list(ui: &mut Ui, session: &Session, p: &Palette, commands: &mut Vec<Command>) {
    ui.spacing_mut().item_spacing.y = 1.0;
    let present = session.undo_count();
    let titles = std::iter::once("as it was opened").chain(session.history());
    for (i, title) in titles.enumerate() {
        let tone = if i > present { p.dim } else { p.ink };
        let title = notation::sentence(ui.ctx(), title);
        let words = format!("     {title}");
        let room = ui.available_width().max(WIDTH_PT) - 2.0 * ui.spacing().button_padding.x;
        let shown = fit::fitted(ui, &words, &plain(12.5), room);
        let is_whole = shown == words;
        let words = RichText::new(shown).font(plain(12.5)).color(colour(tone));
        let line = egui::Button::new(words).frame_when_inactive(false).min_size(egui::vec2(WIDTH_PT, 22.0));
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
        let line = if is_whole { line } else { line.on_hover_text(title.as_ref()) };
        if line.clicked() && i != present {
            commands.push(SessionCommand::GoTo(i).into());
        }
    }
    focus::keep_in_view(ui);
}

/// Draws each branch, titled by its first gesture that the run on display lacks; the newest branch is on top. A click
/// shows the branch; the run on display becomes a branch.
fn list_branches(ui: &mut Ui, branches: &[Fork], p: &Palette, commands: &mut Vec<Command>) {
    ui.spacing_mut().item_spacing = vec2(2.0, 1.0);
    for (i, branch) in branches.iter().enumerate().rev() {
        ui.horizontal(|ui| {
            let when = format!("parts at {:.3} s, to {:.3} s", branch.from, branch.to);
            let dim = colour(p.dim);
            let line = egui::Button::new("")
                .frame_when_inactive(false)
                .min_size(vec2(WIDTH_PT - 58.0, BRANCH_HEIGHT_PT - 2.0));
            let line = ui.add(line);
            let (title, when) = (notation::sentence(ui.ctx(), &branch.title), notation::sentence(ui.ctx(), &when));
            let corner = line.rect.left_top() + vec2(8.0, 4.0);
            for (words, font, tone, y) in [(&title, plain(12.5), colour(p.ink), 0.0), (&when, plain(11.0), dim, 16.0)] {
                let words = egui::WidgetText::from(RichText::new(words.as_ref()).color(tone));
                let words = words.into_galley(ui, Some(egui::TextWrapMode::Truncate), WIDTH_PT - 72.0, font);
                ui.painter().galley(corner + vec2(0.0, y), words, tone);
            }
            name(&line, &format!("Branch {}: {title}, {when}", i + 1));
            if line.on_hover_text("Shows it; what is shown now becomes a branch").clicked() {
                commands.push(SessionCommand::Branch(i).into());
            }
            let beside = IconButton::of(Icon::Beside, "compare branch", "Adds it to the runs side by side");
            if beside.show_in(ui, p, dim).clicked() {
                commands.push(SessionCommand::CompareBranch(i).into());
            }
            let away = IconButton::of(Icon::Cross, "remove branch", "Removes it; Ctrl Z brings it back");
            if away.show_in(ui, p, dim).clicked() {
                commands.push(SessionCommand::DropBranch(i).into());
            }
        });
    }
}

/// Identifier under which egui stores the index of the entry to which the list was scrolled last.
fn seen_id() -> egui::Id {
    egui::Id::unique("history seen")
}
