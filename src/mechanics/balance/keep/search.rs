//! [`Search`]: the least Σ (p Δ)² where a mass and a place of one body may change.
//!
//! In y the conditions and all limits are linear, but a place changes by y m₀/(p m), so that
//! F(y) = Σ y_m² + Σ (y_l m₀/m)² is not convex. From several starts Newton steps go downhill on it: each is the least of
//! a quadratic model within the limits, and every point between two that are within is within. What is found is no worse
//! than any of the starts, of which one keeps every mass as it is. It is not certified: another place may be better.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | m₀/m | of a body, where its change is measured from and what it becomes | |
//! | c | y_l m₀/m, p times how far a place moves | |
//! | β | 1/(m p_m): how fast ln m grows with y_m | |

use nalgebra::{Cholesky, DMatrix, DVector};

use super::super::distance::nearest;
use super::super::plane::{Equation, Plane};
use crate::convex::Row;

/// Newton steps from one start.
const MAX_STEPS: usize = 60;
/// A step that promises less than this fraction of F is the last.
const NO_GAIN: f64 = 1e-15;
/// The least curvature, in that of a mass alone, which is left to a model that is not convex.
const LEAST_CURVATURE: f64 = 0.05;
/// Part of what a step promises which it has to keep.
const KEEPS: f64 = 1e-4;
/// How much heavier than what they are measured from all masses are taken to be in the first quadratic models.
const HEAVIER: [f64; 5] = [1.0, 3.0, 0.3, 8.0, 0.12];
/// Starts with masses that differ from each other, for each that may change.
const MIXED_STARTS: usize = 8;
/// No more of them than this.
const MAX_MIXED_STARTS: usize = 16;
/// How many of the starts, the best ones, a search goes on from.
const MAX_SEARCHES: usize = 6;
/// Exact places may cost so much more, as a fraction: rounding.
const AS_GOOD: f64 = 1e-9;

/// A mass that may change.
pub(super) struct Mass {
    /// Its place in y.
    pub at: usize,
    /// What its change is measured from, kg.
    pub from: f64,
    /// p, 1/kg.
    pub penalty: f64,
    /// Its limits, kg.
    pub ends: [f64; 2],
    /// The places of the same body that may change, in y.
    pub places: Vec<usize>,
}

/// What is looked for.
pub(super) struct Search<'a> {
    pub equations: &'a [Equation],
    /// Whether each of y counts: fixed ones do not.
    pub counts: Vec<bool>,
    pub masses: Vec<Mass>,
    /// a · y ≤ right.
    pub bounds: &'a [Row],
}

impl Search<'_> {
    /// Where searches end, the best first; none where nothing is within the limits.
    pub fn least(&self, plane: &Plane) -> Vec<DVector<f64>> {
        let mut starts = self.starts(plane);
        starts.sort_by(|a, b| self.value(a).total_cmp(&self.value(b)));
        starts.truncate(MAX_SEARCHES);
        let unchanged = self.held(&self.masses.iter().map(|mass| mass.from).collect::<Vec<_>>());
        let mut ends: Vec<_> = starts.into_iter().chain(unchanged).map(|y| self.descend(plane, y)).collect();
        ends.sort_by(|a, b| self.value(a).total_cmp(&self.value(b)));
        // Once more with these masses, so that places are exact.
        let exact = ends.first().and_then(|best| {
            let masses = self.masses.iter().map(|mass| mass.from + best[mass.at] / mass.penalty);
            self.held(&masses.collect::<Vec<_>>()).filter(|y| self.value(y) <= self.value(best) * (1.0 + AS_GOOD))
        });
        exact.into_iter().chain(ends).collect()
    }

    /// m₀/m of a body.
    fn ratio(&self, mass: &Mass, y: &DVector<f64>) -> f64 {
        mass.from / (mass.from + y[mass.at] / mass.penalty)
    }

    /// F.
    fn value(&self, y: &DVector<f64>) -> f64 {
        let mut c = y.clone();
        for mass in &self.masses {
            let ratio = self.ratio(mass, y);
            mass.places.iter().for_each(|i| c[*i] *= ratio);
        }
        c.iter().zip(&self.counts).filter(|(_, counts)| **counts).map(|(c, _)| c * c).sum()
    }

    fn starts(&self, plane: &Plane) -> Vec<DVector<f64>> {
        let all = HEAVIER.map(|by| vec![by; self.masses.len()]);
        let several = self.masses.len() > 1;
        let mixed = (1..=(MIXED_STARTS * self.masses.len()).min(MAX_MIXED_STARTS)).filter(|_| several);
        let mixed = mixed.map(|start| (0..self.masses.len()).map(|i| scattered(start, i)).collect());
        let modelled = all.into_iter().chain(mixed).filter_map(|heavier: Vec<f64>| self.modelled(plane, &heavier));
        modelled.collect()
    }

    /// The best with given masses, kg, as near as their limits let them be.
    fn held(&self, masses: &[f64]) -> Option<DVector<f64>> {
        let held = self.masses.iter().zip(masses).map(|(mass, value)| {
            let mut a = vec![0.0; self.counts.len()];
            a[mass.at] = 1.0;
            let value = value.clamp(mass.ends[0], mass.ends[1]);
            Equation { a, right: mass.penalty * (value - mass.from), tolerance: 1e-9 * mass.penalty * mass.from }
        });
        let equations: Vec<Equation> = self.equations.iter().cloned().chain(held).collect();
        let plane = Plane::of(&equations, self.counts.len());
        let y = plane.exists.then(|| plane.nearest(self.bounds).ok()).flatten()?;
        Some(self.descend(&plane, y))
    }

    /// The least of F with m₀/m as if the masses were so much heavier, and their changes measured from there.
    fn modelled(&self, plane: &Plane, heavier: &[f64]) -> Option<DVector<f64>> {
        let mut h =
            DMatrix::from_diagonal(&DVector::from_iterator(self.counts.len(), self.counts.iter().map(curvature)));
        let mut from = DVector::zeros(self.counts.len());
        for (mass, heavier) in self.masses.iter().zip(heavier) {
            mass.places.iter().for_each(|i| h[(*i, *i)] /= heavier * heavier);
            from[mass.at] = mass.penalty * mass.from * (heavier - 1.0);
        }
        let (m, c) = plane.cut(self.bounds);
        let reduced = plane.free.tr_mul(&(&h * &plane.free));
        let slope = plane.free.tr_mul(&(&h * (&plane.start - from)));
        let z = step(&DVector::zeros(plane.free.ncols()), &slope, reduced, (&m, &c))?;
        Some(&plane.start + &plane.free * z)
    }

    /// Downhill from a start.
    fn descend(&self, plane: &Plane, start: DVector<f64>) -> DVector<f64> {
        let (m, c) = plane.cut(self.bounds);
        let place = |z: &DVector<f64>| &plane.start + &plane.free * z;
        let mut z = plane.free.tr_mul(&(&start - &plane.start));
        for _ in 0..MAX_STEPS {
            let y = place(&z);
            let value = self.value(&y);
            let slope = plane.free.tr_mul(&self.slope(&y));
            let model = |convex: bool| {
                step(&z, &slope, plane.free.tr_mul(&(self.curvature(&y, convex) * &plane.free)), (&m, &c))
            };
            let Some(to) = model(false).or_else(|| model(true)) else { break };
            let way = &to - &z;
            let promised = -slope.dot(&way);
            if promised <= NO_GAIN * value || promised.is_nan() {
                break;
            }
            let shorter = (0..40).map(|i| 0.5_f64.powi(i));
            let keeps = |by: &f64| self.value(&place(&(&z + &way * *by))) <= value - KEEPS * by * promised;
            let Some(by) = shorter.into_iter().find(keeps) else { break };
            z += way * by;
        }
        place(&z)
    }

    /// ∂F/∂y.
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

    /// ∂²F/∂y², or as much of it as is convex.
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
                // What is left of it where the places follow is 2 − 2 Σ (β c)².
                h[(k, k)] += 2.0 * (bent - 1.0 + LEAST_CURVATURE).max(0.0);
            }
        }
        h
    }
}

/// How much heavier the i-th mass is taken to be at a start, from a tenth to ten times: an additive recurrence, which
/// spreads evenly.
fn scattered(start: usize, i: usize) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_894_8;
    let step = (GOLDEN * (i + 1) as f64 * (1.0 + GOLDEN * i as f64)).fract();
    let place = (0.5 + step * start as f64).fract();
    10.0_f64.powf(2.0 * place - 1.0)
}

fn curvature(counts: &bool) -> f64 {
    if *counts { 2.0 } else { 0.0 }
}

/// The least of a quadratic model around z within M z ≤ c; none if the model is not convex, or nothing is within.
fn step(
    z: &DVector<f64>,
    slope: &DVector<f64>,
    curvature: DMatrix<f64>,
    (m, c): (&DMatrix<f64>, &DVector<f64>),
) -> Option<DVector<f64>> {
    let model = Cholesky::new(curvature)?;
    let (centre, l) = (z - model.solve(slope), model.l());
    // In Lᵀ (z − centre) the model is a distance.
    let turned = l.solve_lower_triangular(&m.transpose())?.transpose();
    let way = nearest(&turned, &(c - m * &centre)).ok()?;
    Some(centre + l.tr_solve_lower_triangular(&way)?)
}
