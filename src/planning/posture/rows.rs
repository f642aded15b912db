//! [`Held`]: what every pose of a path keeps, and the freedoms that this leaves.

use super::super::pose_space::PoseSpace;
use crate::mechanics::planar::{DriveAngles, MAX_DRIVES, PerDrive, Vector, unit};

/// Two rows of the point, b, and the last link's drive.
const ROWS: usize = 4;
/// Steps back onto the rows at most.
const MAX_STEPS: usize = 20;
/// How near counts as on the rows, a share of the reach.
const ON_ROWS_SHARE: f64 = 1e-14;
/// What rounding may leave, a share of the reach.
const ROUNDING_SHARE: f64 = 1e-11;
/// A row that is left with this share of its length by the rows before it adds nothing.
const NO_RANK: f64 = 1e-7;

/// The place of the end effector, b, and perhaps the angle of one drive.
#[derive(Clone, Copy, Debug)]
pub(super) struct Held<'a> {
    pub space: &'a PoseSpace,
    /// rad.
    pub b: f64,
    /// A drive that keeps its angle, rad.
    pub hand: Option<(usize, f64)>,
}

/// The rows ∂(p, b, hand)/∂q at a pose, each as long as the arms, as L U with orthonormal U.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rows {
    count: usize,
    across: [PerDrive; ROWS],
    lower: [[f64; ROWS]; ROWS],
}

impl Held<'_> {
    /// How many freedoms are left.
    pub fn freedoms(&self) -> usize {
        self.space.drives() - 3 - usize::from(self.hand.is_some())
    }

    /// What a b of 1 rad counts as, m.
    fn scale(&self) -> f64 {
        self.space.farthest() / self.space.lambda().max_abs()
    }

    /// By how much a pose misses a point, m, and the rest as it counts.
    fn missing(&self, q: &PerDrive, p: Vector) -> [f64; ROWS] {
        let off = p - self.space.place(q);
        let hand = self.hand.map_or(0.0, |(drive, angle)| self.space.farthest() * (angle - q[drive]));
        [off.re, off.im, self.scale() * (self.b - self.space.b(q)), hand]
    }

    /// The rows at a pose; `None` where they depend on each other.
    pub fn rows(&self, q: &PerDrive) -> Option<Rows> {
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
        let mut rows = Rows { count, across: [none; ROWS], lower: [[0.0; ROWS]; ROWS] };
        for (i, row) in all[..count].iter().enumerate() {
            let mut left = *row;
            for _ in 0..2 {
                for (u, lower) in rows.across[..i].iter().zip(&mut rows.lower[i]) {
                    let share = left.dot(u);
                    *lower += share;
                    left = left.plus(-share, u);
                }
            }
            let length = left.dot(&left).sqrt();
            if length.is_nan() || length <= NO_RANK * row.dot(row).sqrt() {
                return None;
            }
            rows.lower[i][i] = length;
            rows.across[i] = left.scaled(1.0 / length);
        }
        Some(rows)
    }

    /// The pose of a point beside a pose, by the least steps.
    pub fn onto(&self, q: &PerDrive, p: Vector) -> Option<PerDrive> {
        let reach = self.space.farthest();
        let mut q = *q;
        let mut last = f64::INFINITY;
        for _ in 0..MAX_STEPS {
            let missing = self.missing(&q, p);
            let size = missing.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
            if size <= ON_ROWS_SHARE * reach || (size >= 0.5 * last && size <= ROUNDING_SHARE * reach) {
                return Some(q);
            }
            if size.is_nan() || size > 4.0 * last {
                return None;
            }
            last = size;
            q = q.plus(1.0, &self.rows(&q)?.least(&missing));
        }
        None
    }

    /// q′ and q″ that go along a curve, beside others.
    pub fn along(
        &self,
        q: &PerDrive,
        (first, second): (&PerDrive, &PerDrive),
        way: [Vector; 2],
    ) -> Option<(PerDrive, PerDrive)> {
        let rows = self.rows(q)?;
        let (n, arms) = (self.space.drives(), arms(self.space, q));
        let i = Vector::new(0.0, 1.0);
        let left = |rates: &PerDrive, wanted: Vector| {
            let off = wanted - (0..n).map(|k| i * arms[k] * rates[k]).sum::<Vector>();
            let hand = self.hand.map_or(0.0, |(drive, _)| -self.space.farthest() * rates[drive]);
            [off.re, off.im, -self.scale() * self.space.lambda().dot(rates), hand]
        };
        let first = first.plus(1.0, &rows.least(&left(first, way[0])));
        // p″ = J q″ − Σ c e q′².
        let pull: Vector = (0..n).map(|k| arms[k] * first[k] * first[k]).sum();
        let second = second.plus(1.0, &rows.least(&left(second, way[1] + pull)));
        Some((first, second))
    }
}

impl Rows {
    /// The least change of q that makes the rows change so.
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

    /// ν of the point with Cᵀ ν nearest to a gradient.
    pub fn multipliers(&self, gradient: &PerDrive) -> Vector {
        let mut nu = [0.0; ROWS];
        for i in (0..self.count).rev() {
            let known: f64 = (i + 1..self.count).map(|j| self.lower[j][i] * nu[j]).sum();
            nu[i] = (self.across[i].dot(gradient) - known) / self.lower[i][i];
        }
        Vector::new(nu[0], nu[1])
    }

    /// Orthonormal directions that they leave free, of number n − 3, or n − 4.
    pub fn free(&self) -> Vec<PerDrive> {
        left_free(&self.across[..self.count], self.across[0].len())
    }
}

/// Orthonormal directions that complete others.
pub(super) fn left_free(across: &[PerDrive], n: usize) -> Vec<PerDrive> {
    let mut all: Vec<PerDrive> = Vec::with_capacity(n);
    all.extend_from_slice(across);
    // What is left of each axis, squared.
    let mut left = PerDrive::from_fn(n, |k| 1.0 - across.iter().map(|u| u[k] * u[k]).sum::<f64>());
    while all.len() < n {
        // The axis of which most is left.
        let Some(axis) = (0..n).max_by(|k, l| left[*k].total_cmp(&left[*l])) else { break };
        let mut next = PerDrive::zeros(n);
        next[axis] = 1.0;
        for _ in 0..2 {
            all.iter().for_each(|u| next = next.plus(-next.dot(u), u));
        }
        let next = next.scaled(1.0 / next.dot(&next).sqrt());
        (0..n).for_each(|k| left[k] -= next[k] * next[k]);
        all.push(next);
    }
    all.split_off(across.len())
}

/// c_k e^{iq_k}: the arms at a pose, m.
pub(super) fn arms(space: &PoseSpace, q: &PerDrive) -> [Vector; MAX_DRIVES] {
    let mut all = [Vector::default(); MAX_DRIVES];
    all.iter_mut().zip(space.tip().iter().zip(q.iter())).for_each(|(arm, (c, q))| *arm = c * unit(*q));
    all
}

/// Relative angles as drive angles on b.
pub(super) fn lifted(space: &PoseSpace, a: &PerDrive, b: f64) -> PerDrive {
    let DriveAngles(q) = space.lift(a, b);
    q
}
