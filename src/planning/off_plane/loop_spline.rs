//! Splines of degree 5 that leave a pose and return to it, and their quadrature.
//!
//! # Source
//! Clamped B-splines on evenly spaced knots by the recursion of Cox and de Boor; q^(4) is continuous.

use nalgebra::DMatrix;

use crate::curves::PathPoint;
use crate::curves::table::PathTable;
use stillbase_mechanics::planar::{DriveAngles, PerDrive};

const DEGREE: usize = 5;
/// Number of polynomial pieces.
const PIECES: usize = 16;
/// Number of B-splines that vanish at both ends.
pub(super) const INNER: usize = PIECES + DEGREE - 2;
/// Gauss points and weights from −1 to 1.
const GAUSS: [[f64; 2]; 5] = [
    [-0.906_179_845_938_664, 0.236_926_885_056_189_1],
    [-0.538_469_310_105_683, 0.478_628_670_499_366_5],
    [0.0, 0.568_888_888_888_888_9],
    [0.538_469_310_105_683, 0.478_628_670_499_366_5],
    [0.906_179_845_938_664, 0.236_926_885_056_189_1],
];

/// Returns knot i.
fn knot(i: usize) -> f64 {
    (i.saturating_sub(DEGREE) as f64).min(PIECES as f64) / PIECES as f64
}

/// Values at a place s of the B-splines that do not vanish there, with their first and second derivatives.
#[derive(Clone, Copy, Debug)]
pub(super) struct Station {
    /// Weight of the place in a quadrature over s.
    pub weight: f64,
    /// Index of the first of these splines; −1 for the one that is 1 at s = 0.
    first: isize,
    values: [[f64; 3]; DEGREE + 1],
}

impl Station {
    fn at(s: f64, weight: f64) -> Self {
        let piece = ((s * PIECES as f64) as usize).min(PIECES - 1);
        // Splines of degree p by index, from those of degree p − 1.
        let mut of_degree = vec![vec![0.0; PIECES + DEGREE + 1]; DEGREE + 1];
        of_degree[0] = (0..=PIECES + DEGREE).map(|i| f64::from(i == piece + DEGREE)).collect();
        let ratio = |x: f64, width: f64| if width > 0.0 { x / width } else { 0.0 };
        for p in 1..=DEGREE {
            for i in piece + DEGREE - p..=piece + DEGREE {
                let rising = ratio(s - knot(i), knot(i + p) - knot(i)) * of_degree[p - 1][i];
                let next = of_degree[p - 1].get(i + 1).copied().unwrap_or(0.0);
                of_degree[p][i] = rising + ratio(knot(i + p + 1) - s, knot(i + p + 1) - knot(i + 1)) * next;
            }
        }
        // N′_{i,p} = p (N_{i,p−1}/(t_{i+p} − t_i) − N_{i+1,p−1}/(t_{i+p+1} − t_{i+1})).
        let slope = |i: usize, p: usize, below: &dyn Fn(usize) -> f64| {
            p as f64 * (ratio(below(i), knot(i + p) - knot(i)) - ratio(below(i + 1), knot(i + p + 1) - knot(i + 1)))
        };
        let plain = |p: usize| {
            let row = &of_degree[p];
            move |i: usize| row.get(i).copied().unwrap_or(0.0)
        };
        let values = std::array::from_fn(|j| {
            let i = piece + j;
            let first = slope(i, DEGREE, &plain(DEGREE - 1));
            let below = |i: usize| slope(i, DEGREE - 1, &plain(DEGREE - 2));
            [of_degree[DEGREE][i], first, slope(i, DEGREE, &below)]
        });
        Self { weight, first: piece as isize - 1, values }
    }

    /// Returns the index and the values of each inner spline that does not vanish here.
    pub fn splines(&self) -> impl Iterator<Item = (usize, [f64; 3])> + '_ {
        let all = self.values.iter().enumerate().map(|(j, values)| (self.first + j as isize, *values));
        all.filter(|(i, _)| (0..INNER as isize).contains(i)).map(|(i, values)| (i as usize, values))
    }

    /// Returns q, q′ and q″ here of the spline from `start` with coefficients x: entry i·n + k is that of spline i and
    /// drive k, rad.
    pub fn point(&self, start: &DriveAngles, x: &[f64]) -> PathPoint {
        let n = start.len();
        let sum = |d: usize| PerDrive::from_fn(n, |k| self.splines().map(|(i, v)| v[d] * x[i * n + k]).sum());
        PathPoint { q: DriveAngles(start.0.plus(1.0, &sum(0))), first: sum(1), second: sum(2) }
    }
}

/// Returns the places and weights of a quadrature over s, with five places in each of `parts` parts of a piece.
pub(super) fn stations(parts: usize) -> Vec<Station> {
    let h = 0.5 / (PIECES * parts) as f64;
    let part = |i: usize| GAUSS.map(|[x, w]| Station::at(h * (2.0 * i as f64 + 1.0 + x), h * w));
    (0..PIECES * parts).flat_map(part).collect()
}

/// Returns ∫ N_i′ N_j′ ds of the inner splines, exact.
pub(super) fn gram(stations: &[Station]) -> DMatrix<f64> {
    let mut gram = DMatrix::zeros(INNER, INNER);
    for station in stations {
        for (i, a) in station.splines() {
            for (j, b) in station.splines() {
                gram[(i, j)] += station.weight * a[1] * b[1];
            }
        }
    }
    gram
}

/// Returns coefficients of the spline that interpolates a curve from its start and back, given relative to the start, rad.
pub(super) fn interpolated(n: usize, curve: impl Fn(f64) -> PerDrive) -> Option<Vec<f64>> {
    // The Greville abscissae, where interpolation by B-splines is stable.
    let greville = |i: usize| (1..=DEGREE).map(|j| knot(i + 1 + j)).sum::<f64>() / DEGREE as f64;
    let (mut matrix, mut right) = (DMatrix::zeros(INNER, INNER), DMatrix::zeros(INNER, n));
    for row in 0..INNER {
        let s = greville(row);
        Station::at(s, 0.0).splines().for_each(|(i, v)| matrix[(row, i)] = v[0]);
        let place = curve(s);
        (0..n).for_each(|k| right[(row, k)] = place[k]);
    }
    let x = matrix.lu().solve(&right)?;
    Some((0..INNER * n).map(|i| x[(i / n, i % n)]).collect())
}

/// Returns the spline as a table, which is exact: its pieces are quintics.
pub(super) fn table(start: &DriveAngles, x: &[f64]) -> Option<PathTable> {
    let node = |i: usize| Station::at(i as f64 / PIECES as f64, 0.0).point(start, x);
    PathTable::even((0..=PIECES).map(node).collect())
}
