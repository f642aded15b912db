//! [`JerkProgram`]: the limits of a path at points between its nodes.

use super::easing::eased;
use super::spline::share;
use crate::curves::PathPoint;
use crate::curves::path::Path;
use crate::timing::limits::{ConstraintRow, Constraints, MAX_ROWS};
use stillbase_mechanics::planar::{MAX_DRIVES, PerDrive};

/// Positions in every interval at which limits are imposed, as fractions of it. Each has half the quadrature weight:
/// two-point Gaussian quadrature.
const GAUSS_PLACES: [f64; 2] = [0.211_324_865_405_187_1, 0.788_675_134_594_812_9];
/// Points and weights in intervals near both ends, where quantities change fast; the additional points have zero
/// weight.
const END_PLACES: [(f64, f64); 5] =
    [(0.01, 0.0), (GAUSS_PLACES[0], 0.5), (0.5, 0.0), (GAUSS_PLACES[1], 0.5), (0.99, 0.0)];
/// Number of intervals at each end that are treated as near the end.
const END_INTERVALS: usize = 4;

/// A two-sided limit at a point: |v · c + g y^⅓| ≤ y^⅓, or |v · c − k y′²/y| ≤ 1 for speed and jerk. Here y is θ̇³ and
/// c are three spline coefficients of y, from [`LimitPoint::first`] on.
#[derive(Clone, Copy, Default)]
pub(super) struct TwoSidedLimit {
    /// v.
    pub v: [f64; 3],
    /// g of torque and acceleration, k of speed and jerk.
    pub g: f64,
    /// Slacks of the upper and the lower limit.
    pub slack: [f64; 2],
    /// Multipliers of these limits.
    pub multiplier: [f64; 2],
    /// Gradients of the slacks with respect to the coefficients.
    pub slope: [[f64; 3]; 2],
    /// Products of the predicted changes of slack and multiplier (second-order correction).
    pub correction: [f64; 2],
    /// Slacks after a trial step.
    pub next: [f64; 2],
}

impl TwoSidedLimit {
    /// Accepts the slacks of the trial step.
    pub fn accept(&mut self) {
        self.slack = self.next;
    }
}

/// A point in an interval at which limits are imposed.
#[derive(Clone, Copy)]
pub(super) struct LimitPoint {
    /// θ of the point.
    pub theta: f64,
    /// Index of the first of its three coefficients.
    pub first: usize,
    /// Weights of the coefficients in y.
    pub y: [f64; 3],
    /// Weights of the coefficients in y′.
    pub slope: [f64; 3],
    /// Quadrature weight in θ.
    pub weight: f64,
}

/// The nonlinear program of a path on given nodes θ_i, with the state of its solution.
pub struct JerkProgram {
    pub(super) nodes: Vec<f64>,
    pub(super) places: Vec<LimitPoint>,
    pub(super) sides: Vec<TwoSidedLimit>,
    /// Number of two-sided limits at each point.
    pub(super) each: usize,
    /// Number of limits on torque and acceleration at each point. They come first, then one on speed, then jerk.
    pub(super) linear: usize,
    /// Multipliers of the constraints c_i ≥ 0, whose slacks are the coefficients.
    pub(super) multiplier: Vec<f64>,
    /// Second-order corrections of the constraints c_i ≥ 0.
    pub(super) correction: Vec<f64>,
}

impl JerkProgram {
    /// Builds the program of a path on nodes θ that rise from 0 to 1; θ̇² must not exceed `max_square`.
    pub fn new(path: &Path, constraints: &Constraints, nodes: Vec<f64>, max_square: f64) -> Self {
        let limits = constraints.limits();
        let jerked: Vec<usize> = (0..limits.jerk.len()).filter(|k| limits.jerk[*k].is_finite()).collect();
        let linear = constraints.rows().len();
        let (each, spaces) = (linear + 1 + jerked.len(), nodes.len() - 1);
        let mut places = Vec::with_capacity(2 * spaces);
        let mut sides = Vec::with_capacity(2 * spaces * each);
        let mut rows = [ConstraintRow::default(); MAX_ROWS];
        let rows = &mut rows[..linear];
        let mut speeds = [0.0; MAX_DRIVES];
        let speeds = &mut speeds[..constraints.speeds()];
        for i in 0..spaces {
            let (h, shares) = (nodes[i + 1] - nodes[i], [share(&nodes, i), share(&nodes, i + 1)]);
            let near_end = i < END_INTERVALS || i + END_INTERVALS >= spaces;
            let own = if near_end { &END_PLACES[..] } else { &GAUSS_PLACES.map(|at| (at, 0.5)) };
            for &(at, weight) in own {
                let back = 1.0 - at;
                let by = |w: [f64; 3]| spread(w, shares);
                let y = by([back * back, 2.0 * at * back, at * at]);
                let slope = by([-back, back - at, at].map(|w| 2.0 / h * w));
                let bend = by([1.0, -2.0, 1.0].map(|w| 2.0 / (h * h) * w));
                let theta = nodes[i] + at * h;
                let (point, third) = by_theta(path, theta);
                let cap = constraints.at(&point, rows, speeds).min(max_square);
                let sum = |p: f64, q: f64, r: f64| [0, 1, 2].map(|k| p * bend[k] + q * slope[k] + r * y[k]);
                let side = |v, g| TwoSidedLimit { v, g, ..TwoSidedLimit::default() };
                sides.extend(rows.iter().map(|row| side(sum(0.0, row.a / 3.0, row.c), row.g)));
                sides.push(side(y.map(|y| y / cap.powf(1.5)), 0.0));
                let motors = constraints.motors();
                let [first, second, third] = [&point.first, &point.second, &third].map(|x| motors.to_motors(x));
                sides.extend(jerked.iter().map(|k| {
                    let per = 1.0 / limits.jerk[*k];
                    let (a, b, c) = (per * first[*k], per * second[*k], per * third[*k]);
                    side(sum(a / 3.0, b, c), a / 9.0)
                }));
                places.push(LimitPoint { theta, first: i, y, slope, weight: weight * h });
            }
        }
        let count = nodes.len() + 1;
        Self { nodes, places, sides, each, linear, multiplier: vec![0.0; count], correction: vec![0.0; count] }
    }
}

/// Returns the path with its derivatives with respect to θ instead of s, and its third derivative.
fn by_theta(path: &Path, theta: f64) -> (PathPoint, PerDrive) {
    let [s, a, b, c] = eased(theta);
    let (point, third) = (path.at(s), path.third(s));
    let PathPoint { q, first, second } = point;
    let third = third.scaled(a * a * a).plus(3.0 * a * b, &second).plus(c, &first);
    (PathPoint { q, first: first.scaled(a), second: second.scaled(a * a).plus(b, &first) }, third)
}

/// Converts weights of an interval's three Bézier coefficients, of which the outer two are its end values, to weights
/// of three spline coefficients.
fn spread(w: [f64; 3], [from, to]: [f64; 2]) -> [f64; 3] {
    [w[0] * (1.0 - from), w[0] * from + w[1] + w[2] * (1.0 - to), w[2] * to]
}

/// Returns v · c for the first three coefficients.
#[inline]
pub(super) fn dot(v: &[f64; 3], c: &[f64]) -> f64 {
    v[0] * c[0] + v[1] * c[1] + v[2] * c[2]
}
