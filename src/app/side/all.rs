//! All settings by key, to search, read and edit.

use egui::{Align, Label, Layout, RichText, TextEdit, Ui};

use super::fold::{fold, undo};
use crate::facts::{ScenarioFacts, Setting};
use crate::place::fold_id;
use crate::theme::{colour, plain};
use crate::widgets::{name, note, undoable_edit};
use crate::{Command, WindowCommand};
use stillbase_picture::scene::palette::Palette;
use stillbase_session::Edit;
use stillbase_session::scenario::{Value, part_of};
use stillbase_settings::change::{self, DEFAULT_WORD};
use stillbase_settings::key::{Key, KeyType};
use stillbase_settings::quantity::{self, QuantityError};
use stillbase_settings::range::shortened;

/// Title of the list.
const TITLE: &str = "All settings";

/// Prefixes that are omitted from the names of settings, because a title above their rows contains them.
const PREFIXES_IN_TITLES: [&str; 7] = ["task.", "control.", "plant.", "base.wheel.", "base.", "tolerance.", "design."];

/// Maximum number of rows.
const MAX_ROWS: usize = 24;

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

/// Draws the list.
pub fn show(ui: &mut Ui, facts: &ScenarioFacts<'_>, p: &Palette, commands: &mut Vec<Command>) {
    fold(ui, p, TITLE, "by key", None, commands, |ui, commands| {
        let id = sought_id();
        let mut sought = ui.data(|d| d.get_temp::<String>(id)).unwrap_or_default();
        let field = TextEdit::singleline(&mut sought).hint_text("search: friction, limit, link.5 …");
        let response = ui.add(field.desired_width(f32::INFINITY));
        name(&response, "Search the settings");
        let wanted = ui.data_mut(|d| d.remove_temp::<bool>(wanted_id())).is_some();
        ui.data_mut(|d| d.insert_temp(id, sought.clone()));
        let word = sought.trim().to_lowercase();
        let (mut count, mut part) = (0, "");
        for setting in facts.settings().iter().filter(|setting| setting.text.contains(&word)) {
            count += 1;
            if count > MAX_ROWS {
                continue;
            }
            let of = part_of(setting.key);
            if of != std::mem::replace(&mut part, of) {
                ui.add_space(2.0);
                note(ui, p, of);
            }
            row(ui, p, setting, commands);
        }
        if wanted {
            let shown = response.rect.with_max_y(ui.min_rect().bottom());
            ui.scroll_to_rect(shown, Some(Align::Center));
        }
        match count {
            0 => note(ui, p, "no key contains this"),
            n if n > MAX_ROWS => note(ui, p, &format!("and {} more: search for them", n - MAX_ROWS)),
            _ => {}
        }
    });
}

/// Parses the text typed for a key. Numbers may have units and arithmetic, and are converted to the unit of the key.
/// Anything else is read as in a file.
fn typed(text: &str, key: &Key) -> Result<Value, QuantityError> {
    if text.trim().is_empty() {
        return Ok(DEFAULT_WORD.into());
    }
    let value = change::value(text);
    let numbers = matches!(
        key.value_type,
        KeyType::Number(_) | KeyType::Whole(_) | KeyType::PerDrive(_) | KeyType::List(..) | KeyType::Bounds(_)
    );
    // Words such as *none* are returned unchanged; the edit checks them.
    if !numbers || key.value_type.accepts(&value) || !text.contains(|c: char| c.is_ascii_digit() || c == 'π') {
        return Ok(value);
    }
    let all: Vec<f64> = text.split(',').map(|part| quantity::read(part, key.unit())).collect::<Result<_, _>>()?;
    Ok(match (key.value_type, all.as_slice()) {
        (KeyType::Whole(_), [one]) if one.fract() == 0.0 && one.abs() < 1e15 => Value::Integer(*one as i64),
        (_, [one]) => Value::Float(*one),
        (_, several) => several.to_vec().into(),
    })
}

fn row(ui: &mut Ui, p: &Palette, setting: &Setting, commands: &mut Vec<Command>) {
    let Setting { path, key, typed: shown, is_default, unmet_condition: wants, .. } = setting;
    let wants = wants.map_or_else(String::new, |wants| format!("\nNo effect as things are: that takes {wants}."));
    let instead = match key.instead {
        "" => String::new(),
        instead => format!("\nWithout it: {instead}."),
    };
    let tip = format!("{path}\n{}\n{}.{instead}{wants}", key.meaning, key.value_type);
    ui.horizontal(|ui| {
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let unit = RichText::new(key.unit()).font(plain(10.5)).color(colour(p.dim));
            ui.add_sized([40.0, 18.0], Label::new(unit).halign(Align::LEFT).truncate());
            let id = ui.scope_id().with(path);
            let kept = ui.data(|d| d.get_temp::<String>(id));
            let mut text = kept.clone().unwrap_or_else(|| shown.clone());
            let hint = if key.default.is_empty() { "" } else { key.default };
            let field = TextEdit::singleline(&mut text).id(id.with("field")).hint_text(hint).desired_width(72.0);
            let response = ui.add(field.font(plain(11.5))).on_hover_text(&tip);
            name(&response, path);
            if response.has_focus() {
                ui.data_mut(|d| d.insert_temp(id, text.clone()));
            } else if kept.is_some() {
                ui.data_mut(|d| d.remove_temp::<String>(id));
                let cancelled = ui.input(|i| i.key_pressed(egui::Key::Escape));
                if text.trim() != shown.as_str() && !cancelled {
                    match typed(&text, key) {
                        Ok(value) => undoable_edit(commands, Edit::set(path, value)),
                        Err(why) => {
                            let text = shortened(text.trim(), 24);
                            commands.push(
                                WindowCommand::Refuse(format!("{path}: \"{text}\" changes nothing: {why}")).into(),
                            );
                        }
                    }
                }
            }
            if !is_default
                && undo(ui, p, &format!("{path} back to normal"), &format!("Back to normal: {}", key.default))
            {
                undoable_edit(commands, Edit::set(path, DEFAULT_WORD));
            }
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                let ink = colour(if wants.is_empty() { p.ink } else { p.dim });
                let name = PREFIXES_IN_TITLES.iter().find_map(|part| path.strip_prefix(part)).unwrap_or(path.as_str());
                ui.add(Label::new(RichText::new(name).font(plain(11.0)).color(ink)).truncate()).on_hover_text(tip);
            });
        });
    });
}
