//! What lies over the viewport's corners: the switch between views, the shade of the workspace with its key, the grid's
//! width, and what can be done.

use egui::epaint::{Mesh, Vertex, WHITE_UV};
use egui::{Align2, Button, Color32, Frame, Rect, RichText, Stroke, Ui, pos2, vec2};

use super::theme::{colour, plain};
use super::{Command, Look};
use crate::scene::palette::{Palette, faded};
use crate::scene::views::{ViewKind, Views};
use crate::scene::{Measure, dexterity};

/// Draws it.
pub fn show(ui: &mut Ui, rect: Rect, look: &Look, views: &Views, commands: &mut Vec<Command>) {
    let p = look.palette();
    let area = Rect::from_min_size(rect.min + vec2(14.0, 12.0), vec2((rect.width() - 28.0).min(620.0), 88.0));
    let mut child = ui.new_child(egui::UiBuilder::new().max_rect(area));
    let frame = Frame::new().fill(colour(p.panel)).stroke((1.0, colour(p.line))).corner_radius(8).inner_margin(3);
    frame.show(&mut child, |ui| {
        ui.spacing_mut().item_spacing.x = 2.0;
        ui.horizontal(|ui| {
            for view in ViewKind::ALL {
                let words = format!("{} (V)", view.explanation());
                if segment(ui, &p, view.name(), look.view == view).on_hover_text(words).clicked() {
                    commands.push(Command::View(view));
                }
            }
        });
    });
    if look.view.shows_machine() {
        shade(&mut child, &p, look, views, commands);
    }
    let low = rect.bottom() - 16.0;
    let grid = ui.painter().text(
        pos2(rect.right() - 14.0, low),
        Align2::RIGHT_CENTER,
        look.view.grid(),
        plain(11.5),
        colour(p.dim),
    );
    // Where there is no room, it is cut short rather than run into the grid's width.
    let left = pos2(rect.left() + 16.0, low);
    let room = Rect::from_min_max(left - vec2(0.0, 10.0), pos2(grid.left() - 12.0, low + 10.0));
    let words = RichText::new(look.view.invitation()).font(plain(11.5)).color(colour(p.dim));
    let layout = egui::Layout::left_to_right(egui::Align::Center);
    let mut corner = ui.new_child(egui::UiBuilder::new().max_rect(room).layout(layout));
    corner.add(egui::Label::new(words).truncate());
}

fn segment(ui: &mut Ui, p: &Palette, text: &str, chosen: bool) -> egui::Response {
    let ink = if chosen { p.ink } else { p.dim };
    let fill = if chosen { colour(p.line) } else { Color32::TRANSPARENT };
    let words = RichText::new(text).color(colour(ink));
    ui.add(Button::new(words).fill(fill).stroke(Stroke::NONE).min_size(vec2(40.0, 22.0)))
}

/// The toggles, and once the shade is on the key to its colours.
fn shade(ui: &mut Ui, p: &Palette, look: &Look, views: &Views, commands: &mut Vec<Command>) {
    ui.add_space(2.0);
    // Labels of the scene pass behind it; a narrow window breaks the line.
    let frame = Frame::new().fill(colour(faded(p.background, 0.82))).corner_radius(6).inner_margin(2);
    frame.show(ui, |ui| toggles(ui, p, look, views, commands));
}

fn toggles(ui: &mut Ui, p: &Palette, look: &Look, views: &Views, commands: &mut Vec<Command>) {
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = vec2(6.0, 2.0);
        let ink = colour(if look.stroke.is_some() { p.ink } else { p.dim });
        let mut drawing = look.stroke.is_some();
        let help = "Draw the end effector's path with the pointer (P)";
        let words = RichText::new("draw a path").font(plain(11.5)).color(ink);
        if ui.checkbox(&mut drawing, words).on_hover_text(help).clicked() {
            commands.push(Command::Draw(drawing));
        }
        let ink = colour(if look.pushing { p.ink } else { p.dim });
        let mut pushing = look.pushing;
        let help = "Push the end effector with the pointer, 20 N for each metre (U; or hold Alt)";
        if ui.checkbox(&mut pushing, RichText::new("push").font(plain(11.5)).color(ink)).on_hover_text(help).clicked() {
            commands.push(Command::Push(pushing));
        }
        let ink = colour(if look.dexterity.is_some() { p.ink } else { p.dim });
        let words = RichText::new("dexterity").font(plain(11.5)).color(ink);
        let help = "Shade the workspace by how well the end effector moves (J)";
        let mut shown = look.dexterity.is_some();
        if ui.checkbox(&mut shown, words).on_hover_text(help).clicked() {
            commands.push(Command::Dexterity(shown.then_some(Measure::Det)));
        }
        for (words, help, mut on, command) in [
            (
                "snapshots",
                "Poses along the motion, as in Fig. 5 (S)",
                look.snapshots,
                Command::Snapshots as fn(bool) -> Command,
            ),
            ("pins", "What pins and bearings carry (I)", look.pins, Command::Pins),
            ("tolerances", "What the bases of many machines feel, and the spectrum (T)", look.study, Command::Study),
            ("side by side", "The same task done in other ways (C)", look.compare, Command::Compare),
        ] {
            let ink = colour(if on { p.ink } else { p.dim });
            let words = RichText::new(words).font(plain(11.5)).color(ink);
            if ui.checkbox(&mut on, words).on_hover_text(help).clicked() {
                commands.push(command(on));
            }
        }
        let Some(measure) = look.dexterity else { return };
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
    });
}
