//! A box at a part of the drawing: why a step is refused there, or that a loop is nearly a parallelogram.

use egui::{Area, Button, Frame, Id, Label, Order, Rect, RichText, Ui, vec2};

use super::{Pen, SketchFacts, draw};
use crate::theme::{colour, plain};
use crate::{Command, notation};
use stillbase_mechanics::planar::Vector;
use stillbase_mechanics::sketch::{Lack, Place, Sketch, SketchStep};
use stillbase_picture::paint::SceneViewport;
use stillbase_picture::scene::Rgba;
use stillbase_picture::scene::palette::Palette;

/// Width of the box, and its distance from the part, points.
const WIDTH_PT: f32 = 250.0;
const AWAY_PT: f32 = 30.0;

/// What the box says.
struct Said {
    place: Place,
    text: String,
    tone: Rgba,
    ways: Vec<(String, SketchStep)>,
}

/// Returns what is to be said: the last refusal, else the first loop that is no parallelogram.
fn said(facts: &SketchFacts, pen: &Pen, p: &Palette) -> Option<Said> {
    let sketch = &facts.sketch;
    if let Some(refused) = &pen.refused {
        let ways = refused.proposals.iter().map(|step| (step.title_in(sketch), step.clone())).collect();
        return Some(Said { place: refused.place.clone(), text: refused.to_string(), tone: p.reaction, ways });
    }
    let is_loop = |lack: &Lack| matches!(lack, Lack::LoopOff { .. } | Lack::LoopOutside { .. });
    let one = facts.resolved.missing.iter().find(|one| is_loop(&one.lack))?;
    let tone = if matches!(one.lack, Lack::LoopOff { .. }) { p.amber } else { p.reaction };
    let ways = one.mends.iter().map(|mend| (mend.label.clone(), mend.step.clone())).collect();
    Some(Said { place: one.place.clone(), text: one.text.clone(), tone, ways })
}

/// Returns where a part of the drawing is, m.
fn at(sketch: &Sketch, place: &Place) -> Vector {
    match place {
        Place::Pin(pin) => sketch.at(*pin),
        Place::Bar(id) => {
            sketch.bar(*id).map_or_else(Vector::default, |bar| sketch.at(bar.root) + sketch.span(bar) * 0.5)
        }
        Place::Drive(drive) => sketch.motor(drive).map_or_else(Vector::default, |motor| sketch.at(motor.pin)),
        Place::Whole => sketch.at(sketch.base),
    }
}

/// Draws the box beside its part, inside the scene.
pub fn show(ui: &Ui, spot: &SceneViewport, facts: &SketchFacts, pen: &Pen, p: &Palette, commands: &mut Vec<Command>) {
    if pen.from.is_some() || pen.drag.is_some() {
        return;
    }
    let Some(Said { place, text, tone, ways }) = said(facts, pen, p) else { return };
    let at = at(&facts.sketch, &place);
    let Some(pin) = spot.screen([at.re, at.im, 0.0]).filter(|pin| spot.rect.contains(*pin)) else { return };
    let id = Id::unique("drawing says");
    let size = ui.memory(|memory| memory.area_rect(id)).map_or(vec2(WIDTH_PT, 60.0), |rect| rect.size());
    let room = spot.rect.shrink(10.0);
    let left = if pin.x - AWAY_PT - size.x > room.left() { pin.x - AWAY_PT - size.x } else { pin.x + AWAY_PT };
    let top = (pin.y - AWAY_PT - size.y).clamp(room.top(), (room.bottom() - size.y).max(room.top()));
    let rect = Rect::from_min_size(egui::pos2(left, top), size);
    let painter = ui.painter();
    painter.circle_stroke(pin, 13.0, (2.0, colour(tone)));
    painter.line_segment([pin, rect.clamp(pin)], (1.2, colour(tone)));
    Area::new(id).order(Order::Middle).fixed_pos(rect.min).show(ui.ctx(), |ui| {
        let frame = Frame::new().fill(colour(p.panel)).stroke((1.0, colour(tone))).corner_radius(8).inner_margin(10);
        frame.show(ui, |ui| {
            ui.set_max_width(WIDTH_PT);
            let text = notation::sentence(ui.ctx(), &text);
            ui.add(Label::new(RichText::new(text).font(plain(12.0)).color(colour(p.ink))).wrap());
            for (words, step) in ways {
                let words =
                    RichText::new(notation::sentence(ui.ctx(), &words)).font(plain(12.0)).color(colour(p.amber));
                if ui.add(Button::new(words).wrap()).clicked() {
                    draw(&facts.sketch, step, commands);
                }
            }
        });
    });
}
