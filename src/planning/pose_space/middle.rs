//! The pose of a point and a b that is nearest to the middle of all ranges, beside another one.

use super::space::PoseSpace;
use crate::mechanics::planar::{MAX_DRIVES, PerDrive, Vector, dot, unit};

/// Steps at most, the longest, and when they are done, rad.
const STEPS: usize = 200;
const LONGEST: f64 = 0.2;
const DONE: f64 = 1e-12;
/// What a joint without a range weighs.
const LIGHT: f64 = 1e-3;
/// The point is kept as near as this, a share of the reach.
const KEPT: f64 = 1e-11;

impl PoseSpace {
    /// Relative angles at b with the end effector on p, m, that have the least ½ Σ x_i², x_i the share of a range either
    /// way from its middle; from a pose that is there. That pose itself where none is found within the limits.
    pub fn centred(&self, p: Vector, b: f64, from: &PerDrive) -> PerDrive {
        let n = self.joints.len();
        let half = |i: usize| match self.joints[i].free {
            true => f64::INFINITY,
            false => 0.5 * (self.joints[i].limits[1] - self.joints[i].limits[0]).max(1e-6),
        };
        let weights = PerDrive::from_fn(n, |i| half(i).powi(-2) + LIGHT);
        let middle = self.middle();
        let mut a = *from;
        for _ in 0..STEPS {
            let columns = self.columns(&a, b);
            let off = p - self.place(&self.lift(&a, b));
            let down = PerDrive::from_fn(n, |i| -(a[i] - middle[i]) * half(i).powi(-2) / weights[i]);
            // Of all steps that bring the point back, the one that is nearest to the way down.
            let along: Vector = (0..n).map(|i| columns[i] * down[i]).sum();
            let gram = (0..n).fold([0.0; 3], |g, i| {
                let (c, w) = (columns[i], 1.0 / weights[i]);
                [g[0] + w * c.re * c.re, g[1] + w * c.re * c.im, g[2] + w * c.im * c.im]
            });
            let det = gram[0] * gram[2] - gram[1] * gram[1];
            if det <= 1e-14 * (gram[0] + gram[2]).powi(2) {
                return *from;
            }
            let left = off - along;
            let pull = Vector::new(gram[2] * left.re - gram[1] * left.im, gram[0] * left.im - gram[1] * left.re) / det;
            let step = PerDrive::from_fn(n, |i| down[i] + dot(columns[i], pull) / weights[i]);
            let size = step.max_abs();
            a = a.plus((LONGEST / size).min(1.0), &step);
            if size < DONE {
                break;
            }
        }
        let there = (self.place(&self.lift(&a, b)) - p).norm() <= KEPT * self.farthest();
        let within = self.joints.iter().zip(a.iter()).all(|(joint, a)| {
            let [low, high] = joint.bounds();
            *a >= low && *a <= high
        });
        if there && within { a } else { *from }
    }

    /// ∂p/∂a with b held, m.
    fn columns(&self, a: &PerDrive, b: f64) -> [Vector; MAX_DRIVES] {
        let (q, n) = (self.lift(a, b), a.len());
        let mut columns = [Vector::default(); MAX_DRIVES];
        for (i, column) in columns.iter_mut().enumerate().take(n) {
            let rates = self.lift_rates(&PerDrive::from_fn(n, |j| f64::from(u8::from(i == j))), 0.0);
            *column = (0..n + 1).map(|k| Vector::new(0.0, self.tip[k] * rates[k]) * unit(q[k])).sum();
        }
        columns
    }
}
