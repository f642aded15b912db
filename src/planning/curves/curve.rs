//! Curves in a plane, of the end effector or of (a_1, a_2): p(s) for s from 0 to 1, with exact derivatives.
//!
//! A curve consists of pieces that join with two continuous derivatives. At a corner where the motion has to stop, one
//! curve ends and another begins.

use std::f64::consts::TAU;

use thiserror::Error;

use stillbase_mechanics::planar::{Vector, cross, dot, unit};
use stillbase_settings::number::counted;

/// A point of a curve with its first two derivatives with respect to s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvePoint {
    /// p, m; rad for a curve of (a_1, a_2).
    pub p: Vector,
    /// dp/ds, m or rad.
    pub first: Vector,
    /// d²p/ds², m or rad.
    pub second: Vector,
}

/// A curve with two continuous derivatives.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    pieces: Vec<Piece>,
    length: f64,
}

/// A piece of a curve over an interval of s.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Piece {
    from: f64,
    to: f64,
    shape: Shape,
}

/// Formula of a piece over its local parameter u, 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Shape {
    /// Σ c_i u^i.
    Polynomial([Vector; 6]),
    /// centre + arm e^{i sweep u}.
    Arc { centre: Vector, arm: Vector, sweep: f64 },
}

/// Why points do not define a curve.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum CurveError {
    /// Not enough points.
    #[error("{}: want {want}", counted(got, "point"))]
    Count {
        /// Number of points.
        got: usize,
        /// Required number, in words.
        want: &'static str,
    },
    /// Two neighbouring points coincide; their indices, counted from 0.
    #[error("points {} and {} are the same: want them apart", .0 + 1, .1 + 1)]
    Coincident(usize, usize),
    /// The three points lie on a line.
    #[error("the three points lie on a line, so no arc goes through them: move the middle one aside")]
    Collinear,
    /// A coordinate is not finite.
    #[error("point {}: want finite coordinates", .0 + 1)]
    NotFinite(usize),
}

/// Points closer than this are treated as coincident, m or rad.
const COINCIDENT_BELOW: f64 = 1e-9;
/// A corner that turns by more than this is not blended, rad: the line turns back there.
const MAX_BLENDED_TURN_RAD: f64 = 3.05;

impl Curve {
    /// Returns the straight line between two points.
    pub fn line(from: Vector, to: Vector) -> Self {
        Self::of(vec![(line(from, to), (to - from).norm().max(COINCIDENT_BELOW))])
    }

    /// Returns the arc from the first point through the second to the third, or the whole circle if `closed`.
    ///
    /// # Errors
    /// If the points do not determine a circle.
    pub fn arc(points: [Vector; 3], closed: bool) -> Result<Self, CurveError> {
        check(&points, closed)?;
        let [a, b, c] = points;
        let (ab, ac) = (b - a, c - a);
        let turn = cross(ab, ac);
        if turn.abs() <= 1e-6 * ab.norm() * ac.norm() {
            return Err(CurveError::Collinear);
        }
        // The circumcentre.
        let i = Vector::new(0.0, 1.0);
        let centre = a + i * (ac * ab.norm_sqr() - ab * ac.norm_sqr()) / (-2.0 * turn);
        let arm = a - centre;
        let angle = |p: Vector| (((p - centre) / arm).arg() * turn.signum()).rem_euclid(TAU);
        let sweep = turn.signum() * if closed { TAU } else { angle(c) };
        Ok(Self::of(vec![(Shape::Arc { centre, arm, sweep }, sweep.abs() * arm.norm())]))
    }

    /// Returns the cubic spline through points, with natural end conditions or closed. Its knots are spaced by the
    /// distances between the points.
    ///
    /// # Errors
    /// If there are too few points, two neighbours coincide, or a coordinate is not finite.
    pub fn spline(points: &[Vector], closed: bool) -> Result<Self, CurveError> {
        check(points, closed)?;
        let want = if closed { 3 } else { 2 };
        if points.len() < want {
            let want = if closed { "at least 3" } else { "at least 2" };
            return Err(CurveError::Count { got: points.len(), want });
        }
        let mut knots = points.to_vec();
        knots.extend(closed.then(|| points[0]));
        let h: Vec<f64> = knots.windows(2).map(|w| (w[1] - w[0]).norm()).collect();
        let bend = if closed { periodic_bends(&knots, &h) } else { natural_bends(&knots, &h) };
        let piece = |i: usize| {
            let (p, q, h2) = (knots[i], knots[i + 1], h[i] * h[i]);
            let (c2, c3) = (0.5 * h2 * bend[i], h2 * (bend[i + 1] - bend[i]) / 6.0);
            let zero = Vector::default();
            (Shape::Polynomial([p, q - p - c2 - c3, c2, c3, zero, zero]), h[i])
        };
        Ok(Self::of((0..h.len()).map(piece).collect()))
    }

    /// Returns straight lines through points. A quintic rounds each corner: it begins and ends at the distance `blend`
    /// from the corner, but at most at half of the shorter line. Where `blend` is 0 or the line turns back, the curve
    /// ends and another begins.
    ///
    /// # Errors
    /// If there are fewer than two points, two neighbours coincide, or a coordinate is not finite.
    pub fn polyline(points: &[Vector], closed: bool, blend: f64) -> Result<Vec<Self>, CurveError> {
        check(points, closed)?;
        let n = points.len();
        if n < 2 {
            return Err(CurveError::Count { got: n, want: "at least 2" });
        }
        let mut corners = points.to_vec();
        corners.extend(closed.then(|| points[0]));
        let last = corners.len() - 1;
        let along = |i: usize| corners[i + 1] - corners[i];
        // Distance from corner i at which its blend begins; 0 where the curve ends.
        let room = |i: usize| {
            let (before, after) = (along(i - 1), along(i));
            let turn = (after / before).arg().abs();
            let room = blend.min(0.5 * before.norm()).min(0.5 * after.norm());
            if (1e-9..=MAX_BLENDED_TURN_RAD).contains(&turn) { room.max(0.0) } else { 0.0 }
        };
        let straight = |i: usize| (along(i) / along(i - 1)).arg().abs() < 1e-9;
        let mut curves = Vec::new();
        let mut pieces: Vec<(Shape, f64)> = Vec::new();
        let mut at = corners[0];
        for (i, corner) in corners.iter().enumerate().skip(1) {
            let d = if i == last { 0.0 } else { room(i) };
            let direction = along(i - 1) / along(i - 1).norm();
            let end = corner - d * direction;
            if (end - at).norm() > COINCIDENT_BELOW {
                pieces.push((line(at, end), (end - at).norm()));
            }
            at = end;
            if i < last && d > 0.0 {
                let onwards = along(i) / along(i).norm();
                at = corner + d * onwards;
                pieces.push((blended(end, direction, at, onwards, d), 2.0 * d));
            } else if i == last || !straight(i) {
                curves.push(Self::of(std::mem::take(&mut pieces)));
            }
        }
        Ok(curves)
    }

    /// Returns a smooth curve along points drawn freehand: removes pauses and tremor and fits a spline.
    ///
    /// # Errors
    /// If fewer than two distinct points remain, or a coordinate is not finite.
    pub fn freehand(points: &[Vector], closed: bool) -> Result<Self, CurveError> {
        if let Some(i) = points.iter().position(|p| !p.is_finite()) {
            return Err(CurveError::NotFinite(i));
        }
        let mut drawn: Vec<Vector> = Vec::with_capacity(points.len());
        for p in points {
            if drawn.last().is_none_or(|last| (p - last).norm() > 1e-4) {
                drawn.push(*p);
            }
        }
        if drawn.len() < 2 {
            return Err(CurveError::Count { got: drawn.len(), want: "at least 2 that are apart" });
        }
        let length: f64 = drawn.windows(2).map(|w| (w[1] - w[0]).norm()).sum();
        // Resample evenly along the line, smooth, and take every eighth point as a knot.
        let (even, spacing) = resampled(&drawn, length, 8 * FREEHAND_INTERVALS);
        let smooth = smoothed(&even, (0.012 / spacing).clamp(1.0, 24.0));
        let mut knots: Vec<Vector> = Vec::with_capacity(FREEHAND_INTERVALS + 1);
        for i in 0..=FREEHAND_INTERVALS {
            // A stroke that goes there and back may give coincident knots.
            if knots.last().is_none_or(|last| (smooth[8 * i] - last).norm() > 1e-3 * spacing) {
                knots.push(smooth[8 * i]);
            }
        }
        let meets = |knots: &[Vector]| (knots[0] - knots[knots.len() - 1]).norm() < 4.0 * spacing;
        while closed && knots.len() > 3 && meets(&knots) {
            knots.pop();
        }
        Self::spline(&knots, closed && knots.len() > 2)
    }

    /// Returns the curve of quintics through given points and derivatives at given s. The caller defines s, such as
    /// t/T. Returns `None` if the s do not rise from 0 to 1, or if their number differs from that of the points.
    pub fn through(stations: &[f64], nodes: &[CurvePoint]) -> Option<Self> {
        let last = stations.len().checked_sub(1).filter(|n| *n > 0 && nodes.len() == stations.len())?;
        if stations[0] != 0.0 || stations[last] != 1.0 || !stations.windows(2).all(|w| w[0] < w[1]) {
            return None;
        }
        let piece = |i: usize| {
            let (from, to, a, b) = (stations[i], stations[i + 1], &nodes[i], &nodes[i + 1]);
            let h = to - from;
            let (c0, c1, c2) = (a.p, a.first * h, a.second * (h * h / 2.0));
            let (v, v1, v2) = (b.p - c0 - c1 - c2, b.first * h - c1 - 2.0 * c2, b.second * (h * h) - 2.0 * c2);
            let (c3, c4) = (10.0 * v - 4.0 * v1 + 0.5 * v2, -15.0 * v + 7.0 * v1 - v2);
            let shape = Shape::Polynomial([c0, c1, c2, c3, c4, 6.0 * v - 3.0 * v1 + 0.5 * v2]);
            Piece { from, to, shape }
        };
        let length: f64 = nodes.windows(2).map(|w| (w[1].p - w[0].p).norm()).sum();
        Some(Self { pieces: (0..last).map(piece).collect(), length: length.max(COINCIDENT_BELOW) })
    }

    fn of(shapes: Vec<(Shape, f64)>) -> Self {
        let length: f64 = shapes.iter().map(|(_, length)| length).sum();
        let n = shapes.len();
        let mut from = 0.0;
        let piece = |(i, (shape, own)): (usize, (Shape, f64))| {
            let to = if i + 1 == n { 1.0 } else { from + own / length };
            let piece = Piece { from, to, shape };
            from = to;
            piece
        };
        Self { pieces: shapes.into_iter().enumerate().map(piece).collect(), length }
    }

    /// Returns the length of the curve, m or rad. It is exact for lines and arcs, the sum of the chords for splines,
    /// and twice the blend distance for a rounded corner.
    pub fn length(&self) -> f64 {
        self.length
    }

    /// Returns the s at which pieces join, with 0 and 1: between these the curve has all derivatives.
    pub fn joints(&self) -> impl Iterator<Item = f64> + '_ {
        std::iter::once(0.0).chain(self.pieces.iter().map(|p| p.to))
    }

    /// Returns the s of the joints and of points between them, so dense that the curve changes little between
    /// neighbours.
    pub fn sample_parameters(&self) -> impl Iterator<Item = f64> + '_ {
        let parts = |piece: &Piece| {
            let spaces = if piece.shape.is_straight() { 1 } else { 16 };
            let (from, to) = (piece.from, piece.to);
            (1..=spaces).map(move |i| if i == spaces { to } else { from + (to - from) * i as f64 / spaces as f64 })
        };
        std::iter::once(0.0).chain(self.pieces.iter().flat_map(parts))
    }

    /// Returns the point at s, clamped to 0..1, and its derivatives.
    pub fn at(&self, s: f64) -> CurvePoint {
        let s = s.clamp(0.0, 1.0);
        let i = self.pieces.partition_point(|p| p.to < s).min(self.pieces.len() - 1);
        let piece = &self.pieces[i];
        let run = piece.to - piece.from;
        let local = piece.shape.at((s - piece.from) / run);
        CurvePoint { p: local.p, first: local.first / run, second: local.second / (run * run) }
    }

    /// Returns d³p/ds³ at s, clamped to 0..1.
    pub fn third(&self, s: f64) -> Vector {
        let s = s.clamp(0.0, 1.0);
        let piece = &self.pieces[self.pieces.partition_point(|p| p.to < s).min(self.pieces.len() - 1)];
        let run = piece.to - piece.from;
        piece.shape.third((s - piece.from) / run) / (run * run * run)
    }

    /// Returns the s of the point nearest to p: the best of `samples` + 1 evenly spaced samples, refined to first
    /// order.
    pub fn nearest(&self, p: Vector, samples: usize) -> f64 {
        let n = samples.max(2);
        let distance = |i: usize| (self.at(i as f64 / n as f64).p - p).norm_sqr();
        let best = (0..=n).min_by(|i, j| distance(*i).total_cmp(&distance(*j))).unwrap_or(0);
        let s = best as f64 / n as f64;
        let at = self.at(s);
        let step = dot(p - at.p, at.first) / at.first.norm_sqr();
        if step.is_finite() { (s + step.clamp(-1.0 / n as f64, 1.0 / n as f64)).clamp(0.0, 1.0) } else { s }
    }
}

impl Shape {
    fn at(&self, u: f64) -> CurvePoint {
        match self {
            Self::Polynomial(c) => CurvePoint {
                p: c[0] + u * (c[1] + u * (c[2] + u * (c[3] + u * (c[4] + u * c[5])))),
                first: c[1] + u * (2.0 * c[2] + u * (3.0 * c[3] + u * (4.0 * c[4] + u * 5.0 * c[5]))),
                second: 2.0 * c[2] + u * (6.0 * c[3] + u * (12.0 * c[4] + u * 20.0 * c[5])),
            },
            Self::Arc { centre, arm, sweep } => {
                let r = arm * unit(sweep * u);
                CurvePoint { p: centre + r, first: r * Vector::new(0.0, *sweep), second: r * (-sweep * sweep) }
            }
        }
    }
}

impl Shape {
    fn is_straight(&self) -> bool {
        matches!(self, Self::Polynomial([_, _, rest @ ..]) if *rest == [Vector::default(); 4])
    }

    fn third(&self, u: f64) -> Vector {
        match self {
            Self::Polynomial(c) => 6.0 * c[3] + u * (24.0 * c[4] + u * 60.0 * c[5]),
            Self::Arc { arm, sweep, .. } => arm * unit(sweep * u) * Vector::new(0.0, -sweep.powi(3)),
        }
    }
}

fn check(points: &[Vector], closed: bool) -> Result<(), CurveError> {
    if let Some(i) = points.iter().position(|p| !p.is_finite()) {
        return Err(CurveError::NotFinite(i));
    }
    let close = |i: &usize| (points[(i + 1) % points.len()] - points[*i]).norm() <= COINCIDENT_BELOW;
    let neighbours = if closed { points.len() } else { points.len().saturating_sub(1) };
    (0..neighbours).find(close).map_or(Ok(()), |i| Err(CurveError::Coincident(i, (i + 1) % points.len())))
}

fn line(from: Vector, to: Vector) -> Shape {
    let zero = Vector::default();
    Shape::Polynomial([from, to - from, zero, zero, zero, zero])
}

/// Returns the quintic that rounds a corner, from the distance d before it to the distance d after it. It meets both
/// lines with their speed and with zero second derivative.
fn blended(from: Vector, direction: Vector, to: Vector, onwards: Vector, d: f64) -> Shape {
    let step = 0.4 * d;
    let b = [
        from,
        from + step * direction,
        from + 2.0 * step * direction,
        to - 2.0 * step * onwards,
        to - step * onwards,
        to,
    ];
    // From Bézier control points to powers of u.
    Shape::Polynomial([
        b[0],
        5.0 * (b[1] - b[0]),
        10.0 * (b[0] - 2.0 * b[1] + b[2]),
        10.0 * (-b[0] + 3.0 * b[1] - 3.0 * b[2] + b[3]),
        5.0 * (b[0] - 4.0 * b[1] + 6.0 * b[2] - 4.0 * b[3] + b[4]),
        -b[0] + 5.0 * b[1] - 10.0 * b[2] + 10.0 * b[3] - 5.0 * b[4] + b[5],
    ])
}

/// Returns six times the difference of the chord slopes of interval i and of the interval `before` it.
fn slope_change(p: &[Vector], h: &[f64], i: usize, before: usize) -> Vector {
    6.0 * ((p[i + 1] - p[i]) / h[i] - (p[before + 1] - p[before]) / h[before])
}

/// Returns the second derivatives of the natural cubic spline at its knots.
fn natural_bends(p: &[Vector], h: &[f64]) -> Vec<Vector> {
    let n = p.len() - 1;
    let mut bend = vec![Vector::default(); n + 1];
    let rows: Vec<_> = (1..n).map(|i| [h[i - 1], 2.0 * (h[i - 1] + h[i]), h[i]]).collect();
    let sides: Vec<_> = (1..n).map(|i| slope_change(p, h, i, i - 1)).collect();
    bend[1..n].copy_from_slice(&tridiagonal(&rows, &sides));
    bend
}

/// Returns the second derivatives of the closed cubic spline at its knots; the last knot repeats the first.
fn periodic_bends(p: &[Vector], h: &[f64]) -> Vec<Vector> {
    let n = h.len();
    let before = |i: usize| (i + n - 1) % n;
    let mut rows: Vec<_> = (0..n).map(|i| [h[before(i)], 2.0 * (h[before(i)] + h[i]), h[i]]).collect();
    let sides: Vec<_> = (0..n).map(|i| slope_change(p, h, i, before(i))).collect();
    // The Sherman–Morrison formula accounts for the corner entries of the cyclic matrix.
    let corner = h[n - 1];
    let gamma = -rows[0][1];
    rows[0][1] -= gamma;
    rows[n - 1][1] -= corner * corner / gamma;
    let y = tridiagonal(&rows, &sides);
    let mut edge = vec![Vector::default(); n];
    edge[0] = Vector::new(gamma, 0.0);
    edge[n - 1] = Vector::new(corner, 0.0);
    let z = tridiagonal(&rows, &edge);
    let share = (y[0] + y[n - 1] * (corner / gamma)) / (1.0 + (z[0] + z[n - 1] * (corner / gamma)).re);
    let mut bend: Vec<Vector> = y.iter().zip(&z).map(|(y, z)| y - share * z.re).collect();
    bend.push(bend[0]);
    bend
}

/// Solves a diagonally dominant tridiagonal system with rows [below, diagonal, above].
fn tridiagonal(rows: &[[f64; 3]], sides: &[Vector]) -> Vec<Vector> {
    let n = rows.len();
    let (mut above, mut x) = (vec![0.0; n], vec![Vector::default(); n]);
    for i in 0..n {
        let [below, diagonal, next] = rows[i];
        let (last, previous) = if i > 0 { (above[i - 1], x[i - 1]) } else { (0.0, Vector::default()) };
        let below = if i > 0 { below } else { 0.0 };
        let pivot = diagonal - below * last;
        above[i] = next / pivot;
        x[i] = (sides[i] - below * previous) / pivot;
    }
    for i in (0..n.saturating_sub(1)).rev() {
        let next = x[i + 1];
        x[i] -= above[i] * next;
    }
    x
}

/// Number of intervals between the knots of a freehand curve.
const FREEHAND_INTERVALS: usize = 24;

/// Returns points spaced evenly along a polyline, `spaces` intervals, and the spacing.
fn resampled(points: &[Vector], length: f64, spaces: usize) -> (Vec<Vector>, f64) {
    let spacing = length / spaces as f64;
    let (mut i, mut behind) = (0, 0.0);
    let sample = |k: usize| {
        let want = k as f64 * spacing;
        let mut own = (points[i + 1] - points[i]).norm();
        while i + 2 < points.len() && behind + own < want {
            behind += own;
            i += 1;
            own = (points[i + 1] - points[i]).norm();
        }
        points[i] + (points[i + 1] - points[i]) * ((want - behind) / own).clamp(0.0, 1.0)
    };
    ((0..=spaces).map(sample).collect(), spacing)
}

/// Replaces each point by a Gaussian-weighted mean of its neighbours. `width` is the standard deviation in points; the
/// first and the last point stay.
fn smoothed(points: &[Vector], width: f64) -> Vec<Vector> {
    let n = points.len();
    let reach = (3.0 * width).ceil() as usize;
    let mean = |i: usize| {
        let room = reach.min(i).min(n - 1 - i);
        let (mut sum, mut weight) = (points[i], 1.0);
        for k in 1..=room {
            let w = (-0.5 * (k as f64 / width).powi(2)).exp();
            sum += w * (points[i - k] + points[i + k]);
            weight += 2.0 * w;
        }
        sum / weight
    };
    (0..n).map(mean).collect()
}
