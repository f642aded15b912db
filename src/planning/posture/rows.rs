//! [`PoseConstraint`]: constraints on every pose of a path, and their null space.

use super::super::pose_space::PoseSpace;
use stillbase_mechanics::planar::{DriveAngles, MAX_DRIVES, PerDrive, Vector, unit};

/// Maximum number of rows: two of the point, one of b, one of the last link's drive.
const ROWS: usize = 4;
/// Maximum number of Newton steps onto the constraints.
const MAX_STEPS: usize = 20;
/// Tolerance of the constraints, as a fraction of the reach.
const CONSTRAINT_TOLERANCE: f64 = 1e-14;
/// Residual that is accepted when the iteration stagnates, as a fraction of the reach.
const STAGNATION_TOLERANCE: f64 = 1e-11;
/// Rank tolerance: a row is dependent if orthogonalisation leaves at most this fraction of its length.
const RANK_TOLERANCE: f64 = 1e-7;

/// Constraints on a pose: the position of the end effector, b, and optionally the angle of one drive.
#[derive(Clone, Copy, Debug)]
pub(super) struct PoseConstraint<'a> {
    pub space: &'a PoseSpace,
    /// Pose constant, rad.
    pub b: f64,
    /// A drive of constant angle, and this angle, rad.
    pub hand: Option<(usize, f64)>,
}

/// The rows ∂(p, b, hand)/∂q at a pose, in m: triangular `lower` times `across`, whose rows are orthonormal.
#[derive(Clone, Copy, Debug)]
pub(super) struct ConstraintJacobian {
    count: usize,
    across: [PerDrive; ROWS],
    lower: [[f64; ROWS]; ROWS],
}

impl PoseConstraint<'_> {
    /// Returns the number of free directions.
    pub fn freedoms(&self) -> usize {
        self.space.drives() - 3 - usize::from(self.hand.is_some())
    }

    /// Returns the scale of b, m/rad.
    fn scale(&self) -> f64 {
        self.space.farthest() / self.space.lambda().max_abs()
    }

    /// Returns the residual of a pose: of the point, of b and of the drive, all scaled to m.
    fn residual(&self, q: &PerDrive, p: Vector) -> [f64; ROWS] {
        let off = p - self.space.end_effector(q);
        let hand = self.hand.map_or(0.0, |(drive, angle)| self.space.farthest() * (angle - q[drive]));
        [off.re, off.im, self.scale() * (self.b - self.space.b(q)), hand]
    }

    /// Returns the rows at a pose; `None` if they are linearly dependent.
    pub fn rows(&self, q: &PerDrive) -> Option<ConstraintJacobian> {
        let n = self.space.drives();
        let arms = arms(self.space, q);
        let none = PerDrive::zeros(n);
        let mut all = [none; ROWS];
        all[0] = PerDrive::from_fn(n, |k| -arms[k].im);
        all[1] = PerDrive::from_fn(n, |k| arms[k].re);
        all[2] = self.space.lambda().scaled(self.scale());
        if let Some((drive, _)) = self.hand {
            all[3][drive] = self.space.farthest();
        }
        let count = ROWS - usize::from(self.hand.is_none());
        let mut rows = ConstraintJacobian { count, across: [none; ROWS], lower: [[0.0; ROWS]; ROWS] };
        for (i, row) in all[..count].iter().enumerate() {
            let mut rest = *row;
            for _ in 0..2 {
                for (u, lower) in rows.across[..i].iter().zip(&mut rows.lower[i]) {
                    let share = rest.dot(u);
                    *lower += share;
                    rest = rest.plus(-share, u);
                }
            }
            let length = rest.dot(&rest).sqrt();
            if length.is_nan() || length <= RANK_TOLERANCE * row.dot(row).sqrt() {
                return None;
            }
            rows.lower[i][i] = length;
            rows.across[i] = rest.scaled(1.0 / length);
        }
        Some(rows)
    }

    /// Finds a pose near `q` with the end effector on `p`, by Newton's method with minimum-norm steps. Returns `None`
    /// if it does not converge.
    pub fn onto(&self, q: &PerDrive, p: Vector) -> Option<PerDrive> {
        let reach = self.space.farthest();
        let mut q = *q;
        let mut last = f64::INFINITY;
        for _ in 0..MAX_STEPS {
            let residual = self.residual(&q, p);
            let size = residual.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
            if size <= CONSTRAINT_TOLERANCE * reach || (size >= 0.5 * last && size <= STAGNATION_TOLERANCE * reach) {
                return Some(q);
            }
            if size.is_nan() || size > 4.0 * last {
                return None;
            }
            last = size;
            q = q.plus(1.0, &self.rows(&q)?.least(&residual));
        }
        None
    }

    /// Returns the q′ and q″, nearest to given ones, with which the end effector follows a curve with the derivatives
    /// `way`, m.
    pub fn along(
        &self,
        q: &PerDrive,
        (first, second): (&PerDrive, &PerDrive),
        way: [Vector; 2],
    ) -> Option<(PerDrive, PerDrive)> {
        let rows = self.rows(q)?;
        let (n, arms) = (self.space.drives(), arms(self.space, q));
        let i = Vector::new(0.0, 1.0);
        let residual = |rates: &PerDrive, wanted: Vector| {
            let off = wanted - (0..n).map(|k| i * arms[k] * rates[k]).sum::<Vector>();
            let hand = self.hand.map_or(0.0, |(drive, _)| -self.space.farthest() * rates[drive]);
            [off.re, off.im, -self.scale() * self.space.lambda().dot(rates), hand]
        };
        let first = first.plus(1.0, &rows.least(&residual(first, way[0])));
        // p″ = J q″ − Σ c_k e^{iq_k} q_k′².
        let pull: Vector = (0..n).map(|k| arms[k] * first[k] * first[k]).sum();
        let second = second.plus(1.0, &rows.least(&residual(second, way[1] + pull)));
        Some((first, second))
    }
}

impl ConstraintJacobian {
    /// Returns the minimum-norm change of q for a wanted change of the constrained quantities, scaled to m.
    pub fn least(&self, wanted: &[f64; ROWS]) -> PerDrive {
        let mut delta = PerDrive::zeros(self.across[0].len());
        let mut y = [0.0; ROWS];
        for (i, u) in self.across[..self.count].iter().enumerate() {
            let known: f64 = (0..i).map(|j| self.lower[i][j] * y[j]).sum();
            y[i] = (wanted[i] - known) / self.lower[i][i];
            delta = delta.plus(y[i], u);
        }
        delta
    }

    /// Returns the least-squares multipliers ν of the point for a gradient.
    pub fn multipliers(&self, gradient: &PerDrive) -> Vector {
        let mut nu = [0.0; ROWS];
        for i in (0..self.count).rev() {
            let known: f64 = (i + 1..self.count).map(|j| self.lower[j][i] * nu[j]).sum();
            nu[i] = (self.across[i].dot(gradient) - known) / self.lower[i][i];
        }
        Vector::new(nu[0], nu[1])
    }

    /// Returns an orthonormal basis of the null space: n − 3 vectors, or n − 4 with a drive of constant angle.
    pub fn free(&self) -> Vec<PerDrive> {
        null_directions(&self.across[..self.count], self.across[0].len())
    }
}

/// Returns orthonormal vectors that complete others to a basis of n dimensions.
pub(super) fn null_directions(across: &[PerDrive], n: usize) -> Vec<PerDrive> {
    let mut all: Vec<PerDrive> = Vec::with_capacity(n);
    all.extend_from_slice(across);
    // Squared length of the part of each axis that is outside the span so far.
    let mut outside = PerDrive::from_fn(n, |k| 1.0 - across.iter().map(|u| u[k] * u[k]).sum::<f64>());
    while all.len() < n {
        // The axis with the longest part outside the span.
        let Some(axis) = (0..n).max_by(|k, l| outside[*k].total_cmp(&outside[*l])) else { break };
        let mut next = PerDrive::zeros(n);
        next[axis] = 1.0;
        for _ in 0..2 {
            all.iter().for_each(|u| next = next.plus(-next.dot(u), u));
        }
        let next = next.scaled(1.0 / next.dot(&next).sqrt());
        (0..n).for_each(|k| outside[k] -= next[k] * next[k]);
        all.push(next);
    }
    all.split_off(across.len())
}

/// Returns the arms c_k e^{iq_k} at a pose, m.
pub(super) fn arms(space: &PoseSpace, q: &PerDrive) -> [Vector; MAX_DRIVES] {
    let mut all = [Vector::default(); MAX_DRIVES];
    all.iter_mut().zip(space.arms().iter().zip(q.iter())).for_each(|(arm, (c, q))| *arm = c * unit(*q));
    all
}

/// Converts relative angles and b to drive angles, rad.
pub(super) fn lifted(space: &PoseSpace, a: &PerDrive, b: f64) -> PerDrive {
    let DriveAngles(q) = space.lift(a, b);
    q
}
