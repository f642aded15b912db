//! Curves as vertices and chords that keep near them.

use super::arrangement::Portion;
use super::span::{BoundaryCurve, Span, Surface};
use crate::mechanics::planar::{Vector, cross, unit};
use crate::planning::reactionless::PlaneMap;

/// Chords between vertices keep this near to the curve, m.
const CHORD: f64 = 0.8e-5;
/// The same as a share of the unit of the map: small machines want them nearer, huge ones would have too many.
const SHARE: [f64; 2] = [1e-3 * CHORD, CHORD];

/// How near to the curve the chords of a map are kept, m.
pub(super) fn near(map: &PlaneMap) -> f64 {
    CHORD.clamp(SHARE[0] * map.unit(), SHARE[1] * map.unit())
}

/// A point of a curve; the curve and a are those of the piece that begins here.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vertex {
    /// (a_1, a_2), rad.
    pub a: [f64; 2],
    /// Before the workspace is turned, m.
    pub at: Vector,
    /// Where it lies.
    pub curve: BoundaryCurve,
}

/// A closed curve, the workspace on its left. The last vertex is joined to the first.
#[derive(Clone, Debug)]
pub struct BoundaryLoop {
    vertices: Vec<Vertex>,
    /// From each vertex to the next.
    portions: Vec<Portion>,
    area: f64,
}

/// A curve of the workspace from one end to the other, each chord within 1e-5 m of it. Across folds and limits, more
/// poses are on its left.
#[derive(Clone, Debug)]
pub struct BoundaryLine {
    vertices: Vec<Vertex>,
    closed: bool,
}

impl BoundaryLoop {
    /// Points of the curve, each chord within 1e-5 m of it; within 1e-5 of the reach below a metre, 1e-8 of it above
    /// a kilometre.
    pub fn vertices(&self) -> &[Vertex] {
        &self.vertices
    }

    /// Signed: negative for a hole, m².
    pub fn area(&self) -> f64 {
        self.area
    }

    pub(super) fn of(on: &Surface, spans: &[Span], chain: &[Portion]) -> Self {
        let (vertices, portions) = chords(on, spans, chain);
        let swept: f64 = chain.iter().map(|p| on.swept(&spans[p.span], p.from, p.to)).sum();
        // Slivers too thin to tell their sides apart leave gaps: what a gap sweeps about the base is far more than they
        // hold.
        let [starts, ends] = [0, 1].map(|end| move |p: &Portion| on.at(&spans[p.span], [p.from, p.to][end]));
        let after = chain.iter().cycle().skip(1);
        let gaps: f64 = chain.iter().zip(after).map(|(p, next)| 0.5 * cross(ends(p), starts(next))).sum();
        Self { vertices, portions, area: swept + gaps }
    }

    pub(super) fn without_area(self) -> Self {
        Self { area: 0.0, ..self }
    }

    pub(super) fn portions(&self) -> &[Portion] {
        &self.portions
    }

    pub(super) fn chord(&self, i: usize) -> [Vector; 2] {
        [self.vertices[i].at, self.vertices[(i + 1) % self.vertices.len()].at]
    }
}

impl BoundaryLine {
    /// Points of the curve from end to end; a closed one ends where it begins.
    pub fn vertices(&self) -> &[Vertex] {
        &self.vertices
    }

    /// Whether it ends where it begins.
    pub fn is_closed(&self) -> bool {
        self.closed
    }

    /// Vertices turned by b*, rad: [`PlaneMap::turn`](crate::planning::reactionless::PlaneMap::turn) of b.
    pub fn turned(&self, turn: f64) -> Vec<[f64; 2]> {
        turned(&self.vertices, turn)
    }

    /// Pieces that follow each other.
    pub(super) fn of(on: &Surface, spans: &[Span], chain: &[Portion]) -> Self {
        let (mut vertices, _) = chords(on, spans, chain);
        if let Some(last) = chain.last() {
            let span = &spans[last.span];
            vertices.push(Vertex { a: on.point(span, last.to), at: on.at(span, last.to), curve: span.curve });
        }
        let ends = vertices.first().zip(vertices.last());
        let closed = chain.len() > 1 && ends.is_some_and(|(first, last)| first.a == last.a);
        Self { vertices, closed }
    }
}

/// Points turned by an angle.
pub(super) fn turned(vertices: &[Vertex], turn: f64) -> Vec<[f64; 2]> {
    let turn = unit(turn);
    let point = |v: &Vertex| {
        let p = v.at * turn;
        [p.re, p.im]
    };
    vertices.iter().map(point).collect()
}

/// The beginning of each chord, and the portion that it stands for.
fn chords(on: &Surface, spans: &[Span], chain: &[Portion]) -> (Vec<Vertex>, Vec<Portion>) {
    let (mut vertices, mut portions) = (Vec::new(), Vec::new());
    for part in chain {
        let span = &spans[part.span];
        let length = part.to - part.from;
        let n = (length * (span.deviation / near(&on.map)).sqrt()).ceil().clamp(1.0, 1e5) as usize;
        let t = |i: usize| if i == n { part.to } else { part.from + length * i as f64 / n as f64 };
        for i in 0..n {
            let a = on.point(span, t(i));
            let at = if t(i) <= 0.0 { span.at[0] } else { on.map.forward_unturned(a) };
            vertices.push(Vertex { a, at, curve: span.curve });
            portions.push(Portion { span: part.span, from: t(i), to: t(i + 1) });
        }
    }
    (vertices, portions)
}
