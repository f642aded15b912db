//! The pointer on lumps: where it puts one along and across a bar.

use egui::{CursorIcon, Pos2};

use super::draw;
use super::hand::{CTRL_GRID_M, Hand, SNAP_PT};
use super::pen::Pen;
use crate::Command;
use stillbase_mechanics::machine::{Lump, PlaceOnLink};
use stillbase_mechanics::planar::{Vector, unit};
use stillbase_mechanics::sketch::{Bar, BarId, Place, SketchRefusal, SketchStep};
use stillbase_picture::scene::sketching::{SketchItem, bar_near, metres_per_px};
use stillbase_session::parts::new_lump;

/// Step of the place of a lump along and across its bar, m.
const STEP_M: f64 = 1e-3;
/// Distance from a bar within which a click beside it puts a lump there, points.
const REACH_PT: f64 = 60.0;

impl Hand<'_> {
    /// Puts a lump on the bar under the pointer, or chooses the lump there.
    pub(super) fn puts_lump(&self, pen: &mut Pen, pos: Option<Pos2>, clicked: bool, commands: &mut Vec<Command>) {
        let sketch = &self.facts.sketch;
        if matches!(pen.hot, None | Some(SketchItem::Limit(..))) {
            // Beside a bar, the lump goes on the nearest one.
            let near = pos.and_then(|pos| bar_near(sketch, &self.spot.pointer(pos), REACH_PT));
            pen.hot = near.map(SketchItem::Bar);
        }
        let bar = match pen.hot {
            Some(SketchItem::Bar(id)) => sketch.bar(id),
            // A pin is at the end of a bar, or between two.
            Some(SketchItem::Pin(pin)) => sketch.bars_at(pin).last(),
            _ => None,
        };
        if bar.is_some() {
            self.ui.ctx().set_cursor_icon(CursorIcon::Crosshair);
        }
        if !clicked {
            return;
        }
        match pen.hot {
            Some(SketchItem::Lump(..)) => pen.chosen = pen.hot,
            _ if bar.is_none() => {
                pen.refused = Some(SketchRefusal {
                    what: "no bar is near enough to carry a lump here".into(),
                    place: Place::Whole,
                    want: "a click on a bar, or a little beside one".into(),
                    proposals: Vec::new(),
                });
            }
            _ => {}
        }
        let Some((bar, (at, across))) = bar.and_then(|bar| Some((bar, self.place_on(bar, pos?)?))) else { return };
        let lump = Some(new_lump(&bar.name, at, across));
        draw(sketch, SketchStep::Lump { bar: bar.id, number: None, lump }, commands);
        pen.chosen = Some(SketchItem::Lump(bar.id, sketch.lumps_of(bar).count() + 1));
    }

    /// Returns the step of a lump that is dragged to a place; none where it is.
    pub(super) fn lump_dragged(&self, id: BarId, number: usize, pos: Pos2) -> Option<Option<SketchStep>> {
        let bar = self.facts.sketch.bar(id)?;
        let lump = self.facts.sketch.lumps_of(bar).nth(number.checked_sub(1)?)?;
        let (at, across) = self.place_on(bar, pos)?;
        let moved = Lump { at, across, ..lump.clone() };
        let is_moved = moved != *lump;
        Some(is_moved.then_some(SketchStep::Lump { bar: id, number: Some(number), lump: Some(moved) }))
    }

    /// Returns the place of the pointer along a bar and to its left, m: at a pin or on the axis if it is near, else in
    /// whole millimetres; with Ctrl in steps of 10 mm, with Shift freely.
    fn place_on(&self, bar: &Bar, pos: Pos2) -> Option<(PlaceOnLink, f64)> {
        let sketch = &self.facts.sketch;
        let pointer = self.spot.pointer(pos);
        let [x, y] = pointer.ray()?.at_height(0.0)?;
        let place = (Vector::new(x, y) - sketch.at(bar.root)) * unit(-sketch.span(bar).arg());
        let (free, coarse) = self.ui.input(|i| (i.modifiers.shift, i.modifiers.command || i.modifiers.ctrl));
        if free {
            return Some((PlaceOnLink::Metres(place.re), place.im));
        }
        let near = SNAP_PT * metres_per_px(&pointer);
        let step = if coarse { CTRL_GRID_M } else { STEP_M };
        // Divided by a whole number, a step is written as a person writes it.
        let round = |x: f64| (x / step).round() / (1.0 / step).round();
        let across = if place.im.abs() < near { 0.0 } else { round(place.im) };
        let pins = bar.all_pins().map(|pin| sketch.along(bar, pin)).filter(|along| (along - place.re).abs() < near);
        let pin = pins.min_by(|a, b| (a - place.re).abs().total_cmp(&(b - place.re).abs()));
        Some((sketch.place_along(bar, pin.unwrap_or_else(|| round(place.re))), across))
    }
}
