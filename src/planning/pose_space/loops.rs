//! [`Traced`]: the boundary of a workspace as closed lines.
//!
//! Where every end of the workspace on a circle goes on to the next circle, edges join them. Where the boundary changes,
//! the ends on both sides of one circle are joined along it, two by two: between them lies what belongs to the workspace
//! on one side only. So every end has two edges, one inwards and one outwards, and all lines close.

use std::f64::consts::TAU;

use super::rings::{Ring, Rings, Step};
use crate::mechanics::planar::{Vector, unit};

/// Points as near as this are one, as a share of the reach; so are loops that are nowhere wider.
const SAME: f64 = 1e-10;
/// A circle about B with a radius below this is B, as a share of the reach.
const AT_BASE: f64 = 1e-6;

/// A boundary: loops with what they hold on their left.
#[derive(Clone, Debug, Default)]
pub(super) struct Traced {
    /// m².
    pub area: f64,
    pub loops: Vec<Vec<[f64; 2]>>,
}

/// Where an edge leads to: the end there, whether it comes from its inner side, and by which way.
#[derive(Clone, Copy, Debug)]
struct Link {
    to: usize,
    from_inside: bool,
    way: Way,
}

#[derive(Clone, Copy, Debug)]
enum Way {
    /// Points of a step, first to last, or back.
    Edge { step: usize, points: [usize; 2], back: bool },
    /// Along a circle of this radius by this angle, m and rad.
    Circle { r: f64, by: f64 },
}

/// An end of the workspace on a circle.
#[derive(Clone, Copy, Debug)]
struct Node {
    at: Vector,
    angle: f64,
    opens: bool,
    /// Inwards and outwards.
    links: [Option<Link>; 2],
}

impl Rings {
    /// The boundary that joins all ends.
    pub fn traced(&self) -> Traced {
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
                Some(Step::On { first, to, .. }) => all.goes_on(j, *first, to),
                _ => all.changes(Some(j), self.rings.get(j + 1).map(|_| j + 1)),
            }
        }
        if self.rings.first().is_some_and(|ring| !ring.ends.is_empty() || ring.r > AT_BASE * far) {
            all.changes(None, Some(0));
        }
        let mut loops = all.walked();
        let signed = |line: &[Vector]| -> f64 {
            let pairs = line.iter().zip(line.iter().cycle().skip(1));
            pairs.map(|(a, b)| 0.5 * (a.conj() * b).im).sum()
        };
        let area = loops.iter().map(|line| signed(line)).sum::<f64>() + self.beside;
        for line in &mut loops {
            line.dedup_by(|p, last| (*p - *last).norm() <= SAME * far);
            while line.len() > 1 && (line[0] - line[line.len() - 1]).norm() <= SAME * far {
                line.pop();
            }
        }
        loops.retain(|line| line.len() > 2 && signed(line).abs() > 10.0 * SAME * far * far);
        let flat = |line: Vec<Vector>| line.into_iter().map(|p| [p.re, p.im]).collect();
        Traced { area, loops: loops.into_iter().map(flat).collect() }
    }
}

struct All<'a> {
    of: &'a Rings,
    nodes: Vec<Node>,
    /// The first end of each circle.
    first: Vec<usize>,
    /// Whole circles.
    circles: Vec<Vec<Vector>>,
}

impl All<'_> {
    fn goes_on(&mut self, j: usize, turned: usize, upto: &[usize]) {
        let n = upto.len();
        for i in 0..n {
            let points = [if i > 0 { upto[i - 1] } else { 0 }, upto[i]];
            let (from, to) = (self.first[j] + i, self.first[j + 1] + (i + turned) % n);
            let way = |back| Way::Edge { step: j, points, back };
            self.nodes[from].links[1] = Some(Link { to, from_inside: true, way: way(false) });
            self.nodes[to].links[0] = Some(Link { to: from, from_inside: false, way: way(true) });
        }
    }

    /// Joins the ends on the outer side of a circle and on the inner side of another that is the same, along it; nothing
    /// lies beyond the last one and inside of the first.
    fn changes(&mut self, inner: Option<usize>, outer: Option<usize>) {
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

    /// Points along a circle from one, without that and the last.
    fn arc(&self, from: Vector, r: f64, by: f64, line: &mut Vec<Vector>) {
        let parts = (by.abs() * (r / (8.0 * self.of.chord)).sqrt()).ceil().min(1e5);
        let count = parts as usize;
        line.extend((1..count).map(|i| from * unit(by * i as f64 / parts)));
    }

    /// All loops, with what they hold on their left.
    fn walked(&mut self) -> Vec<Vec<Vector>> {
        let mut loops = std::mem::take(&mut self.circles);
        let mut seen = vec![false; self.nodes.len()];
        for start in 0..self.nodes.len() {
            // Where it opens, outwards has the workspace on its left.
            let (mut at, mut outwards) = (start, self.nodes[start].opens);
            let mut line = Vec::new();
            while !seen[at] {
                seen[at] = true;
                line.push(self.nodes[at].at);
                let Some(link) = self.nodes[at].links[usize::from(outwards)] else { break };
                match link.way {
                    Way::Circle { r, by } => self.arc(self.nodes[at].at, r, by, &mut line),
                    Way::Edge { step, points: [from, to], back } => {
                        if let Step::On { points, .. } = &self.of.steps[step] {
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
