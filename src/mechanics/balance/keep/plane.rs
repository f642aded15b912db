//! [`Plane`]: all that linear equations leave free, and its point nearest to another place within bounds.

use nalgebra::{DMatrix, DVector};

use super::distance::nearest;
use crate::convex::Row;

/// Part of the greatest singular value below which one counts as none.
const RANK: f64 = 1e-11;

/// One equation a · y = right, and by how much it may be missed.
#[derive(Clone, Debug)]
pub(super) struct Equation {
    pub a: Vec<f64>,
    pub right: f64,
    pub tolerance: f64,
}

/// y = start + free z for any z.
pub(super) struct Plane {
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
        // Of one size each, so that kg m and kg m² weigh alike; square at least, so that the free part is there whole.
        let size = |row: &Equation| row.a.iter().map(|a| a * a).sum::<f64>().sqrt();
        let scale = |row: &Equation| if size(row) > 0.0 { size(row).recip() } else { 0.0 };
        let scales: Vec<f64> = equations.iter().map(scale).collect();
        let rows = equations.len().max(n);
        let a = DMatrix::from_fn(rows, n, |i, j| equations.get(i).map_or(0.0, |row| row.a[j] * scales[i]));
        let right = DVector::from_fn(rows, |i, _| equations.get(i).map_or(0.0, |row| row.right * scales[i]));
        let svd = a.clone().svd(true, true);
        let cut = svd.singular_values.iter().fold(0.0_f64, |most, s| most.max(*s)) * RANK;
        let solve = |right: &DVector<f64>| svd.solve(right, cut).unwrap_or_else(|_| DVector::zeros(n));
        let mut start = solve(&right);
        // Steps of refinement bring the residual to rounding.
        for _ in 0..2 {
            start += solve(&(&right - &a * &start));
        }
        let missed = |row: &Equation| row.a.iter().zip(start.iter()).map(|(a, y)| a * y).sum::<f64>() - row.right;
        let missed: Vec<f64> = equations.iter().map(missed).collect();
        let exists = equations.iter().zip(&missed).all(|(row, missed)| missed.abs() <= row.tolerance);
        let none: Vec<usize> = (0..n).filter(|i| svd.singular_values[*i] <= cut).collect();
        let free = svd.v_t.map_or_else(|| DMatrix::zeros(n, 0), |v| v.select_rows(&none).transpose());
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
