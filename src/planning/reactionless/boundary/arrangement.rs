//! Arrangement of the spans: their intersections, the number of poses on both sides of each part, and loops of parts.

use std::collections::VecDeque;

use super::balance::{self, CurveEdge};
use super::cycle::Cycle;
use super::span::{BoundarySpan, Surface};
use stillbase_mechanics::planar::{Vector, cross, dot};

/// Intersections on a span are equal if their parameters differ by less than this.
const INTERSECTION_TOLERANCE: f64 = 1e-11;
/// Ends within this distance are joined, as a fraction of the unit of the map.
const JOIN_TOLERANCE: f64 = 1e-9;
/// Parts shorter than this are taken to touch without crossing, if their chords are still not separated. It is a
/// fraction of the unit of the map.
const MIN_LENGTH: f64 = 1e-9;
/// Maximum number of pairs of parts that are tested for two spans; beyond it, the spans are taken to overlap.
const MAX_PAIRS: usize = 3000;
/// Number of remaining pairs at which the spans are tested for an overlap.
const OVERLAP_CHECK_AT: usize = MAX_PAIRS - 100;
/// Crossings within this distance of a common end of two curves are ignored, as a fraction of the reach. The curves
/// touch there, or enclose a sliver of negligible area.
const TOUCH_RADIUS: f64 = 1e-4;
/// Points within this distance of a curve lie on it, as a fraction of the unit of the map.
const ON_CURVE_TOLERANCE: f64 = 1e-11;

/// A part of a span.
#[derive(Clone, Copy, Debug)]
pub(super) struct SpanPart {
    pub span: usize,
    pub from: f64,
    pub to: f64,
}

/// A curve between two intersections, with a constant number of poses on each side.
#[derive(Clone, Debug)]
pub(super) struct Strand {
    pub parts: Vec<SpanPart>,
    /// Number of poses of the points on its left.
    pub left: i32,
    /// Number of poses of the points on its right.
    pub right: i32,
}

impl Strand {
    /// Whether it bounds the set of points with at least `n` poses.
    pub fn bounds(&self, n: i32) -> bool {
        self.left >= n && self.right < n
    }
}

pub(super) struct Arrangement<'a> {
    on: &'a Surface,
    cycle: &'a Cycle,
    spans: &'a [BoundarySpan],
    /// Distance from a common end within which crossings are ignored, m.
    tip: f64,
    /// Unit of the map, m.
    unit: f64,
}

#[derive(Clone, Copy)]
struct Part {
    range: [f64; 2],
    at: [Vector; 2],
}

impl Part {
    fn of(span: &BoundarySpan) -> Self {
        Self { range: [0.0, 1.0], at: span.at }
    }

    fn deviation(&self, span: &BoundarySpan, unit: f64) -> f64 {
        span.deviation * (self.range[1] - self.range[0]).powi(2) + 1e-16 * unit
    }

    fn halves(&self, on: &Surface, span: &BoundarySpan) -> [Self; 2] {
        let middle = 0.5 * (self.range[0] + self.range[1]);
        let at = on.at(span, middle);
        [
            Self { range: [self.range[0], middle], at: [self.at[0], at] },
            Self { range: [middle, self.range[1]], at: [at, self.at[1]] },
        ]
    }
}

impl<'a> Arrangement<'a> {
    pub fn of(on: &'a Surface, cycle: &'a Cycle) -> Self {
        let reach: f64 = on.map.c().iter().map(|c| c.abs()).sum();
        Self { on, cycle, spans: &cycle.spans, tip: TOUCH_RADIUS * reach, unit: on.map.unit() }
    }

    /// Returns all curves, split at their intersections.
    pub fn strands(&self) -> Vec<Strand> {
        let strand = |parts: Vec<SpanPart>| {
            // The longest parts first: short ones may lie in a sliver that is too narrow to separate its sides.
            let mut order: Vec<(f64, &SpanPart)> = parts.iter().map(|p| (self.chord(p), p)).collect();
            order.sort_by(|a, b| b.0.total_cmp(&a.0));
            let mut samples = order.iter().take(5).map(|(_, portion)| self.sides(portion));
            let first = samples.next().unwrap_or(Err([0; 2]));
            // If curves coincide no sample is valid, and the first one is taken.
            let [left, right] = first
                .or_else(|unresolved| samples.find_map(Result::ok).ok_or(unresolved))
                .unwrap_or_else(|unresolved| unresolved);
            Strand { parts, left, right }
        };
        let mut strands: Vec<Strand> = self.uncrossed().into_iter().map(strand).collect();
        self.settle(&mut strands);
        strands
    }

    /// Determines the numbers of poses beside strands for which no sample gave them, from neighbouring strands.
    fn settle(&self, strands: &mut [Strand]) {
        let weight = |s: &Strand| self.spans[s.parts[0].span].weight();
        if strands.iter().all(|s| s.left - s.right == weight(s)) {
            return;
        }
        let mut nodes: Vec<Vector> = Vec::new();
        let mut node = |p: &SpanPart, t: f64| {
            let at = self.on.at(&self.spans[p.span], t);
            nodes.iter().position(|n| (n - at).norm() < JOIN_TOLERANCE * self.unit).unwrap_or_else(|| {
                nodes.push(at);
                nodes.len() - 1
            })
        };
        let mut edge = |s: &Strand| {
            let (first, last) = (s.parts[0], s.parts[s.parts.len() - 1]);
            CurveEdge {
                ends: [node(&first, first.from), node(&last, last.to)],
                weight: weight(s),
                sides: [s.left, s.right],
                length: s.parts.iter().map(|p| self.chord(p)).sum(),
            }
        };
        let mut edges: Vec<CurveEdge> = strands.iter().map(&mut edge).collect();
        balance::resolve_sides(&mut edges);
        for (strand, edge) in strands.iter_mut().zip(edges) {
            [strand.left, strand.right] = edge.sides;
        }
    }

    fn chord(&self, p: &SpanPart) -> f64 {
        let span = &self.spans[p.span];
        (self.on.at(span, p.to) - self.on.at(span, p.from)).norm()
    }

    /// Returns the pieces of all curves between their intersections.
    fn uncrossed(&self) -> Vec<Vec<SpanPart>> {
        let mut strands: Vec<Vec<SpanPart>> = Vec::new();
        let mut open = false;
        for (i, mut intersections) in self.intersections().into_iter().enumerate() {
            let span = &self.spans[i];
            let free = |end: f64| !intersections.iter().any(|t| (t - end).abs() < 1e-7);
            let follows = i > 0 && {
                let last = &self.spans[i - 1];
                last.ends[1] == span.ends[0] && last.curve == span.curve
            };
            let (joined, open_after) = (open && follows && free(0.0), free(1.0));
            intersections.push(0.0);
            intersections.push(1.0);
            intersections.sort_by(f64::total_cmp);
            intersections.dedup_by(|next, last| *next - *last < INTERSECTION_TOLERANCE);
            // Keep the exact end, which may have been removed as a duplicate.
            if let Some(last) = intersections.last_mut() {
                *last = 1.0;
            }
            for (n, w) in intersections.windows(2).enumerate() {
                let portion = SpanPart { span: i, from: w[0], to: w[1] };
                match strands.last_mut() {
                    Some(strand) if n == 0 && joined => strand.push(portion),
                    _ => strands.push(vec![portion]),
                }
            }
            open = open_after;
        }
        strands
    }

    /// Returns the number of poses on the left and on the right of a part. If another curve is too close, the error
    /// contains the last sample.
    fn sides(&self, portion: &SpanPart) -> Result<[i32; 2], [i32; 2]> {
        let span = &self.spans[portion.span];
        let (mut unresolved, mut alike) = ([0; 2], 0);
        // The offsets are so small that usually no other curve lies between, even near a tangency. Otherwise further
        // offsets and places are tried.
        for reach in [1e-11, 1e-12, 1e-9].map(|share| share * self.unit) {
            for share in [0.5, 0.31, 0.77, 0.13, 0.91] {
                let jet = self.on.jet(span, portion.from + share * (portion.to - portion.from));
                let speed = jet.rate.norm();
                let aside = Vector::new(-jet.rate.im, jet.rate.re) * (reach / speed);
                if !(aside.is_finite() && reach < 0.1 * speed * (portion.to - portion.from)) {
                    continue;
                }
                let sides = [jet.at + aside, jet.at - aside].map(|p| self.cycle.poses_at(self.on, p));
                if sides[0] - sides[1] == span.weight() {
                    return Ok(sides);
                }
                // The same result at several places: another curve coincides.
                alike = if sides == unresolved { alike + 1 } else { 0 };
                unresolved = sides;
                if alike == 3 {
                    return Err(unresolved);
                }
            }
        }
        Err(unresolved)
    }

    /// Returns the parts of strands that bound the points with at least `n` poses.
    pub fn level(&self, strands: &[Strand], n: i32) -> Vec<SpanPart> {
        self.without_doubles(strands.iter().filter(|s| s.bounds(n)).flat_map(|s| &s.parts))
    }

    /// Removes duplicates: coinciding curves count once.
    fn without_doubles<'b>(&self, portions: impl Iterator<Item = &'b SpanPart>) -> Vec<SpanPart> {
        let ends = |p: &SpanPart| [p.from, p.to].map(|t| self.on.at(&self.spans[p.span], t));
        let near = |a: Vector, b: Vector| (a - b).norm() < JOIN_TOLERANCE * self.unit;
        let mut kept: Vec<(SpanPart, [Vector; 2])> = Vec::new();
        for &portion in portions {
            let [from, to] = ends(&portion);
            let middle = |p: &SpanPart| self.on.at(&self.spans[p.span], 0.5 * (p.from + p.to));
            let double = kept.iter().any(|(other, [f, t])| {
                near(*f, from) && near(*t, to) && near(middle(other), middle(&portion)) && !near(from, to)
            });
            if !double {
                kept.push((portion, [from, to]));
            }
        }
        kept.into_iter().map(|(portion, _)| portion).collect()
    }

    /// Returns the parameters of the intersections of each span.
    fn intersections(&self) -> Vec<Vec<f64>> {
        let mut intersections = vec![Vec::new(); self.spans.len()];
        let mut order: Vec<usize> = (0..self.spans.len()).collect();
        order.sort_by(|&i, &j| self.cycle.bounds[i].low.re.total_cmp(&self.cycle.bounds[j].low.re));
        let mut work = VecDeque::new();
        for (n, &i) in order.iter().enumerate() {
            let a = &self.cycle.bounds[i];
            for &j in &order[n + 1..] {
                let b = &self.cycle.bounds[j];
                if b.low.re > a.high.re {
                    break;
                }
                if b.low.im > a.high.im || b.high.im < a.low.im || self.continues(i, j) {
                    continue;
                }
                self.cross(i, j, &mut intersections, &mut work);
            }
        }
        intersections
    }

    /// Whether one span continues the other on the same curve without turning back: then they do not intersect.
    fn continues(&self, i: usize, j: usize) -> bool {
        let (a, b) = (&self.spans[i], &self.spans[j]);
        let joined = a.ends[1] == b.ends[0] || b.ends[1] == a.ends[0];
        joined && a.curve == b.curve && {
            let (along_a, along_b) = (a.at[1] - a.at[0], b.at[1] - b.at[0]);
            dot(along_a, along_b) > 0.5 * along_a.norm() * along_b.norm()
                && a.deviation < 0.1 * along_a.norm()
                && b.deviation < 0.1 * along_b.norm()
        }
    }

    fn cross(&self, i: usize, j: usize, intersections: &mut [Vec<f64>], work: &mut VecDeque<(Part, Part)>) {
        let (a, b) = (&self.spans[i], &self.spans[j]);
        work.clear();
        work.push_back((Part::of(a), Part::of(b)));
        let tip = a.ends.into_iter().zip(a.at).find(|(end, _)| b.ends.contains(end)).map(|(_, at)| at);
        let mut remaining_pairs = MAX_PAIRS;
        while let Some((pa, pb)) = work.pop_front() {
            remaining_pairs -= 1;
            if remaining_pairs == 0 || (remaining_pairs == OVERLAP_CHECK_AT && self.run_along(i, j)) {
                self.overlap(i, j, intersections);
                return;
            }
            let at_tip = |tip: Vector| pa.at.iter().chain(&pb.at).all(|p| (p - tip).norm_sqr() < self.tip * self.tip);
            if tip.is_some_and(at_tip) {
                continue;
            }
            let (da, db) = (pa.deviation(a, self.unit), pb.deviation(b, self.unit));
            if apart(pa.at, pb.at, da + db) {
                continue;
            }
            let (va, vb) = (pa.at[1] - pa.at[0], pb.at[1] - pb.at[0]);
            let (la, lb) = (va.norm(), vb.norm());
            // Are both parts straight enough to intersect at most once?
            let bend = 5.0 * (da / la + db / lb);
            if bend < 0.5 && cross(va, vb).abs() > bend * la * lb {
                if let Some([t, s]) = self.meet(a, b, &pa, &pb) {
                    intersections[i].push(t);
                    intersections[j].push(s);
                }
            } else if la.max(lb) > MIN_LENGTH * self.unit || da + db > MIN_LENGTH * self.unit {
                if la + da > lb + db {
                    pa.halves(self.on, a).into_iter().for_each(|half| work.push_back((half, pb)));
                } else {
                    pb.halves(self.on, b).into_iter().for_each(|half| work.push_back((pa, half)));
                }
            }
        }
    }

    /// Solves P_A(t) = P_B(s) by Newton's iteration from the intersection of the chords; `None` if the solution is
    /// outside either part.
    fn meet(&self, a: &BoundarySpan, b: &BoundarySpan, pa: &Part, pb: &Part) -> Option<[f64; 2]> {
        let (va, vb) = (pa.at[1] - pa.at[0], pb.at[1] - pb.at[0]);
        let (ta, tb) = (pa.range[1] - pa.range[0], pb.range[1] - pb.range[0]);
        let gap = pb.at[0] - pa.at[0];
        let n = cross(va, vb);
        let mut t = pa.range[0] + (cross(gap, vb) / n).clamp(0.0, 1.0) * ta;
        let mut s = pb.range[0] + (cross(gap, va) / n).clamp(0.0, 1.0) * tb;
        // Both parts are nearly straight, so the iterates stay close to them.
        let near = |x: f64, [low, high]: [f64; 2]| {
            let margin = 0.1 * (high - low);
            x.clamp((low - margin).max(0.0), (high + margin).min(1.0))
        };
        let within = |x: f64, r: [f64; 2]| x >= r[0] - INTERSECTION_TOLERANCE && x <= r[1] + INTERSECTION_TOLERANCE;
        for _ in 0..16 {
            let (ja, jb) = (self.on.jet(a, t), self.on.jet(b, s));
            let gap = jb.at - ja.at;
            let n = cross(ja.rate, jb.rate);
            let step = [cross(gap, jb.rate) / n, cross(gap, ja.rate) / n];
            if step[0].abs() < 1e-13 && step[1].abs() < 1e-13 {
                break;
            }
            if !(step[0].is_finite() && step[1].is_finite()) {
                return None;
            }
            (t, s) = (near(t + step[0], pa.range), near(s + step[1], pb.range));
        }
        let meets = (self.on.at(a, t) - self.on.at(b, s)).norm() < 1e-12 * self.unit;
        (meets && within(t, pa.range) && within(s, pb.range)).then_some([t, s])
    }

    /// Splits two overlapping spans, each at the ends of the other.
    fn overlap(&self, i: usize, j: usize, intersections: &mut [Vec<f64>]) {
        for (one, other) in [(i, j), (j, i)] {
            for end in self.spans[one].at {
                let (t, gap) = self.foot(&self.spans[other], end);
                if gap < JOIN_TOLERANCE * self.unit {
                    intersections[other].push(t);
                }
            }
        }
    }

    /// Whether two spans overlap: they share two points, and the samples between these points.
    fn run_along(&self, i: usize, j: usize) -> bool {
        let (a, b) = (&self.spans[i], &self.spans[j]);
        let on_both = |t: f64| self.foot(b, self.on.at(a, t)).1 < ON_CURVE_TOLERANCE * self.unit;
        let ends = [0.0, 1.0].into_iter().filter(|&t| on_both(t));
        let others =
            b.at.into_iter()
                .map(|end| self.foot(a, end))
                .filter(|(_, gap)| *gap < ON_CURVE_TOLERANCE * self.unit)
                .map(|(t, _)| t);
        let (low, high) = ends.chain(others).fold((1.0_f64, 0.0_f64), |(low, high), t| (low.min(t), high.max(t)));
        high - low > 1e-6 && [0.5, 0.3, 0.8].into_iter().all(|share| on_both(low + share * (high - low)))
    }

    /// Returns the parameter of the nearest point of a span, and its distance from p, m.
    fn foot(&self, span: &BoundarySpan, p: Vector) -> (f64, f64) {
        let mut t = 0.5;
        for _ in 0..40 {
            let jet = self.on.jet(span, t);
            let step = dot(p - jet.at, jet.rate) / jet.rate.norm_sqr();
            if !step.is_finite() {
                break;
            }
            let before = t;
            t = (t + step).clamp(0.0, 1.0);
            if (t - before).abs() < 1e-14 {
                break;
            }
        }
        (t, (self.on.at(span, t) - p).norm())
    }

    /// Joins parts end to start. Of several continuations it takes the leftmost turn, so that loops do not cross
    /// themselves.
    pub fn chain(&self, portions: Vec<SpanPart>) -> Vec<Vec<SpanPart>> {
        let at = |p: &SpanPart, share: f64| self.on.at(&self.spans[p.span], p.from + share * (p.to - p.from));
        let starts: Vec<Vector> = portions.iter().map(|p| at(p, 0.0)).collect();
        let ends: Vec<Vector> = portions.iter().map(|p| at(p, 1.0)).collect();
        let mut used = vec![false; portions.len()];
        let mut loops = Vec::new();
        for first in 0..portions.len() {
            if used[first] {
                continue;
            }
            let mut chain = vec![portions[first]];
            used[first] = true;
            let mut last = first;
            while (ends[last] - starts[first]).norm() > JOIN_TOLERANCE * self.unit {
                let along = ends[last] - at(&portions[last], 0.95);
                let turn = |k: usize| {
                    let next = at(&portions[k], 0.05) - starts[k];
                    cross(along, next).atan2(dot(along, next))
                };
                let gap = |k: usize| (starts[k] - ends[last]).norm();
                let free = || (0..portions.len()).filter(|&k| !used[k]);
                let joined = free()
                    .filter(|&k| gap(k) <= JOIN_TOLERANCE * self.unit)
                    .max_by(|&i, &j| turn(i).total_cmp(&turn(j)));
                // Rounding leaves gaps only near a tangency; the nearest start closes them.
                let near = || free().filter(|&k| gap(k) < 1e-5 * self.unit).min_by(|&i, &j| gap(i).total_cmp(&gap(j)));
                let Some(next) = joined.or_else(near) else { break };
                used[next] = true;
                chain.push(portions[next]);
                last = next;
            }
            loops.push(chain);
        }
        loops
    }
}

/// Whether two chords are separated by more than `slack`, m.
fn apart(a: [Vector; 2], b: [Vector; 2], slack: f64) -> bool {
    let out = |p: f64, q: f64, r: f64, s: f64| p.min(q) > r.max(s) + slack || r.min(s) > p.max(q) + slack;
    if out(a[0].re, a[1].re, b[0].re, b[1].re) || out(a[0].im, a[1].im, b[0].im, b[1].im) {
        return true;
    }
    let one_side = |a: [Vector; 2], b: [Vector; 2]| {
        let along = a[1] - a[0];
        let [first, second] = b.map(|p| cross(along, p - a[0]));
        first * second > 0.0 && first.abs().min(second.abs()) > slack * along.norm()
    };
    one_side(a, b) || one_side(b, a)
}
