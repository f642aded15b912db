//! What the panels are made of: rows of numbers, section titles, notes, and names for screen readers.

use std::cell::Cell;
use std::ops::RangeInclusive;

use egui::{Align, DragValue, Layout, Response, RichText, Slider, SliderClamping, Ui};

use super::command::Command;
use super::theme::{bold, colour, plain};
use crate::picture::numbers::signed;
use crate::picture::scene::palette::Palette;
use crate::session::Edit;
use crate::session::scenario::key_of;
use crate::settings::key::Key;

/// Tells a screen reader what a widget is.
pub fn name(response: &Response, label: &str) {
    let label = label.to_owned();
    response.ctx.accesskit_node_builder(response.id, |node| node.set_label(label));
}

pub(super) fn section(ui: &mut Ui, p: &Palette, title: &str) {
    ui.add_space(10.0);
    ui.label(RichText::new(title.to_uppercase()).font(bold(11.0)).color(colour(p.dim)));
}

/// A name on the left, a number that can be dragged or typed and its unit on the right.
pub(super) struct Row<'a> {
    pub label: &'a str,
    pub unit: &'a str,
    pub tip: &'a str,
    pub decimals: usize,
    /// By how much a drag of one point changes it.
    pub speed: f64,
    /// What may be typed.
    pub range: RangeInclusive<f64>,
    /// What a slider goes through.
    pub slide: RangeInclusive<f64>,
}

/// What a setting means, by its path.
pub(super) fn tip_of(path: &str) -> &'static str {
    key_of(path).map_or("", |key| key.words)
}

impl<'a> Row<'a> {
    /// The row of a setting, by its path: unit, range and tip are those of its key.
    pub fn of(label: &'a str, path: &str) -> Self {
        let key = key_of(path);
        let range = key.and_then(Key::range).map_or(f64::MIN..=f64::MAX, |range| range.low()..=range.high());
        let (unit, tip) = key.map_or(("", ""), |key| (key.unit(), key.words));
        Self { label, unit, tip, decimals: 2, speed: 0.01, slide: range.clone(), range }
    }

    /// The same with decimals, and how fast a drag changes it.
    pub fn with(self, decimals: usize, speed: f64) -> Self {
        Self { decimals, speed, ..self }
    }

    /// The same with what a slider goes through.
    pub fn sliding(self, slide: RangeInclusive<f64>) -> Self {
        Self { slide, ..self }
    }
}

impl Row<'_> {
    pub fn show(&self, ui: &mut Ui, p: &Palette, value: &mut f64) -> Response {
        ui.horizontal(|ui| {
            ui.label(self.label).on_hover_text(self.tip);
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                unit(ui, p, self.unit);
                self.number(ui, value)
            })
            .inner
        })
        .inner
    }

    pub fn number(&self, ui: &mut Ui, value: &mut f64) -> Response {
        let shown = ui.style().number_formatter.format(*value, self.decimals..=self.decimals);
        let refused = Cell::new(None);
        let read = |text: &str| {
            // Nothing was typed: the value of the file stays exact.
            if text == shown {
                return None;
            }
            self.read(text).inspect_err(|_| refused.set(Some(text.to_owned()))).ok()
        };
        let drag = DragValue::new(value)
            .custom_parser(read)
            .speed(self.speed)
            .range(self.range.clone())
            // A value of a file stays as it is until it is changed here.
            .clamp_existing_to_range(false)
            .fixed_decimals(self.decimals)
            .update_while_editing(false);
        let response = ui.add(drag).on_hover_text(self.tip);
        if let Some(text) = refused.take() {
            ui.data_mut(|data| data.insert_temp(refused_id(), self.why_not(&text)));
        }
        name(&response, &format!("{} {}", self.label, self.unit));
        response
    }

    /// A number that was typed, if it is one and in range.
    fn read(&self, text: &str) -> Result<f64, ()> {
        let number: f64 = text.trim().replace('−', "-").parse().map_err(|_| ())?;
        if self.range.contains(&number) { Ok(number) } else { Err(()) }
    }

    fn why_not(&self, text: &str) -> String {
        let text: String = text.trim().chars().take(24).collect();
        let end = |x: f64| signed(x, self.decimals);
        let unit = if self.unit.is_empty() { String::new() } else { format!(" {}", self.unit) };
        let (low, high) = (end(*self.range.start()), end(*self.range.end()));
        format!("{}: \"{text}\" changes nothing: want a number from {low} to {high}{unit}", self.label)
    }

    /// The same with a slider below.
    pub fn with_slider(&self, ui: &mut Ui, p: &Palette, value: &mut f64) -> [Response; 2] {
        let number = self.show(ui, p, value);
        [number, self.slider(ui, value, false)]
    }

    /// A slider alone.
    pub fn slider(&self, ui: &mut Ui, value: &mut f64, logarithmic: bool) -> Response {
        ui.spacing_mut().slider_width = ui.available_width();
        // The field's size follows the row's height.
        ui.spacing_mut().interact_size.y = 15.0;
        let slider = Slider::new(value, self.slide.clone()).clamping(SliderClamping::Edits).show_value(false);
        let slider = ui.add(slider.smart_aim(false).logarithmic(logarithmic));
        ui.spacing_mut().interact_size.y = 22.0;
        name(&slider, &format!("{} slider", self.label));
        // In a drag it would cover what the drag is about.
        if slider.dragged() { slider } else { slider.on_hover_text(self.tip) }
    }
}

/// Where what was typed and cannot be taken waits for the end of the pass.
fn refused_id() -> egui::Id {
    egui::Id::unique("refused entry")
}

/// Why what was typed in this pass cannot be taken.
pub(super) fn refused_entry(ctx: &egui::Context) -> Option<String> {
    ctx.data_mut(|data| data.remove_temp(refused_id()))
}

pub(super) fn unit(ui: &mut Ui, p: &Palette, text: &str) {
    let size = if text.chars().count() > 6 { 10.5 } else { 11.5 };
    let text = RichText::new(text).font(plain(size)).color(colour(p.dim));
    ui.add_sized([44.0, 18.0], egui::Label::new(text).halign(Align::LEFT));
}

pub(super) fn note(ui: &mut Ui, p: &Palette, text: &str) {
    ui.add(egui::Label::new(RichText::new(text).font(plain(11.0)).color(colour(p.dim))).wrap());
}

/// Sends an edit when a widget has changed, and ends the gesture when it is let go.
pub(super) fn send(commands: &mut Vec<Command>, responses: &[Response], edit: impl FnOnce() -> Edit) {
    if responses.iter().any(Response::changed) {
        commands.push(Command::Edit(edit()));
    }
    if responses.iter().any(|r| r.drag_stopped() || r.lost_focus()) {
        commands.push(Command::EndGesture);
    }
}
