//! [`JerkProgram`]: the limits of a path at places between its nodes.

use super::easing::eased;
use super::spline::share;
use crate::mechanics::planar::{MAX_DRIVES, PerDrive};
use crate::planning::curves::PathPoint;
use crate::planning::curves::path::Path;
use crate::planning::timing::limits::{ConstraintRow, Constraints, MAX_ROWS};

/// Where limits are kept in every space, as shares of it, each with half of its weight: two points of Gauss.
const GAUSS_PLACES: [f64; 2] = [0.211_324_865_405_187_1, 0.788_675_134_594_812_9];
/// Near both ends, where all changes fast, at more places, which count for no time.
const END_PLACES: [(f64, f64); 5] =
    [(0.01, 0.0), (GAUSS_PLACES[0], 0.5), (0.5, 0.0), (GAUSS_PLACES[1], 0.5), (0.99, 0.0)];
/// So many spaces are near an end.
const END_SPACES: usize = 4;

/// A two-sided limit at a place: |v · c + g y^⅓| ≤ y^⅓, or |v · c − k y′²/y| ≤ 1 for speed and jerk; c the three
/// coefficients from the place's first.
#[derive(Clone, Copy, Default)]
pub(super) struct Side {
    pub v: [f64; 3],
    /// g or k.
    pub g: f64,
    /// How far from the limit it is above and below, and what that is worth.
    pub room: [f64; 2],
    pub worth: [f64; 2],
    /// How room changes with the coefficients.
    pub slope: [[f64; 3]; 2],
    /// The product of both changes, as the predictor has them.
    pub bent: [f64; 2],
    /// Room after a step that is tried.
    pub next: [f64; 2],
}

impl Side {
    /// Takes the room of the step that was tried.
    pub fn settle(&mut self) {
        self.room = self.next;
    }
}

/// A place in a space at which limits are kept.
#[derive(Clone, Copy)]
pub(super) struct Place {
    pub theta: f64,
    /// The first of its three coefficients.
    pub first: usize,
    /// y and y′ as sums of coefficients.
    pub y: [f64; 3],
    pub slope: [f64; 3],
    /// Of the space's time.
    pub weight: f64,
}

/// The program on given nodes.
pub struct JerkProgram {
    pub(super) nodes: Vec<f64>,
    pub(super) places: Vec<Place>,
    pub(super) sides: Vec<Side>,
    /// Sides of a place, and how many of them are of torque and acceleration; one of speed and those of jerk follow.
    pub(super) each: usize,
    pub(super) linear: usize,
    /// Room of each coefficient above 0 is itself; its worth, and as for the sides.
    pub(super) worth: Vec<f64>,
    pub(super) bent: Vec<f64>,
}

impl JerkProgram {
    /// Of a path on nodes θ that rise from 0 to 1; θ̇² is to stay below `most`.
    pub fn new(path: &Path, constraints: &Constraints, nodes: Vec<f64>, most: f64) -> Self {
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
            let near_end = i < END_SPACES || i + END_SPACES >= spaces;
            let own = if near_end { &END_PLACES[..] } else { &GAUSS_PLACES.map(|at| (at, 0.5)) };
            for &(at, weight) in own {
                let back = 1.0 - at;
                let by = |w: [f64; 3]| spread(w, shares);
                let y = by([back * back, 2.0 * at * back, at * at]);
                let slope = by([-back, back - at, at].map(|w| 2.0 / h * w));
                let bend = by([1.0, -2.0, 1.0].map(|w| 2.0 / (h * h) * w));
                let theta = nodes[i] + at * h;
                let (point, third) = reckoned(path, theta);
                let cap = constraints.at(&point, rows, speeds).min(most);
                let sum = |p: f64, q: f64, r: f64| [0, 1, 2].map(|k| p * bend[k] + q * slope[k] + r * y[k]);
                let side = |v, g| Side { v, g, ..Side::default() };
                sides.extend(rows.iter().map(|row| side(sum(0.0, row.a / 3.0, row.c), row.g)));
                sides.push(side(y.map(|y| y / cap.powf(1.5)), 0.0));
                let motors = constraints.motors();
                let [first, second, third] = [&point.first, &point.second, &third].map(|x| motors.turns(x));
                sides.extend(jerked.iter().map(|k| {
                    let per = 1.0 / limits.jerk[*k];
                    let (a, b, c) = (per * first[*k], per * second[*k], per * third[*k]);
                    side(sum(a / 3.0, b, c), a / 9.0)
                }));
                places.push(Place { theta, first: i, y, slope, weight: weight * h });
            }
        }
        let count = nodes.len() + 1;
        Self { nodes, places, sides, each, linear, worth: vec![0.0; count], bent: vec![0.0; count] }
    }
}

/// The path reckoned by θ, and its third derivative.
fn reckoned(path: &Path, theta: f64) -> (PathPoint, PerDrive) {
    let [s, a, b, c] = eased(theta);
    let (point, third) = (path.at(s), path.third(s));
    let PathPoint { q, first, second } = point;
    let third = third.scaled(a * a * a).plus(3.0 * a * b, &second).plus(c, &first);
    (PathPoint { q, first: first.scaled(a), second: second.scaled(a * a).plus(b, &first) }, third)
}

/// What counts by the values at both ends of a space and the coefficient between, by coefficients.
fn spread(w: [f64; 3], [from, to]: [f64; 2]) -> [f64; 3] {
    [w[0] * (1.0 - from), w[0] * from + w[1] + w[2] * (1.0 - to), w[2] * to]
}

/// v · c, of the first three coefficients.
#[inline]
pub(super) fn dot(v: &[f64; 3], c: &[f64]) -> f64 {
    v[0] * c[0] + v[1] * c[1] + v[2] * c[2]
}
