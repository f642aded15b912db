//! A row of a setting: its plain name and its key, its value and its unit.

use egui::{Align, Label, Layout, RichText, TextEdit, Ui};

use super::fold::undo;
use crate::facts::Setting;
use crate::theme::{colour, plain};
use crate::widgets::{name, undoable_edit};
use crate::{Command, WindowCommand, fit, notation};
use stillbase_picture::notation::{Notation, ShownUnit};
use stillbase_picture::scene::palette::Palette;
use stillbase_session::Edit;
use stillbase_session::scenario::{Value, name_of};
use stillbase_settings::change::{self, DEFAULT_WORD};
use stillbase_settings::key::{Key, KeyType};
use stillbase_settings::quantity::{self, QuantityError};
use stillbase_settings::range::shortened;

/// Least width of the text in a field, and what a field adds to the width of its text, points.
const MIN_FIELD_PT: f32 = 72.0;
const FIELD_MARGIN_PT: f32 = 20.0;
/// Width of a unit, points; a long one takes a second line.
const UNIT_PT: f32 = 44.0;
/// Number of significant digits of a value in another unit than that of its key.
const DIGITS: i32 = 9;

/// Returns the user's unit of a key's numbers, if it differs from the key's own.
pub fn shown_unit(key: &Key, notation: Notation) -> Option<ShownUnit> {
    // The number in a spread, such as normal:0.0005, stays in the unit of the key.
    holds_numbers(key).then(|| notation.shown_unit(key.unit()))?
}

fn holds_numbers(key: &Key) -> bool {
    use KeyType::{Bounds, List, Number, PerDrive, Whole};
    matches!(key.value_type, Number(_) | Whole(_) | PerDrive(_) | List(..) | Bounds(_))
}

/// Returns a value as it is typed, with its numbers in another unit. Words stay.
pub fn in_unit(text: &str, unit: Option<ShownUnit>) -> String {
    let Some(unit) = unit else { return text.to_owned() };
    let part = |part: &str| match part.trim().parse::<f64>() {
        Ok(number) => rounded(unit.factor * number).to_string(),
        Err(_) => part.to_owned(),
    };
    text.split(',').map(part).collect::<Vec<_>>().join(",")
}

/// Returns a number with [`DIGITS`] significant digits.
fn rounded(number: f64) -> f64 {
    if number == 0.0 || !number.is_finite() {
        return number;
    }
    let digits = (DIGITS - 1 - number.abs().log10().floor() as i32).clamp(-300, 300);
    let scale = 10.0_f64.powi(digits);
    let rounded = (number * scale).round() / scale;
    if rounded.is_finite() { rounded } else { number }
}

/// Reads the text typed for a key. Numbers may have units and arithmetic; without a unit they are in the user's unit.
/// They are converted to the unit of the key. Anything else is read as in a file.
pub fn typed(text: &str, key: &Key, unit: Option<ShownUnit>) -> Result<Value, QuantityError> {
    if text.trim().is_empty() {
        return Ok(DEFAULT_WORD.into());
    }
    let value = change::value(text);
    let is_final = unit.is_none() && key.value_type.accepts(&value);
    // Words such as *none* are returned unchanged; the edit checks them.
    if !holds_numbers(key) || is_final || !text.contains(|c: char| c.is_ascii_digit() || c == 'π') {
        return Ok(value);
    }
    let (name, factor) = unit.map_or((key.unit(), 1.0), |unit| (unit.name, unit.factor));
    let read =
        |part: &str| quantity::read(part, name).map(|number| if factor == 1.0 { number } else { number / factor });
    let all: Vec<f64> = text.split(',').map(read).collect::<Result<_, _>>()?;
    Ok(match (key.value_type, all.as_slice()) {
        (KeyType::Whole(_), [one]) if one.fract() == 0.0 && one.abs() < 1e15 => Value::Integer(*one as i64),
        (_, [one]) => Value::Float(*one),
        (_, several) => several.to_vec().into(),
    })
}

/// Draws the row.
pub fn row(ui: &mut Ui, p: &Palette, setting: &Setting, commands: &mut Vec<Command>) {
    let Setting { path, key, is_default, unmet_condition: wants, .. } = setting;
    let unit = shown_unit(key, notation::of(ui.ctx()));
    let shown = in_unit(&setting.typed, unit);
    let default = in_unit(key.default, unit);
    let in_words = unit.map_or(key.unit(), |unit| unit.name);
    let wants = wants.map_or_else(String::new, |wants| format!("\nNo effect as things are: that takes {wants}."));
    let instead = match key.instead {
        "" => String::new(),
        instead => format!("\nWithout it: {instead}."),
    };
    let called = name_of(path);
    let tip = format!("{called}\n{path}\n{}\n{}.{instead}{wants}", key.meaning, key.value_type);
    ui.horizontal(|ui| {
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let words = RichText::new(in_words).font(plain(10.5)).color(colour(p.dim));
            ui.add_sized([UNIT_PT, 18.0], Label::new(words).halign(Align::LEFT).wrap());
            let id = ui.scope_id().with(path);
            let kept = ui.data(|d| d.get_temp::<String>(id));
            let mut text = kept.clone().unwrap_or_else(|| shown.clone());
            // A long word gets more room, as long as the name keeps half of the row.
            let most = (0.5 * ui.available_width()).max(MIN_FIELD_PT);
            let width = (fit::width_of(ui, &text, &plain(11.5)) + FIELD_MARGIN_PT).clamp(MIN_FIELD_PT, most);
            let field = TextEdit::singleline(&mut text).id(id.with("field")).hint_text(&default).desired_width(width);
            let response = ui.add(field.font(plain(11.5))).on_hover_text(&tip);
            name(&response, path);
            if response.has_focus() {
                ui.data_mut(|d| d.insert_temp(id, text.clone()));
            } else if kept.is_some() {
                ui.data_mut(|d| d.remove_temp::<String>(id));
                let cancelled = ui.input(|i| i.key_pressed(egui::Key::Escape));
                if text.trim() != shown.as_str() && !cancelled {
                    match typed(&text, key, unit) {
                        Ok(value) => undoable_edit(commands, Edit::set(path, value)),
                        Err(why) => {
                            let text = shortened(text.trim(), 24);
                            commands.push(
                                WindowCommand::Refuse(format!("{path}: \"{text}\" changes nothing: {why}"), Vec::new())
                                    .into(),
                            );
                        }
                    }
                }
            }
            if !is_default && undo(ui, p, &format!("{path} back to normal"), &format!("Back to normal: {default}")) {
                undoable_edit(commands, Edit::set(path, DEFAULT_WORD));
            }
            ui.with_layout(Layout::top_down(Align::LEFT), |ui| {
                ui.spacing_mut().item_spacing.y = 0.0;
                let ink = colour(if wants.is_empty() { p.ink } else { p.dim });
                // A long name takes a second line.
                let line = |ui: &mut Ui, text: &str, font, tone| {
                    ui.add(Label::new(RichText::new(text).font(font).color(tone)).wrap())
                };
                line(ui, &called, plain(12.0), ink).on_hover_text(&tip);
                let small = line(ui, path, plain(9.5), colour(p.dim));
                fit::say(&small, &format!("key {path}"));
                small.on_hover_text(&tip);
            });
        });
    });
}
