//! [`SolutionSpace`]: the solution set of linear equations, and the solution within bounds that is nearest to 0.

use nalgebra::{DMatrix, DVector};

use super::basis::{extended, least_squares};
use super::distance::nearest;
use stillbase_convex::LinearRow;

/// Relative pivot tolerance: a row whose independent part is at most this fraction of it is treated as dependent.
const RANK_TOLERANCE: f64 = 1e-11;

/// One equation a · y = right, with the tolerance of its residual.
#[derive(Clone, Debug)]
pub(crate) struct LinearEquation {
    pub a: Vec<f64>,
    pub right: f64,
    pub tolerance: f64,
}

/// The solutions y = particular + null_space z of linear equations, for any z.
pub(crate) struct SolutionSpace {
    /// Particular solution nearest to 0.
    pub particular: DVector<f64>,
    /// Orthonormal basis of the null space, in columns.
    pub null_space: DMatrix<f64>,
    /// Residual of each equation at `particular`.
    pub residuals: Vec<f64>,
    /// Whether all residuals are within their tolerances, so that there is a solution.
    pub exists: bool,
}

impl SolutionSpace {
    /// Solves equations in `n` unknowns, in the least squares sense if they contradict each other.
    pub fn of(equations: &[LinearEquation], n: usize) -> Self {
        if n == 0 {
            let residuals: Vec<f64> = equations.iter().map(|row| -row.right).collect();
            let exists = equations.iter().all(|row| row.right.abs() <= row.tolerance);
            return Self { particular: DVector::zeros(0), null_space: DMatrix::zeros(0, 0), residuals, exists };
        }
        // Rows are scaled to unit norm, so that rows in kg m and in kg m² have equal weight.
        let size = |row: &LinearEquation| row.a.iter().map(|a| a * a).sum::<f64>().sqrt();
        let sized: Vec<_> = equations.iter().map(|row| (row, size(row))).filter(|(_, size)| *size > 0.0).collect();
        let rows: Vec<DVector<f64>> =
            sized.iter().map(|(row, size)| DVector::from_vec(row.a.clone()) / *size).collect();
        let span = extended(Vec::new(), rows.clone(), RANK_TOLERANCE);
        let rank = span.len();
        let units = (0..n).map(|i| DVector::from_fn(n, |j, _| f64::from(u8::from(i == j)))).collect();
        let all = extended(span, units, RANK_TOLERANCE);
        // The solution in the row space is unique; of all solutions it is nearest to 0.
        let within = DMatrix::from_fn(rows.len(), rank, |i, j| rows[i].dot(&all[j]));
        let right = DVector::from_fn(rows.len(), |i, _| sized[i].0.right / sized[i].1);
        let by = least_squares(&within, &right).unwrap_or_else(|| DVector::zeros(rank));
        let particular = (0..rank).fold(DVector::zeros(n), |sum, j| sum + &all[j] * by[j]);
        let missed =
            |row: &LinearEquation| row.a.iter().zip(particular.iter()).map(|(a, y)| a * y).sum::<f64>() - row.right;
        let residuals: Vec<f64> = equations.iter().map(missed).collect();
        let exists = equations.iter().zip(&residuals).all(|(row, missed)| missed.abs() <= row.tolerance);
        let null_space = DMatrix::from_fn(n, n - rank, |i, j| all[rank + j][i]);
        Self { particular, null_space, residuals, exists }
    }

    /// Returns the solution nearest to `particular` that satisfies every bound a · y ≤ right.
    ///
    /// # Errors
    /// If there is no such solution; the error holds the weight of each bound in the certificate of infeasibility.
    pub fn nearest(&self, bounds: &[LinearRow]) -> Result<DVector<f64>, Vec<f64>> {
        let (m, c) = self.reduced_bounds(bounds);
        Ok(&self.particular + &self.null_space * nearest(&m, &c)?)
    }

    /// Returns the bounds as constraints on z: M z ≤ c.
    pub fn reduced_bounds(&self, bounds: &[LinearRow]) -> (DMatrix<f64>, DVector<f64>) {
        let at =
            |row: &LinearRow, y: &dyn Fn(usize) -> f64| row.terms.iter().map(|&(j, value)| value * y(j)).sum::<f64>();
        let k = self.null_space.ncols();
        let m = DMatrix::from_fn(bounds.len(), k, |i, j| at(&bounds[i], &|l| self.null_space[(l, j)]));
        let c = DVector::from_fn(bounds.len(), |i, _| bounds[i].right - at(&bounds[i], &|l| self.particular[l]));
        (m, c)
    }
}
