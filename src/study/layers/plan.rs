//! [`PlanSolid`]: a bar, a disc or a pin seen from above, and the distance between two of them.

use stillbase_exchange::solids::{Axle, LinkSolid};
use stillbase_mechanics::machine::{Chain, Machine, place_of};
use stillbase_mechanics::planar::{UnitVectors, Vector, cross, dot, length};

/// Sine of the angle between segments that count as parallel.
const PARALLEL: f64 = 1e-12;

/// A solid seen from above: all points within a radius of a segment, which moves with a link.
#[derive(Clone, Debug)]
pub struct PlanSolid {
    /// Position of the origin of its segment, m.
    pub root: Chain,
    /// The drive that turns it, counted from 0.
    pub drive: usize,
    /// Ends of the segment in the axes of the drive, m.
    pub ends: [Vector; 2],
    /// Radius, m.
    pub radius: f64,
}

/// Two solids in a pose.
#[derive(Clone, Copy, Debug)]
pub struct Nearness {
    /// Distance between their outlines, m; below 0 if they overlap.
    pub gap: f64,
    /// A point between the two, or in both, m.
    pub at: Vector,
}

impl PlanSolid {
    /// Returns a bar or a disc of a link.
    pub fn of(machine: &Machine, solid: &LinkSolid) -> Self {
        let part = &machine.resolved_links()[solid.link];
        let ends = solid.ends.map(|end| end * part.sign);
        Self { root: part.root, drive: part.drive, ends, radius: solid.radius }
    }

    /// Returns a pin with spacers of a radius, m.
    pub fn of_pin(axle: &Axle, radius: f64) -> Self {
        Self { root: axle.at, drive: 0, ends: [Vector::default(); 2], radius }
    }

    /// Returns the largest distance of its ends from its origin, m.
    pub fn lever(&self) -> f64 {
        self.ends.iter().map(|end| length(*end)).fold(0.0, f64::max)
    }

    /// Returns its ends in a pose, m.
    pub fn placed(&self, e: &UnitVectors) -> [Vector; 2] {
        let root = place_of(&self.root, e);
        self.ends.map(|end| root + e[self.drive] * end)
    }
}

/// Returns how near two solids are in a pose.
pub fn nearness(a: &PlanSolid, b: &PlanSolid, e: &UnitVectors) -> Nearness {
    let (own, other) = (a.placed(e), b.placed(e));
    let [p, q] = closest(own, other);
    let (apart, radii) = (length(q - p), a.radius + b.radius);
    // The middle of the gap, or of the overlap along the line between both.
    let share = if apart > 0.0 { (0.5 * (apart + a.radius - b.radius) / apart).clamp(0.0, 1.0) } else { 0.5 };
    Nearness { gap: apart - radii, at: p + (q - p) * share }
}

/// Returns the closest points of two segments.
fn closest(a: [Vector; 2], b: [Vector; 2]) -> [Vector; 2] {
    if let Some(at) = crossing(a, b) {
        return [at; 2];
    }
    let onto_b = a.map(|p| [p, foot(b, p)]);
    let onto_a = b.map(|p| [foot(a, p), p]);
    let pairs = [onto_b[0], onto_b[1], onto_a[0], onto_a[1]];
    let apart = |pair: &[Vector; 2]| (pair[1] - pair[0]).norm_sqr();
    pairs.into_iter().reduce(|best, pair| if apart(&pair) < apart(&best) { pair } else { best }).unwrap_or(pairs[0])
}

/// Returns the point of a segment that is nearest to a point.
fn foot([from, to]: [Vector; 2], p: Vector) -> Vector {
    let along = to - from;
    let whole = along.norm_sqr();
    let share = if whole > 0.0 { (dot(p - from, along) / whole).clamp(0.0, 1.0) } else { 0.0 };
    from + along * share
}

/// Returns the point where two segments cross; `None` if they do not, or are parallel.
fn crossing(a: [Vector; 2], b: [Vector; 2]) -> Option<Vector> {
    let (u, v, w) = (a[1] - a[0], b[1] - b[0], b[0] - a[0]);
    let turn = cross(u, v);
    // Where two segments are parallel but for rounding, one of their ends is as near as any other point.
    if turn.abs() <= PARALLEL * length(u) * length(v) {
        return None;
    }
    let (s, t) = (cross(w, v) / turn, cross(w, u) / turn);
    let within = |x: f64| (0.0..=1.0).contains(&x);
    (within(s) && within(t)).then(|| a[0] + u * s)
}
