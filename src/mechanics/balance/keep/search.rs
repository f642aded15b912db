//! [`RebalanceSearch`]: minimises Σ (p Δ)² if a mass and a position of one body may both change.
//!
//! The conditions and all limits are linear in y, but a position changes by y m₀/(p m). So the objective F(y), the sum
//! of all y_m² and (y_l m₀/m)², is not convex. Newton's method minimises F from several starts. Each step goes towards
//! the minimum of a quadratic model within the limits, and stays feasible because the feasible set is convex. The
//! result is no worse than any start, one of which keeps every mass at its reference value. It is not certified:
//! another local minimum may be lower.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | m₀/m | reference mass of a body over its new mass | |
//! | c | y_l m₀/m, which is p times the change of a position | |
//! | β | 1/(m p_m), the derivative of ln m by y_m | |

use nalgebra::{Cholesky, DMatrix, DVector};

use super::super::distance::nearest;
use super::super::plane::{LinearEquation, SolutionSpace};
use stillbase_convex::LinearRow;

/// Maximum number of Newton steps from one start.
const MAX_NEWTON_STEPS: usize = 60;
/// Iteration stops if the predicted decrease is less than this fraction of F.
const MIN_DECREASE: f64 = 1e-15;
/// Smallest curvature of a convexified model along y_m, as a fraction of the curvature of y_m².
const MIN_CURVATURE: f64 = 0.05;
/// Sufficient decrease: the fraction of the predicted decrease that a step must achieve.
const SUFFICIENT_DECREASE: f64 = 1e-4;
/// Ratios m/m₀ in the quadratic models of the first starts; each is used for all masses.
const START_MASS_RATIOS: [f64; 5] = [1.0, 3.0, 0.3, 8.0, 0.12];
/// Number of starts with a different ratio for each mass, per mass that may change.
const MIXED_STARTS_PER_MASS: usize = 8;
/// Maximum number of starts with a different ratio for each mass.
const MAX_MIXED_STARTS: usize = 16;
/// Maximum number of starts from which Newton's method runs: those with the smallest F.
const MAX_SEARCHES: usize = 6;
/// Relative increase of F, due to rounding, that is accepted when a result is replaced by one with exact positions.
const VALUE_TOLERANCE: f64 = 1e-9;

/// A mass that may change.
pub(super) struct MassVariable {
    /// Its index in y.
    pub at: usize,
    /// Reference mass m₀, kg.
    pub from: f64,
    /// Penalty p, 1/kg.
    pub penalty: f64,
    /// Its limits, kg.
    pub ends: [f64; 2],
    /// Indices in y of the positions of the same body that may change.
    pub places: Vec<usize>,
}

/// The minimisation problem.
pub(super) struct RebalanceSearch<'a> {
    pub equations: &'a [LinearEquation],
    /// Whether each component of y enters F; fixed parameters do not.
    pub counts: Vec<bool>,
    pub masses: Vec<MassVariable>,
    /// The limits, a · y ≤ right.
    pub bounds: &'a [LinearRow],
}

impl RebalanceSearch<'_> {
    /// Returns the results of all searches, the best first; empty if no point is feasible.
    pub fn least(&self, plane: &SolutionSpace) -> Vec<DVector<f64>> {
        let mut starts = self.starts(plane);
        starts.sort_by(|a, b| self.value(a).total_cmp(&self.value(b)));
        starts.truncate(MAX_SEARCHES);
        let unchanged = self.with_masses(&self.masses.iter().map(|mass| mass.from).collect::<Vec<_>>());
        let mut ends: Vec<_> = starts.into_iter().chain(unchanged).map(|y| self.descend(plane, y)).collect();
        ends.sort_by(|a, b| self.value(a).total_cmp(&self.value(b)));
        // The problem is solved again with these masses fixed, so that positions are exact.
        let exact = ends.first().and_then(|best| {
            let masses = self.masses.iter().map(|mass| mass.from + best[mass.at] / mass.penalty);
            self.with_masses(&masses.collect::<Vec<_>>())
                .filter(|y| self.value(y) <= self.value(best) * (1.0 + VALUE_TOLERANCE))
        });
        exact.into_iter().chain(ends).collect()
    }

    /// Returns m₀/m of a body.
    fn ratio(&self, mass: &MassVariable, y: &DVector<f64>) -> f64 {
        mass.from / (mass.from + y[mass.at] / mass.penalty)
    }

    /// Returns F(y).
    fn value(&self, y: &DVector<f64>) -> f64 {
        let mut c = y.clone();
        for mass in &self.masses {
            let ratio = self.ratio(mass, y);
            mass.places.iter().for_each(|i| c[*i] *= ratio);
        }
        c.iter().zip(&self.counts).filter(|(_, counts)| **counts).map(|(c, _)| c * c).sum()
    }

    fn starts(&self, plane: &SolutionSpace) -> Vec<DVector<f64>> {
        let all = START_MASS_RATIOS.map(|by| vec![by; self.masses.len()]);
        let several = self.masses.len() > 1;
        let mixed = (1..=(MIXED_STARTS_PER_MASS * self.masses.len()).min(MAX_MIXED_STARTS)).filter(|_| several);
        let mixed = mixed.map(|start| (0..self.masses.len()).map(|i| mixed_ratio(start, i)).collect());
        let ratios = all.into_iter().chain(mixed);
        ratios.filter_map(|ratios: Vec<f64>| self.start(plane, &ratios)).collect()
    }

    /// Minimises F with the masses fixed at given values, kg, clamped to their limits; `None` if that is not feasible.
    fn with_masses(&self, masses: &[f64]) -> Option<DVector<f64>> {
        let held = self.masses.iter().zip(masses).map(|(mass, value)| {
            let mut a = vec![0.0; self.counts.len()];
            a[mass.at] = 1.0;
            let value = value.clamp(mass.ends[0], mass.ends[1]);
            LinearEquation { a, right: mass.penalty * (value - mass.from), tolerance: 1e-9 * mass.penalty * mass.from }
        });
        let equations: Vec<LinearEquation> = self.equations.iter().cloned().chain(held).collect();
        let plane = SolutionSpace::of(&equations, self.counts.len());
        let y = plane.exists.then(|| plane.nearest(self.bounds).ok()).flatten()?;
        Some(self.descend(&plane, y))
    }

    /// Returns the minimum of a quadratic model of F, built for given ratios m/m₀, that also penalises other ratios;
    /// `None` if the limits are infeasible.
    fn start(&self, plane: &SolutionSpace, ratios: &[f64]) -> Option<DVector<f64>> {
        let mut h =
            DMatrix::from_diagonal(&DVector::from_iterator(self.counts.len(), self.counts.iter().map(curvature)));
        let mut from = DVector::zeros(self.counts.len());
        for (mass, ratio) in self.masses.iter().zip(ratios) {
            mass.places.iter().for_each(|i| h[(*i, *i)] /= ratio * ratio);
            from[mass.at] = mass.penalty * mass.from * (ratio - 1.0);
        }
        let (m, c) = plane.reduced_bounds(self.bounds);
        let reduced = plane.null_space.tr_mul(&(&h * &plane.null_space));
        let slope = plane.null_space.tr_mul(&(&h * (&plane.particular - from)));
        let z = step(&DVector::zeros(plane.null_space.ncols()), &slope, reduced, &m, &c)?;
        Some(&plane.particular + &plane.null_space * z)
    }

    /// Minimises F from a start by Newton's method with a backtracking line search.
    fn descend(&self, plane: &SolutionSpace, start: DVector<f64>) -> DVector<f64> {
        let (m, c) = plane.reduced_bounds(self.bounds);
        let place = |z: &DVector<f64>| &plane.particular + &plane.null_space * z;
        let mut z = plane.null_space.tr_mul(&(&start - &plane.particular));
        for _ in 0..MAX_NEWTON_STEPS {
            let y = place(&z);
            let value = self.value(&y);
            let slope = plane.null_space.tr_mul(&self.slope(&y));
            let model = |convex: bool| {
                step(&z, &slope, plane.null_space.tr_mul(&(self.curvature(&y, convex) * &plane.null_space)), &m, &c)
            };
            let Some(to) = model(false).or_else(|| model(true)) else { break };
            let way = &to - &z;
            let predicted = -slope.dot(&way);
            if predicted <= MIN_DECREASE * value || predicted.is_nan() {
                break;
            }
            let shorter = (0..40).map(|i| 0.5_f64.powi(i));
            let sufficient =
                |by: &f64| self.value(&place(&(&z + &way * *by))) <= value - SUFFICIENT_DECREASE * by * predicted;
            let Some(by) = shorter.into_iter().find(sufficient) else { break };
            z += way * by;
        }
        place(&z)
    }

    /// Returns the gradient ∂F/∂y.
    fn slope(&self, y: &DVector<f64>) -> DVector<f64> {
        let mut slope = DVector::from_fn(y.len(), |i, _| if self.counts[i] { 2.0 * y[i] } else { 0.0 });
        for mass in &self.masses {
            let ratio = self.ratio(mass, y);
            let beta = ratio / (mass.from * mass.penalty);
            for i in mass.places.iter().filter(|i| self.counts[**i]) {
                slope[*i] *= ratio * ratio;
                slope[mass.at] -= 2.0 * beta * (y[*i] * ratio).powi(2);
            }
        }
        slope
    }

    /// Returns the Hessian ∂²F/∂y², or a positive definite matrix in place of it if `convex`.
    fn curvature(&self, y: &DVector<f64>, convex: bool) -> DMatrix<f64> {
        let mut h = DMatrix::from_diagonal(&DVector::from_iterator(y.len(), self.counts.iter().map(curvature)));
        for mass in &self.masses {
            let ratio = self.ratio(mass, y);
            let beta = ratio / (mass.from * mass.penalty);
            let (k, mut bent) = (mass.at, 0.0);
            for &i in mass.places.iter().filter(|i| self.counts[**i]) {
                let c = y[i] * ratio;
                h[(i, i)] *= ratio * ratio;
                h[(i, k)] = -4.0 * beta * ratio * c;
                h[(k, i)] = h[(i, k)];
                h[(k, k)] += 6.0 * (beta * c).powi(2);
                bent += (beta * c).powi(2);
            }
            if convex {
                // The curvature along y_m, with the positions eliminated, is 2 − 2 Σ (β c)².
                h[(k, k)] += 2.0 * (bent - 1.0 + MIN_CURVATURE).max(0.0);
            }
        }
        h
    }
}

/// Returns the ratio m/m₀ of the i-th mass at a start, from 0.1 to 10: an additive recurrence, which spreads evenly.
fn mixed_ratio(start: usize, i: usize) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_894_8;
    let step = (GOLDEN * (i + 1) as f64 * (1.0 + GOLDEN * i as f64)).fract();
    let place = (0.5 + step * start as f64).fract();
    10.0_f64.powf(2.0 * place - 1.0)
}

fn curvature(counts: &bool) -> f64 {
    if *counts { 2.0 } else { 0.0 }
}

/// Returns the minimum of a quadratic model about z within M z ≤ c; `None` if the model is not convex or the
/// constraints are infeasible.
fn step(
    z: &DVector<f64>,
    slope: &DVector<f64>,
    curvature: DMatrix<f64>,
    m: &DMatrix<f64>,
    c: &DVector<f64>,
) -> Option<DVector<f64>> {
    let model = Cholesky::new(curvature)?;
    let (centre, l) = (z - model.solve(slope), model.l());
    // In coordinates Lᵀ (z − centre) the model is half the squared distance from 0.
    let turned = l.solve_lower_triangular(&m.transpose())?.transpose();
    let way = nearest(&turned, &(c - m * &centre)).ok()?;
    Some(centre + l.tr_solve_lower_triangular(&way)?)
}
