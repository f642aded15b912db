//! Lumps of a drawing: discs whose area grows with their mass, and names of those under the pointer.

use super::{ShortNumber, SketchItem, SketchOptions};
use crate::scene::palette::{Palette, mix};
use crate::scene::{Anchor, Label, Marker, Name, Polyline, Scene, point};
use stillbase_mechanics::machine::Lump;
use stillbase_mechanics::planar::Vector;
use stillbase_mechanics::sketch::{Bar, Sketch};

/// Radius of a lump of 0.1 kg, and least and greatest radius of any, px.
const USUAL_PX: f64 = 10.0;
const RADII_PX: [f64; 2] = [7.0, 22.0];
/// Mass of a lump of the usual radius, kg.
const USUAL_KG: f64 = 0.1;

/// Returns the radius with which a lump of a mass, kg, is drawn, px.
pub(super) fn radius(kilograms: f64) -> f64 {
    (USUAL_PX * (kilograms / USUAL_KG).sqrt()).clamp(RADII_PX[0], RADII_PX[1])
}

/// Returns the mark of a lump of a mass, kg.
pub fn lump_marker(name: impl Into<Name>, at: [f32; 3], kilograms: f64, palette: &Palette) -> Marker {
    let fill = mix(palette.dim, palette.background, 0.45);
    Marker::disc(name, at, radius(kilograms) as f32, fill).edged(palette.ink, 1.4)
}

/// Returns every lump with its bar, its number there, from 1, and its place, m.
pub(super) fn all(sketch: &Sketch) -> impl Iterator<Item = (&Bar, usize, &Lump, Vector)> {
    sketch.bars.iter().flat_map(move |bar| {
        let own = sketch.lumps_of(bar).enumerate();
        own.map(move |(i, lump)| (bar, i + 1, lump, sketch.lump_at(bar, lump).1))
    })
}

/// Draws the lumps, and the way from the axis of its bar to each that lies beside it.
pub(super) fn draw(scene: &mut Scene, sketch: &Sketch, options: &SketchOptions, palette: &Palette) {
    for (bar, number, lump, at) in all(sketch) {
        let item = Some(SketchItem::Lump(bar.id, number));
        let place = point(at, 0.0);
        if lump.across != 0.0 {
            let along = sketch.at(bar.root) + sketch.span(bar) * (sketch.lump_at(bar, lump).0 / sketch.length(bar));
            let way = vec![point(along, 0.0), place];
            scene.lines.push(Polyline::new("sketch/lumps/arms", [way], 1.4, palette.dim));
        }
        let marker = lump_marker("sketch/lumps", place, lump.mass, palette);
        let edge = match (options.chosen == item, options.hot == item) {
            (true, _) => Some(palette.amber),
            (_, true) => Some(palette.ink),
            _ => None,
        };
        let size = marker.radius;
        scene.markers.push(edge.map_or_else(|| marker.clone(), |edge| marker.clone().edged(edge, 2.4)));
        if edge.is_some() {
            let text = format!("{} {} kg", lump.title(), ShortNumber(lump.mass));
            let away = [size + 6.0, size + 6.0];
            scene.labels.push(Label::new("sketch/lumps/names", place, away, text, palette.ink, 12.0, Anchor::Left));
        }
    }
}
