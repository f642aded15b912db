//! Refinement of a path to a local optimum: Newton's method over all its poses at once.
//!
//! # Method
//! The poses q_i keep (p_i, b), so a step is Z_i z_i, with a null space basis Z_i at each pose. The reduced Hessian is
//! Zᵀ (∇²f + diag(ν·c_k e^{iq_k})) Z, a banded matrix, because ∂²p/∂q_k² = −c_k e^{iq_k} and ν are the multipliers of
//! p. An augmented Lagrangian keeps the limits: their multipliers grow until no limit is passed. Every step is
//! projected back onto (p, b).

use super::envelope::Envelope;
use super::goal::{PostureCost, times};
use super::rows::{ConstraintJacobian, PoseConstraint, arms};
use super::stations::Stations;
use stillbase_mechanics::planar::{PerDrive, dot};

/// Maximum number of Newton steps between updates of the multipliers.
const MAX_STEPS: usize = 25;
/// Maximum number of updates of the multipliers of limits.
const MAX_ROUNDS: usize = 10;
/// Maximum Newton step, rad.
const MAX_STEP_RAD: f64 = 0.3;
/// Maximum number of halvings of a step.
const MAX_HALVINGS: usize = 8;
/// Tolerance of the limits, rad.
const LIMIT_TOLERANCE_RAD: f64 = 1e-9;
/// Penalty factor of the limits, as a multiple of the stiffness of the objective.
const PENALTY_FACTOR: f64 = 30.0;
/// Relative increase of the objective that is attributed to rounding.
const ROUNDING: f64 = 1e-9;

/// A relative angle and its limits.
#[derive(Clone, Copy, Debug)]
pub(super) struct AngleBound {
    /// ∂a/∂q.
    pub row: PerDrive,
    /// a at q = 0, rad.
    pub offset: f64,
    /// Lower and upper limit, rad.
    pub limits: [f64; 2],
}

impl AngleBound {
    /// Returns the angle, rad.
    pub fn of(&self, q: &PerDrive) -> f64 {
        self.row.dot(q) + self.offset
    }

    /// Returns the distance of a pose beyond the limits, rad; negative inside.
    pub fn past(&self, q: &PerDrive) -> f64 {
        let a = self.of(q);
        (self.limits[0] - a).max(a - self.limits[1])
    }
}

/// Problem data of a refinement.
#[derive(Clone, Copy, Debug)]
pub(super) struct RefinementProblem<'a> {
    pub held: &'a PoseConstraint<'a>,
    pub stations: &'a Stations,
    pub bounds: &'a [AngleBound],
    /// Whether the last pose must equal the first one.
    pub closed: bool,
    /// Step tolerance: the iteration ends with a step below this, rad.
    pub done: f64,
}

/// Constraint rows at a pose, and an orthonormal basis of their null space.
struct Frame {
    rows: ConstraintJacobian,
    free: Vec<PerDrive>,
}

impl Frame {
    fn of(rows: ConstraintJacobian) -> Self {
        Self { free: rows.free(), rows }
    }
}

/// An active limit.
struct ActiveLimit {
    /// Index of the pose.
    pose: usize,
    /// Penalty factor.
    penalty: f64,
    /// Gradient of the angle.
    row: PerDrive,
}

/// The objective and its constraints, linearised at the poses of a path.
struct Linearisation<'a> {
    frames: &'a [Frame],
    /// Gradient of the objective with its limit terms, for each pose.
    gradient: &'a [PerDrive],
    active: &'a [ActiveLimit],
}

/// Multipliers and penalty factor of the limits.
struct Forces {
    /// Multipliers for each pose and limit.
    multipliers: Vec<f64>,
    /// Penalty factor.
    penalty: f64,
}

impl RefinementProblem<'_> {
    /// Finds a local minimum of the objective, starting from a path; `None` if a Newton step cannot be computed.
    pub fn refined(&self, goal: &PostureCost, start: &[PerDrive]) -> Option<Vec<PerDrive>> {
        let mut q = start.to_vec();
        let d = self.held.freedoms();
        if d == 0 || q.len() < 3 {
            return Some(q);
        }
        let mut forces = Forces {
            multipliers: vec![0.0; 2 * self.bounds.len() * q.len()],
            penalty: PENALTY_FACTOR * goal.stiffness(),
        };
        let mut matrix = Envelope::zeros(self.profile(d, q.len()));
        for round in 0..MAX_ROUNDS {
            let done = self.done.max(1e-4 * 0.1f64.powi(2 * round as i32));
            for _ in 0..MAX_STEPS {
                let (next, moved) = self.step(goal, &q, &forces, &mut matrix)?;
                q = next;
                if moved < done {
                    break;
                }
            }
            let worst = self.raise(&q, &mut forces);
            if worst <= LIMIT_TOLERANCE_RAD.max(self.done) && done <= self.done {
                break;
            }
        }
        Some(q)
    }

    /// Returns the first column of each row of the matrix.
    fn profile(&self, d: usize, count: usize) -> Vec<usize> {
        let rows = self.places(d, count);
        let mut first = vec![0; rows.1];
        for i in 0..count {
            let mine = rows.0(i);
            let least = (i.saturating_sub(3)..=(i + 3).min(count - 1)).map(&rows.0).min().unwrap_or(mine).min(mine);
            for k in 0..d {
                let row = mine + k;
                let least = if self.closed && (i == 0 || i == count - 1) { 0 } else { least };
                first[row] = least.min(row);
            }
        }
        first
    }

    /// Returns the first row of each pose and the number of rows; the first pose of closed paths comes last.
    fn places(&self, d: usize, count: usize) -> (impl Fn(usize) -> usize + use<>, usize) {
        let closed = self.closed;
        let at = move |i: usize| match closed {
            true if i == 0 || i == count - 1 => (count - 2) * d,
            true => (i - 1) * d,
            false => i * d,
        };
        (at, if closed { (count - 1) * d } else { count * d })
    }

    /// Returns the contribution of the limits to the augmented Lagrangian.
    fn limit_terms(&self, q: &[PerDrive], forces: &Forces) -> f64 {
        let mut sum = 0.0;
        self.each_limit(q, |i, past, _, _| {
            let own = forces.multipliers[i];
            sum += ((own + forces.penalty * past).max(0.0).powi(2) - own * own) / (2.0 * forces.penalty);
        });
        sum
    }

    /// Calls `what` for each limit of each pose. Its arguments are the index of the limit, the distance beyond it, rad,
    /// the index of the pose, and the sign of the limit with the gradient of the angle.
    fn each_limit(&self, q: &[PerDrive], mut what: impl FnMut(usize, f64, usize, (f64, &PerDrive))) {
        let count = self.bounds.len();
        for (i, q) in q.iter().enumerate() {
            for (j, bound) in self.bounds.iter().enumerate() {
                let a = bound.of(q);
                what(2 * (i * count + j), bound.limits[0] - a, i, (-1.0, &bound.row));
                what(2 * (i * count + j) + 1, a - bound.limits[1], i, (1.0, &bound.row));
            }
        }
    }

    /// Updates the multipliers and returns the maximum distance beyond a limit, rad.
    fn raise(&self, q: &[PerDrive], forces: &mut Forces) -> f64 {
        let mut worst = 0.0_f64;
        let penalty = forces.penalty;
        let multipliers = &mut forces.multipliers;
        self.each_limit(q, |i, past, _, _| {
            worst = worst.max(past);
            multipliers[i] = (multipliers[i] + penalty * past).max(0.0);
        });
        worst
    }

    /// Makes a Newton step and returns the new poses and the length of the step, rad.
    fn step(
        &self,
        goal: &PostureCost,
        q: &[PerDrive],
        forces: &Forces,
        matrix: &mut Envelope,
    ) -> Option<(Vec<PerDrive>, f64)> {
        let d = self.held.freedoms();
        let frames: Vec<Frame> = q.iter().map(|q| self.held.rows(q).map(Frame::of)).collect::<Option<_>>()?;
        let mut gradient = goal.gradient(q);
        let now = goal.value(q, &gradient) + self.limit_terms(q, forces);
        let mut active: Vec<ActiveLimit> = Vec::new();
        self.each_limit(q, |i, past, at, (sign, row)| {
            let force = forces.multipliers[i] + forces.penalty * past;
            if force > 0.0 {
                gradient[at] = gradient[at].plus(sign * force, row);
                active.push(ActiveLimit { pose: at, penalty: forces.penalty, row: *row });
            }
        });
        let (place, rows) = self.places(d, q.len());
        let mut side = vec![0.0; rows];
        for (i, (frame, gradient)) in frames.iter().zip(&gradient).enumerate() {
            (0..d).for_each(|k| side[place(i) + k] -= frame.free[k].dot(gradient));
        }
        let solved = [true, false].into_iter().find_map(|bent| {
            self.assemble(
                goal,
                q,
                &Linearisation { frames: &frames, gradient: &gradient, active: &active },
                bent,
                matrix,
            );
            if !matrix.factor() {
                return None;
            }
            let mut x = side.clone();
            matrix.solve(&mut x);
            let falls = x.iter().zip(&side).map(|(x, s)| x * s).sum::<f64>() >= 0.0;
            (falls && x.iter().all(|x| x.is_finite())).then_some(x)
        })?;
        let way: Vec<PerDrive> = frames
            .iter()
            .enumerate()
            .map(|(i, frame)| {
                let start = PerDrive::zeros(q[i].len());
                (0..d).fold(start, |way, k| way.plus(solved[place(i) + k], &frame.free[k]))
            })
            .collect();
        let size = way.iter().map(PerDrive::max_abs).fold(0.0, f64::max);
        let mut share = (MAX_STEP_RAD / size.max(1e-300)).min(1.0);
        for _ in 0..MAX_HALVINGS {
            let moved = q.iter().zip(&way).zip(&self.stations.places);
            let next: Option<Vec<PerDrive>> =
                moved.map(|((q, way), p)| self.held.onto(&q.plus(share, way), *p)).collect();
            if let Some(mut next) = next {
                if self.closed {
                    let last = next.len() - 1;
                    next[last] = next[0];
                }
                let there = goal.value(&next, &goal.gradient(&next)) + self.limit_terms(&next, forces);
                if there <= now + ROUNDING * now.abs() {
                    return Some((next, share * size));
                }
            }
            share *= 0.5;
        }
        Some((q.to_vec(), 0.0))
    }

    /// Assembles the reduced Hessian. Without `bent`, negative curvature of the constraint p is set to zero.
    fn assemble(&self, goal: &PostureCost, q: &[PerDrive], at: &Linearisation<'_>, bent: bool, matrix: &mut Envelope) {
        let Linearisation { frames, gradient, active } = *at;
        let (d, n) = (self.held.freedoms(), self.held.space.drives());
        let (place, _) = self.places(d, q.len());
        matrix.clear();
        for term in &goal.terms {
            let turned: Vec<Vec<PerDrive>> =
                frames.iter().map(|frame| frame.free.iter().map(|z| times(&term.weight, z)).collect()).collect();
            for (i, row) in term.kappa.iter().enumerate() {
                for (j, kappa) in row.iter().enumerate().filter(|(_, kappa)| **kappa != 0.0) {
                    let other = i + j;
                    for k in 0..d {
                        for (l, turned) in turned[other].iter().enumerate() {
                            let (x, y) = (place(i) + k, place(other) + l);
                            let own = kappa * frames[i].free[k].dot(turned);
                            if x >= y || (j > 0 && place(i) != place(other)) {
                                *matrix.entry(x.max(y), x.min(y)) += own;
                            }
                        }
                    }
                }
            }
        }
        for (i, frame) in frames.iter().enumerate() {
            let (nu, arm) = (frame.rows.multipliers(&gradient[i]), arms(self.held.space, &q[i]));
            let bend = PerDrive::from_fn(n, |k| {
                let own = dot(nu, arm[k]);
                if bent { own } else { own.max(0.0) }
            });
            for k in 0..d {
                for l in 0..=k {
                    let own: f64 = (0..n).map(|m| bend[m] * frame.free[k][m] * frame.free[l][m]).sum();
                    *matrix.entry(place(i) + k, place(i) + l) += own;
                }
            }
        }
        for ActiveLimit { pose: i, penalty, row } in active {
            for k in 0..d {
                for l in 0..=k {
                    *matrix.entry(place(*i) + k, place(*i) + l) +=
                        penalty * frames[*i].free[k].dot(row) * frames[*i].free[l].dot(row);
                }
            }
        }
    }
}
