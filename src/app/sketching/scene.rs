//! The scene of a drawing in place of that of the run.

use std::sync::Arc;

use egui::{Align2, CentralPanel, Frame, PointerButton, Pos2, Rect, Sense, Ui, pos2, vec2};

use super::hand::Hand;
use super::pen::{Pen, PenTool};
use super::{SketchFacts, bubble};
use crate::theme::{colour, plain};
use crate::viewport::move_camera;
use crate::widgets::name;
use crate::{Command, Framing, ViewState, corner, framing};
use stillbase_mechanics::sketch::Pin;
use stillbase_picture::paint::labels::draw_labels;
use stillbase_picture::paint::{SceneViewport, paint};
use stillbase_picture::scene::sketching::{Rubber, SketchOptions, content};
use stillbase_picture::scene::views::Views;

/// What the scene of a drawing needs.
#[derive(Clone, Copy)]
pub struct SketchScene<'a> {
    pub facts: &'a SketchFacts,
    pub views: &'a Views,
}

/// Draws the scene and handles the pointer; returns the rectangle of the scene.
pub fn show(ui: &mut Ui, scene: SketchScene<'_>, view_state: &mut ViewState, commands: &mut Vec<Command>) -> Rect {
    let Some(mut pen) = view_state.pen.take() else { return Rect::NOTHING };
    let shown = CentralPanel::default().frame(Frame::NONE).show(ui, |ui| {
        let rect = ui.available_rect_before_wrap();
        let response = ui.allocate_rect(rect, Sense::click_and_drag());
        name(&response, "Scene: the drawing of the machine");
        let strip = corner::strip(rect);
        // A bar that has left the view takes the view along.
        let spot = SceneViewport { rect, camera: *view_state.camera() };
        let is_out = |pin: &Pin| !spot.screen([pin.at[0], pin.at[1], 0.0]).is_some_and(|at| rect.contains(at));
        if pen.places(&scene.facts.sketch, is_out) {
            view_state.framing[view_state.view as usize] = Framing::Pending;
        }
        framing::keep_framed(rect, (&[strip], None), scene.views, |_| content(&scene.facts.sketch), view_state);
        let spot = SceneViewport { rect, camera: *view_state.camera() };
        let under_way = Hand { ui, response: &response, spot: &spot, facts: scene.facts }.points(&mut pen, commands);
        let holds = pen.from.is_some() || pen.drag.is_some() || pen.tool == PenTool::Bar;
        if !(holds && response.dragged_by(PointerButton::Primary)) {
            move_camera(ui, &response, rect, view_state);
        }
        let (rubber, words) = under_way.unzip();
        let end = rubber.as_ref().map(|rubber| rubber.ends[1]);
        draw_scene(ui, rect, scene, &pen, rubber, view_state);
        let spot = SceneViewport { rect, camera: *view_state.camera() };
        bubble::show(ui, &spot, scene.facts, &pen, &view_state.palette(), commands);
        if let Some((words, [x, y])) = words.zip(end)
            && let Some(at) = spot.screen([x, y, 0.0])
        {
            numbers(ui, rect, at, words, view_state);
        }
        hint(ui, rect, &pen, view_state);
        rect
    });
    view_state.pen = Some(pen);
    shown.inner
}

/// Draws the drawing as it would be after the drag under way.
fn draw_scene(
    ui: &mut Ui,
    rect: Rect,
    scene: SketchScene<'_>,
    pen: &Pen,
    rubber: Option<Rubber>,
    view_state: &ViewState,
) {
    let SketchScene { facts, views } = scene;
    let ring = pen.drag.as_ref().and_then(|drag| drag.onto);
    let options = SketchOptions { theme: view_state.arrangement.theme, hot: pen.hot, chosen: pen.chosen, rubber, ring };
    let (sketch, resolved) = facts.shown();
    let drawn = Arc::new(views.sketched(sketch, resolved, &options));
    paint(ui, 0, rect, &drawn, view_state.camera());
    let spot = SceneViewport { rect, camera: *view_state.camera() };
    draw_labels(ui, 0, &spot, &drawn, &[corner::strip(rect)]);
}

/// Writes length and angle of the bar under way in a box beside its end.
fn numbers(ui: &Ui, rect: Rect, at: Pos2, words: String, view_state: &ViewState) {
    let p = view_state.palette();
    let galley = ui.painter().layout_no_wrap(words, plain(13.0), colour(p.ink));
    let size = galley.size() + vec2(20.0, 12.0);
    let room = rect.shrink(8.0);
    let left = (at.x + 16.0).min(room.right() - size.x).max(room.left());
    let top = if at.y + 18.0 + size.y > room.bottom() { at.y - 18.0 - size.y } else { at.y + 18.0 };
    let place = Rect::from_min_size(pos2(left, top), size);
    ui.painter().rect(place, 6.0, colour(p.panel), (1.2, colour(p.amber)), egui::StrokeKind::Inside);
    ui.painter().galley(place.min + vec2(10.0, 6.0), galley, colour(p.ink));
}

/// Writes what can be done in the lower corners.
fn hint(ui: &Ui, rect: Rect, pen: &Pen, view_state: &ViewState) {
    let tone = colour(view_state.palette().dim);
    let low = rect.bottom() - 16.0;
    let write = |x: f32, align: Align2, text: &str| ui.painter().text(pos2(x, low), align, text, plain(11.5), tone);
    let grid = write(rect.right() - 14.0, Align2::RIGHT_CENTER, "50 mm grid");
    let words = pen.tool.invitation();
    let words = crate::fit::fitted(ui, words, &plain(11.5), grid.left() - rect.left() - 32.0);
    write(rect.left() + 16.0, Align2::LEFT_CENTER, &words);
}
