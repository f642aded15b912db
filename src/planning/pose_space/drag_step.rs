//! Inverse kinematics of a dragged end effector while b is held, for any number of redundant freedoms.
//!
//! # Method
//! Each step moves the end effector towards the point and keeps b, with the least kinetic energy for inertias |λ_k|:
//! Δq = Λ⁻¹Cᵀ(CΛ⁻¹Cᵀ + μ)⁻¹ r. The rows of C are the end effector's Jacobian J, λ, and one for each relative angle at a
//! limit that the step would violate. The damping μ (Levenberg, Marquardt) acts on the rows of the point only, and
//! grows while steps are rejected. If the point is out of reach, Newton's iteration minimises |p − Σ c_k e^{iq_k}|².
//! Half its Hessian is JᵀJ, plus (p − Σ c e)·c_k e_k on the diagonal. It converges to a locally nearest pose.

use super::space::{GuidanceMode, PoseSpace};
use nalgebra::{SMatrix, SVector};
use stillbase_mechanics::planar::{DriveAngles, MAX_DRIVES, PerDrive, Vector, dot, unit};

/// Rows of C: two for the point, one for b, and one for each relative angle. The last row is for a drive that
/// keeps its angle.
const ROWS: usize = KEPT_ROW + 1;
const KEPT_ROW: usize = 3 + MAX_DRIVES - 1;
/// Maximum number of steps.
const MAX_STEPS: usize = 80;
/// Maximum step, rad.
const MAX_STEP_RAD: f64 = 0.3;
/// Residual below which the point is reached, as a fraction of the reach.
const RESIDUAL_TOLERANCE: f64 = 1e-13;
/// Initial damping μ, as a fraction of the squared reach.
const INITIAL_DAMPING: f64 = 1e-8;
/// Damping μ above which the iteration ends, as a fraction of the squared reach.
const MAX_DAMPING: f64 = 1e4;
/// The iteration ends at a step that reduces the residual by less than this fraction of the reach.
const MIN_GAIN: f64 = 1e-12;

/// Maximum number of Newton steps.
const MAX_NEWTON_STEPS: usize = 60;
/// Newton's iteration ends at steps below this, rad.
const NEWTON_TOLERANCE_RAD: f64 = 1e-10;
/// Residual, as a fraction of the reach, below which the point may have come within reach.
const RETRY_BELOW: f64 = 0.01;

type Rows = SMatrix<f64, ROWS, MAX_DRIVES>;
/// Size of the KKT system: Δq, and a multiplier for b and each relative angle.
const KKT: usize = 2 * MAX_DRIVES;

impl PoseSpace {
    /// Returns relative angles at b that put the end effector on p, m, or as near as possible, by iteration from
    /// `from`. Also returns the end effector's distance from p, m.
    pub fn drag_to(&self, p: Vector, b: f64, from: &[f64]) -> (PerDrive, f64) {
        let gone = self.approach(p, b, from, None);
        if gone.1 <= RESIDUAL_TOLERANCE * self.farthest() { gone } else { self.minimise_distance(p, b, gone) }
    }

    /// As [`drag_to`](Self::drag_to), for a space [guided](Self::with_guidance) to [keep](GuidanceMode::Keep) the
    /// angle of a drive, or to approach the [middle](GuidanceMode::Middle) of all ranges. Returns `None` for other
    /// spaces.
    pub fn drag_to_guided(&self, p: Vector, b: f64, from: &[f64]) -> Option<(PerDrive, f64)> {
        match self.guidance {
            GuidanceMode::Keep(kept) => Some(self.approach(p, b, from, Some(kept))),
            GuidanceMode::Middle => {
                let (a, off) = self.approach(p, b, from, None);
                Some((self.midrange_pose(p, b, &a), off))
            }
            GuidanceMode::LeastEnergy | GuidanceMode::WeightedNorm(_) => None,
        }
    }

    fn approach(&self, p: Vector, b: f64, from: &[f64], kept: Option<usize>) -> (PerDrive, f64) {
        let reach = self.farthest();
        let mut a = self.clamped(from);
        let mut q = self.lift(&a, b);
        let mut distance = (self.end_effector(&q) - p).norm();
        let mut mu = INITIAL_DAMPING;
        let mut locked = [false; MAX_DRIVES];
        for _ in 0..MAX_STEPS {
            if distance <= RESIDUAL_TOLERANCE * reach {
                break;
            }
            let Some(step) = self.step(p, &q, &locked, kept, mu) else { break };
            let next = self.angles(&q.0.plus(1.0, &step));
            // An angle that would violate its limit is locked there, and the step is repeated without it.
            if let Some(i) = self.passed(&a, &next, &locked) {
                locked[i] = true;
                continue;
            }
            let next = self.clamped(&next);
            let there = self.lift(&next, b);
            let next_distance = (self.end_effector(&there) - p).norm();
            if next_distance < distance {
                let gain = distance - next_distance;
                (a, q, distance) = (next, there, next_distance);
                (mu, locked) = (0.2 * mu, [false; MAX_DRIVES]);
                if gain < MIN_GAIN * reach {
                    break;
                }
            } else {
                mu *= 8.0;
                if mu > MAX_DAMPING {
                    break;
                }
            }
        }
        (a, distance)
    }

    /// As [`drag_to`](Self::drag_to), for a point that was out of reach at a nearby b, by iteration from the pose at
    /// that b.
    pub fn drag_to_from_nearby(&self, p: Vector, b: f64, from: &[f64]) -> (PerDrive, f64) {
        let a = self.clamped(from);
        let distance = (self.end_effector(&self.lift(&a, b)) - p).norm();
        let settled = self.minimise_distance(p, b, (a, distance));
        if settled.1 > RETRY_BELOW * self.farthest() {
            return settled;
        }
        let gone = self.drag_to(p, b, from);
        if gone.1 < settled.1 { gone } else { settled }
    }

    /// Returns the pose at a local minimum of the distance from p, and that distance, m.
    fn minimise_distance(&self, p: Vector, b: f64, (mut a, mut distance): (PerDrive, f64)) -> (PerDrive, f64) {
        let mut q = self.lift(&a, b);
        let mut mu = INITIAL_DAMPING;
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
                let next_distance = (self.end_effector(&there) - p).norm();
                if next_distance < distance {
                    (a, q, distance) = (next, there, next_distance);
                    (mu, locked) = (0.1 * mu, [false; MAX_DRIVES]);
                    if size < NEWTON_TOLERANCE_RAD {
                        break;
                    }
                    continue;
                }
            }
            mu *= 8.0;
            if size < NEWTON_TOLERANCE_RAD || mu > MAX_DAMPING {
                break;
            }
        }
        (a, distance)
    }

    /// Returns the first angle at a limit that a step would violate.
    fn passed(&self, a: &PerDrive, next: &PerDrive, locked: &[bool; MAX_DRIVES]) -> Option<usize> {
        let passes = |i: &usize| {
            let [low, high] = self.joints[*i].bounds();
            !locked[*i] && ((a[*i] <= low && next[*i] < a[*i]) || (a[*i] >= high && next[*i] > a[*i]))
        };
        (0..self.joints.len()).find(passes)
    }

    /// Returns the Newton step Δq, limited in length; `None` if the system is singular.
    fn curved_step(&self, p: Vector, q: &DriveAngles, locked: &[bool; MAX_DRIVES], mu: f64) -> Option<PerDrive> {
        let (n, reach) = (self.drives(), self.farthest());
        let arm = |k: usize| unit(q[k]) * (self.arms[k] / reach);
        let gap = (p - self.end_effector(q)) / reach;
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
        let short = if size > MAX_STEP_RAD { MAX_STEP_RAD / size } else { 1.0 };
        size.is_finite().then(|| PerDrive::from_fn(n, |k| short * step[k]))
    }

    /// Returns the damped step Δq, limited in length; `None` if the system is singular.
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
        let gap = (p - self.end_effector(q)) / reach;
        (r[0], r[1]) = (gap.re, gap.im);
        for k in 0..n {
            let column = Vector::new(0.0, 1.0) * unit(q[k]) * (self.arms[k] / reach);
            (c[(0, k)], c[(1, k)], c[(2, k)]) = (column.re, column.im, self.lambda[k]);
        }
        for (i, joint) in self.joints.iter().enumerate().filter(|(i, _)| locked[*i]) {
            (c[(3 + i, joint.ends[0])], c[(3 + i, joint.ends[1])]) = (-1.0, 1.0);
        }
        if let Some(kept) = kept {
            c[(KEPT_ROW, kept)] = 1.0;
        }
        // A drive without inertia has no weight; a small weight keeps the step finite.
        let cost = |k: usize| self.lambda[k].abs().max(1e-6);
        let light = match &self.guidance {
            GuidanceMode::WeightedNorm(inverse) => {
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
            } else if (i == KEPT_ROW && kept.is_none()) || (3..KEPT_ROW).contains(&i) && !locked[i - 3] {
                square[(i, i)] = 1.0;
            }
        }
        let step = light * square.lu().solve(&r)?;
        let size = step.amax();
        let short = if size > MAX_STEP_RAD { MAX_STEP_RAD / size } else { 1.0 };
        size.is_finite().then(|| PerDrive::from_fn(n, |k| short * step[k]))
    }

    /// Clamps relative angles to their limits.
    pub fn clamped(&self, a: &[f64]) -> PerDrive {
        PerDrive::from_fn(self.joints.len(), |i| {
            let [low, high] = self.joints[i].bounds();
            a[i].clamp(low, high)
        })
    }
}
