//! The panel on the left while a machine is drawn, and what stands for its balance until it is complete.

use egui::{Button, ComboBox, RichText, Ui};

use super::card::renamed;
use super::lump::lump_title;
use super::{Pen, PenChange, SketchFacts, by_numbers, card, draw, fields, missing, motors};
use crate::theme::{bold, colour, plain};
use crate::widgets::{heading, name, note, reason, section, stepped};
use crate::{Command, FileDialog, SessionCommand, Switch, ViewChange, ViewState, focus};
use stillbase_mechanics::sketch::{Sketch, SketchStep};
use stillbase_picture::scene::palette::Palette;
use stillbase_picture::scene::sketching::{SketchItem, pin_title};
use stillbase_session::scenario::UnfinishedDrawing;
use stillbase_session::{Session, with_own_task};

/// Draws the panel.
pub fn show(
    ui: &mut Ui,
    session: &Session,
    facts: &SketchFacts,
    pen: &Pen,
    view_state: &ViewState,
    commands: &mut Vec<Command>,
) {
    let p = &view_state.palette();
    ui.horizontal(|ui| {
        ui.label(RichText::new("Drawing").font(bold(14.0)));
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            let done = ui.button("Done").on_hover_text("Leave the drawing: masses and counterweights of the machine");
            name(&done, "Done drawing");
            if done.clicked() {
                commands.push(ViewChange::Switch(Switch::Sketching, false).into());
            }
        });
    });
    let sketch = &facts.sketch;
    renamed(ui, "name of the machine", &sketch.name, p, |name| draw(sketch, SketchStep::Name { name }, commands));
    if let Some(refused) = &pen.refused {
        ui.add_space(4.0);
        reason(ui, p, &refused.to_string());
        for step in &refused.proposals {
            if ui.button(step.title_in(sketch)).clicked() {
                draw(sketch, step.clone(), commands);
            }
        }
    }
    ui.add_space(6.0);
    card_of(ui, sketch, pen, commands);
    match pen.chosen {
        Some(chosen) => card::show(ui, facts, chosen, p, commands),
        None => {
            note(ui, p, "Click a bar for its drive, its length and its angle; click a pin or a lump for its place.")
        }
    }
    missing::show(ui, facts, p, commands);
    task(ui, session, facts, view_state, commands);
    by_numbers::show(ui, facts, pen, p, commands);
    motors::show(ui, facts, p, commands);
    if facts.is_complete() {
        ui.add_space(8.0);
        let save = ui.link(RichText::new("save the machine as a file →").font(plain(12.5)).color(colour(p.amber)));
        if save.on_hover_text("A machine file, which --machine and Open read").clicked() {
            commands.push(ViewChange::Dialog(Some(FileDialog::of_machine(session))).into());
        }
    }
}

/// Draws the list of bars and pins, which chooses the card without the pointer.
fn card_of(ui: &mut Ui, sketch: &Sketch, pen: &Pen, commands: &mut Vec<Command>) {
    let title = |item: Option<SketchItem>| match item {
        Some(SketchItem::Bar(id)) => {
            sketch.bar(id).map_or_else(|| "no bar or pin".to_owned(), |bar| format!("bar {}", bar.name))
        }
        Some(SketchItem::Pin(id)) => pin_title(sketch, id),
        Some(SketchItem::Lump(id, number)) => sketch.bar(id).map_or_else(String::new, |bar| lump_title(bar, number)),
        _ => "no bar or pin".to_owned(),
    };
    let list = ComboBox::from_id_salt("card of").selected_text(title(pen.chosen)).width(120.0);
    let bars = sketch.bars.iter().map(|bar| Some(SketchItem::Bar(bar.id)));
    let pins = sketch.pins.iter().map(|pin| Some(SketchItem::Pin(pin.id)));
    let lumps = sketch.bars.iter().flat_map(|bar| {
        let count = sketch.lumps_of(bar).count();
        (1..=count).map(|number| Some(SketchItem::Lump(bar.id, number)))
    });
    let all: Vec<Option<SketchItem>> = [None].into_iter().chain(bars).chain(pins).chain(lumps).collect();
    let list = list.show_ui(ui, |ui| {
        let picked = |item: &&Option<SketchItem>| ui.selectable_label(**item == pen.chosen, title(**item)).clicked();
        all.iter().filter(picked).last().copied()
    });
    let response = list.response.on_hover_text("The bar or pin whose card is shown");
    name(&response, fields::CARD);
    focus::tell(&response, fields::CARD);
    let next = list.inner.flatten().or_else(|| stepped(ui, &response, all.iter(), &pen.chosen));
    if let Some(item) = next {
        commands.push(ViewChange::Pen(PenChange::Choose(item)).into());
    }
}

/// Offers a task for a machine whose present task it cannot do.
fn task(ui: &mut Ui, session: &Session, facts: &SketchFacts, view_state: &ViewState, commands: &mut Vec<Command>) {
    let Some(waits) = session.run().waiting().filter(|_| facts.is_complete()) else { return };
    let p = &view_state.palette();
    section(ui, p, "Its task");
    note(ui, p, &format!("The machine cannot do the present task: {}", waits.why));
    let words = RichText::new("give it a task of its own").font(plain(12.0)).color(colour(p.amber));
    let button = ui.add(Button::new(words));
    if button.on_hover_text("A small motion near the middle of its joint limits").clicked()
        && let Some(scenario) = with_own_task(session.scenario())
    {
        commands.push(SessionCommand::Open(Box::new(scenario)).into());
    }
}

/// Says that the balance stands here once the drawing is a machine.
pub fn balance_waits(ui: &mut Ui, unfinished: &UnfinishedDrawing, p: &Palette) {
    heading(ui, p, "What is out of balance", "once it is a machine");
    let words =
        "Balance, counterweights and the Pareto front of what you draw stand here as soon as nothing is missing.";
    note(ui, p, &format!("{words} {}: see the list on the other side.", unfinished.count()));
}
