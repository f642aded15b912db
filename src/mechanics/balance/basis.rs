//! Orthonormal bases by the Gram–Schmidt method with pivots, and least squares. The pivots reveal the rank of a small
//! matrix to rounding, even if many of its rows are equal.

use nalgebra::{DMatrix, DVector};

/// Extends an orthonormal basis by the vectors `others`, made orthogonal to it, the longest first. Vectors whose
/// orthogonal part is at most `tolerance` long are omitted.
pub(super) fn extended(mut basis: Vec<DVector<f64>>, others: Vec<DVector<f64>>, tolerance: f64) -> Vec<DVector<f64>> {
    let mut rest = others;
    let orthogonalise = |v: &mut DVector<f64>, unit: &DVector<f64>| {
        let along = v.dot(unit);
        v.axpy(-along, unit, 1.0);
    };
    rest.iter_mut().for_each(|v| basis.iter().for_each(|unit| orthogonalise(v, unit)));
    while let Some(longest) = (0..rest.len()).max_by(|a, b| rest[*a].norm().total_cmp(&rest[*b].norm())) {
        let mut next = rest.swap_remove(longest);
        // A second orthogonalisation removes rounding errors.
        basis.iter().for_each(|unit| orthogonalise(&mut next, unit));
        let size = next.norm();
        if size <= tolerance {
            break;
        }
        next /= size;
        rest.iter_mut().for_each(|v| orthogonalise(v, &next));
        basis.push(next);
    }
    basis
}

/// Returns the x that minimises |A x − right|; `None` if the columns of A are linearly dependent.
pub(super) fn least_squares(a: &DMatrix<f64>, right: &DVector<f64>) -> Option<DVector<f64>> {
    if a.ncols() == 0 || a.nrows() < a.ncols() {
        return (a.ncols() == 0).then(|| DVector::zeros(0));
    }
    let qr = a.clone().qr();
    let (q, r) = (qr.q(), qr.r());
    let solve = |right: &DVector<f64>| r.solve_upper_triangular(&q.tr_mul(right));
    let size = r.diagonal().amax();
    if r.diagonal().iter().any(|d| d.abs() <= 1e-13 * size) {
        return None;
    }
    let mut x = solve(right)?;
    // One step of iterative refinement reduces the residual to rounding error.
    x += solve(&(right - a * &x))?;
    Some(x)
}
