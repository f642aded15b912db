//! The pose of a point at a b that is nearest to given relative angles.
//!
//! # Method
//! Minimises ½ Σ w_i (a_i − y_i)² over the poses at (p, b) within the limits by sequential quadratic programming; after
//! each step Newton's iteration restores p. A full Newton step uses the Hessian of the Lagrangian, including the second
//! derivatives of p; angles at their limits are held. If it does not improve the objective, steps without
//! second derivatives are tried, the full one first and then shorter ones.

use nalgebra::{SMatrix, SVector};

use super::boxed::BoxedStep;
use super::continuation::within;
use super::space::PoseSpace;
use stillbase_mechanics::planar::{MAX_DRIVES, PerDrive, Vector, dot, unit};

/// Maximum number of iterations.
const MAX_ITERATIONS: usize = 100;
/// Maximum step, rad.
const MAX_STEP_RAD: f64 = 0.5;
/// The iteration ends at steps below this, rad.
const STEP_TOLERANCE_RAD: f64 = 1e-11;
/// Number of lengths of a step that are tried: the full step first, then each half of the one before.
const MAX_HALVINGS: usize = 12;
/// Added to each weight in steps without second derivatives, so that angles of weight 0 stay bounded.
const WEIGHT_OFFSET: f64 = 1e-3;
/// If half the range of an angle is below this, the angle is held at its midpoint while a pose is centred, rad.
const NARROW_HALF_RANGE_RAD: f64 = 1e-3;
/// Tolerance of active limits, rad.
const ACTIVE_TOLERANCE_RAD: f64 = 1e-12;

/// Preferred relative angles.
pub(super) struct PreferredAngles {
    /// Preferred angles y_i, rad.
    pub angles: PerDrive,
    /// Weights w_i.
    pub weight: PerDrive,
}

/// Size of the KKT system: relative angles, two multipliers for p and one for each angle.
const KKT: usize = 2 * MAX_DRIVES + 2;

/// A pose and the multiplier there, for a Newton step of the optimality (KKT) conditions.
struct KktPoint<'a> {
    /// Relative angles, rad.
    a: &'a PerDrive,
    /// Pose constant, rad.
    b: f64,
    /// Multiplier of the constraint on the point.
    nu: Vector,
    /// Columns ∂p/∂a_i, m/rad.
    columns: &'a [Vector; MAX_DRIVES],
    /// The point to reach minus the end effector's position in the pose, m.
    residual: Vector,
}

impl PoseSpace {
    /// Returns the relative angles of the pose at p, m, and b that minimises ½ Σ x_i², starting from another pose
    /// there. x_i is the deviation of a_i from the midpoint of its range, as a fraction of half the range.
    pub fn midrange_pose(&self, p: Vector, b: f64, from: &PerDrive) -> PerDrive {
        let half = |i: usize| match self.joints[i].free {
            true => f64::INFINITY,
            false => 0.5 * (self.joints[i].limits[1] - self.joints[i].limits[0]).max(1e-6),
        };
        let middle = self.middle();
        // An angle with a narrow range would dominate the objective, so it is held at its midpoint if that is feasible.
        let is_narrow = |i: usize| half(i) < NARROW_HALF_RANGE_RAD;
        let (mut weight, mut start) = (PerDrive::from_fn(self.joints.len(), |i| half(i).powi(-2)), *from);
        let mut bounds = std::array::from_fn(|i| self.joints.get(i).map_or([0.0; 2], |joint| joint.bounds()));
        if (0..self.joints.len()).any(is_narrow) {
            let mut held = bounds;
            (0..self.joints.len()).filter(|i| is_narrow(*i)).for_each(|i| held[i] = [middle[i]; 2]);
            let clamped = PerDrive::from_fn(self.joints.len(), |i| from[i].clamp(held[i][0], held[i][1]));
            if let Some(solved) = self.solved(p, b, &clamped, &held) {
                (0..self.joints.len()).filter(|i| is_narrow(*i)).for_each(|i| weight[i] = 0.0);
                (start, bounds) = (solved, held);
            }
        }
        self.nearest_to_wish(p, b, &start, &PreferredAngles { angles: middle, weight }, &bounds)
    }

    /// Returns the pose at p, m, and b, rad, that minimises the weighted distance from preferred angles, starting from
    /// another pose there.
    pub(super) fn nearest_to_wish(
        &self,
        p: Vector,
        b: f64,
        from: &PerDrive,
        wish: &PreferredAngles,
        windows: &[[f64; 2]; MAX_DRIVES],
    ) -> PerDrive {
        let n = self.joints.len();
        let far = |a: &PerDrive| (0..n).map(|i| 0.5 * wish.weight[i] * (a[i] - wish.angles[i]).powi(2)).sum::<f64>();
        let weight = PerDrive::from_fn(n, |i| wish.weight[i] + WEIGHT_OFFSET);
        let moved = |a: &PerDrive, share: f64, step: &PerDrive| {
            PerDrive::from_fn(n, |i| (a[i] + share * step[i]).clamp(windows[i][0], windows[i][1]))
        };
        let mut a = *from;
        let mut objective = far(&a);
        for _ in 0..MAX_ITERATIONS {
            let (place, columns) = self.columns(&self.lift(&a, b));
            let down = PerDrive::from_fn(n, |i| wish.weight[i] * (wish.angles[i] - a[i]) / weight[i]);
            let range = within(windows, &a, MAX_STEP_RAD);
            let (step, nu) =
                BoxedStep { columns: &columns, weight: &weight, unconstrained: &down, range }.step(p - place);
            if step.max_abs() < STEP_TOLERANCE_RAD {
                break;
            }
            let held = |i: usize| {
                step[i].abs() < ACTIVE_TOLERANCE_RAD
                    && (range[i][0] > -ACTIVE_TOLERANCE_RAD || range[i][1] < ACTIVE_TOLERANCE_RAD)
            };
            let newton_step = self
                .newton_step(&KktPoint { a: &a, b, nu, columns: &columns, residual: p - place }, wish, &held)
                .filter(|step| {
                    let fits = |i: usize| a[i] + step[i] >= windows[i][0] && a[i] + step[i] <= windows[i][1];
                    step.max_abs() < MAX_STEP_RAD && (0..n).all(fits)
                });
            let tries = newton_step.iter().map(|step| (step, 1.0));
            let shorter = (0..MAX_HALVINGS).map(|i| (&step, 0.5f64.powi(i as i32)));
            let better = tries.chain(shorter).find_map(|(step, share)| {
                let there = self.solved(p, b, &moved(&a, share, step), windows)?;
                let far = far(&there);
                (far < objective).then_some((there, far))
            });
            let Some((there, next_objective)) = better else { break };
            let moved = there.minus(&a).max_abs();
            (a, objective) = (there, next_objective);
            if moved < STEP_TOLERANCE_RAD {
                break;
            }
        }
        a
    }

    /// Returns the Newton step of the optimality (KKT) conditions with some angles held; `None` if the system is
    /// singular.
    fn newton_step(&self, at: &KktPoint<'_>, wish: &PreferredAngles, held: &dyn Fn(usize) -> bool) -> Option<PerDrive> {
        let KktPoint { a, b, nu, columns, residual } = *at;
        let n = self.joints.len();
        let q = self.lift(a, b);
        let turned: [PerDrive; MAX_DRIVES] = std::array::from_fn(|i| match i < n {
            true => self.lift_rates(&PerDrive::from_fn(n, |j| f64::from(u8::from(i == j))), 0.0),
            false => PerDrive::zeros(0),
        });
        // Sign convention: the Lagrangian is ½ Σ w (a − y)² − ν·p, and the second derivatives of p contain −c_k
        // e^{iq_k}.
        let bends = PerDrive::from_fn(self.drives(), |k| dot(nu, self.arms[k] * unit(q[k])));
        let mut square = SMatrix::<f64, KKT, KKT>::identity();
        let mut side = SVector::<f64, KKT>::zeros();
        for i in 0..n {
            for j in 0..n {
                let bend: f64 = (0..self.drives()).map(|k| bends[k] * turned[i][k] * turned[j][k]).sum();
                square[(i, j)] = bend + if i == j { wish.weight[i] } else { 0.0 };
            }
            side[i] = wish.weight[i] * (wish.angles[i] - a[i]);
        }
        for (row, part) in [(MAX_DRIVES, 0), (MAX_DRIVES + 1, 1)] {
            square[(row, row)] = 0.0;
            side[row] = if part == 0 { residual.re } else { residual.im };
            for i in 0..n {
                let x = if part == 0 { columns[i].re } else { columns[i].im };
                (square[(row, i)], square[(i, row)]) = (x, x);
            }
        }
        for i in (0..n).filter(|i| held(*i)) {
            let row = MAX_DRIVES + 2 + i;
            square[(row, row)] = 0.0;
            (square[(row, i)], square[(i, row)]) = (1.0, 1.0);
        }
        let step = square.lu().solve(&side)?;
        step.iter().all(|x| x.is_finite()).then(|| PerDrive::from_fn(n, |i| step[i]))
    }
}
