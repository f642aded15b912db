//! A small picture of a drawing in its own pose.

use egui::{Painter, Pos2, Rect, Stroke, vec2};

use super::colour;
use crate::scene::palette::{Palette, mix};
use stillbase_mechanics::planar::Vector;
use stillbase_mechanics::sketch::{Resolved, Sketch, resolve};

/// Least size of what a picture shows, m.
const LEAST_SIZE_M: f64 = 0.3;

/// A drawing to be painted.
pub struct Thumbnail {
    sketch: Sketch,
    resolved: Resolved,
}

impl Thumbnail {
    /// Prepares a drawing.
    pub fn of(sketch: Sketch) -> Self {
        Self { resolved: resolve(&sketch), sketch }
    }

    /// Paints it into a rectangle.
    pub fn paint(&self, painter: &Painter, rect: Rect, p: &Palette) {
        let all = || self.sketch.pins.iter().map(|pin| pin.at);
        let ends = |i: usize| all().fold([f64::MAX, f64::MIN], |[low, high], at| [low.min(at[i]), high.max(at[i])]);
        let [x, y] = [ends(0), ends(1)];
        let size = |[low, high]: [f64; 2]| (high - low).max(LEAST_SIZE_M);
        let scale = (f64::from(rect.width()) / size(x)).min(f64::from(rect.height()) / size(y));
        let middle = Vector::new(0.5 * (x[0] + x[1]), 0.5 * (y[0] + y[1]));
        let spot = |at: Vector| -> Pos2 {
            let off = (at - middle) * scale;
            rect.center() + vec2(off.re as f32, -off.im as f32)
        };
        let drive = |name: &str| self.sketch.motors.iter().position(|motor| motor.drive.name == name);
        for bar in &self.sketch.bars {
            let follows = self.resolved.drives.get(&bar.id).and_then(|follow| drive(&follow.drive));
            let tone = colour(follows.map_or(p.dim, |k| p.drive(k)));
            let ends = [spot(self.sketch.at(bar.root)), spot(self.sketch.at(bar.tip))];
            painter.line_segment(ends, Stroke::new(5.0, tone));
            ends.into_iter().for_each(|end| _ = painter.circle_filled(end, 2.5, tone));
        }
        let base = spot(self.sketch.at(self.sketch.base));
        painter.circle_filled(base, 6.0, colour(mix(p.dim, p.line, 0.5)));
        for (k, motor) in self.sketch.motors.iter().enumerate() {
            let before = self.sketch.motors[..k].iter().filter(|other| other.pin == motor.pin).count();
            let ring = Stroke::new(1.4, colour(p.drive(k)));
            painter.circle_stroke(spot(self.sketch.at(motor.pin)), 6.5 + 2.8 * before as f32, ring);
        }
        for pin in &self.sketch.pins {
            painter.circle_filled(spot(self.sketch.at(pin.id)), 1.6, colour(p.background));
        }
        if let Some(end) = self.sketch.end_effector {
            painter.circle_stroke(spot(self.sketch.at(end.pin)), 4.5, Stroke::new(1.6, colour(p.ink)));
        }
    }
}
