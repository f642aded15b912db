//! [`nearest`]: the point nearest to 0 in an intersection of half spaces, exact to rounding, and in microseconds for
//! few half spaces.
//!
//! # Symbols
//! | letter | meaning |
//! |---|---|
//! | M z ≤ c | the half spaces, rows of equal norm |
//! | u | multiplier of each half space, u ≥ 0 |
//! | E, f | E has columns (−M_i, −c_i), f = (0, 1); at the least squares solution, E u − f is a multiple of (z, −1) |
//!
//! # Source
//! Lawson and Hanson, *Solving Least Squares Problems*, chapter 23: least distance programming by least squares with u
//! ≥ 0. If E u = f, the half spaces have no common point, and u is the certificate of infeasibility.

use nalgebra::{DMatrix, DVector};

use super::basis;

/// Feasibility tolerance, as a fraction of the scale of c.
const FEASIBILITY_TOLERANCE: f64 = 1e-11;
/// Rows shorter than this fraction of the longest do not constrain z.
const MIN_ROW_FRACTION: f64 = 1e-10;
/// If |E u − f| is at most this, there is no z. Any z would be further from 0 than the reciprocal of this, in units of
/// the scale of c.
const INFEASIBLE_UP_TO: f64 = 1e-7;

/// Returns the z nearest to 0 with M z ≤ c.
///
/// # Errors
/// If there is no such z; the error holds the weight of each row in the certificate of infeasibility.
pub(super) fn nearest(m: &DMatrix<f64>, c: &DVector<f64>) -> Result<DVector<f64>, Vec<f64>> {
    let (rows, k) = m.shape();
    let longest = m.row_iter().fold(0.0_f64, |most, row| most.max(row.norm()));
    let size = |i: usize| Some(m.row(i).norm()).filter(|size| *size > MIN_ROW_FRACTION * longest);
    // Violation of each row at z = 0, with rows scaled to unit norm.
    let violation = DVector::from_fn(rows, |i, _| -c[i] / size(i).unwrap_or(1.0));
    let scale = violation.amax();
    if rows == 0 || violation.max() <= FEASIBILITY_TOLERANCE * scale {
        return Ok(DVector::zeros(k));
    }
    let of = |i: usize, j: usize| size(i).map_or(0.0, |size| m[(i, j)] / size);
    let e = DMatrix::from_fn(
        k + 1,
        rows,
        |j, i| if j < k { -of(i, j) } else { violation[i] / scale - FEASIBILITY_TOLERANCE },
    );
    let u = nonnegative_least_squares(&e);
    let mut residual = &e * &u;
    residual[k] -= 1.0;
    if residual.norm() <= INFEASIBLE_UP_TO {
        return Err((0..rows).map(|i| u[i] / size(i).unwrap_or(1.0)).collect());
    }
    let found = DVector::from_fn(k, |j, _| -residual[j] / residual[k]) * scale;
    let active: Vec<usize> = (0..rows).filter(|i| u[*i] > 0.0).collect();
    Ok(refined(m, c, &active, scale * longest).unwrap_or(found))
}

/// Returns the u ≥ 0 that minimises |E u − (0, …, 0, 1)|.
fn nonnegative_least_squares(e: &DMatrix<f64>) -> DVector<f64> {
    let (k, rows) = (e.nrows() - 1, e.ncols());
    let mut f = DVector::zeros(k + 1);
    f[k] = 1.0;
    let mut u = DVector::zeros(rows);
    // Indices of the positive components, and of those that are temporarily excluded.
    let (mut used, mut barred): (Vec<usize>, Vec<usize>) = (Vec::new(), Vec::new());
    for _ in 0..10 * (rows + 1) {
        let descent = e.tr_mul(&(&f - e * &u));
        let others = (0..rows).filter(|i| !used.contains(i) && !barred.contains(i) && descent[*i] > 1e-14);
        let Some(next) = others.max_by(|a, b| descent[*a].total_cmp(&descent[*b])) else { break };
        used.push(next);
        // Steps towards the least squares solution in the components in use; a step ends where the first of them
        // becomes 0.
        while !used.is_empty() {
            let some = e.select_columns(&used);
            let best = basis::least_squares(&some, &f);
            let fresh = used.last() == Some(&next) && u[next] == 0.0;
            let Some(best) = best.filter(|best| !(fresh && best[used.len() - 1] <= 0.0)) else {
                // The descent along this component was only rounding error.
                let last = used.pop().unwrap_or(next);
                u[last] = 0.0;
                barred.push(last);
                break;
            };
            let step = used.iter().zip(best.iter()).filter(|(_, to)| **to <= 0.0);
            let step = step.map(|(i, to)| u[*i] / (u[*i] - to)).fold(1.0_f64, f64::min);
            used.iter().zip(best.iter()).for_each(|(i, to)| u[*i] += step * (to - u[*i]));
            if step >= 1.0 {
                barred.clear();
                break;
            }
            let least = used.iter().map(|i| u[*i]).fold(f64::INFINITY, f64::min).max(0.0);
            used.retain(|i| u[*i] > least + 1e-15);
            (0..rows).filter(|i| !used.contains(i)).for_each(|i| u[i] = 0.0);
        }
    }
    u
}

/// Returns the shortest z on the boundaries of the active half spaces, exact to rounding; `None` if z violates others.
fn refined(m: &DMatrix<f64>, c: &DVector<f64>, active: &[usize], scale: f64) -> Option<DVector<f64>> {
    if active.is_empty() {
        return None;
    }
    let (a, right) = (m.select_rows(active), c.select_rows(active));
    // z = aᵀ x is the minimum-norm solution of a z = right.
    let z = a.tr_mul(&basis::least_squares(&(&a * a.transpose()), &right)?);
    let more = basis::least_squares(&(&a * a.transpose()), &(&right - &a * &z))?;
    let z = z + a.tr_mul(&more);
    ((m * &z - c).max() <= 10.0 * FEASIBILITY_TOLERANCE * scale).then_some(z)
}
