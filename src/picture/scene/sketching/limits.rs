//! Limits of relative angles as arcs at their pins, with a grip at each end.

use crate::scene::palette::{Palette, faded};
use crate::scene::{Marker, Polyline, Scene, point};
use stillbase_mechanics::planar::Vector;
use stillbase_mechanics::sketch::{LimitArc, Sketch};

use super::SketchItem;

/// Radius of the first arc at a pin, and the difference to the next, as fractions of the farthest pin's distance.
const RADIUS: f64 = 0.1;
const NEXT: f64 = 0.025;
/// Least distance that counts as that of the farthest pin, m.
const LEAST_M: f64 = 0.1;
/// Angle between points of an arc, rad.
const STEP_RAD: f64 = 0.05;

/// An arc with its radius.
pub struct DrawnArc {
    /// Its limits.
    pub arc: LimitArc,
    /// Its radius, m.
    pub radius: f64,
    /// Its centre, m.
    at: Vector,
}

impl DrawnArc {
    /// Returns the arcs of a drawing, as they are drawn.
    pub fn all(sketch: &Sketch) -> Vec<Self> {
        let base = sketch.at(sketch.base);
        let far = sketch.pins.iter().map(|pin| (sketch.at(pin.id) - base).norm()).fold(LEAST_M, f64::max);
        let arcs = sketch.limit_arcs();
        let others = |i: usize| arcs[..i].iter().filter(|other| other.pin == arcs[i].pin).count();
        let radii: Vec<f64> = (0..arcs.len()).map(|i| (RADIUS + NEXT * others(i) as f64) * far).collect();
        let drawn = |(arc, radius): (LimitArc, f64)| Self { at: sketch.at(arc.pin), arc, radius };
        arcs.into_iter().zip(radii).map(drawn).collect()
    }

    /// Returns where the bar would be at an angle, on the arc or at a multiple of its radius, m.
    pub fn on(&self, angle: f64, times: f64) -> [f64; 2] {
        let at = self.at + self.arc.direction(angle) * (times * self.radius);
        [at.re, at.im]
    }

    /// Returns the way from the centre to a place, m.
    pub fn way(&self, to: [f64; 2]) -> Vector {
        Vector::new(to[0], to[1]) - self.at
    }
}

/// Draws the arcs.
pub(super) fn draw(scene: &mut Scene, sketch: &Sketch, hot: Option<SketchItem>, palette: &Palette) {
    for (i, drawn) in DrawnArc::all(sketch).iter().enumerate() {
        let [low, high] = drawn.arc.range;
        let is_lit = matches!(hot, Some(SketchItem::Limit(k, _)) if k == i);
        let is_kept = (low..=high).contains(&drawn.arc.now);
        let tone = match (is_lit, is_kept) {
            (true, _) => palette.ink,
            (_, true) => faded(palette.dim, 0.8),
            (_, false) => palette.reaction,
        };
        let n = ((high - low) / STEP_RAD).ceil().clamp(1.0, 400.0) as usize;
        let spot = |angle: f64, times: f64| {
            let [x, y] = drawn.on(angle, times);
            point(Vector::new(x, y), 0.0)
        };
        let bow: Vec<[f32; 3]> = (0..=n).map(|k| spot(low + (high - low) * k as f64 / n as f64, 1.0)).collect();
        let ends = [low, high].map(|angle| vec![spot(angle, 0.8), spot(angle, 1.2)]);
        let strips: Vec<Vec<[f32; 3]>> = [vec![bow], ends.to_vec()].concat();
        scene.lines.push(Polyline::new("sketch/limits", strips, if is_lit { 2.0 } else { 1.4 }, tone));
        for (end, angle) in [low, high].into_iter().enumerate() {
            let is_held = hot == Some(SketchItem::Limit(i, end));
            let grip = Marker::disc("sketch/limits/grips", spot(angle, 1.0), if is_held { 6.0 } else { 4.0 }, {
                palette.background
            });
            scene.markers.push(grip.edged(tone, 1.6));
        }
    }
}
