//! [`Rings`]: the parts of circles about B that belong to the workspace of a b, and how they continue from one circle
//! to the next.

use std::f64::consts::TAU;

use super::b_coverage::BCoverage;
use super::critical::CriticalPoint;
use super::reach::ReachBuffers;
use super::space::PoseSpace;
use stillbase_mechanics::planar::{Vector, unit};

/// Initial number of circles.
const INITIAL_CIRCLES: usize = 128;
/// Every n-th circle, with this n, is computed without the result of the previous one.
const RESTART_EVERY: usize = 16;
/// A change of the boundary is bracketed between circles at this distance, as a fraction of the reach. It is more than
/// twice the greatest shift of a circle by [`PoseSpace::covered`].
const CHANGE_BRACKET: f64 = 2e-8;
/// Maximum number of circles, and of points between them.
const MAX_RINGS: usize = 6000;
const MAX_POINTS: usize = 400_000;
/// Tolerance of the shift of arc ends between the two circles that bracket a change, rad. The boundary does not run
/// along a circle about B, so a larger jump means that a circle is wrong.
const JUMP_TOLERANCE_RAD: f64 = 0.02;
/// Maximum number of bisections of an edge between two circles.
const MAX_DEPTH: usize = 24;
/// An edge whose ends are within this fraction of the reach is treated as an arc without inflection.
const CLOSE_ENDS: f64 = 5e-3;
/// Reach above which the tolerance of chords grows in proportion, m.
const LARGE_REACH_M: f64 = 5.0;
/// Tolerance of the distance between the end of a curve and the arc end on its circle, as a fraction of the reach.
const ENDPOINT_TOLERANCE: f64 = 1e-6;

/// A point where the workspace begins or ends on a circle, counter-clockwise.
#[derive(Clone, Copy, Debug)]
pub(super) struct ArcEnd {
    /// Angle from 0 to 2π, rad.
    pub angle: f64,
    /// Whether the workspace begins here.
    pub opens: bool,
    spot: CriticalPoint,
}

/// A circle about B.
#[derive(Clone, Debug, Default)]
pub(super) struct Ring {
    /// Radius, m.
    pub r: f64,
    /// Ends in order of their angles: opening and closing ones alternate.
    pub ends: Vec<ArcEnd>,
    /// If there are no ends: whether the whole circle belongs to the workspace.
    pub whole: bool,
}

impl Ring {
    /// Whether the point at angle 0 belongs to the workspace.
    pub fn starts_inside(&self) -> bool {
        self.ends.first().map_or(self.whole, |end| !end.opens)
    }

    pub fn at(&self, end: usize) -> Vector {
        self.r * unit(self.ends[end].angle)
    }

    /// Returns the longest arc that belongs to the workspace on one of two circles only, rad.
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

    /// Returns the index of the end, on another circle, that continues the first end of this one. Returns `None` unless
    /// all ends continue in the same order.
    fn turned_to(&self, other: &Self) -> Option<usize> {
        let n = self.ends.len();
        if n != other.ends.len() || (n == 0 && self.whole != other.whole) {
            return None;
        }
        let same = |x: &ArcEnd, y: &ArcEnd| x.opens == y.opens && x.spot.curve == y.spot.curve;
        (0..n.max(1)).find(|k| (0..n).all(|i| same(&self.ends[i], &other.ends[(i + k) % n])))
    }
}

/// Continuation of the boundary from one circle to the next.
#[derive(Clone, Debug)]
pub(super) enum BoundaryStep {
    /// Every end continues, the first one to end `first` of the next circle. `points` lie between the circles; those of
    /// end i stop before index `to[i]`.
    On { first: usize, points: Vec<Vector>, to: Vec<usize> },
    /// The number or order of the ends changes, so both circles are treated as one.
    Changes,
}

/// Circles from the inside outwards.
#[derive(Clone, Debug)]
pub(super) struct Rings {
    pub rings: Vec<Ring>,
    /// One step for each pair of neighbouring circles.
    pub steps: Vec<BoundaryStep>,
    /// Area between the boundary and its chords, m².
    pub chord_area: f64,
    /// Maximum deviation of chords from the boundary, m.
    pub chord: f64,
    /// Sum of the jumps of the boundary in excess of [`JUMP_TOLERANCE_RAD`], rad; 0 if all circles are consistent.
    pub jumps: f64,
}

impl PoseSpace {
    /// Returns circles through the workspace of b. Chords deviate from its boundary by at most `chord`, m; above a
    /// reach of [`LARGE_REACH_M`] by more, in proportion. Progress, 0 to 1, goes to `goes_on`; `None` if it is false.
    pub(super) fn rings(&self, b: f64, chord: f64, goes_on: &mut dyn FnMut(f64) -> bool) -> Option<Rings> {
        let carried = self.rings_of(b, chord, [self.drives() > 3, false], goes_on)?;
        if carried.jumps == 0.0 || self.drives() == 3 {
            return Some(carried);
        }
        // Some result that was reused for the next circle was wrong.
        let afresh = self.rings_of(b, chord, [false, true], goes_on)?;
        Some(if afresh.jumps < carried.jumps { afresh } else { carried })
    }

    /// Returns the circles. If `carries` is set, results of a circle are reused for the next; if `careful` is set,
    /// poses are searched for carefully.
    fn rings_of(
        &self,
        b: f64,
        chord: f64,
        [carries, careful]: [bool; 2],
        goes_on: &mut dyn FnMut(f64) -> bool,
    ) -> Option<Rings> {
        let (near, far) = (self.nearest(), self.farthest());
        let span = far - near;
        let at = |i: usize| near + span * if i == 0 { CHANGE_BRACKET } else { i as f64 / INITIAL_CIRCLES as f64 };
        let chord = chord * (far / LARGE_REACH_M).max(1.0);
        let mut sweep = Sweep {
            space: self,
            b,
            work: ReachBuffers::default(),
            carries,
            budget: [MAX_RINGS, MAX_POINTS],
            done: Rings { rings: Vec::new(), steps: Vec::new(), chord_area: 0.0, chord, jumps: 0.0 },
        };
        sweep.work.looks.careful = careful;
        let mut all: Vec<(f64, BCoverage)> = Vec::with_capacity(INITIAL_CIRCLES + 1);
        for i in 0..=INITIAL_CIRCLES {
            if !goes_on(0.5 * i as f64 / INITIAL_CIRCLES as f64) {
                return None;
            }
            let r = if i == INITIAL_CIRCLES { far * (1.0 - CHANGE_BRACKET) } else { at(i) };
            let knows = carries && i % RESTART_EVERY > 0;
            let last = all.last().map(|(_, covered)| covered).filter(|_| knows);
            let covered = self.covered(r, last.as_slice(), &mut sweep.work);
            all.push(covered);
        }
        // An interval between critical values of b that is feasible on one circle is feasible on the neighbouring
        // circles to which it continues.
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
        let mut from = all.next().map(|covered| sweep.ring_of(covered))?;
        for (i, to) in all.enumerate() {
            if !goes_on(0.5 + 0.5 * i as f64 / INITIAL_CIRCLES as f64) {
                return None;
            }
            let to = sweep.ring_of(to);
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
    work: ReachBuffers,
    /// Whether results of circles are reused for those between them.
    carries: bool,
    /// Remaining numbers of circles and of points.
    budget: [usize; 2],
    done: Rings,
}

/// Points of an edge between two circles, and the area between the edge and their chords, m².
#[derive(Default)]
struct Edge {
    points: Vec<Vector>,
    chord_area: f64,
}

impl Sweep<'_> {
    fn ring(&mut self, r: f64, neighbours: &[&BCoverage]) -> (Ring, BCoverage) {
        self.budget[0] = self.budget[0].saturating_sub(1);
        let neighbours = if self.carries { neighbours } else { &[] };
        let covered = self.space.covered(r, neighbours, &mut self.work);
        self.ring_of(covered)
    }

    fn ring_of(&self, (r, covered): (f64, BCoverage)) -> (Ring, BCoverage) {
        let n = covered.ends.len();
        let whole = covered.gaps.iter().all(|gap| *gap);
        // The angle decreases as b increases.
        let end = |i: usize| {
            let [before, after] = [covered.gaps[(i + n - 1) % n], covered.gaps[i]];
            let c = &covered.ends[i];
            let angle = self.angle(c.b);
            (before != after).then_some(ArcEnd { angle, opens: before, spot: c.spot })
        };
        let mut ends: Vec<ArcEnd> = (0..n).rev().filter_map(end).collect();
        if let Some(least) = (0..ends.len()).min_by(|i, j| ends[*i].angle.total_cmp(&ends[*j].angle)) {
            ends.rotate_left(least);
        }
        (Ring { r, ends, whole }, covered)
    }

    fn angle(&self, b: f64) -> f64 {
        ((self.b - b) / self.space.lambda_sum).rem_euclid(TAU)
    }

    /// Adds a circle and the step to the next one, with further circles between them if the boundary changes.
    fn between(&mut self, from: &(Ring, BCoverage), to: &(Ring, BCoverage)) {
        let far = self.space.farthest();
        if let Some(step) = self.step(&from.0, &to.0) {
            self.done.rings.push(from.0.clone());
            self.done.steps.push(step);
        } else if to.0.r - from.0.r <= CHANGE_BRACKET * far || self.budget[0] == 0 {
            if to.0.r - from.0.r <= CHANGE_BRACKET * far {
                self.done.jumps += (from.0.apart(&to.0) - JUMP_TOLERANCE_RAD).max(0.0);
            }
            self.done.rings.push(from.0.clone());
            self.done.steps.push(BoundaryStep::Changes);
        } else {
            let middle = self.ring(0.5 * (from.0.r + to.0.r), &[&from.1, &to.1]);
            self.between(from, &middle);
            self.between(&middle, to);
        }
    }

    /// Returns the step between two circles if every end continues from one to the other.
    fn step(&mut self, from: &Ring, to: &Ring) -> Option<BoundaryStep> {
        let first = from.turned_to(to)?;
        let n = from.ends.len();
        let (mut edge, mut upto) = (Edge::default(), Vec::with_capacity(n));
        for (i, end) in from.ends.iter().enumerate() {
            let j = (i + first) % n;
            let before = edge.chord_area;
            self.trace([end.spot, to.ends[j].spot], [from.at(i), to.at(j)], &mut edge)?;
            // Seen outwards, the edge of an opening end has the workspace on its left.
            if !end.opens {
                edge.chord_area = before - (edge.chord_area - before);
            }
            upto.push(edge.points.len());
        }
        self.budget[1] = self.budget[1].saturating_sub(edge.points.len());
        self.done.chord_area += edge.chord_area;
        Some(BoundaryStep::On { first, points: edge.points, to: upto })
    }

    fn point(&self, spot: &CriticalPoint) -> Option<Vector> {
        let (r, b) = self.space.along(&spot.curve, spot.t)?;
        Some(r * unit(self.angle(b)))
    }

    /// Adds the points of a curve between two of its places; `None` if the curve does not join them within the limits.
    fn trace(&self, spots: [CriticalPoint; 2], ends: [Vector; 2], edge: &mut Edge) -> Option<()> {
        let missed = ENDPOINT_TOLERANCE * self.space.farthest();
        for (spot, end) in spots.iter().zip(ends) {
            if (self.point(spot)? - end).norm() > missed {
                return None;
            }
        }
        let [from, to] = spots.map(|spot| spot.t);
        self.bisected(&CriticalPoint { t: 0.5 * (from + to), ..spots[0] }, [from, to], ends, MAX_DEPTH, edge)
    }

    /// Adds the points of a curve between two parameters t, given its middle, by bisection.
    fn bisected(
        &self,
        middle: &CriticalPoint,
        [from, to]: [f64; 2],
        [start, end]: [Vector; 2],
        depth: usize,
        edge: &mut Edge,
    ) -> Option<()> {
        let spot = |t: f64| CriticalPoint { t, ..*middle };
        let quarters = [0.25, 0.5, 0.75].map(|part| spot(from + part * (to - from)));
        let q2 = self.point(&quarters[1])?;
        let off = |p: Vector, [a, b]: [Vector; 2]| {
            let way = b - a;
            let length = way.norm();
            if length > 0.0 { ((p - a) * way.conj()).im.abs() / length } else { (p - a).norm() }
        };
        // The area between the edge and its one chord or four chords, by Richardson extrapolation from triangles.
        let area = |a: Vector, b: Vector, c: Vector| 0.5 * ((b - a).conj() * (c - a)).im;
        let two = area(start, q2, end);
        let apart = (end - start).norm();
        // Short edges between close circles need no points in between.
        let halves = [(q2 - start).norm(), (end - q2).norm()];
        let near = apart <= CLOSE_ENDS * self.space.farthest() && halves.iter().all(|d| *d <= 0.8 * apart);
        if near && off(q2, [start, end]) <= self.done.chord {
            edge.chord_area += two * 4.0 / 3.0;
            return Some(());
        }
        let [q1, q3] = [self.point(&quarters[0])?, self.point(&quarters[2])?];
        // A chord a quarter as long deviates a sixteenth as much.
        let bend = off(q2, [start, end]).max(off(q1, [start, q2])).max(off(q3, [q2, end]));
        let even = [(q1 - start).norm(), (q2 - q1).norm(), (q3 - q2).norm(), (end - q3).norm()];
        let straight = even.iter().all(|d| *d <= 2.0 * apart) && bend <= 16.0 * self.done.chord;
        let tiny = even.iter().all(|d| *d <= CHANGE_BRACKET * self.space.farthest());
        let spent = edge.points.len() >= self.budget[1];
        if straight || tiny || spent {
            let four = two + area(start, q1, q2) + area(q2, q3, end);
            let [finer, coarser] = [four + (four - two) / 3.0, two + two / 3.0];
            edge.chord_area += finer + (finer - coarser) / 15.0 - four;
            edge.points.extend([q1, q2, q3]);
            return Some(());
        }
        if depth == 0 {
            return None;
        }
        let half = quarters[1].t;
        self.bisected(&quarters[0], [from, half], [start, q2], depth - 1, edge)?;
        edge.points.push(q2);
        self.bisected(&quarters[2], [half, to], [q2, end], depth - 1, edge)
    }
}
