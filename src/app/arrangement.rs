//! The menu of the window's layouts and panels, at the foot of the tool bar.

use egui::{Popup, PopupCloseBehavior, RectAlign, RichText, Ui, Vec2};

use super::actions::{key_of, key_of_switch};
use super::icon::{Icon, IconButton, dot};
use super::theme::{bold, colour};
use super::{Command, Layout, Switch, ViewChange, ViewState};
use stillbase_picture::notation::{AngleUnit, LengthUnit, NameOrder, Notation};

/// Draws the button of the menu, and the menu while it is open.
pub fn show(ui: &mut Ui, view_state: &ViewState, size: Vec2, commands: &mut Vec<Command>) {
    let p = view_state.palette();
    let tip = "layout\nWhat the window is for: explore, compare, present; and its panels";
    let button = IconButton { size, ..IconButton::of(Icon::Panes, "layout", tip) };
    let button = button.show_in(ui, &p, colour(p.dim));
    let popup = Popup::menu(&button).align(RectAlign::RIGHT_END).gap(8.0).width(250.0);
    popup.close_behavior(PopupCloseBehavior::CloseOnClick).show(|ui| {
        let heading = |ui: &mut Ui, text: &str| {
            ui.label(RichText::new(text).font(bold(11.0)).color(colour(p.dim)));
        };
        let mut line = |ui: &mut Ui, (text, key, tip): (&str, Option<String>, &str), on: bool, command: Command| {
            let words = RichText::new(format!("     {text}")).color(colour(p.ink));
            let line = egui::Button::new(words).frame_when_inactive(false).wrap_mode(egui::TextWrapMode::Extend);
            let key = RichText::new(key.unwrap_or_default()).color(colour(p.dim));
            let line = ui.add(line.right_text(key));
            if on {
                dot(ui, &p, &line);
            }
            line.widget_info(|| egui::WidgetInfo::selected(egui::Role::MenuItemCheckBox, true, on, text));
            if line.on_hover_text(tip).clicked() {
                commands.push(command);
            }
        };
        heading(ui, "LAYOUT");
        for layout in Layout::ALL {
            // The name of the action that chooses the layout; its key is found by this name.
            let action = format!("{}: {}", layout.name(), layout.words());
            let what = (layout.name(), key_of(&action), layout.words());
            line(ui, what, view_state.arrangement.layout == layout, Command::View(ViewChange::Layout(layout)));
        }
        ui.separator();
        heading(ui, "PANELS");
        for (text, switch, tip) in [
            ("Settings", Switch::Side, "b, limits, path, plant, base, control"),
            ("Plots", Switch::Plots, "Signals over time, and which b serves"),
            ("All settings", Switch::Settings, "Every setting in a window of its own"),
            ("Settings on the right", Switch::Swapped, "Settings and plots change sides"),
        ] {
            line(ui, (text, key_of_switch(switch), tip), view_state.is_on(switch), view_state.other(switch));
        }
        ui.separator();
        heading(ui, "UNITS AND NAMES");
        let now = view_state.arrangement.notation;
        let (degrees, millimetres) = (now.angle == AngleUnit::Degrees, now.length == LengthUnit::Millimetres);
        let symbols = now.names == NameOrder::Symbols;
        let (angle, length, names) = (now.angle.other(), now.length.other(), now.names.other());
        for (text, tip, on, new) in [
            (
                "Angles in degrees",
                "Else in radians; files and settings stay in radians",
                degrees,
                Notation { angle, ..now },
            ),
            (
                "Lengths in millimetres",
                "Else in metres; files and settings stay in metres",
                millimetres,
                Notation { length, ..now },
            ),
            ("Symbols first", "n_B before \"moment on the base\", as in the paper", symbols, Notation { names, ..now }),
        ] {
            line(ui, (text, None, tip), on, ViewChange::Notation(new).into());
        }
    });
}
