//! [`PlanSolid`]: a solid of a link or a pin seen from above, and the distance between two of them.

use stillbase_exchange::solids::{Axle, LinkSolid, Plan, encloses, foot};
use stillbase_mechanics::machine::{Chain, Machine, place_of};
use stillbase_mechanics::planar::{UnitVectors, Vector, cross, length};

/// Sine of the angle between segments that count as parallel.
const PARALLEL: f64 = 1e-12;
/// Overlap of outlines without width that cross, m.
const CROSSED: f64 = 1e-9;

/// A solid seen from above, which moves with a link.
#[derive(Clone, Debug)]
pub struct PlanSolid {
    /// Position of the origin of its area, m.
    pub root: Chain,
    /// The drive that turns it, counted from 0.
    pub drive: usize,
    /// The area that it covers, in the axes of the drive, m.
    pub plan: Plan,
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
    /// Returns a solid of a link.
    pub fn of(machine: &Machine, solid: &LinkSolid) -> Self {
        let part = &machine.resolved_links()[solid.link];
        let corners = solid.plan.corners.iter().map(|corner| corner * part.sign).collect();
        Self { root: part.root, drive: part.drive, plan: Plan { corners, radius: solid.plan.radius } }
    }

    /// Returns a pin with spacers of a radius, m.
    pub fn of_pin(axle: &Axle, radius: f64) -> Self {
        Self { root: axle.at, drive: 0, plan: Plan::disc(Vector::default(), radius) }
    }

    /// Returns the largest distance of its corners from its origin, m.
    pub fn lever(&self) -> f64 {
        self.plan.corners.iter().map(|corner| length(*corner)).fold(0.0, f64::max)
    }

    /// Returns how it is placed in a pose: where a point of it lies, m.
    pub fn placed(&self, e: &UnitVectors) -> impl Fn(Vector) -> Vector + Copy {
        let (root, turned) = (place_of(&self.root, e), e[self.drive]);
        move |point| root + turned * point
    }

    /// Returns the number of its sides.
    pub fn sides(&self) -> usize {
        self.plan.sides(|corner| corner).count()
    }
}

/// Returns how near two solids are in a pose.
pub fn nearness(a: &PlanSolid, b: &PlanSolid, e: &UnitVectors) -> Nearness {
    let (own, other) = (a.placed(e), b.placed(e));
    let (mut nearest, mut apart_2) = ([Vector::default(); 2], f64::INFINITY);
    for side in a.plan.sides(own) {
        for facing in b.plan.sides(other) {
            let pair = closest(side, facing);
            let apart = (pair[1] - pair[0]).norm_sqr();
            if apart < apart_2 {
                (nearest, apart_2) = (pair, apart);
            }
        }
    }
    let radii = a.plan.radius + b.plan.radius;
    if let Some((depth, at)) = deepest(&a.plan, own, &b.plan, other) {
        return Nearness { gap: -depth - radii, at };
    }
    let [p, q] = nearest;
    let apart = length(q - p);
    if apart == 0.0 && (a.plan.is_polygon() || b.plan.is_polygon()) {
        return Nearness { gap: -radii.max(CROSSED), at: p };
    }
    // The middle of the gap, or of the overlap along the line between both.
    let share = if apart > 0.0 { (0.5 * (apart + a.plan.radius - b.plan.radius) / apart).clamp(0.0, 1.0) } else { 0.5 };
    Nearness { gap: apart - radii, at: p + (q - p) * share }
}

/// Returns the corner of one area that lies deepest inside the polygon of the other, m, and how deep.
fn deepest(
    a: &Plan,
    own: impl Fn(Vector) -> Vector + Copy,
    b: &Plan,
    other: impl Fn(Vector) -> Vector + Copy,
) -> Option<(f64, Vector)> {
    let into_b = b.is_polygon().then(|| corner_within(a, own, b, other)).flatten();
    let into_a = a.is_polygon().then(|| corner_within(b, other, a, own)).flatten();
    into_b.into_iter().chain(into_a).max_by(|(one, _), (two, _)| one.total_cmp(two))
}

fn corner_within(
    of: &Plan,
    own: impl Fn(Vector) -> Vector,
    polygon: &Plan,
    other: impl Fn(Vector) -> Vector + Copy,
) -> Option<(f64, Vector)> {
    let within = of.corners.iter().map(|corner| own(*corner)).filter(|p| encloses(polygon.sides(other), *p));
    let depth = |p: Vector| polygon.sides(other).map(|side| length(p - foot(side, p))).fold(f64::INFINITY, f64::min);
    within.map(|p| (depth(p), p)).max_by(|(one, _), (two, _)| one.total_cmp(two))
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
