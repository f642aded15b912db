//! The sum of two sets in planes that cross, as a surface.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | u | direction in which the planes cross, of unit length | |
//! | v, w | unit vectors across u, in the plane of the first set and of the second | |
//! | A(v), B(w) | intervals in which a line along u meets the first set, the second | m |
//!
//! A point of the sum is s u + v v + w w with s in A(v) + B(w), the sums of all pairs of their intervals. Over a
//! rectangle in (v, w) between levels of both sets all ends are plane. So each end is cut where another interval covers
//! it, and what is left bounds the sum. Across a level at which intervals appear or vanish, a wall does: there A(v) +
//! B(w) jumps.

use nalgebra::Vector3;

use super::slices::{Band, End, Slices};
use super::strips::{Interval, Piece, differences, outline};
use super::traced::Traced;
use crate::scene::Mesh;

/// Ends that are nearer than this, as a share of the size, are one.
const SAME_END: f64 = 1e-9;

/// Number of contours.
const CONTOURS: usize = 5;

/// Axes of the sum.
#[derive(Clone, Copy, Debug)]
pub struct Axes {
    /// u, v and w.
    pub directions: [Vector3<f64>; 3],
    /// Place of the origin of both planes together, m.
    pub origin: Vector3<f64>,
}

impl Axes {
    fn point(&self, s: f64, v: f64, w: f64) -> Vector3<f64> {
        let [a, b, c] = &self.directions;
        self.origin + s * a + v * b + w * c
    }
}

/// A function that is linear over a unit square: its value at a corner, and what it gains along both sides.
#[derive(Clone, Copy, Debug)]
struct Plane([f64; 3]);

impl Plane {
    fn sum(a: &End, b: &End) -> Self {
        Self([a.s[0] + b.s[0], a.s[1] - a.s[0], b.s[1] - b.s[0]])
    }

    fn at(&self, [x, y]: [f64; 2]) -> f64 {
        self.0[0] + self.0[1] * x + self.0[2] * y
    }

    fn minus(&self, other: &Self) -> Self {
        Self([0, 1, 2].map(|i| self.0[i] - other.0[i]))
    }

    /// Returns the least and the greatest value.
    fn range(&self) -> [f64; 2] {
        let [c, x, y] = self.0;
        [c + x.min(0.0) + y.min(0.0), c + x.max(0.0) + y.max(0.0)]
    }
}

/// Polygon in a unit square.
type Polygon = Vec<[f64; 2]>;

/// Returns the part of a convex polygon in which a function is positive.
fn clipped(polygon: &Polygon, by: &Plane) -> Polygon {
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (i, p) in polygon.iter().enumerate() {
        let q = polygon[(i + 1) % polygon.len()];
        let (a, b) = (by.at(*p), by.at(q));
        if a > 0.0 {
            kept.push(*p);
        }
        if (a > 0.0) != (b > 0.0) {
            let share = a / (a - b);
            kept.push([0, 1].map(|k| p[k] + share * (q[k] - p[k])));
        }
    }
    if kept.len() < 3 { Vec::new() } else { kept }
}

/// An interval of the sum over a rectangle.
struct Cover<'a> {
    ends: [Plane; 2],
    of: [&'a [End; 2]; 2],
}

/// A surface under construction.
pub struct Surface {
    axes: Axes,
    size: f64,
    /// 1 if u, v, w are a right-handed frame, else −1.
    hand: f64,
    mesh: Mesh,
    lines: Traced,
}

impl Surface {
    /// Returns the surface of the sum of two sets, and lines on it: the edges of its walls, and sections by planes of
    /// the first set.
    pub fn of(first: &Slices, second: &Slices, axes: Axes) -> (Mesh, Vec<Vec<[f32; 3]>>) {
        let [u, v, w] = axes.directions;
        let range = |of: &Slices| {
            let all = of.bands.iter().flat_map(|band| &band.parts).flatten().flat_map(|end| end.s);
            all.fold(0.0, |most: f64, s| most.max(s.abs()))
        };
        let size = range(first) + range(second);
        let mut surface = Self {
            axes,
            size,
            hand: u.dot(&v.cross(&w)).signum(),
            mesh: Mesh { shell: true, ..Mesh::default() },
            lines: Traced::new(SAME_END.sqrt() * size),
        };
        for a in &first.bands {
            for b in &second.bands {
                surface.cell(a, b);
            }
        }
        surface.walls(first, second, false);
        surface.walls(second, first, true);
        surface.contours(second, first);
        (surface.mesh, surface.lines.strips())
    }

    /// Adds the ends of all intervals over a rectangle, where no other interval covers them.
    fn cell(&mut self, a: &Band, b: &Band) {
        let sum = |(p, q)| {
            let (p, q): (&[End; 2], &[End; 2]) = (p, q);
            Cover { ends: [0, 1].map(|i| Plane::sum(&p[i], &q[i])), of: [p, q] }
        };
        let pairs = a.parts.iter().flat_map(|p| b.parts.iter().map(move |q| (p, q)));
        let covers: Vec<Cover<'_>> = pairs.map(sum).collect();
        for (i, own) in covers.iter().enumerate() {
            // A curve and a curve have one sheet.
            let is_sheet = own.ends[1].minus(&own.ends[0]).range()[1] <= SAME_END * self.size;
            for side in 0..(if is_sheet { 1 } else { 2 }) {
                let end = &own.ends[side];
                let mut open: Vec<Polygon> = vec![vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]];
                for (k, other) in covers.iter().enumerate() {
                    let (below, above) = (other.ends[0].minus(end), end.minus(&other.ends[1]));
                    let [least, most] = [below.range(), above.range()];
                    if k == i || least[0] >= 0.0 || most[0] >= 0.0 {
                        continue;
                    }
                    // Of equal ends one is drawn.
                    let same = if side == 0 { least } else { most };
                    if same.iter().all(|x| x.abs() <= SAME_END * self.size) && k > i {
                        continue;
                    }
                    open = open.iter().flat_map(|own| [clipped(own, &below), clipped(own, &above)]).collect();
                    open.retain(|own| !own.is_empty());
                }
                for polygon in &open {
                    self.facet(polygon, [a, b], own, side);
                }
            }
        }
    }

    /// Adds a part of an end over a rectangle.
    fn facet(&mut self, polygon: &Polygon, [a, b]: [&Band; 2], own: &Cover<'_>, side: usize) {
        let [u, v, w] = self.axes.directions;
        let outward = if side == 0 { -self.hand } else { self.hand };
        let direction = |of: &End, share: f64, across: &Vector3<f64>| {
            let along = of.along[0] * (1.0 - share) + of.along[1] * share;
            u * along.re + across * along.im
        };
        let chord = |of: &End, band: &Band, across: &Vector3<f64>| {
            u * (of.s[1] - of.s[0]) + across * (band.range[1] - band.range[0])
        };
        let [p, q] = [&own.of[0][side], &own.of[1][side]];
        let flat = outward * chord(p, a, &v).cross(&chord(q, b, &w));
        let first = self.mesh.positions.len() as u32;
        for at in polygon {
            let [x, y] = [0, 1].map(|k| [a, b][k].range[0] + at[k] * ([a, b][k].range[1] - [a, b][k].range[0]));
            let smooth = outward * direction(p, at[0], &v).cross(&direction(q, at[1], &w));
            // Where both directions are that of u, or a corner was rounded off, the facet has its own normal.
            let normal = smooth.try_normalize(1e-6).filter(|n| n.dot(&flat) > 0.0).unwrap_or(flat).normalize();
            self.vertex(self.axes.point(own.ends[side].at(*at), x, y), &normal);
        }
        self.fan(first, polygon.len() as u32, outward > 0.0);
    }

    fn vertex(&mut self, at: Vector3<f64>, normal: &Vector3<f64>) {
        self.mesh.positions.push(at.map(|x| x as f32).into());
        self.mesh.normals.push(normal.map(|x| x as f32).into());
    }

    /// Adds the triangles of a convex polygon, counter-clockwise or the other way round.
    fn fan(&mut self, first: u32, count: u32, counter_clockwise: bool) {
        for k in 1..count.saturating_sub(1) {
            let (b, c) = if counter_clockwise { (k, k + 1) } else { (k + 1, k) };
            self.mesh.triangles.push([first, first + b, first + c]);
        }
    }

    /// Returns a point at a level of one set, with s and the coordinate of the other.
    fn on_level(&self, level: f64, [s, other]: [f64; 2], swapped: bool) -> Vector3<f64> {
        let [v, w] = if swapped { [other, level] } else { [level, other] };
        self.axes.point(s, v, w)
    }

    /// Adds the walls at the levels of a set at which intervals appear or vanish.
    fn walls(&mut self, of: &Slices, other: &Slices, swapped: bool) {
        let Some(last) = of.bands.last() else { return };
        let (same, none) = (SAME_END * self.size, Vec::new());
        let levels = of.bands.iter().map(|band| band.range[0]).chain([last.range[1]]);
        for (i, level) in levels.enumerate() {
            let before = i.checked_sub(1).map_or(&none, |k| &of.bands[k].parts);
            let after = of.bands.get(i).map_or(&none, |band| &band.parts);
            let [before, mut after] = [(before, 1), (after, 0)]
                .map(|(parts, side)| parts.iter().map(|part| part.map(|end| end.s[side])).collect::<Vec<[f64; 2]>>());
            let known: Vec<f64> = before.iter().flatten().copied().collect();
            for end in after.iter_mut().flatten() {
                *end = known.iter().copied().find(|s| (s - *end).abs() <= same).unwrap_or(*end);
            }
            if before == after {
                continue;
            }
            let mut wall = Vec::new();
            for band in &other.bands {
                let all = differences(&sums(&before, band), &sums(&after, band)).into_iter().map(|p| over(p, band));
                let wide = |piece: &Piece| (0..2).any(|k| piece.ends[1][k] - piece.ends[0][k] > same);
                wall.extend(all.filter(wide));
            }
            self.wall(level, &wall, swapped);
        }
    }

    /// Adds a wall.
    fn wall(&mut self, level: f64, pieces: &[Piece], swapped: bool) {
        let [u, v, w] = self.axes.directions;
        let (across, along) = if swapped { (w, v) } else { (v, w) };
        let normal = u.cross(&along).normalize();
        let normal = if normal.dot(&across) < 0.0 { -normal } else { normal };
        for piece in pieces {
            let [low, high] = piece.ends;
            let [from, to] = piece.range;
            let corners = [[low[0], from], [high[0], from], [high[1], to], [low[1], to]]
                .map(|at| self.on_level(level, at, swapped));
            let outward = if piece.is_of_first { normal } else { -normal };
            let first = self.mesh.positions.len() as u32;
            corners.iter().for_each(|at| self.vertex(*at, &outward));
            // The corners run from u to the other direction.
            self.fan(first, 4, u.cross(&along).dot(&outward) > 0.0);
        }
        self.edges(level, pieces, swapped);
    }

    /// Adds the edges of trapezoids at a level.
    fn edges(&mut self, level: f64, pieces: &[Piece], swapped: bool) {
        for edge in outline(pieces, SAME_END * self.size) {
            let [a, b] = edge.map(|at| self.on_level(level, at, swapped));
            self.lines.add(a, b);
        }
    }

    /// Adds contours at levels w of the second set: sections by planes of the first one.
    fn contours(&mut self, of: &Slices, other: &Slices) {
        let (Some(first), Some(last)) = (of.bands.first(), of.bands.last()) else { return };
        let [from, to] = [first.range[0], last.range[1]];
        for i in 1..=CONTOURS {
            let level = from + (to - from) * i as f64 / (CONTOURS + 1) as f64;
            let Some(here) = of.bands.iter().find(|band| level < band.range[1]) else { continue };
            let share = (level - here.range[0]) / (here.range[1] - here.range[0]);
            let at = |end: &End| end.s[0] + share * (end.s[1] - end.s[0]);
            let intervals: Vec<[f64; 2]> = here.parts.iter().map(|part| [at(&part[0]), at(&part[1])]).collect();
            let mut pieces = Vec::new();
            for band in &other.bands {
                let sums = sums(&intervals, band);
                for [low, high] in &sums {
                    if low == high {
                        // A curve and a curve.
                        let ends = [[low[0], band.range[0]], [low[1], band.range[1]]];
                        let [a, b] = ends.map(|at| self.on_level(level, at, true));
                        self.lines.add(a, b);
                    }
                }
                pieces.extend(differences(&sums, &[]).into_iter().map(|piece| over(piece, band)));
            }
            self.edges(level, &pieces, true);
        }
    }
}

/// Returns the sums of intervals and those of a band.
fn sums(intervals: &[[f64; 2]], band: &Band) -> Vec<Interval> {
    let pairs = intervals.iter().flat_map(|own| band.parts.iter().map(move |part| (own, part)));
    pairs.map(|(own, part)| [0, 1].map(|i| part[i].s.map(|s| s + own[i]))).collect()
}

/// Returns a trapezoid over a band, whose parameter ran from 0 to 1.
fn over(piece: Piece, band: &Band) -> Piece {
    let [from, to] = band.range;
    // Exact at the ends, so that neighbours meet.
    let at = |share: f64| if share == 1.0 { to } else { from + share * (to - from) };
    Piece { range: piece.range.map(at), ..piece }
}
