//! The lower corners of the scene: a hint or the colour scale of the workspace on the left, the grid width on the
//! right.

use egui::epaint::{Mesh, Vertex, WHITE_UV};
use egui::{Align2, Button, Rect, RichText, Ui, pos2, vec2};

use super::theme::{colour, plain};
use super::{Command, ViewChange, ViewState, fit};
use stillbase_picture::scene::joints::JointSpace;
use stillbase_picture::scene::palette::Palette;
use stillbase_picture::scene::views::{ViewKind, Views};
use stillbase_picture::scene::{Measure, dexterity};

/// Returns the strip along the lower edge of a scene that both corners occupy.
pub fn strip(rect: Rect) -> Rect {
    Rect::from_min_max(pos2(rect.left(), rect.bottom() - 28.0), rect.right_bottom())
}

/// Draws the hint or the colour scale, and the grid width.
pub fn show(
    ui: &mut Ui,
    rect: Rect,
    view_state: &ViewState,
    (views, has_grid): (&Views, bool),
    commands: &mut Vec<Command>,
) {
    let p = view_state.palette();
    let low = rect.bottom() - 16.0;
    let width = if has_grid { views.grid(view_state.view) } else { String::new() };
    let grid = ui.painter().text(
        pos2(rect.right() - 14.0, low),
        Align2::RIGHT_CENTER,
        view_state.notation().sentence(&width),
        plain(11.5),
        colour(p.dim),
    );
    // Long text is shortened so that it does not overlap the text of the grid width.
    let left = pos2(rect.left() + 16.0, low);
    let room = Rect::from_min_max(left - vec2(0.0, 12.0), pos2(grid.left() - 12.0, low + 12.0));
    let layout = egui::Layout::left_to_right(egui::Align::Center);
    let mut corner = ui.new_child(egui::UiBuilder::new().max_rect(room).layout(layout));
    match view_state.dexterity.filter(|_| view_state.view.shows_machine()) {
        Some(measure) => colour_scale(&mut corner, &p, measure, views, commands),
        None => {
            let joints = views.joints().filter(|_| view_state.view == ViewKind::Joints);
            let words = joints.map_or(view_state.view.invitation(), JointSpace::invitation);
            fit::label(&mut corner, words, plain(11.5), colour(p.dim));
        }
    }
}

/// Returns the rectangle of a scene that the button *show everything* covers.
pub fn recentre_covers(rect: Rect) -> Rect {
    let size = vec2(140.0, 24.0);
    Rect::from_min_size(pos2(rect.center().x - 0.5 * size.x, rect.top() + 10.0), size)
}

/// Draws the button *show everything* at the upper edge. It is needed when a part of the machine or its target is out
/// of view.
pub fn recentre_button(ui: &mut Ui, rect: Rect, view_state: &ViewState, commands: &mut Vec<Command>) {
    let p = view_state.palette();
    let words = RichText::new("show everything (F)").font(plain(11.5)).color(colour(p.ink));
    let at = recentre_covers(rect);
    let button = Button::new(words).fill(colour(p.panel)).stroke((1.0, colour(p.line))).corner_radius(8);
    let button = ui.put(at, button).on_hover_text("A part of the machine, or its target, is out of view");
    super::widgets::name(&button, "Show everything: a part is out of view");
    if button.clicked() {
        commands.push(ViewChange::Fit.into());
    }
}

/// Draws the colour scale of the workspace; a click on its symbol chooses the next measure.
fn colour_scale(ui: &mut Ui, p: &Palette, measure: Measure, views: &Views, commands: &mut Vec<Command>) {
    ui.spacing_mut().item_spacing.x = 6.0;
    let [least, most] = views.stage().shaded(measure);
    let words = RichText::new(measure.symbol()).font(plain(11.5)).color(colour(p.ink));
    let help = format!("{} (click for another)", measure.explanation());
    if ui.add(Button::new(words)).on_hover_text(help).clicked() {
        commands.push(ViewChange::Dexterity(Measure::after(Some(measure)).or(Some(Measure::Det))).into());
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
