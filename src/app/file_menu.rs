//! The File menu: new, open, recent, save, export and quit, made from the table of actions.

use std::path::PathBuf;

use egui::{Button, Label, RichText, Sense, Ui, vec2};

use super::actions::{ACTIONS, Action, ActionGroup, shortcut_label};
use super::fit::{fitted, fitted_path};
use super::own_files::own_files;
use super::theme::{colour, plain};
use super::widgets::name;
use super::{Command, SessionCommand, ViewState};
use stillbase_picture::scene::palette::Palette;
use stillbase_query::Queries;
use stillbase_session::Session;

/// Width of the menu, and size of the picture of a recent file, points.
const WIDTH_PT: f32 = 330.0;
const PICTURE_PT: egui::Vec2 = vec2(64.0, 40.0);

/// Draws the button of the menu, and the menu while it is open.
pub fn show(
    ui: &mut Ui,
    session: &Session,
    queries: &Queries,
    recent: &[PathBuf],
    view_state: &ViewState,
    commands: &mut Vec<Command>,
) {
    let p = view_state.palette();
    let menu = ui.menu_button(RichText::new("File").font(plain(13.5)), |ui| {
        let mut entries = |ui: &mut Ui, group: ActionGroup| {
            ui.set_width(WIDTH_PT);
            let all = ACTIONS.iter().filter(|action| action.group == group);
            all.for_each(|action| entry(ui, &p, action, session, view_state, commands));
        };
        entries(ui, ActionGroup::Open);
        let opened = ui.menu_button("Open recent", |ui| recent_files(ui, &p, queries, recent)).inner.flatten();
        ui.separator();
        entries(ui, ActionGroup::Save);
        ui.menu_button("Export", |ui| entries(ui, ActionGroup::Export));
        ui.separator();
        entries(ui, ActionGroup::Quit);
        commands.extend(opened.map(|path| Command::Session(SessionCommand::OpenFile(path))));
    });
    name(&menu.response.on_hover_text("New, open, save, export, quit"), "File");
}

/// Draws an action with its key.
fn entry(
    ui: &mut Ui,
    p: &Palette,
    action: &Action,
    session: &Session,
    view_state: &ViewState,
    commands: &mut Vec<Command>,
) {
    let command = action.command(session, view_state);
    let key = action.keys.first().map(shortcut_label).unwrap_or_default();
    let button = Button::new(action.title()).right_text(RichText::new(key).color(colour(p.dim)));
    let response = ui.add_enabled(command.is_some(), button.wrap_mode(egui::TextWrapMode::Truncate));
    if response.clicked() {
        commands.extend(command);
        ui.close();
    }
}

/// Draws the recent files: picture, name and folder; returns the one that the user opens.
fn recent_files(ui: &mut Ui, p: &Palette, queries: &Queries, recent: &[PathBuf]) -> Option<PathBuf> {
    let mut opened = None;
    ui.set_width(WIDTH_PT);
    if recent.is_empty() {
        ui.add(Label::new(RichText::new("no file was opened or saved yet").color(colour(p.dim))));
    }
    let files = own_files(queries, recent, false);
    let of = |path: &PathBuf| files.as_ref().and_then(|all| all.iter().find(|file| file.path == *path));
    for path in recent {
        let (rect, response) = ui.allocate_exact_size(vec2(WIDTH_PT, PICTURE_PT.y + 8.0), Sense::click());
        if response.hovered() || response.has_focus() {
            ui.painter().rect_filled(rect, 6.0, colour(p.line));
        }
        let picture = egui::Rect::from_min_size(rect.min + vec2(6.0, 4.0), PICTURE_PT);
        if let Some(Ok(content)) = of(path).map(|file| &file.content) {
            content.portrait.paint(ui.painter(), picture, p);
        }
        let room = rect.right() - picture.right() - 18.0;
        let text = |ui: &Ui, y: f32, words: &str, font, ink| {
            ui.painter().text(egui::pos2(picture.right() + 10.0, y), egui::Align2::LEFT_TOP, words, font, ink);
        };
        let file = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
        let folder = path.parent().map_or_else(String::new, |folder| folder.display().to_string());
        text(ui, rect.top() + 6.0, &fitted(ui, &file, &plain(13.0), room), plain(13.0), colour(p.ink));
        text(ui, rect.top() + 26.0, &fitted_path(ui, &folder, &plain(11.0), room), plain(11.0), colour(p.dim));
        name(&response, &format!("Open {file}"));
        if response.on_hover_text(path.display().to_string()).clicked() {
            opened = Some(path.clone());
            ui.close();
        }
    }
    opened
}
