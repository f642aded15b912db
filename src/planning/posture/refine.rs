//! Refinement of a path to a local optimum: Newton's method over all its poses at once.
//!
//! # Method
//! The poses q_i keep (p_i, b), so a step is Z_i z_i, with a null space basis Z_i at each pose. The reduced Hessian is
//! Zᵀ (∇²f + diag(ν·c_k e^{iq_k})) Z, because ∂²p/∂q_k² = −c_k e^{iq_k}; ν are the multipliers of p. It is a banded
//! matrix. An augmented Lagrangian keeps the limits: their multipliers grow until no limit is passed. Every step is
//! projected back onto (p, b).
//!
//! Each step finds the limits that are active at its end. A step found with the limits active at its start would pass
//! other limits, and the line search would end at a path that is not optimal.

use super::envelope::Envelope;
use super::goal::{PostureCost, times};
use super::rows::{ConstraintJacobian, PoseConstraint, arms};
use super::stations::Stations;
use stillbase_mechanics::planar::{MAX_DRIVES, PerDrive, dot};

/// Maximum number of Newton steps between updates of the multipliers.
const MAX_STEPS: usize = 25;
/// Maximum number of updates of the multipliers of limits.
const MAX_ROUNDS: usize = 10;
/// Maximum Newton step, rad.
const MAX_STEP_RAD: f64 = 0.3;
/// Maximum number of halvings of a step.
const MAX_HALVINGS: usize = 8;
/// Maximum number of sets of active limits that are tried in a step: with any Hessian, and with a convex one.
const MAX_ACTIVE_SETS: [usize; 2] = [6, 12];
/// Bisections of a line search in the model of a step.
const MAX_BISECTIONS: usize = 40;
/// Slope at the end of a line search, relative to that at its start, that is attributed to rounding.
const SLOPE_TOLERANCE: f64 = 1e-9;
/// Tolerance of the limits, rad.
const LIMIT_TOLERANCE_RAD: f64 = 1e-9;
/// A path that stays this far beyond a limit from one update of the multipliers to the next is given up, rad.
const FAILED_BEYOND_RAD: f64 = 1e-2;
/// The penalty factor grows if an update of the multipliers leaves more than this share of the distance beyond limits.
const SLOW_SHARE: f64 = 0.25;
/// Growth of the penalty factor.
const PENALTY_GROWTH: f64 = 10.0;
/// First penalty factor of the limits, as a multiple of the stiffness of the objective.
const PENALTY_FACTOR: f64 = 0.3;
/// Relative gains below which a shortened step ends the iteration, of rough and of final paths.
const ROUGH_GAIN: f64 = 1e-3;
const FINE_GAIN: f64 = 1e-7;
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

/// A limit at one pose, linear in the step along the null space.
struct ModelLimit {
    /// First entry of the pose in the step.
    place: usize,
    /// Multiplier plus penalty at the start of the step; the limit is active if it is positive.
    force: f64,
    /// Derivative of the distance beyond the limit.
    along: [f64; MAX_DRIVES],
}

/// Quadratic model of the objective, with the piecewise quadratic terms of the limits.
struct StepModel<'a> {
    hessian: &'a Envelope,
    /// Negative gradient without limits.
    side: &'a [f64],
    limits: &'a [ModelLimit],
    penalty: f64,
    /// Free directions of each pose.
    d: usize,
}

impl StepModel<'_> {
    /// Returns the step with the least value of the model; `None` if none is found.
    ///
    /// Each solution for a set of active limits shows which limits are active there. The step is the solution that
    /// agrees with its own set. If the Hessian `is_convex`, a line search towards each solution lowers the model;
    /// if no set that was tried agrees, the last step is returned.
    fn least(&self, is_convex: bool) -> Option<Vec<f64>> {
        let mut x = vec![0.0; self.side.len()];
        let mut active: Vec<bool> = self.limits.iter().map(|limit| limit.force > 0.0).collect();
        for _ in 0..MAX_ACTIVE_SETS[usize::from(is_convex)] {
            let mut there = self.solved(&active)?;
            let share = if is_convex { self.share(&x, &there) } else { 1.0 };
            if share < 1.0 {
                there.iter_mut().zip(&x).for_each(|(there, x)| *there = x + share * (*there - x));
            }
            x = there;
            let next: Vec<bool> = self.limits.iter().map(|limit| self.force(limit, &x) > 0.0).collect();
            if share >= 1.0 && next == active {
                return Some(x);
            }
            active = next;
        }
        is_convex.then_some(x)
    }

    /// Returns the force of a limit after a step.
    fn force(&self, limit: &ModelLimit, x: &[f64]) -> f64 {
        limit.force + self.penalty * self.moved(limit, x)
    }

    /// Returns how much farther beyond a limit a step leads.
    fn moved(&self, limit: &ModelLimit, x: &[f64]) -> f64 {
        x[limit.place..limit.place + self.d].iter().zip(&limit.along).map(|(x, along)| x * along).sum()
    }

    /// Returns the stationary point of the model with a fixed set of active limits; `None` if it is no minimum.
    fn solved(&self, active: &[bool]) -> Option<Vec<f64>> {
        let (mut matrix, mut x) = (self.hessian.clone(), self.side.to_vec());
        for (limit, _) in self.limits.iter().zip(active).filter(|(_, active)| **active) {
            for k in 0..self.d {
                x[limit.place + k] -= limit.force * limit.along[k];
                for l in 0..=k {
                    *matrix.entry(limit.place + k, limit.place + l) += self.penalty * limit.along[k] * limit.along[l];
                }
            }
        }
        if !matrix.factor() {
            return None;
        }
        matrix.solve(&mut x);
        x.iter().all(|x| x.is_finite()).then_some(x)
    }

    /// Returns the fraction of the way between two steps at which a convex model is least, at most 1.
    fn share(&self, from: &[f64], to: &[f64]) -> f64 {
        let way: Vec<f64> = to.iter().zip(from).map(|(to, from)| to - from).collect();
        let turned = self.hessian.times(&way);
        let curvature: f64 = turned.iter().zip(&way).map(|(turned, way)| turned * way).sum();
        let start = turned.iter().zip(from).map(|(turned, from)| turned * from).sum::<f64>()
            - self.side.iter().zip(&way).map(|(side, way)| side * way).sum::<f64>();
        let ends: Vec<[f64; 2]> =
            self.limits.iter().map(|limit| [self.force(limit, from), self.moved(limit, &way)]).collect();
        // The derivative along the way rises.
        let slope = |share: f64| {
            let limits = ends.iter().map(|[force, moved]| (force + share * self.penalty * moved).max(0.0) * moved);
            start + share * curvature + limits.sum::<f64>()
        };
        if slope(1.0) <= SLOPE_TOLERANCE * slope(0.0).abs() {
            return 1.0;
        }
        let [mut low, mut high] = [0.0, 1.0];
        for _ in 0..MAX_BISECTIONS {
            let half = 0.5 * (low + high);
            if slope(half) < 0.0 { low = half } else { high = half }
        }
        0.5 * (low + high)
    }
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
        let mut before = f64::INFINITY;
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
            // Where no step keeps the limits, growing multipliers do not help.
            let fails = worst > FAILED_BEYOND_RAD && worst > 0.9 * before;
            if fails || (worst <= LIMIT_TOLERANCE_RAD.max(self.done) && done <= self.done) {
                break;
            }
            if worst > SLOW_SHARE * before {
                forces.penalty *= PENALTY_GROWTH;
            }
            before = worst;
        }
        Some(q)
    }

    /// Returns the relative gain below which a shortened step ends the iteration.
    fn least_gain(&self) -> f64 {
        if self.done > 1e-8 { ROUGH_GAIN } else { FINE_GAIN }
    }

    /// Returns the first column of each row that the matrix stores.
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

    /// Calls `what` for each limit of each pose, with the index of the limit, the distance beyond it, rad, and the
    /// index of the pose. The last argument is a pair: the sign of the limit, and the gradient of the angle.
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

    /// Makes a Newton step and returns the new poses and its length, rad; 0 if it is shortened and gains too little.
    fn step(
        &self,
        goal: &PostureCost,
        q: &[PerDrive],
        forces: &Forces,
        matrix: &mut Envelope,
    ) -> Option<(Vec<PerDrive>, f64)> {
        let d = self.held.freedoms();
        let frames: Vec<Frame> = q.iter().map(|q| self.held.rows(q).map(Frame::of)).collect::<Option<_>>()?;
        let plain = goal.gradient(q);
        let now = goal.value(q, &plain) + self.limit_terms(q, forces);
        let mut gradient = plain.clone();
        self.each_limit(q, |i, past, at, (sign, row)| {
            let force = (forces.multipliers[i] + forces.penalty * past).max(0.0);
            gradient[at] = gradient[at].plus(sign * force, row);
        });
        let (place, rows) = self.places(d, q.len());
        let mut side = vec![0.0; rows];
        for (i, (frame, gradient)) in frames.iter().zip(&plain).enumerate() {
            (0..d).for_each(|k| side[place(i) + k] -= frame.free[k].dot(gradient));
        }
        let limits = self.model_limits(q, &frames, forces);
        let solved = [true, false].into_iter().find_map(|bent| {
            self.assemble(goal, q, &frames, &gradient, bent, matrix);
            StepModel { hessian: matrix, side: &side, limits: &limits, penalty: forces.penalty, d }.least(!bent)
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
                    let is_flat = now - there <= self.least_gain() * now.abs();
                    return Some((next, if is_flat && share < 1.0 { 0.0 } else { share * size }));
                }
            }
            share *= 0.5;
        }
        Some((q.to_vec(), 0.0))
    }

    /// Returns the terms of all limits along the null spaces.
    fn model_limits(&self, q: &[PerDrive], frames: &[Frame], forces: &Forces) -> Vec<ModelLimit> {
        let (place, _) = self.places(self.held.freedoms(), q.len());
        let mut limits = Vec::with_capacity(2 * self.bounds.len() * q.len());
        self.each_limit(q, |i, past, at, (sign, row)| {
            let mut along = [0.0; MAX_DRIVES];
            along.iter_mut().zip(&frames[at].free).for_each(|(along, z)| *along = sign * z.dot(row));
            limits.push(ModelLimit { place: place(at), force: forces.multipliers[i] + forces.penalty * past, along });
        });
        limits
    }

    /// Assembles the reduced Hessian. Without `bent`, negative curvature of the constraint p is set to zero.
    fn assemble(
        &self,
        goal: &PostureCost,
        q: &[PerDrive],
        frames: &[Frame],
        gradient: &[PerDrive],
        bent: bool,
        matrix: &mut Envelope,
    ) {
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
    }
}
