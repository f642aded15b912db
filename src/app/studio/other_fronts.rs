//! Pareto fronts of other machines, drawn beside the front on display: kept fronts and fronts of built-in machines.

use egui::{Align, Button, Layout, RichText, Ui};
use egui_plot::{Line, LineStyle, PlotPoint, PlotPoints, PlotUi, Points, Text};

use super::facts::DesignFacts;
use crate::theme::{colour, plain};
use crate::widgets::{name, note};
use crate::{Command, FrontsCommand, WindowCommand, fit, notation};
use stillbase_mechanics::machine::builtins;
use stillbase_picture::numbers::signed;
use stillbase_picture::scene::palette::{Palette, faded};
use stillbase_study::fronts::MachineFront;

/// Least distance between the name of a front and what it comes to, points.
const ROOM_BETWEEN_PT: f32 = 16.0;

/// Returns the points of all these fronts: added mass, kg, and Σ D_k, kg m².
pub(super) fn places(facts: &DesignFacts) -> impl Iterator<Item = [f64; 2]> {
    facts.other_fronts().iter().filter_map(|front| front.outcome.as_ref().ok()).flat_map(|front| front.measures())
}

/// Draws the fronts, each with its number.
pub(super) fn draw(plot: &mut PlotUi<'_>, facts: &DesignFacts, p: &Palette) {
    for (i, MachineFront { name, outcome }) in facts.other_fronts().iter().enumerate() {
        let Ok(front) = outcome else { continue };
        let places = front.measures();
        let last = places.last().copied().unwrap_or_default();
        let tone = colour(faded(p.ink, 0.6));
        let ends = Points::new(name.clone(), PlotPoints::from(vec![last])).radius(2.5).color(tone);
        plot.points(ends.allow_hover(false));
        let line = Line::new(name.clone(), PlotPoints::from(places)).width(1.4).color(tone);
        plot.line(line.style(LineStyle::dashed_dense()).allow_hover(false));
        let number = RichText::new(format!(" {}", i + 1)).font(plain(11.5));
        let text = Text::new("number", PlotPoint::new(last[0], last[1]), number);
        plot.text(text.color(colour(p.ink)).anchor(egui::Align2::LEFT_BOTTOM).allow_hover(false));
    }
}

/// Draws the list of these fronts, and the controls that add one.
pub(super) fn list(ui: &mut Ui, facts: &DesignFacts, p: &Palette, commands: &mut Vec<Command>) {
    ui.add_space(4.0);
    ui.horizontal(|ui| {
        let tip = "Keeps this curve, to see beside it what another machine or another material comes to";
        if ui.button(RichText::new("keep this front").font(plain(12.0))).on_hover_text(tip).clicked() {
            commands.push(WindowCommand::Fronts(FrontsCommand::Keep).into());
        }
        let add = egui::ComboBox::from_id_salt("add front").selected_text("add…").width(96.0).show_ui(ui, |ui| {
            for machine in builtins() {
                if ui.selectable_label(false, machine.name()).clicked() {
                    commands.push(WindowCommand::Fronts(FrontsCommand::Add(machine.clone().into())).into());
                }
            }
        });
        name(&add.response.on_hover_text("The front of another machine, with the same settings"), "Add a front");
    });
    for (i, MachineFront { name: called, outcome }) in facts.other_fronts().iter().enumerate() {
        ui.horizontal(|ui| {
            let remove = ui.add(Button::new(RichText::new("×").font(plain(12.0))).frame(false));
            name(&remove, &format!("Remove the front of {called}"));
            if remove.on_hover_text("Take this front away").clicked() {
                commands.push(WindowCommand::Fronts(FrontsCommand::Remove(i)).into());
            }
            let words = match outcome {
                Ok(front) => {
                    let least = |i: usize| front.measures().iter().map(|at| at[i]).fold(f64::INFINITY, f64::min);
                    format!("least {} kg, {} kg m²", signed(least(0), 2), signed(least(1), 3))
                }
                Err(_) => "has no front".into(),
            };
            let called = format!("{}  {}", i + 1, notation::sentence(ui.ctx(), called));
            let room = ui.available_width() - fit::width_of(ui, &words, &plain(11.0)) - ROOM_BETWEEN_PT;
            fit::label_within(ui, &called, plain(12.0), colour(p.ink), room.max(0.0));
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                let label = ui.label(RichText::new(words).font(plain(11.0)).color(colour(p.dim)));
                if let Err(why) = outcome {
                    label.on_hover_text(notation::sentence(ui.ctx(), &why.to_string()));
                }
            });
        });
    }
    if let Some(share) = facts.other_fronts_progress() {
        note(ui, p, &format!("looking for them: {:.0} %", 100.0 * share));
    }
}
