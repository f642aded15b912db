//! Curves as vertices and chords within a tolerance.

use super::arrangement::SpanPart;
use super::span::{BoundaryCurve, BoundarySpan, Surface};
use crate::reactionless::PlaneMap;
use stillbase_mechanics::planar::{Vector, cross, unit};

/// Maximum deviation of chords from the curve, m.
const CHORD_TOLERANCE_M: f64 = 0.8e-5;
/// Least and greatest tolerance as a fraction of the unit of the map. Small machines need a smaller tolerance than
/// [`CHORD_TOLERANCE_M`]; large ones would need too many chords with it.
const MIN_CHORD_FRACTION: f64 = 1e-3 * CHORD_TOLERANCE_M;
const MAX_CHORD_FRACTION: f64 = CHORD_TOLERANCE_M;

/// Returns the tolerance of the chords of a map, m.
pub(super) fn near(map: &PlaneMap) -> f64 {
    CHORD_TOLERANCE_M.clamp(MIN_CHORD_FRACTION * map.unit(), MAX_CHORD_FRACTION * map.unit())
}

/// A point of a curve; `curve` and `a` belong to the piece that begins here.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundaryVertex {
    /// Plane coordinates (a_1, a_2), rad.
    pub a: [f64; 2],
    /// Position at b = 0, m.
    pub at: Vector,
    /// The limit, fold or change point on which it lies.
    pub curve: BoundaryCurve,
}

/// A closed curve with the workspace on its left. The last vertex is joined to the first.
#[derive(Clone, Debug)]
pub struct BoundaryLoop {
    vertices: Vec<BoundaryVertex>,
    /// The portion of a span between each vertex and the next.
    portions: Vec<SpanPart>,
    area: f64,
}

/// A curve of the workspace; chords as in [`BoundaryLoop::vertices`]. A fold or limit has more poses on its left.
#[derive(Clone, Debug)]
pub struct BoundaryLine {
    vertices: Vec<BoundaryVertex>,
    closed: bool,
}

impl BoundaryLoop {
    /// Returns the points of the curve. Chords deviate by at most 1e-5 m; for a reach below a metre by 1e-5 of it,
    /// above a kilometre by 1e-8 of it.
    pub fn vertices(&self) -> &[BoundaryVertex] {
        &self.vertices
    }

    /// Returns the signed area, m²: negative for a hole.
    pub fn area(&self) -> f64 {
        self.area
    }

    pub(super) fn of(on: &Surface, spans: &[BoundarySpan], chain: &[SpanPart]) -> Self {
        let (vertices, portions) = chords(on, spans, chain);
        let swept: f64 = chain.iter().map(|p| on.swept(&spans[p.span], p.from, p.to)).sum();
        // A sliver too thin to separate its sides leaves a gap in the curve. The triangle from the base to the gap is
        // added, because its area is much larger than that of the sliver.
        let [starts, ends] = [0, 1].map(|end| move |p: &SpanPart| on.at(&spans[p.span], [p.from, p.to][end]));
        let after = chain.iter().cycle().skip(1);
        let gaps: f64 = chain.iter().zip(after).map(|(p, next)| 0.5 * cross(ends(p), starts(next))).sum();
        Self { vertices, portions, area: swept + gaps }
    }

    pub(super) fn without_area(self) -> Self {
        Self { area: 0.0, ..self }
    }

    pub(super) fn portions(&self) -> &[SpanPart] {
        &self.portions
    }

    pub(super) fn chord(&self, i: usize) -> [Vector; 2] {
        [self.vertices[i].at, self.vertices[(i + 1) % self.vertices.len()].at]
    }
}

impl BoundaryLine {
    /// Returns the points of the curve from end to end; a closed one ends at its first point.
    pub fn vertices(&self) -> &[BoundaryVertex] {
        &self.vertices
    }

    /// Whether the curve is closed.
    pub fn is_closed(&self) -> bool {
        self.closed
    }

    /// Returns the vertices turned by b*, rad: [`PlaneMap::turn`](crate::reactionless::PlaneMap::turn) of b.
    pub fn turned(&self, turn: f64) -> Vec<[f64; 2]> {
        turned(&self.vertices, turn)
    }

    /// Returns the line of consecutive portions.
    pub(super) fn of(on: &Surface, spans: &[BoundarySpan], chain: &[SpanPart]) -> Self {
        let (mut vertices, _) = chords(on, spans, chain);
        if let Some(last) = chain.last() {
            let span = &spans[last.span];
            vertices.push(BoundaryVertex { a: on.point(span, last.to), at: on.at(span, last.to), curve: span.curve });
        }
        let ends = vertices.first().zip(vertices.last());
        let closed = chain.len() > 1 && ends.is_some_and(|(first, last)| first.a == last.a);
        Self { vertices, closed }
    }
}

/// Returns vertices turned by an angle, rad.
pub(super) fn turned(vertices: &[BoundaryVertex], turn: f64) -> Vec<[f64; 2]> {
    let turn = unit(turn);
    let point = |v: &BoundaryVertex| {
        let p = v.at * turn;
        [p.re, p.im]
    };
    vertices.iter().map(point).collect()
}

/// Returns the start vertex of each chord, and its portion of a span.
fn chords(on: &Surface, spans: &[BoundarySpan], chain: &[SpanPart]) -> (Vec<BoundaryVertex>, Vec<SpanPart>) {
    let (mut vertices, mut portions) = (Vec::new(), Vec::new());
    for part in chain {
        let span = &spans[part.span];
        let length = part.to - part.from;
        let n = (length * (span.deviation / near(&on.map)).sqrt()).ceil().clamp(1.0, 1e5) as usize;
        let t = |i: usize| if i == n { part.to } else { part.from + length * i as f64 / n as f64 };
        for i in 0..n {
            let a = on.point(span, t(i));
            let at = if t(i) <= 0.0 { span.at[0] } else { on.map.forward_unturned(a) };
            vertices.push(BoundaryVertex { a, at, curve: span.curve });
            portions.push(SpanPart { span: part.span, from: t(i), to: t(i + 1) });
        }
    }
    (vertices, portions)
}
