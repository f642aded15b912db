//! The bar at the top: machine, scenario, transport, recording.

use std::path::PathBuf;

use crate::theme::other;
use crate::widgets::name;
use egui::{Align, ComboBox, Frame, Layout, Margin, Panel, RichText, Ui};

use super::actions::SPEEDS;
use super::facts::ScenarioFacts;
use super::file_dialog::MACHINE_FORMATS;
use super::gallery::Choosable;
use super::icon::{Icon, IconButton};
use super::marks::Marks;
use super::theme::{bold, colour, plain};
use super::{
    Command, FileDialog, FilePurpose, SessionCommand, Switch, ViewChange, ViewState, WindowCommand, file_menu, fit,
    gallery, timeline,
};
use stillbase_mechanics::machine::Machine;
use stillbase_picture::scene::palette::Theme;
use stillbase_query::Queries;
use stillbase_session::scenario::Scenario;
use stillbase_session::{Session, for_machine};

/// Draws this panel; `line` contains the marks of the time line, and the playback rate if it lags behind the
/// requested one.
pub fn show(
    ui: &mut Ui,
    session: &Session,
    facts: &ScenarioFacts<'_>,
    recent: &[PathBuf],
    line: (&Marks, Option<f64>),
    view_state: &ViewState,
    commands: &mut Vec<Command>,
) {
    let frame = Frame::new().inner_margin(Margin::symmetric(16, 0));
    Panel::top("top").exact_size(44.0).resizable(false).frame(frame).show(ui, |ui| {
        ui.horizontal_centered(|ui| {
            // A narrow window has its name in its frame only.
            if !is_narrow(ui) {
                ui.label(RichText::new("Stillbase").font(bold(17.0)));
                ui.add_space(2.0);
            }
            file_menu::show(ui, session, facts.queries, recent, view_state, commands);
            machines(ui, session, (facts, recent), view_state, commands);
            scenarios(ui, session, facts.queries, facts.work_differs, view_state, commands);
            blocks(ui, session, commands);
            ui.add_space(8.0);
            transport(ui, session, view_state, commands);
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                right_end(ui, session, view_state, commands);
                ui.add_space(10.0);
                timeline::show(ui, session, line, view_state, commands);
            });
        });
    });
}

/// Whether the window is narrow, so that the time line needs the space.
fn is_narrow(ui: &Ui) -> bool {
    ui.ctx().content_rect().width() < 1200.0
}

fn machines(
    ui: &mut Ui,
    session: &Session,
    (facts, recent): (&ScenarioFacts<'_>, &[PathBuf]),
    view_state: &ViewState,
    commands: &mut Vec<Command>,
) {
    let changed = facts.machine_differs;
    let present = &session.scenario().machine;
    // While a drawing is incomplete, the machine is another one.
    let drawn = session.scenario().sketch.as_ref().map(|sketch| sketch.name.as_str());
    let shown = drawn.unwrap_or(present.name());
    let (current, widest) = (edited(shown, changed), edited(shown, true));
    let tip = if changed {
        "The machine; it differs from that of its file, or from the built-in one of this name"
    } else {
        "The machine; choosing another one opens a task that shows its purpose"
    };
    // The width stays when the machine is edited, so that nothing beside moves.
    let width = list_width(ui, &widest, if is_narrow(ui) { [104.0, 150.0] } else { [136.0, 190.0] });
    let combo = ComboBox::from_id_salt("machine")
        .selected_text(chosen_text(ui, shown, changed, width))
        .width(width)
        .height(gallery::room(ui));
    let response =
        combo.show_ui(ui, |ui| match gallery::machines(ui, present, (facts.queries, recent), &view_state.palette()) {
            Some(Choosable::Machine(machine)) => {
                commands.push(SessionCommand::Open(Box::new(with_machine(session, machine))).into());
            }
            Some(Choosable::New(template)) => commands.push(SessionCommand::NewDrawing(template).into()),
            Some(Choosable::File(file)) => commands.push(SessionCommand::OpenFile(file).into()),
            Some(Choosable::Forget(file)) => commands.push(Command::Window(WindowCommand::Forget(file))),
            None => {}
        });
    name(&response.response.on_hover_text(format!("{current}\n{tip}")), "Machine");
}

/// Returns a name, marked as edited if the thing differs from the built-in one of this name.
fn edited(name: &str, is_edited: bool) -> String {
    if is_edited { format!("{name} (edited)") } else { name.to_owned() }
}

/// Returns the width of a list that shows a text whole, points, within limits.
fn list_width(ui: &Ui, text: &str, [least, most]: [f32; 2]) -> f32 {
    let font = egui::TextStyle::Button.resolve(ui.style());
    (fit::width_of(ui, text, &font) + taken_width(ui)).clamp(least, most)
}

/// Returns the width that margins and arrow of a list take, points.
fn taken_width(ui: &Ui) -> f32 {
    let spacing = ui.spacing();
    (2.0 * spacing.button_padding.x + spacing.icon_width + spacing.icon_spacing).ceil()
}

/// Returns the text shown in a closed list of this width, points, which includes arrow and margins.
fn chosen_text(ui: &Ui, name: &str, is_edited: bool, width: f32) -> String {
    let taken = taken_width(ui);
    let font = egui::TextStyle::Button.resolve(ui.style());
    let added = fit::width_of(ui, &edited("", is_edited), &font);
    edited(&fit::fitted(ui, name, &font, width - taken - added), is_edited)
}

/// Returns the scenario to open for a chosen machine: its built-in scenario, else the present scenario with this
/// machine and without edits if that can run, else another one for this machine.
pub(super) fn with_machine(session: &Session, machine: &Machine) -> Scenario {
    for_machine(session.scenario(), machine)
}

fn scenarios(
    ui: &mut Ui,
    session: &Session,
    queries: &Queries,
    changed: bool,
    view_state: &ViewState,
    commands: &mut Vec<Command>,
) {
    let current = session.scenario();
    let shown = if current.title.is_empty() { &current.name } else { &current.title };
    let current_text = edited(shown, changed);
    let width = list_width(ui, &edited(shown, true), if is_narrow(ui) { [150.0, 150.0] } else { [196.0, 250.0] });
    let combo = ComboBox::from_id_salt("scenario")
        .selected_text(chosen_text(ui, shown, changed, width))
        .width(width)
        .height(gallery::room(ui));
    let response = combo.show_ui(ui, |ui| {
        let Some(chosen) = gallery::scenarios(ui, current, queries, &view_state.palette()) else { return };
        commands.push(match Scenario::cases().find(|name| *name == chosen.name) {
            Some(name) => Command::Session(SessionCommand::Case(name)),
            // All other built-in scenarios open with their own machine.
            None => Command::Session(SessionCommand::Open(Box::new(chosen.clone()))),
        });
    });
    let tip = match changed {
        true => {
            "What the machine does; it differs from the built-in scenario of this name: keys 1, 2, 3 bring the paper's cases back"
        }
        false => "What the machine does: keys 1, 2, 3",
    };
    name(&response.response.on_hover_text(format!("{current_text}\n{tip}")), "Scenario");
}

/// Draws the list of the blocks of an assembly, of which one is led.
fn blocks(ui: &mut Ui, session: &Session, commands: &mut Vec<Command>) {
    let Some(own) = &session.scenario().assembly else { return };
    let width = list_width(ui, own.name(), [90.0, 130.0]);
    let text = chosen_text(ui, own.name(), false, width);
    let combo = ComboBox::from_id_salt("block").selected_text(text).width(width);
    let response = combo.show_ui(ui, |ui| {
        for (i, block) in own.scenario.assembly.blocks().iter().enumerate() {
            let words = format!("{} · {}", block.name, block.machine.name());
            if ui.selectable_label(i == own.block, words).clicked() && i != own.block {
                commands.push(SessionCommand::Lead(i).into());
            }
        }
    });
    let tip = "The block of the assembly that you lead: its machine, task and plots are shown, and 3D shows all blocks";
    name(&response.response.on_hover_text(format!("{}\n{tip}", own.name())), "Block");
}

fn transport(ui: &mut Ui, session: &Session, view_state: &ViewState, commands: &mut Vec<Command>) {
    let p = view_state.palette();
    let mut button = |icon: Icon, label: &str, tip: &str, command: Command| {
        if IconButton::of(icon, label, tip).show(ui, &p).clicked() {
            commands.push(command);
        }
    };
    button(Icon::Start, "Start", "To the start (Home)", Command::Session(SessionCommand::Seek(0.0)));
    match view_state.plays(session) {
        true => button(Icon::Pause, "Pause", "Pause (Space)", Command::Session(SessionCommand::TogglePlay)),
        false => button(Icon::Play, "Play", "Play (Space)", Command::Session(SessionCommand::TogglePlay)),
    }
    button(Icon::Step, "Step", "One step on (→)", Command::Session(SessionCommand::Step(1)));
    let text = |s: f64| format!("{s}×");
    let combo = ComboBox::from_id_salt("speed").selected_text(text(view_state.speed)).width(58.0);
    let response = combo.show_ui(ui, |ui| {
        for speed in SPEEDS {
            if ui.selectable_label(speed == view_state.speed, text(speed)).clicked() {
                commands.push(ViewChange::Speed(speed).into());
            }
        }
    });
    name(&response.response.on_hover_text("Simulated seconds a second"), "Speed");
}

/// Draws the right part of the bar, from right to left.
fn right_end(ui: &mut Ui, session: &Session, view_state: &ViewState, commands: &mut Vec<Command>) {
    let p = view_state.palette();
    let dim = |text: &str| RichText::new(text.to_owned()).color(colour(p.dim));
    let help = ui.add(egui::Button::new(dim("?")).frame(false)).on_hover_text("Tour and keys (F1)");
    name(&help, "Help");
    if help.clicked() {
        commands.push(ViewChange::Switch(Switch::Help, !view_state.open.help).into());
    }
    // Where there is space, the button has its full name.
    let words = if is_narrow(ui) { "Ctrl K" } else { "Search commands   Ctrl K" };
    let words = RichText::new(words).font(plain(12.0)).color(colour(p.dim));
    let find = egui::Button::new(words).fill(colour(p.background)).stroke((1.0, colour(p.line))).corner_radius(8);
    let find = ui.add(find).on_hover_text("Every command, by a few letters of its name (Ctrl K)");
    name(&find, "Search commands");
    if find.clicked() {
        commands.push(ViewChange::Switch(Switch::Finder, true).into());
    }
    let word = if view_state.arrangement.theme == Theme::Dark { "Light" } else { "Dark" };
    if IconButton::of(Icon::Halves, word, "Light or dark (L)").show_in(ui, &p, colour(p.dim)).clicked() {
        commands.push(ViewChange::Theme(other(view_state.arrangement.theme)).into());
    }
    let record = IconButton::of(Icon::Record, "Record", "Write this run for the Rerun viewer (R)");
    if record.show_in(ui, &p, colour(p.reaction)).clicked() {
        commands.push(ViewChange::Dialog(Some(FileDialog::suggest(session, FilePurpose::Record))).into());
    }
}

/// Draws the list of formats of a machine's file; the chosen one gives the name its ending.
fn formats(ui: &mut Ui, dialog: &mut FileDialog) {
    if dialog.purpose != FilePurpose::Machine {
        return;
    }
    let now = dialog.ending();
    ui.horizontal_wrapped(|ui| {
        for (ending, words) in MACHINE_FORMATS {
            let is_chosen = now.eq_ignore_ascii_case(ending);
            if ui.selectable_label(is_chosen, words).on_hover_text(format!("a file that ends in .{ending}")).clicked() {
                dialog.set_ending(ending);
            }
        }
    });
}

/// Draws the file dialog.
pub fn dialog(ctx: &egui::Context, view_state: &mut ViewState, commands: &mut Vec<Command>) {
    let Some(mut dialog) = view_state.open.dialog.clone() else { return };
    let [title, verb, hint] = dialog.purpose.words();
    let mut open = true;
    egui::Window::new(title)
        .open(&mut open)
        .collapsible(false)
        .resizable(false)
        .anchor(egui::Align2::CENTER_TOP, [0.0, 120.0])
        .show(ctx, |ui| {
            let edit = egui::TextEdit::singleline(&mut dialog.path).hint_text(hint).desired_width(380.0);
            let field = ui.add(edit);
            name(&field, "File name");
            if !field.has_focus() && !field.lost_focus() {
                field.request_focus();
            }
            let enter = field.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
            let folder = stillbase_files::absolute_path(std::path::Path::new("."));
            let folder = folder.map(|folder| format!("in {}, unless the name says another folder", folder.display()));
            for words in dialog.purpose.endings().into_iter().chain(folder) {
                ui.add(egui::Label::new(RichText::new(words).font(plain(11.5)).weak()).wrap());
            }
            formats(ui, &mut dialog);
            ui.horizontal(|ui| {
                let ready = !dialog.path.trim().is_empty();
                if ui.add_enabled(ready, egui::Button::new(verb)).clicked() || (enter && ready) {
                    let path = dialog.path.trim().into();
                    commands.push(dialog.clone().named(path).into());
                }
                if ui.button("Cancel").clicked() {
                    commands.push(ViewChange::Dialog(None).into());
                }
                if dialog.purpose == FilePurpose::Open {
                    ui.label(RichText::new("or drop a file on the window").weak());
                }
            });
            if let Some(text) = view_state.status.problem() {
                ui.label(RichText::new(text).color(ui.visuals().error_fg_color));
            }
        });
    view_state.open.dialog = open.then_some(dialog);
}
