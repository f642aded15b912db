//! The keyboard, and the card that shows it.

use egui::{Context, Key, KeyboardShortcut, Modifiers};

use super::theme::{bold, colour};
use super::{Command, FileDialog, Purpose, ViewState};
use crate::picture::scene::Measure;
use crate::session::Session;
use crate::session::scenario::Scenario;

const KEYS: [(&str, &str); 30] = [
    ("Space", "play, pause, start over"),
    ("← →", "one step back, one step on"),
    ("Shift ← →", "ten steps"),
    ("Home  End", "start, newest instant"),
    ("1  2  3", "the paper's cases, as they are in the paper"),
    ("B", "put the machine back on its planned path"),
    ("V", "2D, 3D, joint space, tower of workspaces"),
    ("J", "shade the workspace by dexterity, one measure after the other"),
    ("C", "the same task done in other ways, side by side"),
    ("T", "tolerances: what the bases of many machines feel, and the spectrum"),
    ("S", "snapshots along the motion"),
    ("I", "inside the machine: what the pins carry"),
    ("Shift click plot", "a second cursor: plots show differences; Esc takes it away"),
    ("F", "show everything"),
    ("X", "exaggerate the motion of the base, or show it as it is"),
    ("L", "light or dark"),
    ("R", "record for the Rerun viewer"),
    ("Ctrl Z  Ctrl Y", "undo, redo"),
    ("Ctrl S  Ctrl O", "save, open a session"),
    ("drag target", "the machine follows on its plane"),
    ("drag A, B, 1 …", "move a point of the path; where the target covers it, drag its name"),
    ("double click", "add a point to the path"),
    ("Delete", "leave out the point under the pointer"),
    ("P, then drag", "draw a path"),
    ("Alt drag, or U, drag", "push the end effector, 20 N for each metre"),
    ("drag b ring", "the workspace turns"),
    ("drag plane, slice", "change b, in joint space and in the tower"),
    ("drag elsewhere", "pan in 2D, else orbit; Shift pans"),
    ("wheel", "zoom"),
    ("F1  Esc", "this card; close a card or a list, cancel a drag"),
];

/// Turns keys into commands; while text is typed only shortcuts with Ctrl count.
pub fn read(ctx: &Context, session: &Session, view_state: &ViewState, commands: &mut Vec<Command>) {
    let typing = ctx.egui_wants_keyboard_input() || view_state.dialog.is_some();
    let chord =
        |modifiers: Modifiers, key| ctx.input_mut(|i| i.consume_shortcut(&KeyboardShortcut::new(modifiers, key)));
    let ctrl = Modifiers::COMMAND;
    if !typing && (chord(ctrl | Modifiers::SHIFT, Key::Z) || chord(ctrl, Key::Y)) {
        commands.push(Command::Redo);
    }
    if !typing && chord(ctrl, Key::Z) {
        commands.push(Command::Undo);
    }
    for (key, purpose) in [(Key::S, Purpose::Save), (Key::O, Purpose::Open)] {
        if chord(ctrl, key) {
            commands.push(Command::Dialog(Some(FileDialog::suggest(session, purpose))));
        }
    }
    if chord(Modifiers::NONE, Key::F1) {
        commands.push(Command::Help(!view_state.help));
    }
    // While something is dragged or a list is open, Esc ends that and nothing else.
    let taken = view_state.grabbed.is_some() || egui::Popup::is_any_open(ctx);
    if !taken && chord(Modifiers::NONE, Key::Escape) {
        commands.push(match (&view_state.dialog, &view_state.stroke) {
            (Some(_), _) => Command::Dialog(None),
            (None, Some(_)) => Command::Draw(false),
            (None, None) if view_state.mark.is_some() => Command::Mark(None),
            (None, None) if view_state.pushing && !view_state.help => Command::Push(false),
            (None, None) => Command::Help(false),
        });
    }
    if typing {
        return;
    }
    let shift = Modifiers::SHIFT;
    let plain = Modifiers::NONE;
    for (modifiers, key, command) in [
        (plain, Key::Space, Command::TogglePlay),
        (shift, Key::ArrowLeft, Command::Step(-10)),
        (shift, Key::ArrowRight, Command::Step(10)),
        (plain, Key::ArrowLeft, Command::Step(-1)),
        (plain, Key::ArrowRight, Command::Step(1)),
        (plain, Key::Home, Command::Seek(0.0)),
        (plain, Key::End, Command::Seek(session.length())),
        (plain, Key::V, Command::View(view_state.view.next())),
        (plain, Key::J, Command::Dexterity(Measure::after(view_state.dexterity))),
        (plain, Key::F, Command::Fit),
        (plain, Key::C, Command::Compare(!view_state.compare)),
        (plain, Key::S, Command::Snapshots(!view_state.snapshots)),
        (plain, Key::T, Command::Study(!view_state.study)),
        (plain, Key::I, Command::Pins(!view_state.pins)),
        (plain, Key::P, Command::Draw(view_state.stroke.is_none())),
        (plain, Key::U, Command::Push(!view_state.pushing)),
        (plain, Key::B, Command::BackToPath),
        (plain, Key::X, Command::Exaggerate(!view_state.exaggerates_base)),
        (plain, Key::L, Command::Theme(super::theme::other(view_state.theme))),
        (plain, Key::R, Command::Dialog(Some(FileDialog::suggest(session, Purpose::Record)))),
    ] {
        if chord(modifiers, key) {
            commands.push(command);
        }
    }
    for (key, name) in [Key::Num1, Key::Num2, Key::Num3].into_iter().zip(Scenario::cases()) {
        if chord(plain, key) {
            commands.push(Command::Case(name));
        }
    }
}

/// The card of keys.
pub fn help(ctx: &Context, view_state: &ViewState, commands: &mut Vec<Command>) {
    if !view_state.help {
        return;
    }
    let p = view_state.palette();
    let mut open = true;
    egui::Window::new("Keys")
        .open(&mut open)
        .collapsible(false)
        .resizable(false)
        .anchor(egui::Align2::CENTER_CENTER, [0.0, 0.0])
        .show(ctx, |ui| {
            let room = (ctx.content_rect().height() - 120.0).max(160.0);
            egui::ScrollArea::vertical().max_height(room).show(ui, |ui| {
                egui::Grid::new("keys").num_columns(2).spacing([24.0, 7.0]).show(ui, |ui| {
                    for (key, does) in KEYS {
                        ui.label(egui::RichText::new(key).font(bold(13.0)));
                        ui.label(egui::RichText::new(does).color(colour(p.dim)));
                        ui.end_row();
                    }
                });
            });
        });
    if !open {
        commands.push(Command::Help(false));
    }
}
