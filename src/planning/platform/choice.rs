//! [`FreedomChoice`]: what a chain does with the freedoms that a path of its platform leaves.

use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

use super::chain::PlatformChain;
use stillbase_settings::word::words;

/// Smallest singular value that counts, as a fraction of the largest: directions below it cannot be followed.
const RANK_TOLERANCE: f64 = 1e-7;

words! {
    /// What the blocks do with freedoms that are left.
    pub enum FreedomChoice {
        LeastRates = "least-rates", "Least rates", "At each instant the sum of the squared rates of all drives is least";
        StillCarrier = "still-carrier", "Still carrier", "What carries moves as little as it can, at each instant";
        MidRange = "mid-range", "Mid-range", "At each place the angles are nearest to the middles of their ranges";
    }
}

/// Returns the least-squares solution of least norm of A x = y, and what of y it leaves.
fn solved(a: &DMatrix<f64>, y: &DVector<f64>) -> Option<(DVector<f64>, DVector<f64>)> {
    let svd = a.clone().svd(true, true);
    let most = svd.singular_values.max();
    let x = if most > 0.0 { svd.solve(y, RANK_TOLERANCE * most).ok()? } else { DVector::zeros(a.ncols()) };
    let left = y - a * &x;
    Some((x, left))
}

impl PlatformChain {
    /// Returns the rates of all angles for a rate of the place, by a choice that is one of rates, and the rate that they
    /// leave. Rates are by any parameter.
    pub(super) fn rates(
        &self,
        choice: FreedomChoice,
        a: &[f64],
        rate: &Vector3<f64>,
    ) -> Option<(DVector<f64>, Vector3<f64>)> {
        let (jacobian, metric) = (self.jacobian(a), self.metric());
        let root = metric.cholesky()?.l();
        let parts: Vec<Vec<usize>> = match choice {
            // Each block by itself, what carries first.
            FreedomChoice::StillCarrier => (0..self.blocks().len()).map(|i| self.range(i).collect()).collect(),
            _ => vec![(0..self.freedoms()).collect()],
        };
        let (mut all, mut left) = (DVector::zeros(self.freedoms()), *rate);
        for (i, part) in parts.iter().enumerate() {
            let own = DMatrix::from_fn(3, part.len(), |row, k| jacobian[(row, part[k])]);
            let scale = DMatrix::from_fn(part.len(), part.len(), |row, k| root[(part[row], part[k])]);
            // Only what the blocks above cannot do themselves is asked of this one.
            let above: Vec<usize> = parts[i + 1..].iter().flatten().copied().collect();
            let beyond = beyond(&DMatrix::from_fn(3, above.len(), |row, k| jacobian[(row, above[k])]));
            // With u = Lᵀ ȧ the norm of u is that of the rates.
            let inverse = scale.transpose().try_inverse()?;
            let of_u = DMatrix::from_fn(3, 3, |row, k| beyond[(row, k)]) * &own * &inverse;
            let wanted = beyond * left;
            let (u, _) = solved(&of_u, &DVector::from_column_slice(wanted.as_slice()))?;
            let rates = inverse * u;
            let moved = &own * &rates;
            left -= Vector3::new(moved[0], moved[1], moved[2]);
            part.iter().zip(rates.iter()).for_each(|(k, rate)| all[*k] = *rate);
        }
        Some((all, left))
    }
}

/// Returns the projector onto what the columns of a matrix do not span.
fn beyond(columns: &DMatrix<f64>) -> Matrix3<f64> {
    let mut rest = Matrix3::identity();
    if columns.ncols() == 0 {
        return rest;
    }
    let svd = columns.clone().svd(true, false);
    let (Some(u), most) = (svd.u, svd.singular_values.max()) else { return rest };
    for (k, size) in svd.singular_values.iter().enumerate().filter(|(_, size)| **size > RANK_TOLERANCE * most) {
        debug_assert!(*size > 0.0);
        let direction = Vector3::new(u[(0, k)], u[(1, k)], u[(2, k)]);
        rest -= direction * direction.transpose();
    }
    rest
}
