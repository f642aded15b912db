//! [`nearest`]: the point nearest to 0 within half spaces, exact but for rounding and in microseconds where there are few.
//!
//! # Symbols
//! | letter | meaning |
//! |---|---|
//! | M z ≤ c | the half spaces, rows of one size |
//! | u | how much each holds z back, not below 0 |
//! | E, f | E u − f = (z, −1) times a number above 0; E has a column (−M_i, −c_i) for each, f = (0, 1) |
//!
//! # Source
//! Lawson and Hanson, *Solving Least Squares Problems*, chapter 23: least distance programming by least squares with
//! u ≥ 0. Where E u = f there is no z: u proves it.

use nalgebra::{DMatrix, DVector};

use super::basis;

/// Part of the scale of c by which a half space may be missed.
const MISSED: f64 = 1e-11;
/// Rows shorter than this part of the longest leave z free.
const FLAT: f64 = 1e-10;
/// |E u − f| below this is none: z would be further away than its inverse, in the scale of c.
const NONE: f64 = 1e-7;

/// The z nearest to 0 with M z ≤ c.
///
/// # Errors
/// If there is none: how much each row has to do with that.
pub(super) fn nearest(m: &DMatrix<f64>, c: &DVector<f64>) -> Result<DVector<f64>, Vec<f64>> {
    let (rows, k) = m.shape();
    let longest = m.row_iter().fold(0.0_f64, |most, row| most.max(row.norm()));
    let size = |i: usize| Some(m.row(i).norm()).filter(|size| *size > FLAT * longest);
    // What is missed at 0, of rows of one size.
    let missed = DVector::from_fn(rows, |i, _| -c[i] / size(i).unwrap_or(1.0));
    let scale = missed.amax();
    if rows == 0 || missed.max() <= MISSED * scale {
        return Ok(DVector::zeros(k));
    }
    let of = |i: usize, j: usize| size(i).map_or(0.0, |size| m[(i, j)] / size);
    let e = DMatrix::from_fn(k + 1, rows, |j, i| if j < k { -of(i, j) } else { missed[i] / scale - MISSED });
    let u = held_back(&e);
    let mut left = &e * &u;
    left[k] -= 1.0;
    if left.norm() <= NONE {
        return Err((0..rows).map(|i| u[i] / size(i).unwrap_or(1.0)).collect());
    }
    let found = DVector::from_fn(k, |j, _| -left[j] / left[k]) * scale;
    let held: Vec<usize> = (0..rows).filter(|i| u[*i] > 0.0).collect();
    Ok(settled(m, c, &held, scale * longest).unwrap_or(found))
}

/// The u ≥ 0 with the least |E u − (0, …, 0, 1)|.
fn held_back(e: &DMatrix<f64>) -> DVector<f64> {
    let (k, rows) = (e.nrows() - 1, e.ncols());
    let mut f = DVector::zeros(k + 1);
    f[k] = 1.0;
    let mut u = DVector::zeros(rows);
    let (mut used, mut barred): (Vec<usize>, Vec<usize>) = (Vec::new(), Vec::new());
    for _ in 0..10 * (rows + 1) {
        let wanted = e.tr_mul(&(&f - e * &u));
        let others = (0..rows).filter(|i| !used.contains(i) && !barred.contains(i) && wanted[*i] > 1e-14);
        let Some(next) = others.max_by(|a, b| wanted[*a].total_cmp(&wanted[*b])) else { break };
        used.push(next);
        // As far towards the least of those in use as none of them turns below 0.
        while !used.is_empty() {
            let some = e.select_columns(&used);
            let best = basis::least_squares(&some, &f);
            let fresh = used.last() == Some(&next) && u[next] == 0.0;
            let Some(best) = best.filter(|best| !(fresh && best[used.len() - 1] <= 0.0)) else {
                // Rounding alone asked for it.
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

/// To rounding: the least z on the half spaces that hold it back, if it is in all others.
fn settled(m: &DMatrix<f64>, c: &DVector<f64>, held: &[usize], scale: f64) -> Option<DVector<f64>> {
    if held.is_empty() {
        return None;
    }
    let (a, right) = (m.select_rows(held), c.select_rows(held));
    // z = aᵀ x, which is the shortest of all with a z = right.
    let z = a.tr_mul(&basis::least_squares(&(&a * a.transpose()), &right)?);
    let more = basis::least_squares(&(&a * a.transpose()), &(&right - &a * &z))?;
    let z = z + a.tr_mul(&more);
    ((m * &z - c).max() <= 10.0 * MISSED * scale).then_some(z)
}
