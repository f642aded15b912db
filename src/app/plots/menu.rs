//! The menu of a plot: opened by a button in its corner, or by the right mouse button.

use egui::accesskit::Role;
use egui::{Align2, Button, Popup, Rect, Response, ScrollArea, Sense, Ui, WidgetInfo, pos2, vec2};

use super::prepared::extent;
use super::shown::DisplayContext;
use super::written::values;
use super::{place, search};
use crate::export::values_text;
use crate::theme::{bold, colour};
use crate::{Command, FileDialog, FilePurpose, PlotFile, ViewChange};
use stillbase_picture::charts::choice::{Plot, PlotChange};
use stillbase_settings::text::capitalised;

/// Height of the margins of the menu, points.
const MENU_MARGINS_PT: f32 = 16.0;

/// Draws the button, and the menu while it is open.
pub fn show(
    ui: &mut Ui,
    shown: &DisplayContext<'_>,
    plot: &Plot<'_>,
    response: &Response,
    commands: &mut Vec<Command>,
) {
    let corner = pos2(response.rect.right() - 24.0, response.rect.top());
    let rect = Rect::from_min_size(corner, vec2(22.0, 16.0));
    let button = ui.interact(rect, response.id.with("menu"), Sense::click());
    let p = shown.view_state.palette();
    button.widget_info(|| WidgetInfo::labeled(Role::Button, true, format!("{}: menu", plot.title)));
    // The button is hidden until the pointer is over the plot, but the keyboard can always focus it.
    let open = Popup::is_id_open(ui.ctx(), Popup::default_response_id(&button));
    if response.contains_pointer() || button.contains_pointer() || button.has_focus() || open {
        let lit = button.hovered() || button.has_focus() || open;
        ui.painter().rect_filled(rect, 4.0, colour(if lit { p.line } else { p.panel }));
        ui.painter().text(rect.center(), Align2::CENTER_CENTER, "⋯", bold(13.0), colour(p.ink));
    }
    response.context_menu(|ui| entries(ui, shown, plot, response.rect, commands));
    Popup::menu(&button).show(|ui| entries(ui, shown, plot, response.rect, commands));
}

/// Draws the entries that give the plot another place.
fn places(ui: &mut Ui, shown: &DisplayContext<'_>, plot: &Plot<'_>, rect: Rect, commands: &mut Vec<Command>) {
    let mut entry = |ui: &mut Ui, words: &str, change: Option<PlotChange>| {
        if ui.add_enabled(change.is_some(), Button::new(words)).clicked() {
            commands.extend(change.map(|change| Command::View(ViewChange::Charts(change))));
            ui.close();
        }
    };
    if plot.window.is_some() {
        return;
    }
    let all = shown.view_state.plots(shown.session.scenario(), shown.signals);
    entry(ui, "Move up", place::moved(&all, &plot.name, false));
    entry(ui, "Move down", place::moved(&all, &plot.name, true));
    entry(ui, "Into a window of its own", Some(place::pulled_out(&plot.name, rect)));
}

/// Draws the entries, which scroll in a window that is not as high.
fn entries(ui: &mut Ui, shown: &DisplayContext<'_>, plot: &Plot<'_>, rect: Rect, commands: &mut Vec<Command>) {
    let room = ui.ctx().content_rect().height() - MENU_MARGINS_PT;
    ScrollArea::vertical().max_height(room).min_scrolled_height(room).show(ui, |ui| {
        all_entries(ui, shown, plot, rect, commands);
    });
}

fn all_entries(ui: &mut Ui, shown: &DisplayContext<'_>, plot: &Plot<'_>, rect: Rect, commands: &mut Vec<Command>) {
    let chosen = &shown.view_state.charts;
    let extent = extent(shown.session);
    ui.set_min_width(210.0);
    // First in a window of its own, which may be too low for the whole menu.
    if plot.window.is_some() {
        if ui.button("Put back among the plots").clicked() {
            commands.push(ViewChange::Charts(PlotChange::Window(plot.name.clone(), None)).into());
            ui.close();
        }
        ui.separator();
    }
    if ui.button("Copy the values shown").clicked() {
        let text = values_text(shown.session.frames(), &values(shown.session, shown.view_state, plot));
        // Nothing fails in memory.
        ui.ctx().copy_text(text.unwrap_or_default());
        ui.close();
    }
    for file in PlotFile::ALL {
        if ui.button(format!("Save as {}…", file.words())).clicked() {
            let purpose = FilePurpose::Plot(plot.name.clone(), file);
            commands.push(ViewChange::Dialog(Some(FileDialog::suggest(shown.session, purpose))).into());
            ui.close();
        }
    }
    ui.separator();
    if ui.button("Add a curve…").clicked() {
        search::start(ui.ctx(), search::SearchPurpose::Curve(plot.name.clone()));
        ui.close();
    }
    for curve in plot.curves.iter().filter(|curve| curve.added && plot.curves.len() > 1) {
        if ui.button(format!("Take {} out", curve.signal.symbol)).clicked() {
            commands.push(ViewChange::Charts(PlotChange::Remove(plot.name.clone(), curve.signal.path.clone())).into());
            ui.close();
        }
    }
    if ui.button("Against another signal…").clicked() {
        search::start(ui.ctx(), search::SearchPurpose::Abscissa(plot.name.clone()));
        ui.close();
    }
    if plot.against.is_some() && ui.button("Against time").clicked() {
        commands.push(ViewChange::Charts(PlotChange::Against(plot.name.clone(), None)).into());
        ui.close();
    }
    ui.separator();
    let mut statistics = chosen.statistics;
    if ui.checkbox(&mut statistics, "Statistics of the time shown").changed() {
        commands.push(ViewChange::Charts(PlotChange::Statistics(statistics)).into());
        ui.close();
    }
    if ui.add_enabled(chosen.range.is_some(), Button::new("Show all time   Alt 0")).clicked() {
        commands.push(ViewChange::Charts(PlotChange::Range(extent.all(chosen.range))).into());
        ui.close();
    }
    if ui.add_enabled(plot.values.is_some(), Button::new("Show all values")).clicked() {
        commands.push(ViewChange::Charts(PlotChange::Values(plot.name.clone(), None)).into());
        ui.close();
    }
    // Every drive has a setting of this name: the list shows all of them.
    let key = plot.curves.iter().find_map(|curve| curve.signal.limit_key());
    if let Some(key) = key
        && ui.button(format!("{}s of the drives…", capitalised(&key.replace('_', " ")))).clicked()
    {
        commands.push(ViewChange::LookUp(key.to_owned()).into());
        ui.close();
    }
    ui.separator();
    places(ui, shown, plot, rect, commands);
    if ui.button("Put this plot away").clicked() {
        commands.push(ViewChange::Charts(PlotChange::Close(plot.name.clone())).into());
        ui.close();
    }
}
