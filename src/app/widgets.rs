//! Parts of the panels: rows of numbers, section titles, notes, and names for screen readers.

use std::cell::Cell;
use std::ops::RangeInclusive;

use egui::response::Flags;
use egui::{
    Align, DragValue, EventFilter, Key, Label, Layout, Modifiers, Response, RichText, Slider, SliderClamping, Ui,
};

use super::theme::{bold, colour, plain};
use super::{Command, SessionCommand, fit, focus, notation, pointing};
use stillbase_picture::notation::ShownUnit;
use stillbase_picture::numbers::signed;
use stillbase_picture::scene::palette::Palette;
use stillbase_session::Edit;
use stillbase_session::scenario::key_of;
use stillbase_settings::key;
use stillbase_settings::number::ShortNumber;
use stillbase_settings::quantity;
use stillbase_settings::range::shortened;

/// The payload that is added with a click, kg.
pub(super) const CLICK_PAYLOAD: f64 = 0.3;

/// Sets the name of a widget for screen readers.
pub fn name(response: &Response, label: &str) {
    pointing::drawn(response, label);
    if focus::is_asked(&response.ctx, label) {
        response.request_focus();
    }
    let label = label.to_owned();
    response.ctx.accesskit_node_builder(response.id, |node| node.set_label(label));
}

/// Whether a key is pressed that moves through a list: up or down.
pub(super) fn steps(ui: &Ui) -> bool {
    ui.input(|i| i.key_pressed(Key::ArrowUp) || i.key_pressed(Key::ArrowDown))
}

/// Lets the keys up and down move through the choices of a drop-down list that has the keyboard focus, open or not.
/// Returns the choice that a key has led to.
pub(super) fn stepped<'a, T: Clone + PartialEq + 'a>(
    ui: &Ui,
    list: &Response,
    all: impl Iterator<Item = &'a T>,
    now: &T,
) -> Option<T> {
    if !list.has_focus() {
        return None;
    }
    // Without this the keys would move the focus.
    let filter = EventFilter { vertical_arrows: true, ..EventFilter::default() };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(list.id, filter));
    let keys = [Key::ArrowUp, Key::ArrowDown];
    let [up, down] = keys.map(|key| ui.input_mut(|i| i.count_and_consume_key(Modifiers::NONE, key)));
    if up == down {
        return None;
    }
    let all: Vec<&T> = all.collect();
    let at = all.iter().position(|one| *one == now)?;
    let to = (at + down).saturating_sub(up).min(all.len() - 1);
    (to != at).then(|| all[to].clone())
}

pub(super) fn section(ui: &mut Ui, p: &Palette, title: &str) {
    ui.add_space(10.0);
    ui.label(RichText::new(title.to_uppercase()).font(bold(11.0)).color(colour(p.dim)));
}

/// Draws a heading with a hint: beside it, or below it if there is no room.
pub(super) fn heading(ui: &mut Ui, p: &Palette, title: &str, words: &str) {
    let words = notation::sentence(ui.ctx(), words);
    let [title_font, words_font] = [bold(13.5), plain(11.5)];
    let width = fit::width_of(ui, title, &title_font) + fit::width_of(ui, &words, &words_font);
    let has_room = width + ui.spacing().item_spacing.x <= ui.available_width();
    let title = RichText::new(title).font(title_font).color(colour(p.ink));
    let words = Label::new(RichText::new(words).font(words_font).color(colour(p.dim))).wrap();
    match has_room {
        true => _ = ui.horizontal(|ui| [ui.label(title), ui.add(words)]),
        false => _ = [ui.label(title), ui.add(words)],
    }
    ui.add_space(2.0);
}

/// A row: a name on the left, an editable number and its unit on the right.
pub(super) struct NumberRow<'a> {
    pub label: &'a str,
    pub unit: &'a str,
    pub tip: &'a str,
    pub decimals: usize,
    /// Change of the value by a drag of one point.
    pub speed: f64,
    /// Valid range.
    pub range: RangeInclusive<f64>,
    /// Range of the slider.
    pub slide: RangeInclusive<f64>,
}

/// Returns the explanation of a setting, by its path.
pub(super) fn tip_of(path: &str) -> &'static str {
    key_of(path).map_or("", |key| key.meaning)
}

impl<'a> NumberRow<'a> {
    /// Creates the row of the setting at `path`, with the unit, range and tip of its key.
    pub fn of(label: &'a str, path: &str) -> Self {
        let key = key_of(path);
        let range = key.and_then(key::Key::range).map_or(f64::MIN..=f64::MAX, |range| range.low()..=range.high());
        let (unit, tip) = key.map_or(("", ""), |key| (key.unit(), key.meaning));
        Self { label, unit, tip, decimals: 2, speed: 0.01, slide: range.clone(), range }
    }

    /// Sets the decimals, and the change by a drag of one point.
    pub fn with(self, decimals: usize, speed: f64) -> Self {
        Self { decimals, speed, ..self }
    }

    /// Sets the range of the slider.
    pub fn sliding(self, slide: RangeInclusive<f64>) -> Self {
        Self { slide, ..self }
    }
}

impl NumberRow<'_> {
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

    /// Returns this row in another unit.
    fn in_unit(&self, unit: &ShownUnit) -> NumberRow<'_> {
        let scaled = |range: &RangeInclusive<f64>| unit.factor * range.start()..=unit.factor * range.end();
        NumberRow {
            unit: unit.name,
            decimals: unit.decimals(self.decimals),
            speed: unit.factor * self.speed,
            range: scaled(&self.range),
            slide: scaled(&self.slide),
            ..*self
        }
    }

    /// Draws the number in the user's unit.
    pub fn number(&self, ui: &mut Ui, value: &mut f64) -> Response {
        let Some(unit) = notation::of(ui.ctx()).shown_unit(self.unit) else { return self.own_number(ui, value) };
        let mut shown = unit.factor * *value;
        let response = self.in_unit(&unit).own_number(ui, &mut shown);
        if response.changed() {
            *value = (shown / unit.factor).clamp(*self.range.start(), *self.range.end());
        }
        response
    }

    fn own_number(&self, ui: &mut Ui, value: &mut f64) -> Response {
        let shown = ui.style().number_formatter.format(*value, self.decimals..=self.decimals);
        let before = *value;
        // Reason of a refusal, and the number that was read, if it was one.
        let refused = Cell::new(None);
        let read = |text: &str| {
            // If the text is unchanged, the value keeps the digits that the text does not show.
            if text == shown {
                return None;
            }
            let (why, number) = match quantity::read(text, self.unit) {
                Ok(number) if self.range.contains(&number) => return Some(number),
                Ok(number) => (self.allowed_range(), Some(number)),
                Err(why) => (why.to_string(), None),
            };
            refused.set(Some((self.why_not(text, &why), number)));
            None
        };
        let drag = DragValue::new(value)
            .custom_parser(read)
            .speed(self.speed)
            .range(self.range.clone())
            // A value read from a file is clamped only when it is edited.
            .clamp_existing_to_range(false)
            .fixed_decimals(self.decimals)
            .update_while_editing(false);
        // A number that has the focus before it is drawn is ready to be typed over.
        if focus::is_asked(ui.ctx(), self.label) {
            ui.memory_mut(|memory| memory.request_focus(ui.next_auto_id()));
        }
        let mut response = ui.add(drag).on_hover_text(self.tip);
        // The factor is 1, because egui itself slows the drag with Shift.
        restrict(&mut response, value, before, &self.range, 1.0, self.round());
        if let Some((why, number)) = refused.take() {
            let nearest = number.filter(|x| !x.is_nan());
            let nearest = nearest.map(|x| (response.id, x.clamp(*self.range.start(), *self.range.end())));
            let unit = if self.unit.is_empty() { String::new() } else { format!(" {}", self.unit) };
            let way_out =
                nearest.map_or_else(String::new, |(_, x)| format!("take {} = {}{unit}", self.label, self.exact(x)));
            ui.data_mut(|data| data.insert_temp(refused_id(), RefusedEntry { why, nearest, way_out }));
        }
        let taken = ui.data_mut(|data| data.remove_temp::<TakenNumber>(taken_id(response.id)));
        if let Some(TakenNumber { number, .. }) = taken.filter(|taken| taken.is_of_last_pass(ui.ctx())) {
            *value = number;
            // As if the number had been typed: the edit is an undo entry of its own.
            response.flags.insert(Flags::CHANGED | Flags::DRAG_STOPPED);
        }
        name(&response, &format!("{} {}", self.label, self.unit));
        response
    }

    /// Returns what is allowed, in words.
    fn allowed_range(&self) -> String {
        let end = |x: f64| self.exact(x);
        let unit = if self.unit.is_empty() { String::new() } else { format!(" {}", self.unit) };
        let (low, high) = (end(*self.range.start()), end(*self.range.end()));
        format!("want a number from {low} to {high}{unit}")
    }

    /// Writes a number with the decimals of the row, or with more if it would be another one.
    fn exact(&self, x: f64) -> String {
        let unit = 10f64.powi(self.decimals as i32);
        match ((x * unit).round() / unit - x).abs() <= 1e-9 * x.abs() {
            true => signed(x, self.decimals),
            false => ShortNumber(x).to_string(),
        }
    }

    fn why_not(&self, text: &str, why: &str) -> String {
        format!("{}: \"{}\" changes nothing: {why}", self.label, shortened(text.trim(), 24))
    }

    /// Returns the step of a drag with Ctrl.
    fn round(&self) -> f64 {
        match self.unit {
            "rad" => 0.05,
            "°" => 5.0,
            "m" => 0.01,
            "mm" => 10.0,
            _ => 10.0 * 0.1_f64.powi(self.decimals as i32),
        }
    }

    /// Draws the row with a slider below.
    pub fn with_slider(&self, ui: &mut Ui, p: &Palette, value: &mut f64) -> [Response; 2] {
        self.with_stopped_slider(ui, p, value, |requested| requested)
    }

    /// Draws the row with a slider whose value is limited by `stops`.
    pub fn with_stopped_slider(
        &self,
        ui: &mut Ui,
        p: &Palette,
        value: &mut f64,
        stops: impl Fn(f64) -> f64,
    ) -> [Response; 2] {
        let number = self.show(ui, p, value);
        [number, self.stopped_slider(ui, value, false, stops)]
    }

    /// Draws the slider alone.
    pub fn slider(&self, ui: &mut Ui, value: &mut f64, logarithmic: bool) -> Response {
        self.stopped_slider(ui, value, logarithmic, |requested| requested)
    }

    /// Draws the slider in the user's unit.
    fn stopped_slider(&self, ui: &mut Ui, value: &mut f64, logarithmic: bool, stops: impl Fn(f64) -> f64) -> Response {
        let Some(unit) = notation::of(ui.ctx()).shown_unit(self.unit) else {
            return self.own_slider(ui, value, logarithmic, stops);
        };
        let mut shown = unit.factor * *value;
        let stops = |requested: f64| unit.factor * stops(requested / unit.factor);
        let response = self.in_unit(&unit).own_slider(ui, &mut shown, logarithmic, stops);
        if response.changed() {
            *value = (shown / unit.factor).clamp(*self.slide.start(), *self.slide.end());
        }
        response
    }

    fn own_slider(&self, ui: &mut Ui, value: &mut f64, logarithmic: bool, stops: impl Fn(f64) -> f64) -> Response {
        ui.spacing_mut().slider_width = ui.available_width();
        // The slider's size follows from the row height.
        ui.spacing_mut().interact_size.y = 15.0;
        let before = *value;
        let turned = |requested: Option<f64>| {
            if let Some(requested) = requested {
                *value = stops(requested);
            }
            *value
        };
        let slider = Slider::from_get_set(self.slide.clone(), turned);
        let slider = slider.clamping(SliderClamping::Edits).show_value(false);
        let mut slider = ui.add(slider.smart_aim(false).logarithmic(logarithmic));
        restrict(&mut slider, value, before, &self.slide, f64::from(FINE_DRAG_FACTOR), self.round());
        ui.spacing_mut().interact_size.y = 22.0;
        name(&slider, &format!("{} slider", self.label));
        // During a drag the tooltip would cover the scene.
        if slider.dragged() { slider } else { slider.on_hover_text(self.tip) }
    }
}

/// Factor by which Shift slows a drag.
pub(super) const FINE_DRAG_FACTOR: f32 = 0.1;

/// A number that is being dragged.
#[derive(Clone, Copy)]
struct DraggedNumber {
    /// Value requested by the pointer.
    requested: f64,
    /// Lag of the number behind the pointer, because Shift slows the drag.
    behind: f64,
    /// Cancelled with Esc: the number keeps its value until the release.
    given_up: bool,
}

/// Limits the drag of a number: slower with Shift, to round numbers with Ctrl, no change after Esc.
fn restrict(response: &mut Response, value: &mut f64, before: f64, range: &RangeInclusive<f64>, fine: f64, round: f64) {
    let (ctx, id) = (response.ctx.clone(), response.id.with("held"));
    // On Esc egui itself ends a drag, but a slider goes on following the pointer.
    if !response.is_pointer_button_down_on() && !response.drag_stopped() {
        ctx.data_mut(|data| data.remove_temp::<Option<DraggedNumber>>(id));
        return;
    }
    let requested = *value;
    let now = ctx.data(|data| data.get_temp::<Option<DraggedNumber>>(id)).flatten();
    let mut now = now.unwrap_or(DraggedNumber { requested, behind: 0.0, given_up: false });
    let (shift, ctrl, esc) =
        ctx.input(|i| (i.modifiers.shift, i.modifiers.ctrl || i.modifiers.command, i.key_pressed(Key::Escape)));
    if shift {
        now.behind += (1.0 - fine) * (requested - now.requested);
    }
    now.requested = requested;
    if esc && !now.given_up {
        now.given_up = true;
        ctx.data_mut(|data| data.insert_temp(given_up_id(), true));
    }
    if now.behind != 0.0 {
        *value = (requested - now.behind).clamp(*range.start(), *range.end());
    }
    if ctrl {
        *value = ((*value / round).round() * round).clamp(*range.start(), *range.end());
    }
    if now.given_up {
        *value = before;
    }
    // A slider sets its value in every frame, changed or not.
    response.flags.set(Flags::CHANGED, *value != before);
    ctx.data_mut(|data| data.insert_temp(id, Some(now)));
}

/// Key of the flag for a cancelled drag; the flag is kept until the end of the pass.
fn given_up_id() -> egui::Id {
    egui::Id::unique("given up")
}

/// Takes the flag for a cancelled drag, and returns whether it was set in this pass.
pub(super) fn drag_cancelled(ctx: &egui::Context) -> bool {
    ctx.data_mut(|data| data.remove_temp::<bool>(given_up_id())).unwrap_or_default()
}

/// Key of the reason why an entry was refused; the reason is kept until the end of the pass.
fn refused_id() -> egui::Id {
    egui::Id::unique("refused entry")
}

/// A refused entry: a number out of its range, or text that is no number.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RefusedEntry {
    /// Reason of the refusal.
    pub why: String,
    /// The widget, and the nearest number in its range, in its unit.
    nearest: Option<(egui::Id, f64)>,
    /// Label of the button that takes the nearest number.
    way_out: String,
}

impl RefusedEntry {
    /// Draws the button that takes the nearest number in range, if there is one and its row is on display.
    pub(super) fn button(&self, ui: &mut Ui) {
        let Some((id, number)) = self.nearest.filter(|(id, _)| ui.ctx().read_response(*id).is_some()) else { return };
        let text = notation::sentence(ui.ctx(), &self.way_out);
        if ui.button(text).on_hover_text("The nearest number that is allowed").clicked() {
            let taken = TakenNumber { number, pass: ui.ctx().cumulative_pass_nr() };
            ui.data_mut(|data| data.insert_temp(taken_id(id), taken));
            ui.ctx().request_repaint();
        }
    }
}

/// A number that a widget is to take in the next pass.
#[derive(Clone, Copy, Default)]
struct TakenNumber {
    number: f64,
    /// The pass in which the button was clicked.
    pass: u64,
}

impl TakenNumber {
    /// Returns whether the click was just now. A row that was not drawn since then keeps its number.
    fn is_of_last_pass(self, ctx: &egui::Context) -> bool {
        ctx.cumulative_pass_nr() <= self.pass + 1
    }
}

/// Key of a [`TakenNumber`] of the widget `id`.
fn taken_id(id: egui::Id) -> egui::Id {
    id.with("taken")
}

/// Whether an entry was refused in this pass.
pub(super) fn has_refused(ctx: &egui::Context) -> bool {
    ctx.data(|data| data.get_temp::<RefusedEntry>(refused_id())).is_some()
}

/// Takes the entry that was refused in this pass, and returns it.
pub(super) fn refused_entry(ctx: &egui::Context) -> Option<RefusedEntry> {
    ctx.data_mut(|data| data.remove_temp(refused_id()))
}

/// Writes a unit behind a number, in the user's notation.
pub(super) fn unit(ui: &mut Ui, p: &Palette, text: &str) {
    let text = notation::of(ui.ctx()).unit_name(text);
    let size = if text.chars().count() > 6 { 10.5 } else { 11.5 };
    let text = RichText::new(text).font(plain(size)).color(colour(p.dim));
    ui.add_sized([44.0, 18.0], egui::Label::new(text).halign(Align::LEFT));
}

pub(super) fn note(ui: &mut Ui, p: &Palette, text: &str) {
    let text = notation::sentence(ui.ctx(), text);
    ui.add(egui::Label::new(RichText::new(text).font(plain(11.0)).color(colour(p.dim))).wrap());
}

/// Says why something cannot be, in the user's units.
pub(super) fn reason(ui: &mut Ui, p: &Palette, text: &str) {
    let text = notation::sentence(ui.ctx(), text);
    ui.add(egui::Label::new(RichText::new(text).font(plain(12.0)).color(colour(p.reaction))).wrap());
}

/// Sends an edit when a widget has changed, and ends the gesture at its release.
pub(super) fn send(commands: &mut Vec<Command>, responses: &[Response], edit: impl FnOnce() -> Edit) {
    if responses.iter().any(Response::changed) {
        commands.push(SessionCommand::Edit(edit()).into());
    }
    if responses.iter().any(|r| r.drag_stopped() || r.lost_focus()) {
        commands.push(SessionCommand::EndGesture.into());
    }
}

/// Sends an edit as a separate undo entry.
pub(super) fn undoable_edit(commands: &mut Vec<Command>, edit: Edit) {
    commands.extend([Command::Session(SessionCommand::Edit(edit)), Command::Session(SessionCommand::EndGesture)]);
}
