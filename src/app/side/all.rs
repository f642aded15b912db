//! All settings, to search, read and edit: in the panel, and in a window of their own.

use egui::{Align, RichText, ScrollArea, TextEdit, Ui, vec2};

use super::SCROLL_BAR_WIDTH;
use super::fold::fold;
use super::setting;
use crate::facts::{ScenarioFacts, Setting};
use crate::place::fold_id;
use crate::theme::{bold, colour};
use crate::widgets::{name, note};
use crate::{Command, Switch, ViewChange, ViewState, focus};
use stillbase_picture::scene::palette::Palette;
use stillbase_session::scenario::part_of;

/// Title of the list.
const TITLE: &str = "All settings";

/// Maximum number of rows in the panel.
const MAX_ROWS: usize = 24;

/// Minimum width of a column, and space between columns, points.
const MIN_COLUMN_PT: f32 = 216.0;
const COLUMN_GAP_PT: f32 = 20.0;
/// Minimum width of a column of the window, points, and maximum number of its columns.
const MIN_WINDOW_COLUMN_PT: f32 = 300.0;
const MAX_COLUMNS: f32 = 5.0;

fn sought_id() -> egui::Id {
    egui::Id::unique("settings sought")
}

/// Key under which egui stores the request to scroll to the list in the next pass.
fn wanted_id() -> egui::Id {
    egui::Id::unique("settings wanted")
}

/// Unfolds the list and searches it for a path.
pub fn look_up(ctx: &egui::Context, path: &str) {
    ctx.data_mut(|data| {
        data.insert_temp(fold_id(TITLE), true);
        data.insert_temp(sought_id(), path.to_owned());
        data.insert_temp(wanted_id(), true);
    });
}

/// Draws the list in the panel.
pub fn show(ui: &mut Ui, facts: &ScenarioFacts<'_>, p: &Palette, in_window: bool, commands: &mut Vec<Command>) {
    fold(ui, p, TITLE, "by name", None, commands, |ui, commands| {
        let (response, word) = search(ui);
        let wanted = ui.data_mut(|d| d.remove_temp::<bool>(wanted_id())).is_some();
        let words = if in_window { "Close the window" } else { "In a window, all at once" };
        let button = ui.small_button(words).on_hover_text("Every setting in as many columns as fit");
        name(&button, "All settings in a window");
        if button.clicked() {
            commands.push(ViewChange::Switch(Switch::Settings, !in_window).into());
        }
        let settings = facts.settings();
        let found: Vec<&Setting> = settings.iter().filter(|setting| setting.contains(&word)).collect();
        let shown = &found[..found.len().min(MAX_ROWS)];
        grouped(ui, p, shown, MIN_COLUMN_PT, commands);
        if wanted {
            let shown = response.rect.with_max_y(ui.min_rect().bottom());
            ui.scroll_to_rect(shown, Some(Align::Center));
        }
        match found.len() {
            0 => note(ui, p, "no setting contains this"),
            n if n > MAX_ROWS => note(ui, p, &format!("and {} more: search for them", n - MAX_ROWS)),
            _ => {}
        }
    });
}

/// Draws the window with all settings, while it is open.
pub fn window(ctx: &egui::Context, facts: &ScenarioFacts<'_>, view_state: &ViewState, commands: &mut Vec<Command>) {
    if !view_state.open.settings {
        return;
    }
    let p = view_state.palette();
    let mut open = true;
    // Right of the tool bar, between the bars at the top and at the bottom.
    let size = ctx.content_rect().size() - vec2(96.0, 104.0);
    egui::Window::new(TITLE)
        .id(egui::Id::unique("window of all settings"))
        .open(&mut open)
        .collapsible(false)
        .default_size(size.max(vec2(320.0, 240.0)))
        .default_pos([72.0, 56.0])
        .min_size([320.0, 240.0])
        .show(ctx, |ui| {
            let (_, word) = search(ui);
            let settings = facts.settings();
            let found: Vec<&Setting> = settings.iter().filter(|setting| setting.contains(&word)).collect();
            ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                ui.set_width(ui.available_width() - SCROLL_BAR_WIDTH);
                grouped(ui, &p, &found, MIN_WINDOW_COLUMN_PT, commands);
                if found.is_empty() {
                    note(ui, &p, "no setting contains this");
                }
                focus::keep_in_view(ui);
            });
        });
    if !open {
        commands.push(ViewChange::Switch(Switch::Settings, false).into());
    }
}

/// Draws the search field; returns it with the word that is sought.
fn search(ui: &mut Ui) -> (egui::Response, String) {
    let mut sought = ui.data(|d| d.get_temp::<String>(sought_id())).unwrap_or_default();
    let field = TextEdit::singleline(&mut sought).hint_text("search: friction, limit, link 5 …");
    let response = ui.add(field.desired_width(f32::INFINITY));
    name(&response, "Search the settings");
    let word = sought.trim().to_lowercase();
    ui.data_mut(|d| d.insert_temp(sought_id(), sought));
    (response, word)
}

/// Draws settings below the titles of their parts, in as many columns of a minimum width, points, as fit.
fn grouped(ui: &mut Ui, p: &Palette, settings: &[&Setting], min_width: f32, commands: &mut Vec<Command>) {
    let columns = ((ui.available_width() + COLUMN_GAP_PT) / (min_width + COLUMN_GAP_PT)).floor();
    let columns = columns.clamp(1.0, MAX_COLUMNS) as usize;
    for part in settings.chunk_by(|a, b| part_of(a.key) == part_of(b.key)) {
        ui.add_space(4.0);
        ui.label(RichText::new(part_of(part[0].key)).font(bold(11.5)).color(colour(p.dim)));
        let rows = part.len().div_ceil(columns);
        ui.scope(|ui| {
            ui.spacing_mut().item_spacing.x = if columns > 1 { COLUMN_GAP_PT } else { 8.0 };
            ui.columns(columns, |uis| {
                // Each column is read from top to bottom.
                for (ui, part) in uis.iter_mut().zip(part.chunks(rows)) {
                    ui.spacing_mut().item_spacing.x = 8.0;
                    part.iter().for_each(|setting| setting::row(ui, p, setting, commands));
                }
            });
        });
    }
}
