//! The tabs of the panel on the right: balance, or equations of the paper.

use egui::{Button, RichText, Ui, vec2};

use crate::theme::{bold, colour};
use crate::widgets::name;
use crate::{Command, GuidePage, GuidePlace, Switch, ViewChange, ViewState, guide};

/// Width of the button that opens the guide, points.
const HELP_WIDTH_PT: f32 = 19.0;

const TABS: [(bool, &str, &str); 2] = [
    (false, "Balance", "What is out of balance, and counterweights to take"),
    (true, "Equations", "Every equation of the paper with the numbers of the machine"),
];

/// Draws the tabs.
pub fn show(ui: &mut Ui, view_state: &ViewState, commands: &mut Vec<Command>) {
    let p = &view_state.palette();
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 3.0;
        let width = 0.5 * (ui.available_width() - 3.0 - crate::side::SCROLL_BAR_WIDTH - HELP_WIDTH_PT);
        for (learns, words, tip) in TABS {
            let chosen = learns == view_state.arrangement.shows_equations;
            let text = RichText::new(words).font(bold(12.5)).color(colour(if chosen { p.ink } else { p.dim }));
            let fill = if chosen { colour(p.line) } else { egui::Color32::TRANSPARENT };
            let button = Button::new(text).fill(fill).stroke((1.0, colour(p.line))).min_size(vec2(width, 24.0));
            let tab = ui.add(button).on_hover_text(tip);
            name(&tab, &format!("{words} tab"));
            if tab.clicked() && !chosen {
                commands.push(ViewChange::Switch(Switch::Equations, learns).into());
            }
        }
        let place = match view_state.arrangement.shows_equations {
            true => GuidePlace::under(GuidePage::Design, "Every equation of the paper"),
            false => GuidePage::Design.into(),
        };
        guide::button(ui, p, "the design", place, commands);
    });
    ui.add_space(4.0);
}
