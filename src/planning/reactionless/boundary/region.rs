//! A convex region of (a_1, a_2): the rectangle of the limits, or the part of it on one side of lines of change points.

use super::determinant::FOLD_INSET;
use super::fold::{self, FoldCurves};
use super::span::{BoundaryCurve, BoundarySpan, Surface};
use stillbase_mechanics::planar::{Vector, dot};

/// Maximum length of a span along an edge, rad.
const MAX_STEP_RAD: f64 = 0.35;
/// Corners within this distance of a line lie on it, rad.
const ON_LINE_RAD: f64 = 1e-9;

/// The half-plane n · a ≥ level, with components of n in {−1, 0, 1}.
#[derive(Clone, Copy, Debug)]
pub(super) struct HalfPlane {
    pub n: [f64; 2],
    pub level: f64,
    /// The boundary curve to which points of its line belong.
    pub curve: BoundaryCurve,
}

#[derive(Clone, Copy, Debug)]
struct Edge {
    curve: BoundaryCurve,
    ends: [[f64; 2]; 2],
    /// The half-plane on whose line the edge lies; `None` if the edge lies on a limit.
    half_plane: Option<HalfPlane>,
}

/// A convex polygon in (a_1, a_2), counter-clockwise.
#[derive(Clone, Debug)]
pub(super) struct Region {
    edges: Vec<Edge>,
    half_planes: Vec<HalfPlane>,
}

impl HalfPlane {
    fn depth(&self, a: [f64; 2]) -> f64 {
        self.n[0] * a[0] + self.n[1] * a[1] - self.level
    }

    /// Returns the boundary line as a point and a direction.
    fn line(&self) -> [[f64; 2]; 2] {
        let norm = self.n[0] * self.n[0] + self.n[1] * self.n[1];
        [self.n.map(|n| n * self.level / norm), [-self.n[1], self.n[0]]]
    }

    /// Moves the line slightly inwards if det is 0 all along it, so that det has a sign there.
    fn off_folds(mut self, on: &Surface) -> Self {
        let [from, way] = self.line();
        if on.det.vanishes(from, way) {
            self.level += 4.0 * FOLD_INSET;
        }
        self
    }

    /// Returns the zeros of det on the line between two of its points, from the first to the second.
    fn zeros(&self, on: &Surface, ends: [[f64; 2]; 2]) -> Vec<[f64; 2]> {
        let [from, way] = self.line();
        let norm = way[0] * way[0] + way[1] * way[1];
        let [y, z] = ends.map(|a| ((a[0] - from[0]) * way[0] + (a[1] - from[1]) * way[1]) / norm);
        let mut zeros = fold::zeros_on(on, [from, way], [y.min(z), y.max(z)]);
        if y > z {
            zeros.reverse();
        }
        zeros.into_iter().map(|y| [0, 1].map(|j| from[j] + y * way[j])).collect()
    }
}

impl Region {
    /// Returns the region within the limits.
    pub fn limits(on: &Surface) -> Self {
        let [a1, a2] = on.map.limits();
        let corners = [[a1.min, a2.min], [a1.max, a2.min], [a1.max, a2.max], [a1.min, a2.max]];
        let edge = |i: usize| Edge { curve: side(i), ends: [corners[i], corners[(i + 1) % 4]], half_plane: None };
        Self { edges: (0..4).map(edge).collect(), half_planes: Vec::new() }
    }

    /// Returns the part of the region within a half-plane.
    pub fn within(mut self, on: &Surface, half: HalfPlane) -> Self {
        let half = half.off_folds(on);
        let depth = |a: [f64; 2]| if half.depth(a).abs() < ON_LINE_RAD { 0.0 } else { half.depth(a) };
        let crossing = |[from, to]: [[f64; 2]; 2]| {
            let share = depth(from) / (depth(from) - depth(to));
            [0, 1].map(|j| match half.n[1 - j] {
                // Exact on a line of constant a_j, as along limits.
                0.0 => half.level / half.n[j],
                _ => from[j] + share * (to[j] - from[j]),
            })
        };
        let mut kept: Vec<Edge> = Vec::with_capacity(self.edges.len() + 1);
        let (mut exit, mut entry) = (None, None);
        for edge in &self.edges {
            let [from, to] = edge.ends;
            let (begins, ends) = (depth(from), depth(to));
            if begins >= 0.0 && ends >= 0.0 {
                kept.push(*edge);
            } else if begins > 0.0 {
                let at = crossing(edge.ends);
                kept.push(Edge { ends: [from, at], ..*edge });
                exit = Some((kept.len(), at));
            } else if ends > 0.0 {
                let at = crossing(edge.ends);
                kept.push(Edge { ends: [at, to], ..*edge });
                entry = Some(at);
            } else {
                if begins == 0.0 {
                    exit = Some((kept.len(), from));
                }
                if ends == 0.0 {
                    entry = Some(to);
                }
            }
        }
        if let (Some((place, from)), Some(to)) = (exit, entry)
            && from != to
        {
            kept.insert(place, Edge { curve: half.curve, ends: [from, to], half_plane: Some(half) });
        }
        self.edges = kept;
        self.half_planes.push(half);
        self
    }

    /// Whether the region is narrower than `thin`, rad: a line, a point, or empty.
    pub fn is_thin(&self, thin: f64) -> bool {
        self.edges.len() < 3 || self.edges.iter().any(|e| self.width(e) < thin)
    }

    /// Returns the width of the region perpendicular to an edge, rad.
    fn width(&self, edge: &Edge) -> f64 {
        let inwards = inwards(edge.ends);
        let depth = |a: [f64; 2]| dot(vector(a) - vector(edge.ends[0]), inwards);
        self.edges.iter().map(|e| depth(e.ends[0])).fold(0.0, f64::max)
    }

    /// Returns the edges as spans, oriented with the side of more poses on the left.
    pub fn edge_spans(&self, on: &Surface) -> Vec<BoundarySpan> {
        let mut spans = Vec::new();
        for edge in &self.edges {
            let mut stops = vec![edge.ends[0]];
            stops.extend(edge.zeros(on));
            stops.push(edge.ends[1]);
            for w in stops.windows(2) {
                // Counter-clockwise if det > 0, where the map keeps orientation; else clockwise.
                let sheet = sheet(on, [w[0], w[1]], self.width(edge));
                let ends = if sheet > 0.0 { [w[0], w[1]] } else { [w[1], w[0]] };
                spans.extend(along(on, edge.curve, ends));
            }
        }
        spans
    }

    /// Returns the parts of the folds inside the region.
    pub fn keep(&self, on: &Surface, folds: FoldCurves) -> FoldCurves {
        if self.half_planes.is_empty() {
            return folds;
        }
        let inside = |a: [f64; 2]| self.half_planes.iter().all(|half| half.depth(a) > 0.0);
        let edges = self.edges.iter().filter(|e| e.half_plane.is_some());
        let zeros: Vec<[f64; 2]> = edges.flat_map(|e| e.zeros(on)).collect();
        let mut spans = Vec::with_capacity(folds.spans.len());
        for span in &folds.spans {
            let mut splits: Vec<(f64, [f64; 2])> =
                zeros.iter().filter_map(|&a| on.locate(span, a).map(|t| (t, a))).collect();
            splits.retain(|(t, _)| (1e-9..1.0 - 1e-9).contains(t));
            if splits.is_empty() {
                if inside(on.point(span, 0.5)) {
                    spans.push(*span);
                }
                continue;
            }
            splits.push((0.0, span.ends[0]));
            splits.push((1.0, span.ends[1]));
            splits.sort_by(|a, b| a.0.total_cmp(&b.0));
            for w in splits.windows(2) {
                if inside(on.point(span, 0.5 * (w[0].0 + w[1].0))) {
                    spans.push(on.part(span, [w[0].0, w[1].0], [w[0].1, w[1].1]));
                }
            }
        }
        FoldCurves { spans, cusps: folds.cusps.into_iter().filter(|&a| inside(a)).collect() }
    }

    /// Returns the outline as spans for a region without area, where no side has more poses.
    pub fn outline(&self, on: &Surface) -> Vec<BoundarySpan> {
        let mut spans: Vec<BoundarySpan> = self.edges.iter().flat_map(|e| along(on, e.curve, e.ends)).collect();
        if let (true, Some(edge)) = (spans.is_empty(), self.edges.first()) {
            spans.push(on.straight(edge.curve, edge.ends));
        }
        spans
    }
}

impl Edge {
    /// Returns the zeros of det, in the direction of the edge.
    fn zeros(&self, on: &Surface) -> Vec<[f64; 2]> {
        if let Some(half) = self.half_plane {
            return half.zeros(on, self.ends);
        }
        // The zeros are computed along the whole limit, so that they equal the ends of the folds exactly.
        let BoundaryCurve::Limit { angle: fixed, .. } = self.curve else { return Vec::new() };
        let (other, level) = (1 - fixed, self.ends[0][fixed]);
        let whole = on.map.limits()[other];
        let [from, to] = self.ends.map(|a| a[other]);
        let mut zeros = fold::zeros(on, fixed, level, [whole.min, whole.max]);
        zeros.retain(|y| (from.min(to)..=from.max(to)).contains(y));
        if from > to {
            zeros.reverse();
        }
        let point = |y: f64| if other == 0 { [y, level] } else { [level, y] };
        zeros.into_iter().map(point).collect()
    }
}

/// Returns the curve of an edge of the limits, counter-clockwise from the edge of least a_2.
fn side(edge: usize) -> BoundaryCurve {
    [
        BoundaryCurve::Limit { angle: 1, upper: false },
        BoundaryCurve::Limit { angle: 0, upper: true },
        BoundaryCurve::Limit { angle: 1, upper: true },
        BoundaryCurve::Limit { angle: 0, upper: false },
    ][edge % 4]
}

/// Returns spans along a straight part of an edge.
pub(super) fn along(
    on: &Surface,
    curve: BoundaryCurve,
    [from, to]: [[f64; 2]; 2],
) -> impl Iterator<Item = BoundarySpan> {
    let run = (to[0] - from[0]).abs() + (to[1] - from[1]).abs();
    let n = (run / MAX_STEP_RAD).ceil() as usize;
    let point = move |i: usize| match i {
        0 => from,
        i if i == n => to,
        i => [0, 1].map(|j| if from[j] == to[j] { from[j] } else { from[j] + (to[j] - from[j]) * i as f64 / n as f64 }),
    };
    (0..n).map(move |i| on.straight(curve, [point(i), point(i + 1)]))
}

fn vector(a: [f64; 2]) -> Vector {
    Vector::new(a[0], a[1])
}

/// Returns the unit vector to the left of an edge.
fn inwards([from, to]: [[f64; 2]; 2]) -> Vector {
    let along = vector(to) - vector(from);
    Vector::new(-along.im, along.re) / along.norm()
}

/// Returns det at the middle of a part of an edge, or slightly inside if the edge itself is singular.
fn sheet(on: &Surface, ends: [[f64; 2]; 2], width: f64) -> f64 {
    let inwards = inwards(ends);
    let values = [0.0, 1e-8, 1e-6, 1e-4, 1e-2, 0.3].map(|depth| {
        let aside = inwards * (depth * width);
        on.det.value([0.5 * (ends[0][0] + ends[1][0]) + aside.re, 0.5 * (ends[0][1] + ends[1][1]) + aside.im])
    });
    values.into_iter().find(|v| v.abs() > 1e-12 * on.det.scale()).unwrap_or(0.0)
}
