//! Picking of the machine and the items around it, and their highlighting.

use super::reaction;
use crate::scene::exaggeration::DrawnFrame;
use crate::scene::linkage::{Bar, LinkageModel, PLATE_HALF_SIZE};
use crate::scene::options::{Handle, ViewOptions};
use crate::scene::palette::{Palette, Theme, mix, palette};
use crate::scene::pointer::Pointer;
use crate::scene::{Polyline, Scene, Solid, place};
use stillbase_mechanics::planar::Vector;

/// Distances within which the pointer picks a link, a line, a pin and a payload, px.
const LINK_PICK_PX: f64 = 6.0;
const LINE_PICK_PX: f64 = 5.0;
const PIN_PICK_PX: f64 = 6.0;
const PAYLOAD_PICK_PX: f64 = 12.0;

/// Fraction of the text colour that highlights the item under the pointer.
const HIGHLIGHT: f32 = 0.45;

fn seen_near(pointer: &Pointer, at: [f64; 3], most: f64) -> bool {
    pointer.distance(at).is_some_and(|d| d < most)
}

/// Returns the index of the link under the pointer; the uppermost of several.
pub fn link(linkage: &LinkageModel, shown: &DrawnFrame<'_>, pointer: &Pointer) -> Option<usize> {
    let (e, at) = (shown.q.units(), shown.base.at);
    let near = |ends: [[f64; 3]; 2]| {
        let ends = ends.map(|[x, y, z]| [x + at.re, y + at.im, z]);
        pointer.distance_to_segment(ends).is_some_and(|d| d < LINK_PICK_PX)
    };
    let bars = linkage.bars().iter().enumerate();
    let height = |bar: &Bar| bar.pose(&e).2;
    bars.filter(|(_, bar)| near(bar.ends(&e))).max_by(|(_, a), (_, b)| height(a).total_cmp(&height(b))).map(|(i, _)| i)
}

/// Returns the index of the pin under the pointer.
pub fn joint(linkage: &LinkageModel, shown: &DrawnFrame<'_>, pointer: &Pointer) -> Option<usize> {
    let (e, at) = (shown.q.units(), shown.base.at);
    linkage.joints(&e).position(|([x, y, z], _)| seen_near(pointer, [x + at.re, y + at.im, z], PIN_PICK_PX))
}

/// Whether the payload at a position, m, is under the pointer.
pub fn payload(at: Vector, linkage: &LinkageModel, pointer: &Pointer) -> bool {
    seen_near(pointer, [at.re, at.im, linkage.top()], PAYLOAD_PICK_PX)
}

/// Whether the base is under the pointer.
pub fn base(linkage: &LinkageModel, moves: bool, shown: &DrawnFrame<'_>, pointer: &Pointer) -> bool {
    let Some([x, y]) = pointer.ray().and_then(|ray| ray.at_height(linkage.bottom())) else { return false };
    let at = shown.in_base(Vector::new(x, y));
    let [length, width] = PLATE_HALF_SIZE.map(|part| part * linkage.reach());
    at.norm() < linkage.foot() || (moves && at.re.abs() < length && at.im.abs() < width)
}

/// Returns the arrow or the arc of the reaction, if it is under the pointer.
pub fn reaction(linkage: &LinkageModel, shown: &DrawnFrame<'_>, pointer: &Pointer) -> Option<Handle> {
    let palette = palette(Theme::Dark);
    let mut drawn = Scene::new(palette.background, linkage.model.clone());
    reaction::draw(&mut drawn, linkage, &palette, shown, &ViewOptions::default(), ("", false));
    let hit = |name: &str| drawn.lines.iter().any(|l| l.name == name && line(l, pointer));
    let all = [("reaction/force", Handle::Force), ("reaction/moment", Handle::Moment)];
    all.into_iter().find(|(name, _)| hit(name)).map(|(_, handle)| handle)
}

/// Whether a line is under the pointer.
pub fn line(line: &Polyline, pointer: &Pointer) -> bool {
    let placed = |p: [f32; 3]| place(&line.world_from_item, p).map(f64::from);
    let near = |ends: [[f64; 3]; 2]| pointer.distance_to_segment(ends).is_some_and(|d| d < LINE_PICK_PX);
    line.strips.iter().any(|strip| strip.windows(2).any(|pair| near([placed(pair[0]), placed(pair[1])])))
}

/// Highlights the item under the pointer.
pub fn light(solids: &mut [Solid], linkage: &LinkageModel, hot: Option<Handle>, palette: &Palette) {
    let of = |solid: &Solid| match hot {
        Some(Handle::Link(i)) => linkage.bars().get(i).is_some_and(|bar| *bar.item() == solid.name),
        Some(Handle::Base) => solid.name.starts_with("machine/base"),
        _ => false,
    };
    for solid in solids.iter_mut().filter(|solid| of(solid)) {
        solid.colour = mix(solid.colour, palette.ink, HIGHLIGHT);
    }
    // The solids of pins are in the order of their indices.
    let mut pins = solids.iter_mut().filter(|solid| solid.name == "machine/joints");
    if let Some(Handle::Joint(i)) = hot
        && let Some(pin) = pins.nth(i)
    {
        pin.colour = palette.amber;
    }
}
