//! Dragging a link while the end effector and b are held, for four drives and more.
//!
//! # Method
//! With b fixed, the poses with the same end effector position p(a) form a set of n − 3 dimensions in the n − 1
//! relative angles a. Over a step the tangential displacement w is a quadratic function of time. Then a = a₀ + w +
//! J₀ᵀμ, where Newton's method finds the μ that keeps the end effector; rates and accelerations follow from J ȧ = 0.
//! So the end effector and b are constant up to rounding at every instant and any speed.

use std::sync::Arc;

use super::braking::{LAG_TIME, approach, greatest_feasible_fraction, norm};
use crate::Reference;
use crate::pose_space::PoseSpace;
use stillbase_mechanics::machine::Chain;
use stillbase_mechanics::planar::{MAX_DRIVES, PerDrive, Vector, dot, unit};

/// A point of a link, and the position it is dragged to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pull {
    /// The point is Σ_k chain_k e^{iq_k}, m.
    pub chain: Chain,
    /// Target position, m.
    pub at: Vector,
}

/// Fraction of the bound on |ä| that is used tangentially, to change the speed.
const ALONG_SHARE: f64 = 0.65;
/// Maximum fraction of the bound on |ä| that following the curvature may take.
const ACROSS_SHARE: f64 = 0.7;
/// The wanted speed is chosen so that following the curvature takes at most this fraction of the bound on |ä|.
const TURNING_SHARE: f64 = 0.4;
/// The dragging error is clipped to this fraction of the reach.
const MAX_ERROR_SHARE: f64 = 0.15;
/// Damping of the least-squares rates, as a fraction of the reach per radian.
const DAMPING_SHARE: f64 = 0.05;
/// The reference stops when both its wanted and its present speed are below this, rad/s.
const STILL_BELOW_RAD_S: f64 = 1e-8;
/// Tolerance of the end effector position, as a fraction of the reach.
const POSITION_TOLERANCE: f64 = 1e-15;

/// A reference that keeps the end effector in place while a link is dragged.
#[derive(Clone, Debug)]
pub struct HeldReference {
    space: Arc<PoseSpace>,
    pull: Pull,
    point: Vector,
    b: f64,
    bound: f64,
    step: f64,
    a: PerDrive,
    v: PerDrive,
    /// Tangential acceleration over the present step, rad/s².
    acc: PerDrive,
}

/// Columns of the Jacobian ∂p/∂a, m.
type Columns = [Vector; MAX_DRIVES];

/// Relative angles with their derivatives.
struct State {
    a: PerDrive,
    v: PerDrive,
    acc: PerDrive,
}

/// Returns J x.
fn along(columns: &Columns, x: &PerDrive) -> Vector {
    columns.iter().zip(x.iter()).map(|(c, x)| *c * *x).sum()
}

/// Returns Jᵀ μ.
fn across(columns: &Columns, mu: Vector, n: usize) -> PerDrive {
    PerDrive::from_fn(n, |i| dot(columns[i], mu))
}

/// Solves J J₀ᵀ μ = r for μ; `None` if the matrix is singular.
fn solved(j: &Columns, j0: &Columns, n: usize, r: Vector) -> Option<Vector> {
    let x = along(j, &across(j0, Vector::new(1.0, 0.0), n));
    let y = along(j, &across(j0, Vector::new(0.0, 1.0), n));
    let det = x.re * y.im - x.im * y.re;
    let size = x.norm() * y.norm();
    (det.abs() > 1e-12 * size).then(|| Vector::new(r.re * y.im - r.im * y.re, x.re * r.im - x.im * r.re) / det)
}

impl HeldReference {
    /// Holds the end effector at its position in a pose at rest, and starts the drag. `bound` is the bound on |ä|,
    /// rad/s²; `step` is the time between calls of [`advance`](Self::advance), s.
    pub fn new(space: Arc<PoseSpace>, a: PerDrive, b: f64, (bound, step): (f64, f64), pull: Pull) -> Self {
        let (point, still) = (space.end_effector(&space.lift(&a, b)), PerDrive::zeros(a.len()));
        let mut held = Self { space, pull, point, b, bound, step, a, v: still, acc: still };
        held.steer();
        held
    }

    /// Changes the drag.
    pub fn pull(&mut self, pull: Pull) {
        self.pull = pull;
        self.steer();
    }

    /// Returns the relative angles, rad, and their rates, rad/s.
    pub fn angles(&self) -> (PerDrive, PerDrive) {
        (self.a, self.v)
    }

    /// Returns whether the reference stands still.
    pub fn is_at_rest(&self) -> bool {
        self.v.iter().chain(self.acc.iter()).all(|x| *x == 0.0)
    }

    /// Returns the reference dt seconds into the present step.
    pub fn reference(&self, dt: f64) -> Reference {
        let at = self.after(&self.acc, dt).unwrap_or(State { a: self.a, v: self.v, acc: self.acc });
        let rates = |x: &PerDrive| self.space.lift_rates(x, 0.0);
        Reference { q: self.space.lift(&at.a, self.b), qd: rates(&at.v), qdd: rates(&at.acc) }
    }

    /// Ends the present step and begins the next.
    pub fn advance(&mut self) {
        match self.after(&self.acc, self.step) {
            Some(next) => (self.a, self.v) = (self.space.clamped(&next.a), next.v),
            None => self.v = PerDrive::zeros(self.a.len()),
        }
        self.steer();
    }

    /// Returns the derivatives of a chain's point with respect to the relative angles, m.
    fn columns(&self, chain: &[f64], a: &PerDrive) -> Columns {
        let (q, n) = (self.space.lift(a, self.b), a.len());
        let mut columns = Columns::default();
        for (i, column) in columns.iter_mut().enumerate().take(n) {
            let rates = self.space.lift_rates(&PerDrive::from_fn(n, |j| f64::from(u8::from(i == j))), 0.0);
            let turns = (0..n + 1).map(|k| unit(q[k]) * (chain[k] * rates[k])).sum::<Vector>();
            *column = Vector::new(0.0, 1.0) * turns;
        }
        columns
    }

    fn jacobian(&self, a: &PerDrive) -> Columns {
        self.columns(self.space.arms(), a)
    }

    /// Returns the component of x in the null space of J; `None` if J Jᵀ is singular.
    fn tangent(&self, j: &Columns, x: &PerDrive) -> Option<PerDrive> {
        let n = x.len();
        Some(x.minus(&across(j, solved(j, j, n, along(j, x))?, n)))
    }

    /// Finds the pose near a + w that has the held end effector position, by Newton's method; `None` if there is none.
    fn pose_near(&self, j0: &Columns, w: &PerDrive) -> Option<PerDrive> {
        let n = w.len();
        let mut a = self.a.plus(1.0, w);
        let gap = |a: &PerDrive| self.point - self.space.end_effector(&self.space.lift(a, self.b));
        let mut off = gap(&a);
        for _ in 0..12 {
            if off.norm() <= POSITION_TOLERANCE * self.space.farthest() {
                break;
            }
            let next = a.plus(1.0, &across(j0, solved(&self.jacobian(&a), j0, n, off)?, n));
            let next_off = gap(&next);
            // The residual no longer falls: it is at rounding level.
            if next_off.norm() >= off.norm() {
                break;
            }
            (a, off) = (next, next_off);
        }
        (off.norm() < 1e-9 * self.space.farthest()).then_some(a)
    }

    /// Returns the normal component of ä that keeps the end effector in place, for the rates `v`. `j_acc` is J times
    /// the tangential acceleration.
    fn turning(&self, j: &Columns, j0: &Columns, a: &PerDrive, v: &PerDrive, j_acc: Vector) -> Option<PerDrive> {
        let (q, qd) = (self.space.lift(a, self.b), self.space.lift_rates(v, 0.0));
        let inwards: Vector = (0..q.len()).map(|k| unit(q[k]) * (self.space.arms()[k] * qd[k] * qd[k])).sum();
        Some(across(j0, solved(j, j0, a.len(), inwards - j_acc)?, a.len()))
    }

    /// Returns the state after the time dt, s, with a tangential acceleration; `None` if no pose keeps the end
    /// effector.
    fn after(&self, acc: &PerDrive, dt: f64) -> Option<State> {
        let n = self.a.len();
        if self.is_still(acc) {
            return Some(State { a: self.a, v: self.v, acc: *acc });
        }
        let j0 = self.jacobian(&self.a);
        let a = self.pose_near(&j0, &self.v.scaled(dt).plus(0.5 * dt * dt, acc))?;
        let (j, w) = (self.jacobian(&a), self.v.plus(dt, acc));
        let v = w.minus(&across(&j0, solved(&j, &j0, n, along(&j, &w))?, n));
        let turning = self.turning(&j, &j0, &a, &v, along(&j, acc))?;
        Some(State { a, v, acc: acc.plus(1.0, &turning) })
    }

    fn is_still(&self, acc: &PerDrive) -> bool {
        self.v.iter().chain(acc.iter()).all(|x| *x == 0.0)
    }

    fn is_within(&self, a: &PerDrive) -> bool {
        self.space.joints().iter().zip(a.iter()).all(|(joint, a)| {
            let [low, high] = joint.bounds();
            *a >= low && *a <= high
        })
    }

    /// Returns whether the reference can stop within limits and bound after the coming step.
    fn can_stop_after(&self, acc: &PerDrive) -> bool {
        let Some(next) = self.after(acc, self.step) else { return false };
        if !self.is_within(&next.a) {
            return false;
        }
        let (speed, brake) = (norm(&next.v), ALONG_SHARE * self.bound);
        if speed == 0.0 {
            return true;
        }
        // Full braking step by step, in the last step only as much as needed.
        let whole = (speed / (brake * self.step)).floor();
        let rest = speed - whole * brake * self.step;
        let far = self.step * (0.5 * whole * (speed + rest) + 0.5 * rest);
        let there = Self { a: next.a, v: next.v, ..self.clone() };
        let j0 = there.jacobian(&next.a);
        let fits = |share: f64| {
            let way = next.v.scaled(share * far / speed);
            let Some(a) = there.pose_near(&j0, &way) else { return false };
            let (j, v) = (there.jacobian(&a), next.v.scaled((1.0 - share).sqrt()));
            let Some(v) = there.tangent(&j, &v) else { return false };
            let turning = there.turning(&j, &j, &a, &v, Vector::default());
            self.is_within(&a) && turning.is_some_and(|turning| norm(&turning) <= ACROSS_SHARE * self.bound)
        };
        [0.0, 0.5, 1.0].into_iter().all(fits)
    }

    /// Returns the wanted rates: towards the target of the drag, no faster than limits and curvature permit.
    fn wanted(&self, j: &Columns) -> Option<PerDrive> {
        let (n, reach) = (self.a.len(), self.space.farthest());
        let q = self.space.lift(&self.a, self.b);
        let pulled: Vector = (0..n + 1).map(|k| unit(q[k]) * self.pull.chain[k]).sum();
        let err = self.pull.at - pulled;
        let err = err * (MAX_ERROR_SHARE * reach / err.norm().max(MAX_ERROR_SHARE * reach));
        let g = self.columns(&self.pull.chain, &self.a);
        let row = |of: fn(&Vector) -> f64| self.tangent(j, &PerDrive::from_fn(n, |i| of(&g[i])));
        let (x, y) = (row(|g| g.re)?, row(|g| g.im)?);
        let damping = (DAMPING_SHARE * reach).powi(2);
        let (xx, xy, yy) = (x.dot(&x) + damping, x.dot(&y), y.dot(&y) + damping);
        let det = xx * yy - xy * xy;
        let way = x.scaled((yy * err.re - xy * err.im) / det).plus((xx * err.im - xy * err.re) / det, &y);
        let far = norm(&way);
        if far == 0.0 {
            return Some(way);
        }
        let brake = ALONG_SHARE * self.bound;
        let turning = norm(&self.turning(j, j, &self.a, &way.scaled(1.0 / far), Vector::default())?);
        let max_speed = (TURNING_SHARE * self.bound / turning.max(1e-9)).sqrt();
        let mut w = way.scaled(approach(far, brake).min(max_speed) / far);
        // Reduce the rates by the least change until each angle can stop at its limit.
        let passes = |w: &PerDrive, i: usize| {
            let ([low, high], a) = (self.space.joints()[i].bounds(), self.a[i]);
            let [up, down] = [high - a, a - low].map(|room| approach(room.max(0.0), brake));
            let fits = w[i].min(up).max(-down);
            (fits != w[i]).then_some(fits)
        };
        for _ in 0..4 {
            for i in 0..n {
                let Some(fits) = passes(&w, i) else { continue };
                let one = self.tangent(j, &PerDrive::from_fn(n, |k| f64::from(u8::from(i == k))))?;
                if one[i] > 1e-9 {
                    w = w.plus((fits - w[i]) / one[i], &one);
                }
            }
        }
        let share = |i: usize| passes(&w, i).map_or(1.0, |fits| (fits / w[i]).max(0.0));
        Some(w.scaled((0..n).map(share).fold(1.0, f64::min)))
    }

    /// Sets the tangential acceleration of the coming step.
    fn steer(&mut self) {
        let (n, brake) = (self.a.len(), ALONG_SHARE * self.bound);
        let speed = norm(&self.v);
        let braking = self.v.scaled(if speed > 0.0 { -brake.min(speed / self.step) / speed } else { 0.0 });
        let j = self.jacobian(&self.a);
        let wish = || {
            let wanted = self.wanted(&j)?;
            if norm(&wanted) < STILL_BELOW_RAD_S && speed < STILL_BELOW_RAD_S {
                return None;
            }
            let want = self.tangent(&j, &wanted.minus(&self.v).scaled(1.0 / LAG_TIME))?;
            Some(want.scaled((brake / norm(&want)).min(1.0)))
        };
        let Some(want) = wish() else {
            if speed < STILL_BELOW_RAD_S {
                (self.v, self.acc) = (PerDrive::zeros(n), PerDrive::zeros(n));
            } else {
                self.acc = braking;
            }
            return;
        };
        let at = |t: f64| braking.plus(t, &want.minus(&braking));
        self.acc = if self.can_stop_after(&want) {
            want
        } else {
            at(greatest_feasible_fraction(|t| self.can_stop_after(&at(t))))
        };
    }
}
