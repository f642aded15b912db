//! What the pointer is on in a drawing.

use super::lumps::{all, radius};
use super::{DrawnArc, SketchItem};
use crate::scene::pointer::Pointer;
use stillbase_mechanics::sketch::{BarId, PinId, Sketch};

/// Distance within which the pointer is on a pin, and on the axis of a bar, px.
const PIN_PICK_PX: f64 = 11.0;
const BAR_PICK_PX: f64 = 8.0;

/// Distance within which the pointer is on a pin that a lump lies at, px.
const COVERED_PICK_PX: f64 = 6.5;

/// Returns the thing of a drawing under the pointer: a pin comes before a lump, a lump before the grip of a limit, a grip
/// before a bar, and of several the nearest.
pub fn pick(sketch: &Sketch, pointer: &Pointer) -> Option<SketchItem> {
    let at = |pin: PinId| {
        let at = sketch.at(pin);
        [at.re, at.im, 0.0]
    };
    let pins = sketch.pins.iter().filter_map(|pin| Some((SketchItem::Pin(pin.id), pointer.distance(at(pin.id))?)));
    let lumps = all(sketch).filter_map(|(bar, number, lump, at)| {
        let far = pointer.distance([at.re, at.im, 0.0]).filter(|far| *far < radius(lump.mass))?;
        Some((SketchItem::Lump(bar.id, number), far))
    });
    let lump = lumps.min_by(|a, b| a.1.total_cmp(&b.1));
    let most = if lump.is_some() { COVERED_PICK_PX } else { PIN_PICK_PX };
    let near = pins.filter(|(_, far)| *far < most).min_by(|a, b| a.1.total_cmp(&b.1));
    let grips = || {
        let all = DrawnArc::all(sketch);
        let ends = all.iter().enumerate().flat_map(|(i, drawn)| [(i, 0, drawn), (i, 1, drawn)]);
        let far = ends.filter_map(|(i, end, drawn)| {
            let [x, y] = drawn.on(drawn.arc.range[end], 1.0);
            Some((SketchItem::Limit(i, end), pointer.distance([x, y, 0.0])?))
        });
        far.filter(|(_, far)| *far < PIN_PICK_PX).min_by(|a, b| a.1.total_cmp(&b.1))
    };
    let item = near.or(lump).or_else(grips).map(|(item, _)| item);
    item.or_else(|| bar_near(sketch, pointer, BAR_PICK_PX).map(SketchItem::Bar))
}

/// Returns the bar whose axis is nearest to the pointer, within a distance, px.
pub fn bar_near(sketch: &Sketch, pointer: &Pointer, most: f64) -> Option<BarId> {
    let at = |pin: PinId| {
        let at = sketch.at(pin);
        [at.re, at.im, 0.0]
    };
    let bars = sketch.bars.iter().filter_map(|bar| {
        let sides = bar.all_pins().map(|pin| [at(bar.root), at(pin)]);
        let far = sides.filter_map(|side| pointer.distance_to_segment(side)).min_by(f64::total_cmp)?;
        Some((bar.id, far))
    });
    bars.filter(|(_, far)| *far < most).min_by(|a, b| a.1.total_cmp(&b.1)).map(|(bar, _)| bar)
}

/// Returns the size of a pixel in the plane of the drawing, m; 0 if the pointer does not see the plane.
pub fn metres_per_px(pointer: &Pointer) -> f64 {
    let place = |pointer: &Pointer| pointer.ray()?.at_height(0.0);
    let [x, y] = pointer.at;
    let both = place(pointer).zip(place(&Pointer { at: [x + 1.0, y], ..*pointer }));
    both.map_or(0.0, |(one, other)| (other[0] - one[0]).hypot(other[1] - one[1]))
}
