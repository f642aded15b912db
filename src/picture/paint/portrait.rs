//! Paints a [`Portrait`] with egui.

use egui::{Color32, Mesh, Painter, Pos2, Rect, Shape, Stroke};

use super::colour;
use crate::scene::palette::{Palette, mix};
use crate::scene::portrait::Portrait;
use stillbase_mechanics::planar::Vector;

impl Portrait {
    /// Paints it into a rectangle.
    pub fn paint(&self, painter: &Painter, rect: Rect, p: &Palette) {
        let size = self.bounds[1] - self.bounds[0];
        let scale = (f64::from(rect.width()) / size.re).min(f64::from(rect.height()) / size.im) as f32;
        let middle = (self.bounds[0] + self.bounds[1]) * 0.5;
        let spot = |at: Vector| {
            let off = at - middle;
            rect.center() + egui::vec2(off.re as f32 * scale, -off.im as f32 * scale)
        };
        let grey = mix(p.dim, p.line, 0.65);
        let long = |m: f64| m as f32 * scale;
        let disc = |at: Pos2, radius: f32, tone| {
            painter.circle_filled(at, radius, colour(tone));
        };
        disc(spot(Vector::default()), long(self.foot), grey);
        for link in &self.links {
            let tone = p.drive(link.drive);
            let ends = link.ends.map(spot);
            let radius = long(link.radius).max(1.4);
            // An edge in the background colour separates links that cross.
            painter.line_segment(ends, Stroke::new(2.0 * radius + 1.6, colour(p.background)));
            painter.line_segment(ends, Stroke::new(2.0 * radius, colour(tone)));
            ends.into_iter().for_each(|end| disc(end, radius, tone));
            for cover in &link.covers {
                if cover.areas.is_empty() {
                    painter.line_segment(cover.ends.map(spot), Stroke::new(2.0 * long(cover.radius), colour(tone)));
                    disc(spot(cover.ends[0]), long(cover.radius), tone);
                }
                // As plain triangles: the soft edge of a polygon grows into spikes at the corners of a thin one.
                painter.add(Shape::mesh(fans(&cover.areas, spot, colour(tone))));
            }
        }
        if self.path.len() > 1 {
            let points: Vec<Pos2> = self.path.iter().map(|at| spot(*at)).collect();
            if let (Some(first), Some(last)) = (points.first(), points.last()) {
                disc(*first, 2.4, p.amber);
                disc(*last, 2.4, p.amber);
            }
            painter.line(points, Stroke::new(1.8, colour(p.amber)));
        }
        for pin in &self.pins {
            disc(spot(*pin), 1.5, p.background);
        }
        disc(spot(Vector::default()), 0.3 * long(self.foot), p.ink);
        painter.circle_stroke(spot(self.tip), 5.0, Stroke::new(1.6, colour(p.ink)));
    }
}

/// Returns convex polygons as triangles.
fn fans(areas: &[Vec<Vector>], spot: impl Fn(Vector) -> Pos2, tone: Color32) -> Mesh {
    let mut mesh = Mesh::default();
    for area in areas {
        let first = mesh.vertices.len() as u32;
        area.iter().for_each(|corner| mesh.colored_vertex(spot(*corner), tone));
        (2..area.len() as u32).for_each(|i| mesh.add_triangle(first, first + i - 1, first + i));
    }
    mesh
}
