//! Parts of the sections: heads that fold, switches, and numbers with a default value.

use egui::{Align, Button, ComboBox, Layout, RichText, Ui};

use crate::theme::{bold, colour, plain};
use crate::widgets::{NumberRow, name, send, undoable_edit};
use crate::{Command, GuidePlace, SessionCommand, fit, guide, place};
use stillbase_picture::scene::palette::Palette;
use stillbase_session::Edit;
use stillbase_session::scenario::Value;
use stillbase_settings::change::DEFAULT_WORD;

/// A section of the panel, and the part of a scenario that it edits.
#[derive(Clone, Copy)]
pub enum PanelSection {
    Plant,
    Base,
    Control,
}

impl PanelSection {
    fn word(self) -> &'static str {
        match self {
            Self::Plant => "plant",
            Self::Base => "base",
            Self::Control => "control",
        }
    }

    /// Returns the edit that sets a key, given by the parts of its path; the word `default` removes the key.
    pub fn set(self, path: &[&str], value: impl Into<Value>) -> Edit {
        Edit::at(&[&[self.word()], path].concat(), value)
    }

    /// Returns the edit that restores the default of a key.
    pub fn back(self, path: &[&str]) -> Edit {
        self.set(path, DEFAULT_WORD)
    }

    /// Returns the edit that restores the defaults of all keys.
    pub fn all_back(self) -> Edit {
        self.back(&[])
    }
}

/// Draws a section that folds. `back` is the edit that restores all its defaults; with such an edit, the section is
/// open at first.
pub fn fold(
    ui: &mut Ui,
    p: &Palette,
    title: &str,
    summary: &str,
    back: Option<Edit>,
    commands: &mut Vec<Command>,
    body: impl FnOnce(&mut Ui, &mut Vec<Command>),
) {
    let id = place::fold_id(title);
    let chosen = ui.data(|d| d.get_temp::<bool>(id));
    let mut open = chosen.unwrap_or(back.is_some());
    // Folded sections are close together.
    ui.add_space(if open { 8.0 } else { 2.0 });
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        let sign = if open { "▾" } else { "▸" };
        let words = RichText::new(format!("{sign} {}", title.to_uppercase())).font(bold(11.0)).color(colour(p.dim));
        let button = ui.add(Button::new(words).frame(false).min_size(egui::vec2(0.0, 18.0)));
        name(&button, &format!("{title} section"));
        if button.on_hover_text(if open { "Fold" } else { "Unfold" }).clicked() {
            open = !open;
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            guide::button(ui, p, title, GuidePlace::of_section(title), commands);
            let differs = back.is_some();
            if let Some(edit) = back
                && undo(ui, p, &format!("{title} back to normal"), "Put everything here back to normal")
            {
                undoable_edit(commands, edit);
            }
            let ink = colour(if differs { p.amber } else { p.dim });
            fit::label(ui, summary, plain(11.0), ink);
        });
    });
    // A section that was open at first stays open when all its values are defaults again.
    ui.data_mut(|d| d.insert_temp(id, open));
    if open {
        body(ui, commands);
    }
}

/// Draws a small button that restores a default; returns whether it was clicked.
pub fn undo(ui: &mut Ui, p: &Palette, label: &str, tip: &str) -> bool {
    let sign = RichText::new("↺").font(plain(13.0)).color(colour(p.amber));
    let response = ui.add(Button::new(sign).frame(false).min_size(egui::vec2(14.0, 18.0)));
    name(&response, label);
    response.on_hover_text(tip).clicked()
}

/// Draws a switch that sends an edit; returns its state before the edit.
pub fn switch(
    ui: &mut Ui,
    (label, tip): (&str, &str),
    on: bool,
    commands: &mut Vec<Command>,
    to: impl FnOnce(bool) -> Edit,
) -> bool {
    let mut now = on;
    if ui.checkbox(&mut now, label).on_hover_text(tip).changed() {
        undoable_edit(commands, to(now));
    }
    on
}

/// Draws a switch that is on while its setting is not zero. While the pointer is down it stays on, so that a slider
/// that passes zero does not hide itself.
pub fn switch_nonzero(
    ui: &mut Ui,
    words: (&str, &str),
    nonzero: bool,
    commands: &mut Vec<Command>,
    to: impl FnOnce(bool) -> Edit,
) -> bool {
    let id = egui::Id::unique(("switch_nonzero", words.0));
    let was = ui.data(|d| d.get_temp::<bool>(id)).unwrap_or_default();
    let held = ui.input(|i| i.pointer.any_down() || i.pointer.any_released());
    let on = nonzero || (was && held);
    ui.data_mut(|d| d.insert_temp(id, on));
    switch(ui, words, on, commands, to)
}

/// Draws choices side by side.
pub fn segments<T: Copy + PartialEq>(
    ui: &mut Ui,
    p: &Palette,
    choices: &[(T, &str, &str)],
    now: T,
    commands: &mut Vec<Command>,
    to: impl Fn(T) -> Edit,
) {
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 3.0;
        let width = (ui.available_width() - 3.0 * (choices.len() as f32 - 1.0)) / choices.len() as f32;
        for (value, words, tip) in choices {
            let chosen = *value == now;
            let text = RichText::new(*words).font(plain(12.0)).color(colour(if chosen { p.ink } else { p.dim }));
            let fill = if chosen { colour(p.line) } else { egui::Color32::TRANSPARENT };
            let button = Button::new(text).fill(fill).stroke((1.0, colour(p.line))).min_size(egui::vec2(width, 22.0));
            let response = ui.add(button.selected(false)).on_hover_text(*tip);
            if response.clicked() && !chosen {
                undoable_edit(commands, to(*value));
            }
        }
    });
}

/// Draws a label and a list to choose from; returns a newly chosen value.
pub fn choose<T: Clone + PartialEq>(
    ui: &mut Ui,
    label: &str,
    tip: &str,
    choices: &[(T, String)],
    now: &T,
    commands: &mut Vec<Command>,
    to: impl Fn(&T) -> Option<Edit>,
) -> Option<T> {
    let mut taken = None;
    ui.horizontal(|ui| {
        ui.label(label).on_hover_text(tip);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let shown = choices.iter().find(|c| c.0 == *now).map_or("", |c| &c.1);
            let room = (ui.available_width() - 22.0).clamp(60.0, 150.0);
            let response = ComboBox::from_id_salt(label).selected_text(shown).width(room).show_ui(ui, |ui| {
                for (value, words) in choices {
                    if ui.selectable_label(value == now, words).clicked() && value != now {
                        taken = Some(value.clone());
                        commands.extend(to(value).into_iter().flat_map(|e| {
                            [Command::Session(SessionCommand::Edit(e)), Command::Session(SessionCommand::EndGesture)]
                        }));
                    }
                }
            });
            name(&response.response.on_hover_text(tip), label);
        });
    });
    taken
}

/// Scale of the slider of a number, or no slider.
#[derive(Clone, Copy, PartialEq)]
pub enum SliderScale {
    No,
    Linear,
    Logarithmic,
}

/// A number with a default value.
pub struct NumberField<'a> {
    pub row: NumberRow<'a>,
    pub now: f64,
    pub normal: f64,
    /// Whether the default value is shown beside the number.
    pub shows_default: bool,
    /// The edit that restores the default; without it, the number is set to the default value.
    pub back: Option<Edit>,
    /// Its name for screen readers, if several fields have the same label.
    pub called: Option<String>,
}

impl<'a> NumberField<'a> {
    pub fn of(row: NumberRow<'a>, now: f64, normal: f64) -> Self {
        Self { row, now, normal, shows_default: false, back: None, called: None }
    }

    pub fn show(
        self,
        ui: &mut Ui,
        p: &Palette,
        slide: SliderScale,
        commands: &mut Vec<Command>,
        edit: impl Fn(f64) -> Edit,
    ) {
        let Self { row, now, normal, shows_default, back, called } = self;
        let called = called.unwrap_or_else(|| row.label.to_owned());
        let mut value = now;
        let differs = now != normal;
        let written = |x: f64| stillbase_picture::numbers::signed(x, row.decimals);
        let mut responses = Vec::new();
        ui.horizontal(|ui| {
            ui.label(row.label).on_hover_text(row.tip);
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                ui.spacing_mut().item_spacing.x = 6.0;
                super::unit(ui, p, row.unit);
                let number = row.number(ui, &mut value);
                name(&number, &format!("{called} {}", row.unit));
                responses.push(number);
                if differs {
                    let tip = format!("Back to normal: {} {}", written(normal), row.unit);
                    if undo(ui, p, &format!("{called} back to normal"), &tip) {
                        undoable_edit(commands, back.unwrap_or_else(|| edit(normal)));
                    }
                }
                if shows_default {
                    let text = RichText::new(written(normal)).font(plain(11.5)).color(colour(p.dim));
                    ui.label(text).on_hover_text("As the model has it");
                }
            });
        });
        if slide != SliderScale::No {
            responses.push(row.slider(ui, &mut value, slide == SliderScale::Logarithmic));
        }
        send(commands, &responses, || edit(value));
    }
}
