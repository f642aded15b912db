//! How far the end effector goes while b is held.
//!
//! b only turns the workspace about B, so a point at a distance r belongs to it at the angles φ = (b − β)/Σλ for every
//! β that reaches the point on the x axis. Its boundary is what the ends of these β make of r.

use std::f64::consts::{PI, TAU};

use super::reach::{Seen, Work};
use super::space::PoseSpace;
use crate::mechanics::planar::{Vector, dot, unit};

/// A workspace of b: a region, or with two drives a curve.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outline {
    /// m²; 0 with two drives.
    pub area: f64,
    /// Length of the curve of two drives, m.
    pub length: f64,
    /// Least and greatest x and y, m.
    pub extent: [f64; 4],
    /// The boundary, each loop closed, outer ones counter-clockwise, m.
    pub loops: Vec<Vec<[f64; 2]>>,
    /// The curve of two drives, m.
    pub curve: Vec<[f64; 2]>,
}

/// Chords are as near to the boundary as this, m for an arm of a metre.
const CHORD: f64 = 1e-5;
/// Between two distances it runs along the circle by no more than this, as a share of the reach.
const RUN: f64 = 0.05;
/// Where the boundary turns back it is found to this, as a share of the reach.
const FOUND: f64 = 1e-9;
/// Distances to begin with.
const FIRST: usize = 48;
/// The most distances that are looked at.
const MOST: usize = 6000;

impl Outline {
    /// How far a point, m, is from the boundary, negative outside; of two drives how far from their curve.
    pub fn distance(&self, p: Vector) -> f64 {
        let at = |[x, y]: [f64; 2]| Vector::new(x, y);
        let beside = |line: &[[f64; 2]]| {
            let spaces = line.windows(2).map(|w| {
                let (from, way) = (at(w[0]), at(w[1]) - at(w[0]));
                let share = dot(p - from, way) / way.norm_sqr();
                (p - from - way * if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 }).norm()
            });
            spaces.chain(line.first().map(|x| (p - at(*x)).norm())).fold(f64::INFINITY, f64::min)
        };
        if self.loops.is_empty() {
            return beside(&self.curve);
        }
        let closed = |line: &Vec<[f64; 2]>| line.iter().chain(line.first()).copied().collect::<Vec<_>>();
        let loops: Vec<Vec<[f64; 2]>> = self.loops.iter().map(closed).collect();
        let far = loops.iter().map(|line| beside(line)).fold(f64::INFINITY, f64::min);
        // A ray to the right crosses the boundary an odd number of times from inside.
        let crosses = |w: &&[[f64; 2]]| {
            let ([ax, ay], [bx, by]) = (w[0], w[1]);
            (ay > p.im) != (by > p.im) && p.re < ax + (p.im - ay) / (by - ay) * (bx - ax)
        };
        let inside = loops.iter().flat_map(|line| line.windows(2)).filter(crosses).count() % 2 == 1;
        if inside { far } else { -far }
    }
}

/// What of a circle about B belongs to the workspace: angles [from, to], rad.
#[derive(Clone, Debug)]
struct Ring {
    r: f64,
    arcs: Vec<[f64; 2]>,
    whole: bool,
    seen: Seen,
}

impl Ring {
    fn angle(&self) -> f64 {
        if self.whole { TAU } else { self.arcs.iter().map(|[from, to]| to - from).sum() }
    }
}

impl PoseSpace {
    /// The workspace of b.
    pub fn outline(&self, b: f64) -> Outline {
        self.outline_within(b, CHORD, &mut |_| true).unwrap_or_default()
    }

    /// The same, with chords as near to the boundary as this, m for an arm of a metre; two drives have what they have.
    /// Told how much is done, from 0 to 1, the caller says whether the rest is still wanted; `None` if it is not.
    pub fn outline_within(&self, b: f64, chord: f64, goes_on: &mut dyn FnMut(f64) -> bool) -> Option<Outline> {
        Some(match self.drives() {
            1 => {
                let place = self.place(&self.lift(&[], b));
                let at = [place.re, place.im];
                Outline { curve: vec![at], extent: [at[0], at[0], at[1], at[1]], ..Outline::default() }
            }
            2 => self.curve(b),
            _ => self.region(b, chord, goes_on)?,
        })
    }

    /// Two drives: where the end effector goes as the angle between them runs from limit to limit.
    fn curve(&self, b: f64) -> Outline {
        let [low, high] = self.joints[0].limits;
        let place = |a: f64| self.place(&self.lift(&[a], b));
        let speed = |a: f64| {
            let q = self.lift(&[a], b);
            let rate = self.lift(&[a + 1.0], b).0.minus(&q.0);
            (0..2).map(|k| self.tip[k] * rate[k] * unit(q[k])).sum::<Vector>().norm()
        };
        // Chords by the curvature: |p″| is at most Σ |c|.
        let turns = (high - low) * (self.farthest() / (8.0 * CHORD * self.farthest().max(1e-3))).sqrt();
        let parts = (turns.ceil() as usize).clamp(16, 4000) & !1;
        let at = |i: usize| low + (high - low) * i as f64 / parts as f64;
        let curve: Vec<[f64; 2]> = (0..=parts).map(|i| place(at(i))).map(|p| [p.re, p.im]).collect();
        let h = (high - low) / parts as f64;
        let weight = |i: usize| {
            if i == 0 || i == parts {
                1.0
            } else if i % 2 == 1 {
                4.0
            } else {
                2.0
            }
        };
        let length = (0..=parts).map(|i| weight(i) * speed(at(i))).sum::<f64>() * h / 3.0;
        Outline { length, extent: extent(curve.iter()), curve, ..Outline::default() }
    }

    fn region(&self, b: f64, chord: f64, goes_on: &mut dyn FnMut(f64) -> bool) -> Option<Outline> {
        let (near, far) = (self.nearest(), self.farthest());
        let span = far - near;
        let at = |i: usize| near + span * (i as f64 + if i == 0 { FOUND } else { 0.0 }) / FIRST as f64;
        let mut sweep =
            Sweep { space: self, b, chord, work: Work::default(), rings: Vec::new(), area: 0.0, budget: MOST };
        let mut from = sweep.ring(at(0), &[]);
        for i in 1..=FIRST {
            if !goes_on((i - 1) as f64 / FIRST as f64) {
                return None;
            }
            let r = if i == FIRST { far * (1.0 - FOUND) } else { at(i) };
            let to = sweep.ring(r, &[]);
            sweep.rings.push(from.clone());
            sweep.refine(&from, &to);
            from = to;
        }
        sweep.rings.push(from);
        let loops = chained(&sweep.rings);
        let extent = extent(loops.iter().flatten());
        Some(Outline { area: sweep.area, extent, loops, ..Outline::default() })
    }
}

/// Rings of a workspace from the inside outwards.
struct Sweep<'a> {
    space: &'a PoseSpace,
    b: f64,
    chord: f64,
    work: Work,
    rings: Vec<Ring>,
    /// m².
    area: f64,
    /// How many rings may still be looked at.
    budget: usize,
}

impl Sweep<'_> {
    fn ring(&mut self, r: f64, beside: &[&Seen]) -> Ring {
        let (set, seen) = self.space.reach_of(r, beside, &mut self.work);
        let whole = matches!(set.intervals[..], [[_, to]] if to >= set.period && set.intervals[0][0] == 0.0);
        let turned = |b: f64| (self.b - b) / self.space.sum;
        let mut arcs: Vec<[f64; 2]> =
            set.intervals.iter().rev().map(|[low, high]| [turned(*high), turned(*low)]).collect();
        if whole {
            arcs.clear();
        }
        Ring { r, arcs, whole, seen }
    }

    /// Rings between two, so close that straight lines join them.
    fn refine(&mut self, from: &Ring, to: &Ring) {
        let middle = self.ring(0.5 * (from.r + to.r), &[&from.seen, &to.seen]);
        self.budget = self.budget.saturating_sub(1);
        let far = self.space.farthest();
        let alike = |x: &Ring, y: &Ring| x.whole == y.whole && x.arcs.len() == y.arcs.len();
        let width = to.r - from.r;
        let smooth = alike(from, &middle) && alike(&middle, to) && {
            let bent = |i: usize, end: usize| {
                let [a, m, c] = [from, &middle, to].map(|ring| ring.arcs[i][end]);
                let off = (turned(a, m) + turned(c, m)) * 0.5 * middle.r;
                // Across the chord: an edge that runs along the circle hardly bends.
                let run = (turned(c, a) * middle.r).hypot(width);
                off.abs() * width / run <= self.chord * 0.8
                    && (turned(a, m).abs() + turned(c, m).abs()) * middle.r < RUN * far
            };
            (0..from.arcs.len()).all(|i| !(!bent(i, 0) || !bent(i, 1)))
        };
        if smooth || width <= FOUND * far || self.budget == 0 {
            self.area += width / 6.0 * (from.r * from.angle() + 4.0 * middle.r * middle.angle() + to.r * to.angle());
            self.rings.push(middle);
            return;
        }
        self.refine(from, &middle);
        self.rings.push(middle.clone());
        self.refine(&middle, to);
    }
}

/// x − y by the shorter way round, rad.
fn turned(x: f64, y: f64) -> f64 {
    let by = x - y;
    by - TAU * (by / TAU).round()
}

fn extent<'a>(points: impl Iterator<Item = &'a [f64; 2]>) -> [f64; 4] {
    let none = [f64::INFINITY, f64::NEG_INFINITY, f64::INFINITY, f64::NEG_INFINITY];
    let all = points.fold(none, |[a, b, c, d], p| [a.min(p[0]), b.max(p[0]), c.min(p[1]), d.max(p[1])]);
    if all[0].is_finite() { all } else { [0.0; 4] }
}

/// An end of an arc: of which ring, which arc, and which end.
type End = (usize, usize, usize);

/// The ends of arcs joined from ring to ring, and where arcs begin, cease, part or meet, with each other.
fn chained(rings: &[Ring]) -> Vec<Vec<[f64; 2]>> {
    let ends = |j: usize| (0..rings[j].arcs.len()).flat_map(move |i| [(j, i, 0), (j, i, 1)]);
    let angle = |(j, i, end): End| rings[j].arcs[i][end];
    // Links to the ring after, and to the one before.
    let first: Vec<usize> = rings
        .iter()
        .scan(0, |ends, ring| {
            *ends += 2 * ring.arcs.len();
            Some(*ends - 2 * ring.arcs.len())
        })
        .collect();
    let index = |(j, i, end): End| first[j] + 2 * i + end;
    let all: Vec<End> = (0..rings.len()).flat_map(ends).collect();
    let mut links: Vec<[Option<usize>; 2]> = vec![[None; 2]; all.len()];
    for j in 0..rings.len().saturating_sub(1) {
        let nearest = |of: End, on: usize| {
            let same = ends(on).filter(|e| e.2 == of.2);
            same.min_by(|x, y| turned(angle(*x), angle(of)).abs().total_cmp(&turned(angle(*y), angle(of)).abs()))
        };
        for from in ends(j) {
            let Some(to) = nearest(from, j + 1) else { continue };
            if nearest(to, j) == Some(from) && turned(angle(to), angle(from)).abs() < 0.5 {
                links[index(from)][0] = Some(index(to));
                links[index(to)][1] = Some(index(from));
            }
        }
    }
    for j in 0..rings.len() {
        for side in 0..2 {
            let mut open: Vec<End> = ends(j).filter(|e| links[index(*e)].get(side) == Some(&None)).collect();
            open.sort_by(|x, y| angle(*x).rem_euclid(TAU).total_cmp(&angle(*y).rem_euclid(TAU)));
            // The nearest two of different kind, until none is left.
            while open.len() > 1 {
                let n = open.len();
                let gap = |i: usize| turned(angle(open[(i + 1) % n]), angle(open[i])).abs();
                let fits = |i: &usize| open[*i].2 != open[(*i + 1) % n].2;
                let Some(i) = (0..n).filter(fits).min_by(|x, y| gap(*x).total_cmp(&gap(*y))) else { break };
                let (a, b) = (open[i], open[(i + 1) % n]);
                links[index(a)][side] = Some(index(b));
                links[index(b)][side] = Some(index(a));
                open.retain(|e| *e != a && *e != b);
            }
        }
    }
    let place = |i: usize| {
        let (j, ..) = all[i];
        let p = rings[j].r * unit(angle(all[i]));
        [p.re, p.im]
    };
    let mut seen = vec![false; all.len()];
    let mut loops: Vec<Vec<[f64; 2]>> = Vec::new();
    for start in 0..all.len() {
        let (mut at, mut side, mut line) = (start, 0, Vec::new());
        while !seen[at] {
            seen[at] = true;
            line.push(place(at));
            let Some(next) = links[at][side] else { break };
            // Along the same ring the way turns back.
            let stays = all[next].0 == all[at].0;
            side = if stays { 1 - side } else { side };
            at = next;
        }
        if line.len() > 2 {
            loops.push(line);
        }
    }
    // Where whole circles begin or end.
    for (j, ring) in rings.iter().enumerate() {
        let without = |k: Option<usize>| k.and_then(|k| rings.get(k)).is_none_or(|r| !r.whole && r.arcs.is_empty());
        let inner = j == 0 && ring.r < 1e-6 * rings[rings.len() - 1].r;
        if ring.whole && ((without(j.checked_sub(1)) && !inner) || without(Some(j + 1))) {
            let parts = ((PI * (ring.r / (2.0 * CHORD)).sqrt()).ceil() as usize).clamp(24, 4000);
            let on = |i: usize| ring.r * unit(TAU * i as f64 / parts as f64);
            loops.push((0..parts).map(on).map(|p| [p.re, p.im]).collect());
        }
    }
    oriented(loops)
}

/// Outer loops counter-clockwise, holes clockwise.
fn oriented(mut loops: Vec<Vec<[f64; 2]>>) -> Vec<Vec<[f64; 2]>> {
    let depth: Vec<usize> = (0..loops.len())
        .map(|i| (0..loops.len()).filter(|j| *j != i && holds(&loops[*j], loops[i][0])).count())
        .collect();
    for (line, depth) in loops.iter_mut().zip(depth) {
        if (signed(line) > 0.0) != depth.is_multiple_of(2) {
            line.reverse();
        }
    }
    loops
}

fn signed(line: &[[f64; 2]]) -> f64 {
    let n = line.len();
    (0..n).map(|i| (line[i], line[(i + 1) % n])).map(|(a, b)| 0.5 * (a[0] * b[1] - a[1] * b[0])).sum()
}

fn holds(line: &[[f64; 2]], p: [f64; 2]) -> bool {
    let n = line.len();
    let crosses = |i: &usize| {
        let (a, b) = (line[*i], line[(*i + 1) % n]);
        (a[1] > p[1]) != (b[1] > p[1]) && p[0] < a[0] + (p[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
    };
    (0..n).filter(crosses).count() % 2 == 1
}
