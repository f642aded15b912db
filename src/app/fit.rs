//! Text in the room that it has: whole, or shortened at a word, with the whole of it on hover.

use std::borrow::Cow;

use egui::accesskit::Role;
use egui::{Color32, FontId, Label, Response, RichText, TextWrapMode, Ui, WidgetInfo};

use stillbase_settings::text::{cut_at_word, cut_path};

/// Returns the width of a line of text, points.
pub fn width_of(ui: &Ui, text: &str, font: &FontId) -> f32 {
    ui.painter().layout_no_wrap(text.to_owned(), font.clone(), Color32::WHITE).size().x
}

/// Returns a text that fits a width, points.
pub fn fitted<'a>(ui: &Ui, text: &'a str, font: &FontId, room: f32) -> Cow<'a, str> {
    cut_at_word(text, |part| width_of(ui, part, font) <= room)
}

/// Returns a path that fits a width, points.
pub fn fitted_path<'a>(ui: &Ui, path: &'a str, font: &FontId, room: f32) -> Cow<'a, str> {
    cut_path(path, |part| width_of(ui, part, font) <= room)
}

/// Draws a text in the room that is left in the line.
pub fn label(ui: &mut Ui, text: &str, font: FontId, tone: Color32) -> Response {
    label_within(ui, text, font, tone, ui.available_width())
}

/// Draws a text in a room of this width, points.
pub fn label_within(ui: &mut Ui, text: &str, font: FontId, tone: Color32, room: f32) -> Response {
    let shown = fitted(ui, text, &font, room);
    let is_whole = shown == text;
    let label = Label::new(RichText::new(shown).font(font).color(tone)).wrap_mode(TextWrapMode::Extend);
    let response = ui.add(label);
    if is_whole {
        return response;
    }
    say(&response, text);
    response.on_hover_text(text)
}

/// Tells screen readers a text in place of the one that a label shows.
pub fn say(label: &Response, text: &str) {
    label.widget_info(|| WidgetInfo::labeled(Role::Label, true, text));
}
