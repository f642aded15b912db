//! The card of a [`Tour`]'s step, in a corner of the scene where it does not cover what its text mentions.

use egui::{Align2, Area, Button, Id, RichText, Ui, vec2};

use super::{STEPS, StepButton, Tour, said};
use crate::intro::Corner;
use crate::theme::{bold, card, colour, plain};
use crate::widgets::name;
use crate::{Command, ViewChange, ViewState, WindowCommand};
use stillbase_picture::scene::palette::Palette;
use stillbase_picture::scene::views::ViewKind;
use stillbase_session::Session;

impl Tour {
    /// Draws the card, if possible where it covers none of the things that it mentions.
    pub fn show(
        &self,
        ctx: &egui::Context,
        rect: egui::Rect,
        mentioned: &[egui::Rect],
        session: &Session,
        view_state: &ViewState,
        commands: &mut Vec<Command>,
    ) {
        let (p, step) = (view_state.palette(), &STEPS[self.step]);
        let width = 430.0_f32.min(rect.width() - 32.0);
        let size = ctx.memory(|m| m.area_rect(id())).map_or(vec2(width, 190.0), |last| last.size());
        let corner = Corner::kept(ctx, id(), view_state, rect, size, mentioned);
        let area = Area::new(id()).pivot(Align2::LEFT_TOP).fixed_pos(corner.place(rect, size).min);
        area.show(ctx, |ui| {
            card(&p).show(ui, |ui| {
                ui.set_width(width - 28.0);
                ui.horizontal(|ui| {
                    ui.label(RichText::new(step.title).font(bold(15.0)).color(colour(p.ink)));
                    ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                        let count = format!("{} of {}", self.step + 1, STEPS.len());
                        ui.label(RichText::new(count).font(plain(12.0)).color(colour(p.dim)));
                    });
                });
                let words = said(step.words, session);
                ui.add(egui::Label::new(RichText::new(words).font(plain(12.5)).color(colour(p.ink))).wrap());
                if let Some(note) = &self.note {
                    ui.add(egui::Label::new(RichText::new(note).font(plain(12.0)).color(colour(p.dim))).wrap());
                }
                ui.add_space(4.0);
                self.exercise(ui, &said(step.exercise, session), &p);
                ui.add_space(4.0);
                self.buttons(ui, (step.button)(session), view_state, &p, commands);
            });
        });
    }

    fn exercise(&self, ui: &mut Ui, exercise: &str, p: &Palette) {
        let (words, tone) =
            if self.done { (format!("Done: {exercise}"), p.zero) } else { (exercise.to_owned(), p.amber) };
        ui.add(egui::Label::new(RichText::new(words).font(bold(12.5)).color(colour(tone))).wrap());
    }

    fn buttons(
        &self,
        ui: &mut Ui,
        button: Option<StepButton>,
        view_state: &ViewState,
        p: &Palette,
        commands: &mut Vec<Command>,
    ) {
        ui.horizontal(|ui| {
            if let Some((words, what)) = button.filter(|_| !self.done)
                && ui.button(words).clicked()
            {
                if !view_state.view.shows_machine() {
                    commands.push(ViewChange::Kind(ViewKind::Flat).into());
                }
                commands.extend(what);
            }
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                let words = match (self.step + 1 == STEPS.len(), self.done) {
                    (true, _) => "End",
                    (false, true) => "Next",
                    (false, false) => "Skip",
                };
                let mut next = Button::new(RichText::new(words).color(colour(p.ink)));
                if self.done {
                    next = Button::new(RichText::new(words).color(colour(p.background))).fill(colour(p.amber));
                }
                let next = ui.add(next);
                name(&next, &format!("{words}: tour"));
                if next.clicked() {
                    commands.push(WindowCommand::TurnTour(true).into());
                }
                let back = ui.add_enabled(self.step > 0, Button::new("Back"));
                name(&back, "Back: tour");
                if back.clicked() {
                    commands.push(WindowCommand::TurnTour(false).into());
                }
                let leave = ui.add(Button::new(RichText::new("Leave").color(colour(p.dim))).frame(false));
                name(&leave, "Leave the tour");
                if leave.on_hover_text("Esc").clicked() {
                    commands.push(WindowCommand::Tour(false).into());
                }
            });
        });
    }

    /// Returns the rectangle of a scene that the card covers.
    pub fn covers(ctx: &egui::Context, rect: egui::Rect) -> egui::Rect {
        let usual = egui::Rect::from_min_size(rect.left_bottom() + vec2(0.0, -190.0), vec2(446.0, 190.0));
        ctx.memory(|m| m.area_rect(id())).unwrap_or(usual)
    }
}

fn id() -> Id {
    Id::unique("tour")
}
