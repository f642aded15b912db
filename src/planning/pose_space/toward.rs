//! Towards a point while b is held: the pose that a hand leads to, whatever freedoms are left.
//!
//! # Method
//! Of all small motions that bring the end effector nearer to a point and leave b as it is, the one with the least kinetic
//! energy by the λ of the drives: Δq = Λ⁻¹Cᵀ(CΛ⁻¹Cᵀ + μ)⁻¹ r. The rows of C are ∂p/∂q, λ, and one for each relative
//! angle that stands at a limit and would pass it; μ (Levenberg, Marquardt) acts on the point only and grows while a
//! step brings nothing. Where the point cannot be reached, how the ends of the arms curve counts too: Newton's
//! iteration for the least |p − Σ c_k e^{iq_k}|², whose second derivatives are CᵀC and (p − Σ c e)·c_k e_k on the diagonal,
//! ends at a pose that is as near as can be.

use super::space::{Lead, PoseSpace};
use crate::mechanics::planar::{DriveAngles, MAX_DRIVES, PerDrive, Vector, dot, unit};
use nalgebra::{SMatrix, SVector};

/// Rows of C: two of the point, one of b, one a relative angle, and one of a drive that does not turn.
const ROWS: usize = KEPT + 1;
const KEPT: usize = 3 + MAX_DRIVES - 1;
/// The most steps.
const MAX_STEPS: usize = 80;
/// The longest of them, rad.
const MAX_STEP: f64 = 0.3;
/// Nearer to the point than this share of the reach is at it.
const AT_SHARE: f64 = 1e-13;
/// μ to begin with, a share of the square of the reach.
const FIRST_DAMPING: f64 = 1e-8;
/// μ at which it is given up, a share of the square of the reach.
const LAST_DAMPING: f64 = 1e4;
/// A step that brings less than this share is the last.
const MIN_GAIN_SHARE: f64 = 1e-12;

/// Steps of Newton's iteration at most.
const MAX_NEWTON_STEPS: usize = 60;
/// The shortest of them, rad.
const MIN_NEWTON_STEP: f64 = 1e-10;
/// Nearer than this share of the reach, a point that was out of it may be in it.
const ALMOST_SHARE: f64 = 0.01;

type Rows = SMatrix<f64, ROWS, MAX_DRIVES>;
/// Δq, and a multiplier for b and each relative angle.
const KKT: usize = 2 * MAX_DRIVES;

impl PoseSpace {
    /// Relative angles at b that put the end effector on p, m, or as near as can be from there, gone to from others; and
    /// how far that is, m.
    pub fn toward(&self, p: Vector, b: f64, from: &[f64]) -> (PerDrive, f64) {
        let gone = self.gone(p, b, from, None);
        if gone.1 <= AT_SHARE * self.farthest() { gone } else { self.settled(p, b, gone) }
    }

    /// The same with the drive that is to [keep](Lead::Keep) its angle at that angle, or gone on to the
    /// [middle](Lead::Middle) of all ranges, where it is [led](Self::led) so.
    pub fn toward_led(&self, p: Vector, b: f64, from: &[f64]) -> Option<(PerDrive, f64)> {
        match self.lead {
            Lead::Keep(kept) => Some(self.gone(p, b, from, Some(kept))),
            Lead::Middle => {
                let (a, off) = self.gone(p, b, from, None);
                Some((self.centred(p, b, &a), off))
            }
            Lead::LeastEnergy | Lead::Weighed(_) => None,
        }
    }

    fn gone(&self, p: Vector, b: f64, from: &[f64], kept: Option<usize>) -> (PerDrive, f64) {
        let reach = self.farthest();
        let mut a = self.clamped(from);
        let mut q = self.lift(&a, b);
        let mut off = (self.place(&q) - p).norm();
        let mut mu = FIRST_DAMPING;
        let mut locked = [false; MAX_DRIVES];
        for _ in 0..MAX_STEPS {
            if off <= AT_SHARE * reach {
                break;
            }
            let Some(step) = self.step(p, &q, &locked, kept, mu) else { break };
            let next = self.angles(&q.0.plus(1.0, &step));
            // An angle that would pass its limit stays there, and the others do without it.
            if let Some(i) = self.passed(&a, &next, &locked) {
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
                if brought < MIN_GAIN_SHARE * reach {
                    break;
                }
            } else {
                mu *= 8.0;
                if mu > LAST_DAMPING {
                    break;
                }
            }
        }
        (a, off)
    }

    /// The same for a point that was out of reach of the pose beside it, at a b near to this one.
    pub fn toward_beside(&self, p: Vector, b: f64, from: &[f64]) -> (PerDrive, f64) {
        let a = self.clamped(from);
        let off = (self.place(&self.lift(&a, b)) - p).norm();
        let settled = self.settled(p, b, (a, off));
        if settled.1 > ALMOST_SHARE * self.farthest() {
            return settled;
        }
        let gone = self.toward(p, b, from);
        if gone.1 < settled.1 { gone } else { settled }
    }

    /// The pose beside another one that is as near to p as can be, and how far that is, m.
    fn settled(&self, p: Vector, b: f64, (mut a, mut off): (PerDrive, f64)) -> (PerDrive, f64) {
        let mut q = self.lift(&a, b);
        let mut mu = FIRST_DAMPING;
        let mut locked = [false; MAX_DRIVES];
        for _ in 0..MAX_NEWTON_STEPS {
            let step = self.curved_step(p, &q, &locked, mu);
            let size = step.map_or(f64::INFINITY, |step| step.max_abs());
            let next = step.map(|step| self.angles(&q.0.plus(1.0, &step)));
            if let Some(next) = next {
                if let Some(i) = self.passed(&a, &next, &locked) {
                    locked[i] = true;
                    continue;
                }
                let next = self.clamped(&next);
                let there = self.lift(&next, b);
                let left = (self.place(&there) - p).norm();
                if left < off {
                    (a, q, off) = (next, there, left);
                    (mu, locked) = (0.1 * mu, [false; MAX_DRIVES]);
                    if size < MIN_NEWTON_STEP {
                        break;
                    }
                    continue;
                }
            }
            mu *= 8.0;
            if size < MIN_NEWTON_STEP || mu > LAST_DAMPING {
                break;
            }
        }
        (a, off)
    }

    /// The first angle that stands at a limit and would pass it.
    fn passed(&self, a: &PerDrive, next: &PerDrive, locked: &[bool; MAX_DRIVES]) -> Option<usize> {
        let passes = |i: &usize| {
            let [low, high] = self.joints[*i].bounds();
            !locked[*i] && ((a[*i] <= low && next[*i] < a[*i]) || (a[*i] >= high && next[*i] > a[*i]))
        };
        (0..self.joints.len()).find(passes)
    }

    /// Δq of Newton's step, as long as is allowed at most.
    fn curved_step(&self, p: Vector, q: &DriveAngles, locked: &[bool; MAX_DRIVES], mu: f64) -> Option<PerDrive> {
        let (n, reach) = (self.drives(), self.farthest());
        let arm = |k: usize| unit(q[k]) * (self.tip[k] / reach);
        let gap = (p - self.place(q)) / reach;
        let mut square = SMatrix::<f64, KKT, KKT>::zeros();
        let mut r = SVector::<f64, KKT>::zeros();
        for k in 0..n {
            let along = Vector::new(0.0, 1.0) * arm(k);
            r[k] = dot(gap, along);
            (0..n).for_each(|l| square[(k, l)] = dot(along, Vector::new(0.0, 1.0) * arm(l)));
            square[(k, k)] += dot(gap, arm(k)) + mu * self.lambda[k].abs().max(1e-6);
            (square[(k, n)], square[(n, k)]) = (self.lambda[k], self.lambda[k]);
        }
        for i in n + 1..KKT {
            match self.joints.get(i - n - 1).filter(|_| locked[i - n - 1]) {
                Some(joint) => {
                    for (end, sign) in joint.ends.into_iter().zip([-1.0, 1.0]) {
                        (square[(end, i)], square[(i, end)]) = (sign, sign);
                    }
                }
                None => square[(i, i)] = 1.0,
            }
        }
        let step = square.lu().solve(&r)?;
        let size = step.rows(0, n).amax();
        let short = if size > MAX_STEP { MAX_STEP / size } else { 1.0 };
        size.is_finite().then(|| PerDrive::from_fn(n, |k| short * step[k]))
    }

    /// Δq of one step, as long as is allowed at most.
    fn step(
        &self,
        p: Vector,
        q: &DriveAngles,
        locked: &[bool; MAX_DRIVES],
        kept: Option<usize>,
        mu: f64,
    ) -> Option<PerDrive> {
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
        if let Some(kept) = kept {
            c[(KEPT, kept)] = 1.0;
        }
        // A drive that turns nothing costs nothing: a little keeps the step finite.
        let cost = |k: usize| self.lambda[k].abs().max(1e-6);
        let light = match &self.lead {
            Lead::Weighed(inverse) => {
                SMatrix::<f64, MAX_DRIVES, MAX_DRIVES>::from_fn(|k, l| inverse[k][l]) * c.transpose()
            }
            _ => {
                let mut light = c.transpose();
                (0..n).for_each(|k| light.row_mut(k).scale_mut(1.0 / cost(k)));
                light
            }
        };
        let mut square = c * light;
        for i in 0..ROWS {
            if i < 2 {
                square[(i, i)] += mu;
            } else if (i == KEPT && kept.is_none()) || (3..KEPT).contains(&i) && !locked[i - 3] {
                square[(i, i)] = 1.0;
            }
        }
        let step = light * square.lu().solve(&r)?;
        let size = step.amax();
        let short = if size > MAX_STEP { MAX_STEP / size } else { 1.0 };
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
