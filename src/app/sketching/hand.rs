//! [`Hand`]: the pointer over a drawing.

use egui::{CursorIcon, EventFilter, Key, PointerButton, Pos2, Response, Ui};

use super::motors::motor_at;
use super::pen::{Drag, Pen, PenTool, Start};
use super::{SketchFacts, draw, fields};
use crate::{Command, focus};
use stillbase_mechanics::planar::{Vector, unit};
use stillbase_mechanics::sketch::{LimitArc, Onto, PinId, Sketch, SketchStep, Snap, SnapOptions, snap};
use stillbase_picture::paint::SceneViewport;
use stillbase_picture::scene::sketching::{DrawnArc, GRID_M, Rubber, SketchItem, metres_per_px, pick};

/// Distance within which the pointer snaps, points.
pub(super) const SNAP_PT: f64 = 10.0;
/// Step of angles, and grid with Ctrl.
const ANGLE_STEP_RAD: f64 = std::f64::consts::PI / 12.0;
pub(super) const CTRL_GRID_M: f64 = 0.01;
/// Step of joint limits.
const LIMIT_STEP_RAD: f64 = std::f64::consts::PI / 180.0;
/// Distance within which a typed end lies on a pin or bar, m.
const TYPED_SNAP_M: f64 = 1e-6;
/// Shortest bar that is drawn, m.
const SHORTEST_M: f64 = 1e-3;

/// Returns where a typed place puts the end of a bar: on the pin or the bar that is there, m.
pub fn typed(sketch: &Sketch, to: [f64; 2]) -> Snap {
    let options = SnapOptions { grid: 0.0, angle: 0.0, radius: TYPED_SNAP_M };
    let caught = snap(sketch, None, to, &options);
    let onto = if matches!(caught.onto, Onto::Pin(_) | Onto::Bar { .. }) { caught.onto } else { Onto::Free };
    Snap { point: to, onto, ..caught }
}

/// The pointer over a drawing.
pub struct Hand<'a> {
    pub ui: &'a Ui,
    pub response: &'a Response,
    pub spot: &'a SceneViewport,
    pub facts: &'a SketchFacts,
}

impl Hand<'_> {
    /// Handles hovering, clicks, drags and typed numbers. Returns the bar under way,
    /// with its length and angle in words.
    pub fn points(&self, pen: &mut Pen, commands: &mut Vec<Command>) -> Option<(Rubber, String)> {
        let pos = self.response.interact_pointer_pos().or(self.response.hover_pos());
        pen.hot = pos.and_then(|pos| pick(&self.facts.sketch, &self.spot.pointer(pos)));
        if self.response.clicked() || self.response.drag_started() {
            pen.refused = None;
        }
        // The list from which a thing is chosen has no use for these keys.
        let is_typing = self.ui.ctx().egui_wants_keyboard_input() && !focus::is_on(self.ui.ctx(), fields::CARD);
        let deletes = self.ui.input(|i| i.key_pressed(Key::Delete) || i.key_pressed(Key::Backspace));
        if deletes && !is_typing && pen.from.is_none() {
            self.delete(pen.chosen.take(), commands);
        }
        if self.ui.input(|i| i.key_pressed(Key::Escape)) && (pen.from.is_some() || pen.drag.is_some()) {
            pen.apply(super::PenChange::GiveUp);
            self.response.surrender_focus();
        }
        let clicked = self.response.clicked_by(PointerButton::Primary);
        match pen.tool {
            PenTool::Bar => return self.draws(pen, pos, commands),
            PenTool::Move => self.moves(pen, pos, commands),
            PenTool::Motor => {
                if let (true, Some(SketchItem::Pin(pin))) = (clicked, pen.hot) {
                    draw(&self.facts.sketch, motor_at(self.facts, pin), commands);
                }
            }
            PenTool::Lump if !clicked && (pen.drag.is_some() || matches!(pen.hot, Some(SketchItem::Lump(..)))) => {
                self.moves(pen, pos, commands);
            }
            PenTool::Lump => self.puts_lump(pen, pos, clicked, commands),
            PenTool::EndEffector => {
                if let (true, Some(SketchItem::Pin(pin))) = (clicked, pen.hot) {
                    draw(&self.facts.sketch, SketchStep::EndEffector { pin, bar: None }, commands);
                }
            }
            PenTool::Delete if clicked => self.delete(pen.hot, commands),
            PenTool::Delete => {}
        }
        if pen.hot.is_some() {
            self.ui.ctx().set_cursor_icon(CursorIcon::PointingHand);
        }
        None
    }

    fn delete(&self, thing: Option<SketchItem>, commands: &mut Vec<Command>) {
        match thing {
            Some(SketchItem::Pin(pin)) => draw(&self.facts.sketch, SketchStep::DeletePin { pin }, commands),
            Some(SketchItem::Bar(bar)) => draw(&self.facts.sketch, SketchStep::DeleteBar { bar }, commands),
            Some(SketchItem::Lump(bar, number)) => {
                let step = SketchStep::Lump { bar, number: Some(number), lump: None };
                draw(&self.facts.sketch, step, commands);
            }
            Some(SketchItem::Limit(arc, _)) => {
                if let Some(LimitArc { to, from, .. }) = self.facts.sketch.limit_arcs().into_iter().nth(arc) {
                    draw(&self.facts.sketch, SketchStep::Limits { to, from, offset: 0.0, range: None }, commands);
                }
            }
            None => {}
        }
    }

    /// Returns where the pointer puts the end of a bar from a start, m.
    fn snapped(&self, from: Option<[f64; 2]>, pos: Pos2) -> Option<Snap> {
        let pointer = self.spot.pointer(pos);
        let at = pointer.ray()?.at_height(0.0)?;
        let (fine, round) = self.ui.input(|i| (i.modifiers.shift, i.modifiers.command || i.modifiers.ctrl));
        let radius = if fine { 0.0 } else { SNAP_PT * metres_per_px(&pointer) };
        let grid = match (round, from) {
            (true, _) => CTRL_GRID_M,
            (false, None) => GRID_M,
            (false, Some(_)) => 0.0,
        };
        let angle = if fine { 0.0 } else { ANGLE_STEP_RAD };
        Some(snap(&self.facts.sketch, from, at, &SnapOptions { grid, angle, radius }))
    }

    /// Draws a bar: from press to release, or from click to click.
    fn draws(&self, pen: &mut Pen, pos: Option<Pos2>, commands: &mut Vec<Command>) -> Option<(Rubber, String)> {
        self.ui.ctx().set_cursor_icon(CursorIcon::Crosshair);
        let clicked = self.response.clicked_by(PointerButton::Primary);
        let begins = self.response.drag_started_by(PointerButton::Primary);
        if pen.from.is_none() && (clicked || begins) {
            let press = self.ui.input(|i| i.pointer.press_origin()).filter(|_| begins).or(pos)?;
            if let (true, Some(SketchItem::Bar(_))) = (clicked, pen.hot) {
                pen.chosen = pen.hot;
                return None;
            }
            let start = self.snapped(None, press)?;
            pen.from = Some(Start { end: start.end(), at: start.point });
            self.response.request_focus();
            if clicked {
                return None;
            }
        }
        let start = pen.from?;
        // The keys of a pass are for the numbers: Tab and arrows move no focus.
        let keys = EventFilter { tab: true, horizontal_arrows: true, vertical_arrows: true, escape: true };
        self.ui.memory_mut(|memory| memory.set_focus_lock_filter(self.response.id, keys));
        let enters = self.response.has_focus() && self.ui.input(|i| pen.typed.take(i));
        let end = self.end(pen, start, pos)?;
        let ends = enters || clicked || self.response.drag_stopped_by(PointerButton::Primary);
        if ends {
            (pen.from, pen.typed) = (None, super::typed::Typed::default());
            self.response.surrender_focus();
            if end.length >= SHORTEST_M {
                let step = SketchStep::Bar { from: start.end, to: end.end(), name: None };
                draw(&self.facts.sketch, step, commands);
            }
            return None;
        }
        let text = pen.typed.words(end.length, end.angle);
        let is_caught = matches!(end.onto, Onto::Pin(_) | Onto::Bar { .. });
        Some((Rubber { ends: [start.at, end.point], is_caught }, text))
    }

    /// Returns the end of the bar under way: at the pointer, with the numbers that are typed.
    fn end(&self, pen: &Pen, start: Start, pos: Option<Pos2>) -> Option<Snap> {
        let (metres, radians) = (pen.typed.metres(), pen.typed.radians());
        let at_pointer = pos.and_then(|pos| self.snapped(Some(start.at), pos));
        if metres.is_none() && radians.is_none() {
            return at_pointer;
        }
        let length = metres.or(at_pointer.map(|end| end.length))?;
        let angle = radians.or(at_pointer.map(|end| end.angle)).unwrap_or_default();
        let to = Vector::new(start.at[0], start.at[1]) + unit(angle) * length;
        Some(Snap { length, angle, ..typed(&self.facts.sketch, [to.re, to.im]) })
    }

    /// Chooses things, and drags pins, lumps and limits.
    fn moves(&self, pen: &mut Pen, pos: Option<Pos2>, commands: &mut Vec<Command>) {
        if self.response.clicked_by(PointerButton::Primary) {
            pen.chosen = pen.hot.filter(|hot| !matches!(hot, SketchItem::Limit(..)));
        }
        if self.response.drag_started_by(PointerButton::Primary) {
            let press = self.ui.input(|i| i.pointer.press_origin()).or(pos);
            let held = press.and_then(|pos| pick(&self.facts.sketch, &self.spot.pointer(pos)));
            match held {
                Some(item @ (SketchItem::Pin(_) | SketchItem::Lump(..))) => {
                    pen.chosen = held;
                    pen.drag = Some(Drag { item, step: None, onto: None });
                }
                Some(item @ SketchItem::Limit(..)) => pen.drag = Some(Drag { item, step: None, onto: None }),
                _ => {}
            }
        }
        let Some(drag) = &mut pen.drag else { return };
        self.ui.ctx().set_cursor_icon(CursorIcon::Grabbing);
        pen.hot = Some(drag.item);
        let next = pos.and_then(|pos| match drag.item {
            SketchItem::Pin(pin) => self.pin_dragged(pin, pos),
            SketchItem::Limit(arc, end) => self.limit_dragged(arc, end, pos),
            SketchItem::Lump(bar, number) => self.lump_dragged(bar, number, pos).map(|step| (step, None)),
            SketchItem::Bar(_) => None,
        });
        if let Some((step, onto)) = next {
            (drag.step, drag.onto) = (step, onto);
        }
        if self.response.drag_stopped_by(PointerButton::Primary)
            && let Some(step) = pen.drag.take().and_then(|drag| drag.step)
        {
            pen.chosen = self.pin_after(&step).map(SketchItem::Pin).or(pen.chosen);
            draw(&self.facts.sketch, step, commands);
        }
    }

    /// Returns the pin that a dragged one has become.
    fn pin_after(&self, step: &SketchStep) -> Option<PinId> {
        match *step {
            SketchStep::Weld { onto, .. } => Some(onto),
            SketchStep::Attach { pin, bar } => {
                let sketch = &self.facts.sketch;
                let along = sketch.along(sketch.bar(bar)?, pin);
                let next = sketch.with(step).ok()?;
                let bar = next.bar(bar)?;
                let far = |own: &PinId| (next.along(bar, *own) - along).abs();
                bar.all_pins().min_by(|a, b| far(a).total_cmp(&far(b)))
            }
            _ => None,
        }
    }

    /// Returns the step of a pin that is dragged to a place, and the pin with which it would become one.
    fn pin_dragged(&self, pin: PinId, pos: Pos2) -> Option<Dragged> {
        let end = self.snapped(None, pos)?;
        Some(match end.onto {
            Onto::Pin(own) if own == pin => (None, None),
            Onto::Pin(onto) => (Some(SketchStep::Weld { pin, onto }), Some(end.point)),
            Onto::Bar { bar, .. } if self.facts.sketch.with(&SketchStep::Attach { pin, bar }).is_ok() => {
                (Some(SketchStep::Attach { pin, bar }), Some(end.point))
            }
            _ => (Some(SketchStep::MovePin { pin, to: end.point }), None),
        })
    }

    /// Returns the step of a limit that is dragged to a place: in whole degrees, or freely with Shift.
    fn limit_dragged(&self, arc: usize, end: usize, pos: Pos2) -> Option<Dragged> {
        let drawn = DrawnArc::all(&self.facts.sketch).into_iter().nth(arc)?;
        let to = self.spot.pointer(pos).ray()?.at_height(0.0)?;
        let step = if self.ui.input(|i| i.modifiers.shift) { 0.0 } else { LIMIT_STEP_RAD };
        let range = drawn.arc.dragged(end, drawn.way(to), step);
        Some(((range != drawn.arc.range).then(|| drawn.arc.step(range)), None))
    }
}

/// The step of a drag, and the place of the pin with which the dragged one would become one, m.
type Dragged = (Option<SketchStep>, Option<[f64; 2]>);
