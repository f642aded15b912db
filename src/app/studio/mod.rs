//! The panels of the design view: on the left the table of links, on the right the balance of the machine or the
//! equations.

mod bars;
mod brief;
mod equations;
mod facts;
mod front;
mod layers;
mod lengths;
mod lesson;
mod measures;
mod other_fronts;
mod part_shape;
mod parts;
mod payload;
mod sought;
mod stock;
mod table;
mod tabs;
mod terms;
mod typeset;

use egui::{Align, Frame, Layout, Margin, Panel, RichText, ScrollArea, Ui};

use super::side::SCROLL_BAR_WIDTH;
use super::sketching::{self, SketchFacts};
use super::theme::{colour, plain};
use super::widgets::name;
use super::{Command, FileDialog, FilePurpose, Switch, ViewChange, ViewState, focus};
use stillbase_picture::scene::palette::Palette;
use stillbase_session::Session;

pub use facts::{DesignFacts, as_cut, layers_of, leave, of_front};
pub use layers::cut;
pub use sought::{holds, look_up};

/// Default widths of the panels, points.
const TABLE_WIDTH_PT: f32 = 336.0;
const BALANCE_WIDTH_PT: f32 = 372.0;
/// Minimum width of the scene, and of the panel on the right, points.
const MIN_SCENE_WIDTH_PT: f32 = 250.0;
const MIN_BALANCE_WIDTH_PT: f32 = 280.0;

/// Draws both panels.
pub fn show(
    ui: &mut Ui,
    session: &Session,
    (facts, drawing): (&DesignFacts, Option<&SketchFacts>),
    view_state: &ViewState,
    commands: &mut Vec<Command>,
) {
    let p = view_state.palette();
    let balance =
        (ui.available_width() - TABLE_WIDTH_PT - MIN_SCENE_WIDTH_PT).clamp(MIN_BALANCE_WIDTH_PT, BALANCE_WIDTH_PT);
    let frame = Frame::new().inner_margin(Margin { left: 14, right: 2, top: 12, bottom: 8 });
    let (one, other) = match view_state.arrangement.swapped {
        true => (Panel::right("links"), Panel::left("balance")),
        false => (Panel::left("links"), Panel::right("balance")),
    };
    if view_state.arrangement.now().side.shown {
        one.exact_size(TABLE_WIDTH_PT).frame(frame).show(ui, |ui| {
            scrolled(ui, |ui| {
                if let Some((drawing, pen)) = drawing.zip(view_state.drawing_pen()) {
                    sketching::panel(ui, session, drawing, pen, view_state, commands);
                    if drawing.is_complete() {
                        layers::show(ui, session, &facts.layers, &p, commands);
                    }
                    return;
                }
                draw_button(ui, &p, commands);
                if session.run().unfinished().is_some() {
                    sketching::waits::panel(ui, "Its links stand", &p);
                    return;
                }
                table::show(ui, session, view_state, commands);
                let is_balanced = facts.terms.iter().all(|term| term.is_balanced);
                brief::show(ui, session.scenario(), is_balanced, &p, commands);
                lengths::show(ui, session.scenario(), facts.length_search.as_ref(), &p, commands);
                stock::show(ui, session, facts, &p, commands);
                measures::show(ui, session, facts, &p);
                layers::show(ui, session, &facts.layers, &p, commands);
            });
        });
    }
    if view_state.arrangement.now().plots.shown {
        other.exact_size(balance).frame(frame).show(ui, |ui| {
            if let Some(unfinished) = session.run().unfinished() {
                scrolled(ui, |ui| sketching::balance_waits(ui, unfinished, &p));
                return;
            }
            tabs::show(ui, view_state, commands);
            if let Some(lesson) = &facts.lesson {
                equations::show(ui, session, lesson, view_state);
            } else {
                scrolled(ui, |ui| {
                    bars::show(ui, session, facts, view_state);
                    front::show(ui, facts, view_state, commands);
                    if drawing.is_some() {
                        measures::show(ui, session, facts, &p);
                    }
                    payload::show(ui, facts, session.scenario().machine.spec().payload.mass, &p);
                    elsewhere(ui, session, view_state, commands);
                });
            }
        });
    }
}

/// Draws the button that begins to draw the machine.
fn draw_button(ui: &mut Ui, p: &Palette, commands: &mut Vec<Command>) {
    ui.horizontal(|ui| {
        let words = RichText::new("bars, motors, pins").font(plain(12.0)).color(colour(p.dim));
        ui.label(words);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let button = ui.button("Draw").on_hover_text("Draw the machine: bars from pin to pin, motors on pins");
            name(&button, "Draw the machine");
            if button.clicked() {
                commands.push(ViewChange::Switch(Switch::Sketching, true).into());
            }
        });
    });
    ui.add_space(4.0);
}

/// Draws the hyperlink that exports the machine.
fn elsewhere(ui: &mut Ui, session: &Session, view_state: &ViewState, commands: &mut Vec<Command>) {
    let p = view_state.palette();
    ui.add_space(8.0);
    ui.horizontal(|ui| {
        ui.label(RichText::new("MJCF, URDF, drawings, parts list").font(plain(12.0)).color(colour(p.dim)));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let link = ui.link(RichText::new("take it along →").font(plain(12.5)).color(colour(p.amber)));
            if link.on_hover_text("Write the machine for another program or a workshop: the ending says what").clicked()
            {
                commands.push(ViewChange::Dialog(Some(FileDialog::suggest(session, FilePurpose::Machine))).into());
            }
        });
    });
}

fn scrolled(ui: &mut Ui, add: impl FnOnce(&mut Ui)) {
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        ui.set_width(ui.available_width() - SCROLL_BAR_WIDTH);
        add(ui);
        focus::keep_in_view(ui);
    });
}
