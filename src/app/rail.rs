//! The tool bar on the left: views, tools of the pointer, layers of the scene, and analyses. It stands beside the
//! scene and covers no part of it.

use egui::{Frame, Margin, Panel, ScrollArea, Ui, vec2};

use super::actions::{key_of, key_of_switch};
use super::icon::{Icon, IconButton, SEPARATOR_HEIGHT, disabled_word_button, rule, word_button};
use super::{Command, Switch, ViewChange, ViewState, arrangement, focus, history, sketching};
use stillbase_picture::scene::palette::Palette;
use stillbase_picture::scene::views::{ViewKind, Views};
use stillbase_session::{Fork, Session};

/// Width of the tool bar, points.
const WIDTH_PT: f32 = 50.0;
/// Size of a button, and the minimum height to which it shrinks in a low window, points.
const BUTTON_SIZE_PT: egui::Vec2 = vec2(42.0, 30.0);
const MIN_BUTTON_HEIGHT_PT: f32 = 22.0;
/// Height of the button of a view, points.
const VIEW_BUTTON_HEIGHT_PT: f32 = 25.0;
/// Gap between buttons, points.
const GAP_PT: f32 = 2.0;

/// A button that is on or off.
struct Toggle {
    icon: Icon,
    /// Its name.
    label: &'static str,
    /// Its effect.
    effect: &'static str,
    switch: Switch,
}

const fn tool(switch: Switch, icon: Icon, label: &'static str, effect: &'static str) -> Toggle {
    Toggle { icon, label, effect, switch }
}

/// Tools of the pointer.
const POINTER_TOOLS: [Toggle; 4] = [
    tool(
        Switch::Holding,
        Icon::Pointer,
        "take hold",
        "The pointer takes hold of target, points and b ring, and moves the view elsewhere",
    ),
    tool(Switch::Drawing, Icon::Curve, "draw a path", "Draw the end effector's path with the pointer"),
    tool(
        Switch::Pushing,
        Icon::Push,
        "push",
        "Push the end effector with the pointer, 20 N for each metre; or hold Alt",
    ),
    tool(
        Switch::Measuring,
        Icon::Ruler,
        "measure",
        "Click two points for their distance, a third one for the angle at the second; both follow the motion",
    ),
];

/// Layers of the scene.
const LAYERS: [Toggle; 3] = [
    tool(Switch::Dexterity, Icon::Ellipse, "dexterity", "Shade the workspace by how well the end effector moves"),
    tool(Switch::Snapshots, Icon::Fan, "snapshots", "Poses along the motion, as in Fig. 5"),
    tool(Switch::Pins, Icon::Pin, "pins", "What pins and bearings carry"),
];

/// Analyses.
const ANALYSES: [Toggle; 3] = [
    tool(Switch::Study, Icon::Bell, "tolerances", "What the bases of many machines feel, and the spectrum"),
    tool(Switch::Compare, Icon::Beside, "side by side", "The same task done in other ways"),
    tool(
        Switch::Table,
        Icon::Samples,
        "table",
        "From a CSV table: a motion of your own made reactionless, or the change that balances a measured machine",
    ),
];

/// Draws the tool bar.
pub fn show(ui: &mut Ui, session: &Session, branches: &[Fork], view_state: &ViewState, commands: &mut Vec<Command>) {
    let p = view_state.palette();
    let frame = Frame::new().inner_margin(Margin { left: 4, right: 4, top: 8, bottom: 6 });
    Panel::left("tools").exact_size(WIDTH_PT).resizable(false).frame(frame).show(ui, |ui| {
        // In a low window the tool bar scrolls.
        let room = ui.available_height();
        let bars = egui::scroll_area::ScrollBarVisibility::AlwaysHidden;
        ScrollArea::vertical().auto_shrink(false).scroll_bar_visibility(bars).show(ui, |ui| {
            ui.spacing_mut().item_spacing = vec2(0.0, GAP_PT);
            let size = vec2(BUTTON_SIZE_PT.x, height(room));
            for view in ViewKind::ALL {
                let size = vec2(BUTTON_SIZE_PT.x, VIEW_BUTTON_HEIGHT_PT);
                // While a drawing is not complete, every view says what is missing.
                let is_drawn = session.run().unfinished().is_none();
                if let Err(why) =
                    Views::has(view, session.run()).or_else(|why| if is_drawn { Err(why) } else { Ok(()) })
                {
                    let tip = format!("This machine has no such view: {why}");
                    disabled_word_button(ui, &p, view.name(), &tip, size);
                    continue;
                }
                let tip = format!("{}{}", view.explanation(), key("The next view: 2D, 3D, joint space, tower, design"));
                if word_button(ui, &p, view.name(), &tip, view_state.view == view, size).clicked() {
                    commands.push(ViewChange::Kind(view).into());
                }
            }
            if let Some(pen) = view_state.drawing_pen() {
                rule(ui, &p, BUTTON_SIZE_PT.x);
                sketching::rail(ui, &p, pen, size, commands);
            }
            let groups = if view_state.drawing_pen().is_some() { 0 } else { 3 };
            for group in [POINTER_TOOLS.as_slice(), &LAYERS, &ANALYSES].into_iter().take(groups) {
                rule(ui, &p, BUTTON_SIZE_PT.x);
                for tool in group {
                    toggle(ui, &p, tool, size, view_state, commands);
                }
            }
            rule(ui, &p, BUTTON_SIZE_PT.x);
            let tip = format!("Show everything{}", key("Show everything"));
            let fit = IconButton { size, ..IconButton::of(Icon::Corners, "show everything", &tip) };
            if fit.show_in(ui, &p, super::theme::colour(p.dim)).clicked() {
                commands.push(ViewChange::Fit.into());
            }
            arrangement::show(ui, view_state, size, commands);
            history::show(ui, session, branches, view_state, size, commands);
            focus::keep_in_view(ui);
        });
    });
}

/// Returns the height of a button at which all buttons fit into the height `room`, if possible, points.
fn height(room: f32) -> f32 {
    let words = ViewKind::ALL.len() as f32 * (VIEW_BUTTON_HEIGHT_PT + GAP_PT);
    let rules = 4.0 * (SEPARATOR_HEIGHT + GAP_PT);
    // The three other buttons are *show everything*, the arrangement and the history.
    let buttons = (POINTER_TOOLS.len() + LAYERS.len() + ANALYSES.len() + 3) as f32;
    ((room - words - rules) / buttons - GAP_PT).floor().clamp(MIN_BUTTON_HEIGHT_PT, BUTTON_SIZE_PT.y)
}

fn toggle(
    ui: &mut Ui,
    p: &Palette,
    tool: &Toggle,
    size: egui::Vec2,
    view_state: &ViewState,
    commands: &mut Vec<Command>,
) {
    let enabled = !tool.switch.is_of_machine() || view_state.view.shows_machine();
    let on = view_state.is_on(tool.switch);
    let only = if enabled { "" } else { "\n(in 2D and 3D)" };
    let key = in_brackets(key_of_switch(tool.switch));
    let tip = format!("{}{key}\n{}{only}", tool.label, tool.effect);
    let button = IconButton { icon: tool.icon, label: tool.label, tip: &tip, on: Some(on), enabled, size };
    if button.show(ui, p).clicked() {
        commands.push(view_state.other(tool.switch));
    }
}

/// Returns the key of an action in brackets, if it has one.
fn key(action: &str) -> String {
    in_brackets(key_of(action))
}

fn in_brackets(key: Option<String>) -> String {
    key.map(|key| format!(" ({key})")).unwrap_or_default()
}
