//! The bar above the scene, with the switch between views and what can be done and shown; and the scene's lower
//! corners: the key to the shade of the workspace, and the grid's width.

use egui::epaint::{Mesh, Vertex, WHITE_UV};
use egui::{Align2, Button, Color32, Frame, Margin, Rect, RichText, Stroke, Ui, pos2, vec2};

use super::theme::{colour, plain};
use super::{Command, ViewState};
use crate::picture::scene::palette::Palette;
use crate::picture::scene::views::{ViewKind, Views};
use crate::picture::scene::{Measure, dexterity};

/// Room that the switch and the toggles take beside each other.
const ONE_ROW: f32 = 740.0;

/// The bar above the scene: which view, and what can be done and shown in it.
pub fn bar(ui: &mut Ui, view_state: &ViewState, commands: &mut Vec<Command>) {
    let p = view_state.palette();
    let frame =
        Frame::new().fill(colour(p.background)).inner_margin(Margin { left: 14, right: 14, top: 10, bottom: 6 });
    frame.show(ui, |ui| {
        ui.set_width(ui.available_width());
        let views = |ui: &mut Ui, commands: &mut Vec<Command>| views(ui, &p, view_state, commands);
        if ui.available_width() >= ONE_ROW {
            ui.horizontal(|ui| {
                views(ui, commands);
                ui.add_space(14.0);
                toggles(ui, &p, view_state, commands);
            });
        } else {
            views(ui, commands);
            ui.add_space(4.0);
            toggles(ui, &p, view_state, commands);
        }
    });
}

fn views(ui: &mut Ui, p: &Palette, view_state: &ViewState, commands: &mut Vec<Command>) {
    let frame = Frame::new().fill(colour(p.panel)).stroke((1.0, colour(p.line))).corner_radius(8).inner_margin(3);
    frame.show(ui, |ui| {
        ui.spacing_mut().item_spacing.x = 2.0;
        ui.horizontal(|ui| {
            for view in ViewKind::ALL {
                let words = format!("{} (V)", view.explanation());
                if segment(ui, p, view.name(), view_state.view == view).on_hover_text(words).clicked() {
                    commands.push(Command::View(view));
                }
            }
        });
    });
}

/// In the scene's lower corners: what can be done or the key to the shade, and the grid's width.
pub fn corners(ui: &mut Ui, rect: Rect, view_state: &ViewState, views: &Views, commands: &mut Vec<Command>) {
    let p = view_state.palette();
    let low = rect.bottom() - 16.0;
    let grid = ui.painter().text(
        pos2(rect.right() - 14.0, low),
        Align2::RIGHT_CENTER,
        view_state.view.grid(),
        plain(11.5),
        colour(p.dim),
    );
    // Where there is no room, it is cut short rather than run into the grid's width.
    let left = pos2(rect.left() + 16.0, low);
    let room = Rect::from_min_max(left - vec2(0.0, 12.0), pos2(grid.left() - 12.0, low + 12.0));
    let layout = egui::Layout::left_to_right(egui::Align::Center);
    let mut corner = ui.new_child(egui::UiBuilder::new().max_rect(room).layout(layout));
    match view_state.dexterity.filter(|_| view_state.view.shows_machine()) {
        Some(measure) => key(&mut corner, &p, measure, views, commands),
        None => {
            let words = RichText::new(view_state.view.invitation()).font(plain(11.5)).color(colour(p.dim));
            corner.add(egui::Label::new(words).truncate());
        }
    }
}

fn segment(ui: &mut Ui, p: &Palette, text: &str, chosen: bool) -> egui::Response {
    let ink = if chosen { p.ink } else { p.dim };
    let fill = if chosen { colour(p.line) } else { Color32::TRANSPARENT };
    let words = RichText::new(text).color(colour(ink));
    ui.add(Button::new(words).fill(fill).stroke(Stroke::NONE).min_size(vec2(40.0, 22.0)))
}

/// What can be done and shown; what the view does not have is left out.
fn toggles(ui: &mut Ui, p: &Palette, view_state: &ViewState, commands: &mut Vec<Command>) {
    if !view_state.view.shows_machine() {
        return;
    }
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = vec2(6.0, 2.0);
        for (words, help, on, command) in [
            (
                "draw a path",
                "Draw the end effector's path with the pointer (P)",
                view_state.stroke.is_some(),
                Command::Draw as fn(bool) -> Command,
            ),
            (
                "push",
                "Push the end effector with the pointer, 20 N for each metre (U; or hold Alt)",
                view_state.pushing,
                Command::Push,
            ),
            (
                "dexterity",
                "Shade the workspace by how well the end effector moves (J)",
                view_state.dexterity.is_some(),
                |on| Command::Dexterity(on.then_some(Measure::Det)),
            ),
            ("snapshots", "Poses along the motion, as in Fig. 5 (S)", view_state.snapshots, Command::Snapshots),
            ("pins", "What pins and bearings carry (I)", view_state.pins, Command::Pins),
            (
                "tolerances",
                "What the bases of many machines feel, and the spectrum (T)",
                view_state.study,
                Command::Study,
            ),
            ("side by side", "The same task done in other ways (C)", view_state.compare, Command::Compare),
        ] {
            let mut now = on;
            let words = RichText::new(words).font(plain(11.5)).color(colour(if on { p.ink } else { p.dim }));
            if ui.checkbox(&mut now, words).on_hover_text(help).clicked() {
                commands.push(command(now));
            }
        }
    });
}

/// The key to the shade of the workspace.
fn key(ui: &mut Ui, p: &Palette, measure: Measure, views: &Views, commands: &mut Vec<Command>) {
    ui.spacing_mut().item_spacing.x = 6.0;
    let [least, most] = views.stage().shaded(measure);
    let words = RichText::new(measure.symbol()).font(plain(11.5)).color(colour(p.ink));
    let help = format!("{} (click for another)", measure.explanation());
    if ui.add(Button::new(words)).on_hover_text(help).clicked() {
        commands.push(Command::Dexterity(Measure::after(Some(measure)).or(Some(Measure::Det))));
    }
    let least = if least == 0.0 { "0".into() } else { format!("{least:.3}") };
    ui.label(RichText::new(least).font(plain(11.5)).color(colour(p.dim)));
    let (bar, _) = ui.allocate_exact_size(vec2(56.0, 8.0), egui::Sense::hover());
    let [low, high] = dexterity::colours(p).map(colour);
    let mut mesh = Mesh::default();
    for (pos, color) in
        [(bar.left_top(), low), (bar.right_top(), high), (bar.right_bottom(), high), (bar.left_bottom(), low)]
    {
        mesh.vertices.push(Vertex { pos, uv: WHITE_UV, color });
    }
    mesh.indices = vec![0, 1, 2, 0, 2, 3];
    ui.painter().add(mesh);
    ui.label(RichText::new(format!("{most:.3} {}", measure.unit())).font(plain(11.5)).color(colour(p.dim)));
}
