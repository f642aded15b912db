//! A small picture of a machine, seen from above in a pose that separates its links, or at the start of its path. It
//! needs kinematics only, so it is cheap.

use std::f64::consts::PI;

use egui::{Color32, Mesh, Painter, Pos2, Rect, Shape, Stroke};

use super::colour;
use crate::scene::linkage::{FlatLink, LinkageModel};
use crate::scene::palette::{Palette, mix};
use stillbase_mechanics::machine::{Machine, place_of};
use stillbase_mechanics::planar::{DriveAngles, PerDrive, Vector};
use stillbase_planning::Motion;

/// Position of each relative angle between its limits, from 0 to 1. At 0.5, arms with symmetric limits would be
/// straight.
const BEND_FRACTION: f64 = 0.62;
/// Relative angle without limits, and angle between drives that no relative angle connects, rad.
const FREE_ANGLE_RAD: f64 = 1.0;
/// Number of orientations tried, over half a turn; the one that fills the picture best is chosen.
const ORIENTATIONS: usize = 24;
/// Number of parts of a path.
const PATH_POINTS: usize = 48;
/// Ratio of width to height of the picture for which the orientation is chosen.
const ASPECT_RATIO: f64 = 2.2;

/// A machine to be painted; lengths in m.
pub struct Portrait {
    links: Vec<FlatLink>,
    pins: Vec<Vector>,
    tip: Vector,
    foot: f64,
    /// Path of the end effector; empty if there is none.
    path: Vec<Vector>,
    /// Lower left and upper right corner of the bounding box.
    bounds: [Vector; 2],
}

impl Portrait {
    /// Computes the picture of a machine.
    pub fn of(machine: &Machine) -> Self {
        let linkage = LinkageModel::of(machine);
        let bent = bent(machine);
        let turned = |i: usize| {
            let turn = PI * i as f64 / ORIENTATIONS as f64;
            let q: Vec<f64> = bent.iter().map(|q| q + turn).collect();
            Self::posed(machine, &linkage, &q)
        };
        let first = turned(0);
        (1..ORIENTATIONS).map(turned).fold(first, |best, other| if other.size() < best.size() { other } else { best })
    }

    fn posed(machine: &Machine, linkage: &LinkageModel, q: &[f64]) -> Self {
        let e = DriveAngles(PerDrive::from_fn(q.len(), |k| q[k])).units();
        let (links, foot) = (linkage.flat(&e), linkage.foot());
        let tip = place_of(machine.end_effector(), &e);
        let mut bounds = [Vector::new(-foot, -foot), Vector::new(foot, foot)];
        let discs = links.iter().flat_map(|link| {
            let ends = link.ends.map(|at| (at, link.radius));
            let weights = link.covers.iter().flat_map(|cover| cover.ends.map(|end| (end, cover.radius)));
            ends.into_iter().chain(weights)
        });
        for (at, radius) in discs.chain([(tip, 0.03 * linkage.reach())]) {
            bounds[0] = Vector::new(bounds[0].re.min(at.re - radius), bounds[0].im.min(at.im - radius));
            bounds[1] = Vector::new(bounds[1].re.max(at.re + radius), bounds[1].im.max(at.im + radius));
        }
        let pins = linkage.joints(&e).map(|([x, y, _], _)| Vector::new(x, y)).collect();
        Self { links, pins, tip, foot, path: Vec::new(), bounds }
    }

    /// Computes the picture of a machine at the start of a motion, with the path of its end effector.
    pub fn of_path(machine: &Machine, motion: &Motion) -> Self {
        let pose = |i: usize| motion.path.at(i as f64 / PATH_POINTS as f64).q;
        let drives = machine.drives();
        let mut portrait = Self::posed(machine, &LinkageModel::of(machine), &pose(0).0[..drives]);
        let tip = |i: usize| place_of(machine.end_effector(), &pose(i).units());
        portrait.path = (0..=PATH_POINTS).map(tip).collect();
        for at in &portrait.path {
            let [low, high] = &mut portrait.bounds;
            *low = Vector::new(low.re.min(at.re), low.im.min(at.im));
            *high = Vector::new(high.re.max(at.re), high.im.max(at.im));
        }
        portrait
    }

    /// Height of the smallest picture with [`ASPECT_RATIO`] that contains the machine, m.
    fn size(&self) -> f64 {
        let size = self.bounds[1] - self.bounds[0];
        size.im.max(size.re / ASPECT_RATIO)
    }

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

/// Returns drive angles, rad, for which every relative angle is well within its limits.
fn bent(machine: &Machine) -> Vec<f64> {
    let mut q = vec![None; machine.drives()];
    for start in 0..q.len() {
        if q[start].is_none() {
            q[start] = Some(if start == 0 { 0.0 } else { q[start - 1].unwrap_or_default() + FREE_ANGLE_RAD });
        }
        // Each pass sets the drives that are connected to known drives.
        for _ in 0..q.len() {
            for angle in machine.angles() {
                let (low, high) = (*angle.limits.start(), *angle.limits.end());
                let bounded = low.is_finite() && high.is_finite();
                let by = if bounded { low + BEND_FRACTION * (high - low) } else { FREE_ANGLE_RAD } - angle.offset;
                match (q[angle.from], q[angle.to]) {
                    (Some(from), None) => q[angle.to] = Some(from + by),
                    (None, Some(to)) => q[angle.from] = Some(to - by),
                    _ => {}
                }
            }
        }
    }
    q.into_iter().map(Option::unwrap_or_default).collect()
}
