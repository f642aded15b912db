//! [`TracedBoundary`]: the boundary of a workspace as closed polygons.
//!
//! An end is a point where the workspace begins or ends on a circle. Where every end continues on the next circle,
//! edges join the ends of both circles. Where their number or order changes, the two neighbouring circles are treated
//! as one, and their ends are joined along it in pairs. Between the ends of a pair, the workspace is on one side of the
//! circle only. So every end has two edges, one inwards and one outwards, and all polygons close.

use std::f64::consts::TAU;

use super::rings::{BoundaryStep, Ring, Rings};
use stillbase_mechanics::planar::{Vector, unit};

/// Points within this fraction of the reach are equal. Loops with an area of at most ten times this fraction of the
/// squared reach are dropped.
const SAME_POINT: f64 = 1e-10;
/// A circle about B with a radius below this fraction of the reach is treated as B.
const BASE_RADIUS: f64 = 1e-6;

/// A boundary: loops with the workspace on their left.
#[derive(Clone, Debug, Default)]
pub(super) struct TracedBoundary {
    /// Area of the workspace, m².
    pub area: f64,
    pub loops: Vec<Vec<[f64; 2]>>,
}

/// An edge to another end: that end, whether the edge arrives from its inner side, and the points between.
#[derive(Clone, Copy, Debug)]
struct Link {
    to: usize,
    from_inside: bool,
    way: Way,
}

#[derive(Clone, Copy, Debug)]
enum Way {
    /// A range of the points of a step, forwards or backwards.
    Edge { step: usize, points: [usize; 2], back: bool },
    /// Arc of a circle of radius r, m, by a signed angle, rad.
    Circle { r: f64, by: f64 },
}

/// A point where the workspace begins or ends on a circle.
#[derive(Clone, Copy, Debug)]
struct Node {
    at: Vector,
    angle: f64,
    opens: bool,
    /// Edges inwards and outwards.
    links: [Option<Link>; 2],
}

impl Rings {
    /// Joins all ends into closed loops.
    pub fn traced(&self) -> TracedBoundary {
        let far = self.rings.last().map_or(0.0, |ring| ring.r);
        let mut all = All { of: self, nodes: Vec::new(), first: Vec::new(), circles: Vec::new() };
        for ring in &self.rings {
            all.first.push(all.nodes.len());
            let node = |i: usize| Node {
                at: ring.at(i),
                angle: ring.ends[i].angle,
                opens: ring.ends[i].opens,
                links: [None; 2],
            };
            all.nodes.extend((0..ring.ends.len()).map(node));
        }
        for j in 0..self.rings.len() {
            match self.steps.get(j) {
                Some(BoundaryStep::On { first, to, .. }) => all.join_by_edges(j, *first, to),
                _ => all.join_along_circle(Some(j), self.rings.get(j + 1).map(|_| j + 1)),
            }
        }
        if self.rings.first().is_some_and(|ring| !ring.ends.is_empty() || ring.r > BASE_RADIUS * far) {
            all.join_along_circle(None, Some(0));
        }
        let mut loops = all.collect_loops();
        let signed = |line: &[Vector]| -> f64 {
            let pairs = line.iter().zip(line.iter().cycle().skip(1));
            pairs.map(|(a, b)| 0.5 * (a.conj() * b).im).sum()
        };
        let area = loops.iter().map(|line| signed(line)).sum::<f64>() + self.chord_area;
        for line in &mut loops {
            line.dedup_by(|p, last| (*p - *last).norm() <= SAME_POINT * far);
            while line.len() > 1 && (line[0] - line[line.len() - 1]).norm() <= SAME_POINT * far {
                line.pop();
            }
        }
        loops.retain(|line| line.len() > 2 && signed(line).abs() > 10.0 * SAME_POINT * far * far);
        let flat = |line: Vec<Vector>| line.into_iter().map(|p| [p.re, p.im]).collect();
        TracedBoundary { area, loops: loops.into_iter().map(flat).collect() }
    }
}

struct All<'a> {
    of: &'a Rings,
    nodes: Vec<Node>,
    /// Index of the first end of each circle.
    first: Vec<usize>,
    /// Boundary loops that are whole circles.
    circles: Vec<Vec<Vector>>,
}

impl All<'_> {
    fn join_by_edges(&mut self, j: usize, turned: usize, upto: &[usize]) {
        let n = upto.len();
        for i in 0..n {
            let points = [if i > 0 { upto[i - 1] } else { 0 }, upto[i]];
            let (from, to) = (self.first[j] + i, self.first[j + 1] + (i + turned) % n);
            let way = |back| Way::Edge { step: j, points, back };
            self.nodes[from].links[1] = Some(Link { to, from_inside: true, way: way(false) });
            self.nodes[to].links[0] = Some(Link { to: from, from_inside: false, way: way(true) });
        }
    }

    /// Joins the outer sides of one circle's ends and the inner sides of the next circle's ends, along the first
    /// circle. There is no workspace beyond the last circle or inside the first.
    fn join_along_circle(&mut self, inner: Option<usize>, outer: Option<usize>) {
        let empty = Ring::default();
        let ring = |j: Option<usize>| j.map_or(&empty, |j| &self.of.rings[j]);
        let r = inner.or(outer).map_or(0.0, |j| self.of.rings[j].r);
        let ends = |j: Option<usize>, side: usize| {
            let first = j.map_or(0, |j| self.first[j]);
            (0..ring(j).ends.len()).map(move |i| (first + i, side))
        };
        let mut all: Vec<(usize, usize)> = ends(inner, 1).chain(ends(outer, 0)).collect();
        let mut differ = ring(inner).starts_inside() != ring(outer).starts_inside();
        if all.is_empty() {
            if differ {
                let by = if ring(inner).whole { TAU } else { -TAU };
                let mut circle = vec![Vector::new(r, 0.0)];
                self.arc(Vector::new(r, 0.0), r, by, &mut circle);
                self.circles.push(circle);
            }
            return;
        }
        all.sort_by(|x, y| self.nodes[x.0].angle.total_cmp(&self.nodes[y.0].angle));
        for k in 0..all.len() {
            differ = !differ;
            let (from, to) = (all[k], all[(k + 1) % all.len()]);
            if differ {
                let mut by = self.nodes[to.0].angle - self.nodes[from.0].angle;
                if k + 1 == all.len() {
                    by += TAU;
                }
                let link =
                    |to: (usize, usize), by| Link { to: to.0, from_inside: to.1 == 0, way: Way::Circle { r, by } };
                self.nodes[from.0].links[from.1] = Some(link(to, by));
                self.nodes[to.0].links[to.1] = Some(link(from, -by));
            }
        }
    }

    /// Adds points along a circular arc, without its ends.
    fn arc(&self, from: Vector, r: f64, by: f64, line: &mut Vec<Vector>) {
        let parts = (by.abs() * (r / (8.0 * self.of.chord)).sqrt()).ceil().min(1e5);
        let count = parts as usize;
        line.extend((1..count).map(|i| from * unit(by * i as f64 / parts)));
    }

    /// Collects all loops, with the workspace on their left.
    fn collect_loops(&mut self) -> Vec<Vec<Vector>> {
        let mut loops = std::mem::take(&mut self.circles);
        let mut seen = vec![false; self.nodes.len()];
        for start in 0..self.nodes.len() {
            // From an opening end, the outward edge has the workspace on its left.
            let (mut at, mut outwards) = (start, self.nodes[start].opens);
            let mut line = Vec::new();
            while !seen[at] {
                seen[at] = true;
                line.push(self.nodes[at].at);
                let Some(link) = self.nodes[at].links[usize::from(outwards)] else { break };
                match link.way {
                    Way::Circle { r, by } => self.arc(self.nodes[at].at, r, by, &mut line),
                    Way::Edge { step, points: [from, to], back } => {
                        if let BoundaryStep::On { points, .. } = &self.of.steps[step] {
                            let points = &points[from..to];
                            if back {
                                line.extend(points.iter().rev());
                            } else {
                                line.extend(points);
                            }
                        }
                    }
                }
                (at, outwards) = (link.to, link.from_inside);
            }
            if line.len() > 2 {
                loops.push(line);
            }
        }
        loops
    }
}
