//! The tool bar on the left: which view, what the pointer does, what is shown of the machine, and what is found out
//! about it. It stands beside the scene and covers nothing of it.

use egui::{Frame, Margin, Panel, ScrollArea, Ui, vec2};

use super::actions::key_of;
use super::icon::{Icon, IconButton, rule, word_button, word_without};
use super::{Command, ViewState, arrangement, history};
use crate::picture::scene::Measure;
use crate::picture::scene::palette::Palette;
use crate::picture::scene::views::{ViewKind, Views};
use crate::session::{Fork, Session};

/// How wide it is, points.
const WIDTH: f32 = 50.0;
/// A button.
const BUTTON: egui::Vec2 = vec2(42.0, 30.0);

/// A button that is on or off.
struct Toggle {
    icon: Icon,
    /// Its name.
    label: &'static str,
    /// What it does.
    does: &'static str,
    /// The action of [`ACTIONS`] that does the same.
    action: &'static str,
    on: fn(&ViewState) -> bool,
    command: fn(bool) -> Command,
    /// Only views of the machine have it.
    of_machine: bool,
}

/// What the pointer does.
const HANDS: [Toggle; 3] = [
    Toggle {
        icon: Icon::Pointer,
        label: "take hold",
        does: "The pointer takes hold of target, points and b ring, and moves the view elsewhere",
        action: "",
        on: |v| v.stroke.is_none() && !v.pushing,
        command: |_| Command::TakeHold,
        of_machine: true,
    },
    Toggle {
        icon: Icon::Curve,
        label: "draw a path",
        does: "Draw the end effector's path with the pointer",
        action: "Draw a path with the pointer",
        on: |v| v.stroke.is_some(),
        command: Command::Draw,
        of_machine: true,
    },
    Toggle {
        icon: Icon::Push,
        label: "push",
        does: "Push the end effector with the pointer, 20 N for each metre; or hold Alt",
        action: "Push the end effector with the pointer",
        on: |v| v.pushing,
        command: Command::Push,
        of_machine: true,
    },
];

/// What is shown of the machine.
const LAYERS: [Toggle; 3] = [
    Toggle {
        icon: Icon::Ellipse,
        label: "dexterity",
        does: "Shade the workspace by how well the end effector moves",
        action: "Shade the workspace by dexterity, one measure after the other",
        on: |v| v.dexterity.is_some(),
        command: |on| Command::Dexterity(on.then_some(Measure::Det)),
        of_machine: true,
    },
    Toggle {
        icon: Icon::Fan,
        label: "snapshots",
        does: "Poses along the motion, as in Fig. 5",
        action: "Snapshots along the motion",
        on: |v| v.snapshots,
        command: Command::Snapshots,
        of_machine: true,
    },
    Toggle {
        icon: Icon::Pin,
        label: "pins",
        does: "What pins and bearings carry",
        action: "Inside the machine: what the pins carry",
        on: |v| v.pins,
        command: Command::Pins,
        of_machine: false,
    },
];

/// What is found out about it.
const ANALYSES: [Toggle; 2] = [
    Toggle {
        icon: Icon::Bell,
        label: "tolerances",
        does: "What the bases of many machines feel, and the spectrum",
        action: "Tolerances: what the bases of many machines feel, and the spectrum",
        on: |v| v.study,
        command: Command::Study,
        of_machine: false,
    },
    Toggle {
        icon: Icon::Beside,
        label: "side by side",
        does: "The same task done in other ways",
        action: "The same task done in other ways, side by side",
        on: |v| v.compare,
        command: Command::Compare,
        of_machine: false,
    },
];

/// Draws it.
pub fn show(ui: &mut Ui, session: &Session, branches: &[Fork], view_state: &ViewState, commands: &mut Vec<Command>) {
    let p = view_state.palette();
    let frame = Frame::new().inner_margin(Margin { left: 4, right: 4, top: 8, bottom: 6 });
    Panel::left("tools").exact_size(WIDTH).resizable(false).frame(frame).show(ui, |ui| {
        // A low window scrolls it.
        let bars = egui::scroll_area::ScrollBarVisibility::AlwaysHidden;
        ScrollArea::vertical().auto_shrink(false).scroll_bar_visibility(bars).show(ui, |ui| {
            ui.spacing_mut().item_spacing = vec2(0.0, 2.0);
            for view in ViewKind::ALL {
                let size = vec2(BUTTON.x, 25.0);
                if let Err(why) = Views::has(view, session.run()) {
                    let tip = format!("Not of this machine: {why}");
                    word_without(ui, &p, (view.name(), &tip), size);
                    continue;
                }
                let tip = format!("{}{}", view.explanation(), key("The next view: 2D, 3D, joint space, tower"));
                let word = (view.name(), tip.as_str());
                if word_button(ui, &p, word, view_state.view == view, size).clicked() {
                    commands.push(Command::View(view));
                }
            }
            for group in [HANDS.as_slice(), &LAYERS, &ANALYSES] {
                rule(ui, &p, BUTTON.x);
                for tool in group {
                    toggle(ui, &p, tool, view_state, commands);
                }
            }
            rule(ui, &p, BUTTON.x);
            let tip = format!("Show everything{}", key("Show everything"));
            let fit = IconButton { size: BUTTON, ..IconButton::of(Icon::Corners, "show everything", &tip) };
            if fit.show_in(ui, &p, super::theme::colour(p.dim)).clicked() {
                commands.push(Command::Fit);
            }
            arrangement::show(ui, view_state, BUTTON, commands);
            history::show(ui, (session, branches), view_state, BUTTON, commands);
        });
    });
}

fn toggle(ui: &mut Ui, p: &Palette, tool: &Toggle, view_state: &ViewState, commands: &mut Vec<Command>) {
    let enabled = !tool.of_machine || view_state.view.shows_machine();
    let on = (tool.on)(view_state);
    let only = if enabled { "" } else { "\n(in 2D and 3D)" };
    let tip = format!("{}{}\n{}{only}", tool.label, key(tool.action), tool.does);
    let button = IconButton { icon: tool.icon, label: tool.label, tip: &tip, on: Some(on), enabled, size: BUTTON };
    if button.show(ui, p).clicked() {
        commands.push((tool.command)(!on));
    }
}

/// The key of an action in brackets, if it has one.
fn key(action: &str) -> String {
    key_of(action).map(|key| format!(" ({key})")).unwrap_or_default()
}
