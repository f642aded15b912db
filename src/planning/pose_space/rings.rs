//! [`Rings`]: what of circles about B belongs to the workspace of a b, and how it goes on from each to the next.

use std::f64::consts::TAU;

use super::covered::Covered;
use super::critical::Spot;
use super::reach::Work;
use super::space::PoseSpace;
use crate::mechanics::planar::{Vector, unit};

/// Circles to begin with.
const FIRST_CIRCLES: usize = 128;
/// Of so many circles one is looked at without what is known of the one before.
const AFRESH_EVERY: usize = 16;
/// Circles between which the boundary changes are found to be as near as this, as a share of the reach: more than twice as
/// far as one is moved.
const FOUND: f64 = 2e-8;
/// The most circles that are looked at, and the most points between them.
const MAX_RINGS: usize = 6000;
const MAX_POINTS: usize = 400_000;
/// Edges of a region do not run along a circle about B; between circles that are as near as [`FOUND`] its ends move by less
/// than this where it begins, ceases, parts or meets, rad.
const JUMP: f64 = 0.02;
/// Halvings of an edge between two circles.
const MAX_DEPTH: usize = 24;
/// Ends as near as this, as a share of the reach, have an edge between them that bends one way.
const CLOSE_ENDS_SHARE: f64 = 5e-3;
/// A reach up to which chords are as near as they are asked for; beyond they grow with it, m.
const LARGE: f64 = 5.0;
/// A point of a curve may miss where a circle has its end by this, as a share of the reach.
const MISSED: f64 = 1e-6;

/// Where the workspace begins or ends on a circle, counter-clockwise.
#[derive(Clone, Copy, Debug)]
pub(super) struct End {
    /// From 0 to 2π, rad.
    pub angle: f64,
    /// Whether it begins here.
    pub opens: bool,
    spot: Spot,
}

/// A circle about B.
#[derive(Clone, Debug, Default)]
pub(super) struct Ring {
    /// m.
    pub r: f64,
    /// By angle: it begins and ends by turns.
    pub ends: Vec<End>,
    /// Without ends: whether all of it belongs to the workspace.
    pub whole: bool,
}

impl Ring {
    /// Whether its point at angle 0 belongs to the workspace.
    pub fn starts_inside(&self) -> bool {
        self.ends.first().map_or(self.whole, |end| !end.opens)
    }

    pub fn at(&self, end: usize) -> Vector {
        self.r * unit(self.ends[end].angle)
    }

    /// The longest arc that only one of two circles has, rad.
    fn apart(&self, other: &Self) -> f64 {
        let has = |ring: &Self, angle: f64| {
            let before = ring.ends.iter().rev().find(|end| end.angle <= angle).or(ring.ends.last());
            before.map_or(ring.whole, |end| end.opens)
        };
        let mut angles: Vec<f64> = self.ends.iter().chain(&other.ends).map(|end| end.angle).collect();
        angles.extend([0.0, TAU]);
        angles.sort_unstable_by(f64::total_cmp);
        let arcs = angles.windows(2).filter(|w| {
            let middle = 0.5 * (w[0] + w[1]);
            has(self, middle) != has(other, middle)
        });
        arcs.map(|w| w[1] - w[0]).fold(0.0, f64::max)
    }

    /// Which end of another circle continues the first of this one, if all do, in the same order.
    fn turned_to(&self, other: &Self) -> Option<usize> {
        let n = self.ends.len();
        if n != other.ends.len() || (n == 0 && self.whole != other.whole) {
            return None;
        }
        let same = |x: &End, y: &End| x.opens == y.opens && x.spot.curve == y.spot.curve;
        (0..n.max(1)).find(|k| (0..n).all(|i| same(&self.ends[i], &other.ends[(i + k) % n])))
    }
}

/// How the boundary goes on from a circle to the next.
#[derive(Clone, Debug)]
pub(super) enum Step {
    /// Every end goes on: the first one to this one of the next circle; the points between, those of each end up to an
    /// index.
    On { first: usize, points: Vec<Vector>, to: Vec<usize> },
    /// It begins, ceases, parts or meets here: both circles are one.
    Changes,
}

/// Circles from the inside outwards.
#[derive(Clone, Debug)]
pub(super) struct Rings {
    pub rings: Vec<Ring>,
    /// One fewer.
    pub steps: Vec<Step>,
    /// What lies between the boundary and its chords, m².
    pub beside: f64,
    /// Chords are as near to circles as this, m.
    pub chord: f64,
    /// How much more than [`JUMP`] of all circles is covered on one side of them only, rad.
    pub jumps: f64,
}

impl PoseSpace {
    /// Circles through the workspace of b, with chords as near to its boundary as this, m. Told how much is done, from 0
    /// to 1, the caller says whether the rest is still wanted; `None` if it is not.
    pub(super) fn rings(&self, b: f64, chord: f64, goes_on: &mut dyn FnMut(f64) -> bool) -> Option<Rings> {
        let carried = self.rings_of(b, chord, [self.drives() > 3, false], goes_on)?;
        if carried.jumps == 0.0 || self.drives() == 3 {
            return Some(carried);
        }
        // What went on from circle to circle was wrong somewhere.
        let afresh = self.rings_of(b, chord, [false, true], goes_on)?;
        Some(if afresh.jumps < carried.jumps { afresh } else { carried })
    }

    /// The same; what is known of a circle may be carried on to the next, and poses may be looked for with all care.
    fn rings_of(
        &self,
        b: f64,
        chord: f64,
        [carries, careful]: [bool; 2],
        goes_on: &mut dyn FnMut(f64) -> bool,
    ) -> Option<Rings> {
        let (near, far) = (self.nearest(), self.farthest());
        let span = far - near;
        let at = |i: usize| near + span * if i == 0 { FOUND } else { i as f64 / FIRST_CIRCLES as f64 };
        let chord = chord * (far / LARGE).max(1.0);
        let mut sweep = Sweep {
            space: self,
            b,
            work: Work::default(),
            carries,
            budget: [MAX_RINGS, MAX_POINTS],
            done: Rings { rings: Vec::new(), steps: Vec::new(), beside: 0.0, chord, jumps: 0.0 },
        };
        sweep.work.looks.careful = careful;
        let mut all: Vec<(f64, Covered)> = Vec::with_capacity(FIRST_CIRCLES + 1);
        for i in 0..=FIRST_CIRCLES {
            if !goes_on(0.5 * i as f64 / FIRST_CIRCLES as f64) {
                return None;
            }
            let r = if i == FIRST_CIRCLES { far * (1.0 - FOUND) } else { at(i) };
            let knows = carries && i % AFRESH_EVERY > 0;
            let last = all.last().map(|(_, covered)| covered).filter(|_| knows);
            let covered = self.covered(r, last.as_slice(), &mut sweep.work);
            all.push(covered);
        }
        // What one of them knows of a part that several pass through all of them know.
        let circles = if carries { 1..all.len() } else { 0..0 };
        for i in circles.clone() {
            let (before, from) = all.split_at_mut(i);
            from[0].1.covers_too(&before[i - 1].1);
        }
        for i in circles.rev() {
            let (before, from) = all.split_at_mut(i);
            before[i - 1].1.covers_too(&from[0].1);
        }
        let mut all = all.into_iter();
        let mut from = all.next().map(|covered| sweep.ringed(covered))?;
        for (i, to) in all.enumerate() {
            if !goes_on(0.5 + 0.5 * i as f64 / FIRST_CIRCLES as f64) {
                return None;
            }
            let to = sweep.ringed(to);
            sweep.between(&from, &to);
            from = to;
        }
        sweep.done.rings.push(from.0);
        Some(sweep.done)
    }
}

struct Sweep<'a> {
    space: &'a PoseSpace,
    b: f64,
    work: Work,
    /// Whether what is known of circles is carried on to those between them.
    carries: bool,
    /// How many circles and points there may still be.
    budget: [usize; 2],
    done: Rings,
}

/// Points of an edge between two circles, and what lies between it and their chords, m².
#[derive(Default)]
struct Edge {
    points: Vec<Vector>,
    beside: f64,
}

impl Sweep<'_> {
    fn ring(&mut self, r: f64, beside: &[&Covered]) -> (Ring, Covered) {
        self.budget[0] = self.budget[0].saturating_sub(1);
        let beside = if self.carries { beside } else { &[] };
        let covered = self.space.covered(r, beside, &mut self.work);
        self.ringed(covered)
    }

    fn ringed(&self, (r, covered): (f64, Covered)) -> (Ring, Covered) {
        let n = covered.ends.len();
        let whole = covered.gaps.iter().all(|gap| *gap);
        // Angles fall where b rises.
        let end = |i: usize| {
            let [before, after] = [covered.gaps[(i + n - 1) % n], covered.gaps[i]];
            let c = &covered.ends[i];
            let angle = self.angle(c.b);
            (before != after).then_some(End { angle, opens: before, spot: c.spot })
        };
        let mut ends: Vec<End> = (0..n).rev().filter_map(end).collect();
        if let Some(least) = (0..ends.len()).min_by(|i, j| ends[*i].angle.total_cmp(&ends[*j].angle)) {
            ends.rotate_left(least);
        }
        (Ring { r, ends, whole }, covered)
    }

    fn angle(&self, b: f64) -> f64 {
        ((self.b - b) / self.space.sum).rem_euclid(TAU)
    }

    /// Notes a circle and what lies between it and the next, with circles between where the boundary changes.
    fn between(&mut self, from: &(Ring, Covered), to: &(Ring, Covered)) {
        let far = self.space.farthest();
        if let Some(step) = self.step(&from.0, &to.0) {
            self.done.rings.push(from.0.clone());
            self.done.steps.push(step);
        } else if to.0.r - from.0.r <= FOUND * far || self.budget[0] == 0 {
            if to.0.r - from.0.r <= FOUND * far {
                self.done.jumps += (from.0.apart(&to.0) - JUMP).max(0.0);
            }
            self.done.rings.push(from.0.clone());
            self.done.steps.push(Step::Changes);
        } else {
            let middle = self.ring(0.5 * (from.0.r + to.0.r), &[&from.1, &to.1]);
            self.between(from, &middle);
            self.between(&middle, to);
        }
    }

    /// What lies between two circles if every end goes on from one to the other.
    fn step(&mut self, from: &Ring, to: &Ring) -> Option<Step> {
        let first = from.turned_to(to)?;
        let n = from.ends.len();
        let (mut edge, mut upto) = (Edge::default(), Vec::with_capacity(n));
        for (i, end) in from.ends.iter().enumerate() {
            let j = (i + first) % n;
            let before = edge.beside;
            self.trace([end.spot, to.ends[j].spot], [from.at(i), to.at(j)], &mut edge)?;
            // Outwards it has the workspace on its left where it opens.
            if !end.opens {
                edge.beside = before - (edge.beside - before);
            }
            upto.push(edge.points.len());
        }
        self.budget[1] = self.budget[1].saturating_sub(edge.points.len());
        self.done.beside += edge.beside;
        Some(Step::On { first, points: edge.points, to: upto })
    }

    fn point(&self, spot: &Spot) -> Option<Vector> {
        let (r, b) = self.space.along(&spot.curve, spot.t)?;
        Some(r * unit(self.angle(b)))
    }

    /// The points of a curve between two of its own; `None` if it does not join them within the limits.
    fn trace(&self, spots: [Spot; 2], ends: [Vector; 2], edge: &mut Edge) -> Option<()> {
        let missed = MISSED * self.space.farthest();
        for (spot, end) in spots.iter().zip(ends) {
            if (self.point(spot)? - end).norm() > missed {
                return None;
            }
        }
        let [from, to] = spots.map(|spot| spot.t);
        self.halved(&Spot { t: 0.5 * (from + to), ..spots[0] }, [from, to], ends, MAX_DEPTH, edge)
    }

    /// The same between two places t, with the middle.
    fn halved(
        &self,
        middle: &Spot,
        [from, to]: [f64; 2],
        [start, end]: [Vector; 2],
        depth: usize,
        edge: &mut Edge,
    ) -> Option<()> {
        let spot = |t: f64| Spot { t, ..*middle };
        let quarters = [0.25, 0.5, 0.75].map(|part| spot(from + part * (to - from)));
        let q2 = self.point(&quarters[1])?;
        let off = |p: Vector, [a, b]: [Vector; 2]| {
            let way = b - a;
            let length = way.norm();
            if length > 0.0 { ((p - a) * way.conj()).im.abs() / length } else { (p - a).norm() }
        };
        // Areas between the edge and one, two and four chords, extrapolated.
        let area = |a: Vector, b: Vector, c: Vector| 0.5 * ((b - a).conj() * (c - a)).im;
        let two = area(start, q2, end);
        let apart = (end - start).norm();
        // Between circles that lie close no chord is parted.
        let halves = [(q2 - start).norm(), (end - q2).norm()];
        let near = apart <= CLOSE_ENDS_SHARE * self.space.farthest() && halves.iter().all(|d| *d <= 0.8 * apart);
        if near && off(q2, [start, end]) <= self.done.chord {
            edge.beside += two * 4.0 / 3.0;
            return Some(());
        }
        let [q1, q3] = [self.point(&quarters[0])?, self.point(&quarters[2])?];
        // What is four times as short bends a sixteenth.
        let bend = off(q2, [start, end]).max(off(q1, [start, q2])).max(off(q3, [q2, end]));
        let even = [(q1 - start).norm(), (q2 - q1).norm(), (q3 - q2).norm(), (end - q3).norm()];
        let straight = even.iter().all(|d| *d <= 2.0 * apart) && bend <= 16.0 * self.done.chord;
        let tiny = even.iter().all(|d| *d <= FOUND * self.space.farthest());
        let spent = edge.points.len() >= self.budget[1];
        if straight || tiny || spent {
            let four = two + area(start, q1, q2) + area(q2, q3, end);
            let [finer, coarser] = [four + (four - two) / 3.0, two + two / 3.0];
            edge.beside += finer + (finer - coarser) / 15.0 - four;
            edge.points.extend([q1, q2, q3]);
            return Some(());
        }
        if depth == 0 {
            return None;
        }
        let half = quarters[1].t;
        self.halved(&quarters[0], [from, half], [start, q2], depth - 1, edge)?;
        edge.points.push(q2);
        self.halved(&quarters[2], [half, to], [q2, end], depth - 1, edge)
    }
}
