//! What stands in place of scene, plots and settings while a drawing is no machine yet: what is missing, and the way
//! back to the drawing. Nothing of the machine before is shown.

use std::sync::Arc;

use egui::{Align2, Area, Button, CentralPanel, Frame, Id, Label, Rect, RichText, Sense, Ui, vec2};

use super::SketchFacts;
use super::scene::SketchScene;
use crate::theme::{bold, colour, plain};
use crate::widgets::{name, note};
use crate::{Command, Layout, Switch, ViewChange, ViewState, corner, framing, notation};
use stillbase_picture::paint::labels::draw_labels;
use stillbase_picture::paint::{SceneViewport, paint};
use stillbase_picture::scene::palette::Palette;
use stillbase_picture::scene::sketching::{SketchOptions, content};
use stillbase_picture::scene::views::ViewKind;
use stillbase_session::scenario::UnfinishedDrawing;

/// Width of the card, points.
const WIDTH_PT: f32 = 380.0;

/// Draws what is missing in place of a scene; in flat views over the drawing as it is. Returns the rectangle of the scene.
pub fn scene(
    ui: &mut Ui,
    unfinished: &UnfinishedDrawing,
    drawing: SketchScene<'_>,
    view_state: &ViewState,
    commands: &mut Vec<Command>,
) -> Rect {
    let is_flat = matches!(view_state.view, ViewKind::Flat | ViewKind::Design);
    let shown = CentralPanel::default().frame(Frame::NONE).show(ui, |ui| {
        let rect = ui.available_rect_before_wrap();
        let response = ui.allocate_rect(rect, Sense::hover());
        name(&response, "Scene: no machine yet");
        if is_flat {
            picture(ui, rect, drawing, view_state);
        }
        rect
    });
    let rect = shown.inner;
    let (pivot, at) = match is_flat {
        true => (Align2::CENTER_BOTTOM, rect.center_bottom() - vec2(0.0, 34.0)),
        false => (Align2::CENTER_CENTER, rect.center()),
    };
    let p = &view_state.palette();
    let width = WIDTH_PT.min(rect.width() - 40.0).max(160.0);
    Area::new(card()).pivot(pivot).fixed_pos(at).order(egui::Order::Middle).show(ui.ctx(), |ui| {
        let frame = Frame::new().fill(colour(p.panel)).stroke((1.0, colour(p.line))).corner_radius(8).inner_margin(14);
        frame.show(ui, |ui| {
            ui.set_width(width);
            let title = format!("{} is no machine yet", unfinished.drawing);
            ui.add(Label::new(RichText::new(title).font(bold(14.0)).color(colour(p.ink))).wrap());
            note(ui, p, &format!("{} as soon as nothing is missing.", promise(view_state.view)));
            ui.add_space(4.0);
            list(ui, unfinished, p);
            ui.add_space(6.0);
            match view_state.arrangement.layout {
                Layout::Present => note(ui, p, "Esc leads back to the panels."),
                _ => back(ui, commands),
            }
        });
    });
    rect
}

fn card() -> Id {
    Id::unique("no machine yet")
}

/// Says what a view shows of a machine.
fn promise(view: ViewKind) -> &'static str {
    match view {
        ViewKind::Joints => "Its joint space stands here",
        ViewKind::Tower => "Its workspaces over all b stand here",
        _ => "It moves here",
    }
}

/// Draws the drawing as it is, clear of the card.
fn picture(ui: &Ui, rect: Rect, SketchScene { facts, views }: SketchScene<'_>, view_state: &ViewState) {
    let options = SketchOptions { theme: view_state.arrangement.theme, ..SketchOptions::default() };
    let drawn = Arc::new(views.sketched(&facts.sketch, &facts.resolved, &options));
    let card = ui.memory(|memory| memory.area_rect(card()));
    let covered: Vec<Rect> = [Some(corner::strip(rect)), card].into_iter().flatten().collect();
    let camera = content(&facts.sketch).framed(views.camera(ViewKind::Flat), &framing::area(rect, &covered));
    paint(ui, 0, rect, &drawn, &camera);
    draw_labels(ui, 0, &SceneViewport { rect, camera }, &drawn, &covered);
}

/// Says in a panel what stands there once the drawing is a machine.
pub fn panel(ui: &mut Ui, what: &str, p: &Palette) {
    note(ui, p, &format!("{what} here as soon as it is a machine."));
}

/// Draws the list of what is missing.
fn list(ui: &mut Ui, unfinished: &UnfinishedDrawing, p: &Palette) {
    for one in &unfinished.missing {
        let words =
            RichText::new(notation::sentence(ui.ctx(), &format!("• {one}"))).font(plain(12.5)).color(colour(p.ink));
        ui.add(Label::new(words).wrap());
    }
}

/// Draws the button that leads back to the drawing.
fn back(ui: &mut Ui, commands: &mut Vec<Command>) {
    let button = ui.add(Button::new(RichText::new("draw on").font(plain(12.5))));
    if button.on_hover_text("Back to the drawing (Shift D)").clicked() {
        commands.push(ViewChange::Switch(Switch::Sketching, true).into());
    }
}

/// Returns the drawing of a session that is no machine yet, for pictures without a hand.
pub fn facts(queries: &stillbase_query::Queries, session: &stillbase_session::Session) -> Option<SketchFacts> {
    session.run().unfinished().map(|_| SketchFacts::of(queries, session, &super::Pen::default()))
}
