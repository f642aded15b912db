//! Towards a point while b is held: the pose that a hand leads to, whatever freedoms are left.
//!
//! # Method
//! Of all small motions that bring the end effector nearer to a point and leave b as it is, the one with the least kinetic
//! energy by the λ of the drives: Δq = Λ⁻¹Cᵀ(CΛ⁻¹Cᵀ + μ)⁻¹ r. The rows of C are ∂p/∂q, λ, and one for each relative
//! angle that stands at a limit and would pass it; μ (Levenberg, Marquardt) acts on the point only and grows while a
//! step brings nothing. Where the point cannot be reached this ends at a pose that is as near as can be.

use super::space::PoseSpace;
use crate::mechanics::planar::{DriveAngles, MAX_DRIVES, PerDrive, Vector, unit};
use nalgebra::{SMatrix, SVector};

/// Rows of C: two of the point, one of b, one a relative angle.
const ROWS: usize = 3 + MAX_DRIVES - 1;
/// The most steps, and the longest, rad.
const STEPS: usize = 80;
const LONGEST: f64 = 0.3;
/// Nearer to the point than this share of the reach is at it.
const AT: f64 = 1e-13;
/// μ to begin with and where it is given up, shares of the square of the reach.
const FIRST: f64 = 1e-8;
const LAST: f64 = 1e4;
/// A step that brings less than this share is the last.
const LITTLE: f64 = 1e-12;

type Rows = SMatrix<f64, ROWS, MAX_DRIVES>;

impl PoseSpace {
    /// Relative angles at b that put the end effector on p, m, or as near as can be from there, gone to from others; and
    /// how far that is, m.
    pub fn toward(&self, p: Vector, b: f64, from: &[f64]) -> (PerDrive, f64) {
        let reach = self.farthest();
        let mut a = self.clamped(from);
        let mut q = self.lift(&a, b);
        let mut off = (self.place(&q) - p).norm();
        let mut mu = FIRST;
        let mut locked = [false; MAX_DRIVES];
        for _ in 0..STEPS {
            if off <= AT * reach {
                break;
            }
            let Some(step) = self.step(p, &q, &locked, mu) else { break };
            let next = self.angles(&q.0.plus(1.0, &step));
            // An angle that would pass its limit stays there, and the others do without it.
            let passes = |i: usize| {
                let [low, high] = self.joints[i].bounds();
                !locked[i] && ((a[i] <= low && next[i] < a[i]) || (a[i] >= high && next[i] > a[i]))
            };
            if let Some(i) = (0..self.joints.len()).find(|i| passes(*i)) {
                locked[i] = true;
                continue;
            }
            let next = self.clamped(&next);
            let there = self.lift(&next, b);
            let left = (self.place(&there) - p).norm();
            if left < off {
                let brought = off - left;
                (a, q, off) = (next, there, left);
                (mu, locked) = (0.2 * mu, [false; MAX_DRIVES]);
                if brought < LITTLE * reach {
                    break;
                }
            } else {
                mu *= 8.0;
                if mu > LAST {
                    break;
                }
            }
        }
        (a, off)
    }

    /// Δq of one step, as long as is allowed at most.
    fn step(&self, p: Vector, q: &DriveAngles, locked: &[bool; MAX_DRIVES], mu: f64) -> Option<PerDrive> {
        let (n, reach) = (self.drives(), self.farthest());
        let mut c = Rows::zeros();
        let mut r = SVector::<f64, ROWS>::zeros();
        let gap = (p - self.place(q)) / reach;
        (r[0], r[1]) = (gap.re, gap.im);
        for k in 0..n {
            let column = Vector::new(0.0, 1.0) * unit(q[k]) * (self.tip[k] / reach);
            (c[(0, k)], c[(1, k)], c[(2, k)]) = (column.re, column.im, self.lambda[k]);
        }
        for (i, joint) in self.joints.iter().enumerate().filter(|(i, _)| locked[*i]) {
            (c[(3 + i, joint.ends[0])], c[(3 + i, joint.ends[1])]) = (-1.0, 1.0);
        }
        // A drive that turns nothing costs nothing: a little keeps the step finite.
        let cost = |k: usize| self.lambda[k].abs().max(1e-6);
        let mut light = c.transpose();
        (0..n).for_each(|k| light.row_mut(k).scale_mut(1.0 / cost(k)));
        let mut square = c * light;
        for i in 0..ROWS {
            if i < 2 {
                square[(i, i)] += mu;
            } else if i >= 3 && !locked[i - 3] {
                square[(i, i)] = 1.0;
            }
        }
        let step = light * square.lu().solve(&r)?;
        let size = step.amax();
        let short = if size > LONGEST { LONGEST / size } else { 1.0 };
        size.is_finite().then(|| PerDrive::from_fn(n, |k| short * step[k]))
    }

    /// Relative angles within their limits.
    pub fn clamped(&self, a: &[f64]) -> PerDrive {
        PerDrive::from_fn(self.joints.len(), |i| {
            let [low, high] = self.joints[i].bounds();
            a[i].clamp(low, high)
        })
    }
}
