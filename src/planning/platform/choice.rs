//! [`FreedomChoice`]: what a chain does with the freedoms that a path of its platform leaves.

use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

use super::chain::PlatformChain;
use stillbase_settings::word::words;

/// Smallest singular value that counts, as a fraction of the largest: directions below it cannot be followed.
const RANK_TOLERANCE: f64 = 1e-7;

/// Singular values of what is carried, as fractions of the largest, between which its carrier takes over a direction
/// gradually: near the edge of its own reach its rates would grow without bound.
const TAKEN_OVER: [f64; 2] = [0.03, 0.12];

words! {
    /// What the blocks do with freedoms that are left.
    pub enum FreedomChoice {
        LeastRates = "least-rates", "Least rates", "At each instant the sum of the squared rates of all drives is least";
        StillCarrier = "still-carrier", "Still carrier", "What carries moves only where what it carries is near the edge of its own reach";
        MidRange = "mid-range", "Mid-range", "At each place the angles are nearest to the middles of their ranges";
    }
}

/// Returns the least-squares solution of least norm of A x = y, for A of three rows. Singular values below a fraction
/// `tolerance` of the largest count as zero.
///
/// It goes by the eigenvalues of A Aᵀ: iterations for singular values may fail where A lacks rank.
pub(super) fn least_norm(a: &DMatrix<f64>, y: &Vector3<f64>, tolerance: f64) -> DVector<f64> {
    let (square, values, most) = eigen_of_rows(a);
    let mut z = Vector3::zeros();
    for k in (0..3).filter(|k| values[*k] > tolerance * tolerance * most && values[*k] > 0.0) {
        let direction = square.column(k);
        z += direction.dot(y) / values[k] * direction;
    }
    a.transpose() * DVector::from_column_slice(z.as_slice())
}

/// Returns directions and eigenvalues of A Aᵀ, for A of three rows, and the largest eigenvalue.
fn eigen_of_rows(a: &DMatrix<f64>) -> (Matrix3<f64>, Vector3<f64>, f64) {
    let square = a * a.transpose();
    let eigen = Matrix3::from_fn(|row, k| square[(row, k)]).symmetric_eigen();
    (eigen.eigenvectors, eigen.eigenvalues, eigen.eigenvalues.max())
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
            let (asked, share) =
                asked_of_carrier(&DMatrix::from_fn(3, above.len(), |row, k| jacobian[(row, above[k])]));
            // With u = Lᵀ ȧ the norm of u is that of the rates.
            let inverse = scale.transpose().try_inverse()?;
            let of_u = DMatrix::from_fn(3, 3, |row, k| asked[(row, k)]) * &own * &inverse;
            let wanted = share * left;
            let rates = inverse * least_norm(&of_u, &wanted, RANK_TOLERANCE);
            let moved = &own * &rates;
            left -= Vector3::new(moved[0], moved[1], moved[2]);
            part.iter().zip(rates.iter()).for_each(|(k, rate)| all[*k] = *rate);
        }
        Some((all, left))
    }
}

/// Returns the projector onto the directions in which a carrier has to move, and its share of the rate in each: all of it
/// where the columns of what it carries do not lead, none where they lead well.
fn asked_of_carrier(columns: &DMatrix<f64>) -> (Matrix3<f64>, Matrix3<f64>) {
    let (mut asked, mut share) = (Matrix3::identity(), Matrix3::identity());
    if columns.ncols() == 0 {
        return (asked, share);
    }
    let (directions, squares, most) = eigen_of_rows(columns);
    let [none, all] = TAKEN_OVER;
    for (k, square) in squares.iter().enumerate().filter(|(_, square)| **square > none * none * most) {
        let direction = directions.column(k);
        let onto = direction * direction.transpose();
        let x = (((square / most).sqrt() - none) / (all - none)).min(1.0);
        share -= x * x * (3.0 - 2.0 * x) * onto;
        if x == 1.0 {
            asked -= onto;
        }
    }
    (asked, share)
}
