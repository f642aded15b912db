//! [`Plane`]: all that linear equations leave free, and its point nearest to another place within bounds.

use nalgebra::{DMatrix, DVector};

use super::basis::{extended, least_squares};
use super::distance::nearest;
use crate::convex::Row;

/// What is left of a row counts as none up to this part of it.
const RANK: f64 = 1e-11;

/// One equation a · y = right, and by how much it may be missed.
#[derive(Clone, Debug)]
pub(crate) struct Equation {
    pub a: Vec<f64>,
    pub right: f64,
    pub tolerance: f64,
}

/// y = start + free z for any z.
pub(crate) struct Plane {
    /// Its point nearest to 0.
    pub start: DVector<f64>,
    /// Orthonormal columns.
    pub free: DMatrix<f64>,
    /// By how much each equation is missed; all within their tolerances where there is a plane.
    pub missed: Vec<f64>,
    /// Whether all of them can be met together.
    pub exists: bool,
}

impl Plane {
    /// What equations over `n` unknowns leave free; the nearest that comes to it where they contradict each other.
    pub fn of(equations: &[Equation], n: usize) -> Self {
        if n == 0 {
            let missed: Vec<f64> = equations.iter().map(|row| -row.right).collect();
            let exists = equations.iter().all(|row| row.right.abs() <= row.tolerance);
            return Self { start: DVector::zeros(0), free: DMatrix::zeros(0, 0), missed, exists };
        }
        // Of one size each, so that kg m and kg m² weigh alike.
        let size = |row: &Equation| row.a.iter().map(|a| a * a).sum::<f64>().sqrt();
        let sized: Vec<_> = equations.iter().map(|row| (row, size(row))).filter(|(_, size)| *size > 0.0).collect();
        let rows: Vec<DVector<f64>> =
            sized.iter().map(|(row, size)| DVector::from_vec(row.a.clone()) / *size).collect();
        let span = extended(Vec::new(), rows.clone(), RANK);
        let rank = span.len();
        let units = (0..n).map(|i| DVector::from_fn(n, |j, _| f64::from(u8::from(i == j)))).collect();
        let all = extended(span, units, RANK);
        // In what the rows span every solution is one, and the nearest to 0.
        let within = DMatrix::from_fn(rows.len(), rank, |i, j| rows[i].dot(&all[j]));
        let right = DVector::from_fn(rows.len(), |i, _| sized[i].0.right / sized[i].1);
        let by = least_squares(&within, &right).unwrap_or_else(|| DVector::zeros(rank));
        let start = (0..rank).fold(DVector::zeros(n), |sum, j| sum + &all[j] * by[j]);
        let missed = |row: &Equation| row.a.iter().zip(start.iter()).map(|(a, y)| a * y).sum::<f64>() - row.right;
        let missed: Vec<f64> = equations.iter().map(missed).collect();
        let exists = equations.iter().zip(&missed).all(|(row, missed)| missed.abs() <= row.tolerance);
        let free = DMatrix::from_fn(n, n - rank, |i, j| all[rank + j][i]);
        Self { start, free, missed, exists }
    }

    /// Its point nearest to its start with every a · y ≤ right.
    ///
    /// # Errors
    /// If there is none: how much each bound has to do with it.
    pub fn nearest(&self, bounds: &[Row]) -> Result<DVector<f64>, Vec<f64>> {
        let (m, c) = self.cut(bounds);
        Ok(&self.start + &self.free * nearest(&m, &c)?)
    }

    /// The bounds in z: M z ≤ c.
    pub fn cut(&self, bounds: &[Row]) -> (DMatrix<f64>, DVector<f64>) {
        let at = |row: &Row, y: &dyn Fn(usize) -> f64| row.terms.iter().map(|&(j, value)| value * y(j)).sum::<f64>();
        let k = self.free.ncols();
        let m = DMatrix::from_fn(bounds.len(), k, |i, j| at(&bounds[i], &|l| self.free[(l, j)]));
        let c = DVector::from_fn(bounds.len(), |i, _| bounds[i].right - at(&bounds[i], &|l| self.start[l]));
        (m, c)
    }
}
