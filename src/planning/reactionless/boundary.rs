//! The exact boundary of a reactionless workspace.
//!
//! The workspace is the set of all points that the end effector reaches on a plane b = const within the limits of a_1
//! and a_2. Its boundary is a subset of the images of the limits and of det ∂(x, y)/∂(a_1, a_2) = 0; b only turns it,
//! by b* = b/Σλ, (15), (16).
//!
//! The number of poses of a point changes by one across the image of a limit and by two across a fold, the image of det
//! = 0. Oriented with the side of more poses on the left, these images form a cycle. Its winding number about a point
//! is the point's number of poses. The images are split where they intersect. The parts with no pose on their right are
//! the boundary: outer loops run counter-clockwise, holes clockwise. Areas follow by Green's theorem along the exact
//! curves.
//!
//! | quantity | unit |
//! |---|---|
//! | positions | m, unturned (b = 0) unless a b is given |
//! | a_1, a_2, b | rad |
//! | areas | m² |

mod arrangement;
mod balance;
mod cycle;
mod determinant;
mod distance;
mod fold;
mod inside;
mod line;
mod region;
mod sides;
mod span;

use arrangement::{Arrangement, SpanPart, Strand};
use cycle::Cycle;
pub use line::{BoundaryLine, BoundaryLoop, BoundaryVertex};
use region::Region;
pub use sides::ChangeCurve;
pub use span::BoundaryCurve;
use span::Surface;

use super::PlaneMap;
use stillbase_mechanics::planar::{Vector, cross, dot, unit};

/// A region narrower than this is treated as a curve without area, rad.
const MIN_WIDTH_RAD: f64 = 1e-9;

/// The boundary of a reactionless workspace, computed once for all b.
#[derive(Clone, Debug)]
pub struct Boundary {
    on: Surface,
    cycle: Cycle,
    strands: Vec<Strand>,
    loops: Vec<BoundaryLoop>,
    cusps: Vec<BoundaryVertex>,
    area: f64,
    sheet_area: f64,
    interior_singularity: bool,
    /// Whether the workspace has no area; its loop is then a curve traversed back and forth.
    flat: bool,
}

/// Bounds of a workspace, m.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct BoundingBox {
    pub x_min: f64,
    pub x_max: f64,
    pub y_min: f64,
    pub y_max: f64,
}

/// The boundary point at which the end effector stays for a target outside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// The boundary point, turned by b*, m.
    pub at: Vector,
    /// Its plane coordinates, rad.
    pub a: [f64; 2],
    /// The limit or fold that blocks the end effector there.
    pub curve: BoundaryCurve,
    /// Distance from the target, m.
    pub distance: f64,
}

impl Boundary {
    /// Returns the boundary of the workspace within the map's limits.
    ///
    /// Limits that coincide with a straight fold are moved inwards by 4e-10 rad. Nodes of folds, which only occur in
    /// machines of special proportions, are exact to 1e-10 m. If such proportions make whole curves coincide, loops may
    /// be incomplete.
    pub fn of(map: &PlaneMap) -> Self {
        let on = Surface::of(map);
        let region = Region::limits(&on);
        Self::over(on, &region)
    }

    /// Returns the boundary of the image of a region.
    fn over(on: Surface, region: &Region) -> Self {
        let size: f64 = on.map.c().iter().map(|c| c.abs()).sum();
        if region.is_thin(MIN_WIDTH_RAD) || on.det.scale() <= 1e-14 * size * size {
            return Self::curve(on, region);
        }
        let mut spans = region.edge_spans(&on);
        let folds = region.keep(&on, fold::spans(&on));
        let interior_singularity = !folds.spans.is_empty();
        spans.extend(folds.spans);
        let sheet_area = spans.iter().map(|s| f64::from(s.weight()) * on.swept(s, 0.0, 1.0)).sum();
        let cycle = Cycle::of(spans, on.map.unit());
        let arrangement = Arrangement::of(&on, &cycle);
        let strands = arrangement.strands();
        let chains = arrangement.chain(arrangement.level(&strands, 1));
        let mut loops: Vec<BoundaryLoop> =
            chains.iter().map(|chain| BoundaryLoop::of(&on, &cycle.spans, chain)).collect();
        loops.sort_by(|a, b| b.area().total_cmp(&a.area()));
        if loops.is_empty() {
            return Self::curve(on, region);
        }
        let area = loops.iter().map(BoundaryLoop::area).sum();
        let cusp = |a: [f64; 2]| BoundaryVertex { a, at: on.map.forward_unturned(a), curve: BoundaryCurve::Fold };
        let cusps = folds.cusps.into_iter().map(cusp).collect();
        Self { on, cycle, strands, loops, cusps, area, sheet_area, interior_singularity, flat: false }
    }

    /// Returns a workspace without area: its outline, traversed back and forth.
    fn curve(on: Surface, region: &Region) -> Self {
        let spans = region.outline(&on);
        let chain: Vec<SpanPart> = (0..spans.len()).map(|span| SpanPart { span, from: 0.0, to: 1.0 }).collect();
        let outline = BoundaryLoop::of(&on, &spans, &chain).without_area();
        Self {
            loops: vec![outline],
            on,
            cycle: Cycle::of(spans, on.map.unit()),
            strands: Vec::new(),
            cusps: Vec::new(),
            area: 0.0,
            sheet_area: 0.0,
            interior_singularity: false,
            flat: true,
        }
    }

    /// Returns the closed curves that bound the workspace, at least one, sorted by descending area.
    pub fn loops(&self) -> &[BoundaryLoop] {
        &self.loops
    }

    /// Returns the area of the workspace, m².
    pub fn area(&self) -> f64 {
        self.area
    }

    /// Returns ∫ |det ∂(x, y)/∂(a_1, a_2)| da, m²: the area in which each point counts once for each of its poses.
    pub fn sheet_area(&self) -> f64 {
        self.sheet_area
    }

    /// Whether det = 0 somewhere strictly within the limits.
    pub fn interior_singularity(&self) -> bool {
        self.interior_singularity
    }

    /// Returns the vertices of all loops, turned by b*, m.
    pub fn turned(&self, b: f64) -> Vec<Vec<[f64; 2]>> {
        let turn = unit(self.on.map.turn(b));
        let point = |v: &BoundaryVertex| {
            let p = v.at * turn;
            [p.re, p.im]
        };
        self.loops.iter().map(|l| l.vertices().iter().map(point).collect()).collect()
    }

    /// Returns the bounds in x and y of the workspace turned by b*, m.
    pub fn extent(&self, b: f64) -> BoundingBox {
        let turn = unit(self.on.map.turn(b));
        // A direction in the turned workspace, turned back, is the same direction in the unturned one.
        let most = |x: f64, y: f64| self.support(Vector::new(x, y) * turn.conj());
        BoundingBox { x_min: -most(-1.0, 0.0), x_max: most(1.0, 0.0), y_min: -most(0.0, -1.0), y_max: most(0.0, 1.0) }
    }

    /// Support function: returns the largest component along a unit vector, m.
    fn support(&self, w: Vector) -> f64 {
        let vertices = || self.loops.iter().flat_map(|l| l.vertices());
        let mut best = vertices().map(|v| dot(v.at, w)).fold(f64::NEG_INFINITY, f64::max);
        let bar = best - 2.5 * line::near(&self.on.map);
        for l in &self.loops {
            for (i, part) in l.portions().iter().enumerate() {
                let [from, to] = l.chord(i);
                if dot(from, w).max(dot(to, w)) < bar {
                    continue;
                }
                let span = &self.cycle.spans[part.span];
                if let Some(t) = falling_zero(|t| dot(self.on.jet(span, t).rate, w), part.from, part.to) {
                    best = best.max(dot(self.on.at(span, t), w));
                }
            }
        }
        best
    }

    /// Whether p, m, lies in the workspace of the plane b or on its boundary.
    pub fn contains(&self, p: Vector, b: f64) -> bool {
        self.contains_unturned(p * unit(-self.on.map.turn(b)))
    }

    fn contains_unturned(&self, p: Vector) -> bool {
        if !p.is_finite() {
            return false;
        }
        let mut winding = 0;
        for l in &self.loops {
            for (i, part) in l.portions().iter().enumerate() {
                let [from, to] = l.chord(i);
                let span = &self.cycle.spans[part.span];
                match span.crossings(&self.on, (part.from, from), (part.to, to), p) {
                    Some(n) => winding += n,
                    None => return true,
                }
            }
        }
        winding > 0
    }

    /// Returns the boundary point at which the end effector stays on the plane b for a target p, m, outside. It is the
    /// local minimum of the distance from p that a descent along one loop reaches from the present position `from`, m.
    ///
    /// If `from` is inside, the end effector first moves straight towards p up to the boundary, then along it.
    pub fn nearest(&self, p: Vector, b: f64, from: Vector) -> Nearest {
        let turn = unit(self.on.map.turn(b));
        let (p, from) = (p * turn.conj(), from * turn.conj());
        let (which, start) = self.exit(from, p).unwrap_or_else(|| self.closest(from));
        let l = &self.loops[which];
        let n = l.vertices().len();
        let distance = |i: usize| (l.vertices()[i % n].at - p).norm_sqr();
        let mut i = if distance(start + 1) < distance(start) { (start + 1) % n } else { start };
        for _ in 0..n {
            let (next, last) = ((i + 1) % n, (i + n - 1) % n);
            let lower = if distance(next) < distance(last) { next } else { last };
            if distance(lower) >= distance(i) {
                break;
            }
            i = lower;
        }
        let vertex = l.vertices()[i];
        let (mut a, mut at, mut curve) = (vertex.a, vertex.at, vertex.curve);
        for part in [l.portions()[(i + n - 1) % n], l.portions()[i]] {
            let span = &self.cycle.spans[part.span];
            let towards = |t: f64| {
                let jet = self.on.jet(span, t);
                dot(p - jet.at, jet.rate)
            };
            if let Some(t) = falling_zero(towards, part.from, part.to) {
                let candidate = self.on.jet(span, t);
                if (candidate.at - p).norm_sqr() < (at - p).norm_sqr() {
                    (a, at, curve) = (candidate.a, candidate.at, span.curve);
                }
            }
        }
        Nearest { at: at * turn, a: self.on.map.clamp(a), curve, distance: (at - p).norm() }
    }

    /// Returns the chord nearest to a point, as indices of loop and vertex.
    fn closest(&self, p: Vector) -> (usize, usize) {
        let mut best = (f64::INFINITY, (0, 0));
        for (k, l) in self.loops.iter().enumerate() {
            for i in 0..l.vertices().len() {
                let gap = from_chord(l.chord(i), p);
                if gap < best.0 {
                    best = (gap, (k, i));
                }
            }
        }
        best.1
    }

    /// Returns the chord through which the straight line from an inner point to p first leaves the workspace, as
    /// indices of loop and vertex.
    fn exit(&self, from: Vector, p: Vector) -> Option<(usize, usize)> {
        if !self.contains_unturned(from) {
            return None;
        }
        let way = p - from;
        let mut best: Option<(f64, (usize, usize))> = None;
        for (k, l) in self.loops.iter().enumerate() {
            for i in 0..l.vertices().len() {
                let [a, b] = l.chord(i);
                if from_chord([a, b], from) < (1.25 * line::near(&self.on.map)).powi(2) {
                    return None;
                }
                let n = cross(way, b - a);
                let (t, s) = (cross(a - from, b - a) / n, cross(a - from, way) / n);
                // The outside is on the right of the boundary.
                let leaves = n > 0.0 && (0.0..=1.0).contains(&t) && (0.0..=1.0).contains(&s);
                if leaves && best.is_none_or(|(least, _)| t < least) {
                    best = Some((t, (k, i)));
                }
            }
        }
        best.map(|(_, found)| found)
    }
}

/// Returns the squared distance of p from a chord, m².
fn from_chord([a, b]: [Vector; 2], p: Vector) -> f64 {
    let along = b - a;
    let share = (dot(p - a, along) / along.norm_sqr()).clamp(0.0, 1.0);
    let share = if share.is_nan() { 0.0 } else { share };
    (a + share * along - p).norm_sqr()
}

/// Returns a zero of a function between two points, if it is ≥ 0 at the first and ≤ 0 at the second.
fn falling_zero(f: impl Fn(f64) -> f64, from: f64, to: f64) -> Option<f64> {
    let (mut low, mut high) = (from, to);
    let (mut at_low, mut at_high) = (f(low), f(high));
    if !(at_low >= 0.0 && at_high <= 0.0) {
        return None;
    }
    // Regula falsi that halves the value at the retained bound: superlinear, and never leaves the bracket.
    for _ in 0..60 {
        if at_low == at_high {
            break;
        }
        let t = (low * at_high - high * at_low) / (at_high - at_low);
        let value = f(t);
        if value == 0.0 || (high - low) < 1e-15 {
            return Some(t);
        }
        let (side, other) = if value > 0.0 { (&mut low, &mut at_high) } else { (&mut high, &mut at_low) };
        if (t - *side).abs() < 1e-16 {
            return Some(t);
        }
        *side = t;
        *other *= 0.5;
        if value > 0.0 {
            at_low = value;
        } else {
            at_high = value;
        }
    }
    Some(0.5 * (low + high))
}
