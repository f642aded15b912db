//! Orthonormal vectors that span others, and what solves equations in them: by Gram and Schmidt with pivots, which finds the
//! rank of small matrices to rounding however many of their rows are alike.

use nalgebra::{DMatrix, DVector};

/// The given orthonormal vectors and as many more, each from the longest of what they lack of others, as are longer than
/// `cut`.
pub(super) fn extended(mut basis: Vec<DVector<f64>>, others: Vec<DVector<f64>>, cut: f64) -> Vec<DVector<f64>> {
    let mut left = others;
    let rid = |v: &mut DVector<f64>, of: &DVector<f64>| {
        let along = v.dot(of);
        v.axpy(-along, of, 1.0);
    };
    left.iter_mut().for_each(|v| basis.iter().for_each(|of| rid(v, of)));
    while let Some(longest) = (0..left.len()).max_by(|a, b| left[*a].norm().total_cmp(&left[*b].norm())) {
        let mut next = left.swap_remove(longest);
        // Again, for what rounding has left.
        basis.iter().for_each(|of| rid(&mut next, of));
        let size = next.norm();
        if size <= cut {
            break;
        }
        next /= size;
        left.iter_mut().for_each(|v| rid(v, &next));
        basis.push(next);
    }
    basis
}

/// The x with the least |A x − right|, of a matrix with independent columns; `None` if they are not.
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
    // A step of refinement brings the residual to rounding.
    x += solve(&(right - a * &x))?;
    Some(x)
}
