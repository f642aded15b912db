//! Poses of a point at a b, by continuation from the critical poses of the point.
//!
//! # Method
//! With p fixed, b is a function on the poses of p, and the poses at one b form connected components. As b rises, each
//! lasts until it ends, splits or merges at a critical pose. From that pose b can fall, and a descent from it reaches
//! the component without passing another critical pose. The same holds for falling b. So each component is found by
//! climbing from a critical pose below it or descending from one above it. The exceptions are components that last as
//! b changes without end, such as turns of the whole machine: they meet no critical pose.
//!
//! From a critical pose, b changes to first order if a joint that leaves its limit changes b in the wanted direction.
//! Otherwise it changes to second order, along the direction of largest curvature of b among those that keep p. From
//! there on, Newton's iteration at prescribed values of b takes steps of least norm in a within the bounds of every
//! a_i. If it does not converge, the step of b is reduced to a quarter.

use nalgebra::{DMatrix, SymmetricEigen};

use super::boxed::BoxedStep;
use super::critical::CriticalPose;
use super::space::PoseSpace;
use stillbase_mechanics::planar::{DriveAngles, MAX_DRIVES, PerDrive, Vector, dot, unit};

/// Maximum number of Newton iterations, and the greatest and least step, rad.
const MAX_NEWTON_ITERATIONS: usize = 30;
const MAX_STEP_RAD: f64 = 0.7;
const MIN_STEP_RAD: f64 = 1e-11;
/// Residual at which Newton's iteration stops, and a larger one that is accepted if it stalls; as fractions of the
/// reach.
const RESIDUAL_TOLERANCE: f64 = 1e-13;
const STALLED_TOLERANCE: f64 = 1e-10;
/// Values of b within this tolerance, rad, of a critical value may differ from it only by rounding. The critical pose
/// itself is then the solution, if its residual is below [`CRITICAL_RESIDUAL`] as a fraction of the reach.
const CRITICAL_B_TOLERANCE_RAD: f64 = 1e-9;
const CRITICAL_RESIDUAL: f64 = 5e-10;
/// Newton's iteration stops after more than this number of iterations that reduce the residual by less than half.
const MAX_SLOW_ITERATIONS: usize = 6;

/// Limits on the work of one continuation in b.
#[derive(Clone, Copy, Debug)]
pub(super) struct ContinuationLimits {
    /// Maximum number of steps of b.
    max_steps: usize,
    /// Least step of b, as a fraction of the whole change.
    min_step_fraction: f64,
    /// Maximum number of rejected Newton steps.
    max_rejected: usize,
}

/// Limits while no pose has been found.
pub(super) const FULL_CONTINUATION: ContinuationLimits =
    ContinuationLimits { max_steps: 60, min_step_fraction: 1e-5, max_rejected: usize::MAX };
/// Limits for further poses.
pub(super) const SHORT_CONTINUATION: ContinuationLimits =
    ContinuationLimits { max_steps: 8, min_step_fraction: 0.05, max_rejected: usize::MAX };
/// Limits where a pose is unlikely.
pub(super) const MINIMAL_CONTINUATION: ContinuationLimits =
    ContinuationLimits { max_steps: 4, min_step_fraction: 0.2, max_rejected: 2 };
/// Greatest first step along the direction of largest curvature, rad.
const MAX_FIRST_STEP_RAD: f64 = 0.2;
/// Number of first steps that are tried, each for a tenth of the rise of the previous one.
const FIRST_STEP_TRIES: usize = 4;
/// Derivatives and curvatures of b below this fraction of the largest are treated as zero.
const GAIN_TOLERANCE: f64 = 1e-9;

/// A change of b from a critical pose by `rise`, rad; negative if b falls.
#[derive(Clone, Copy, Debug)]
pub(super) struct Climb<'a> {
    pub from: &'a CriticalPose,
    pub rise: f64,
}

impl PoseSpace {
    /// Returns the bounds of each relative angle, rad; [−π, π] if it has no limits.
    pub(super) fn windows(&self) -> [[f64; 2]; MAX_DRIVES] {
        std::array::from_fn(|i| self.joints.get(i).map_or([0.0; 2], |joint| joint.limits))
    }

    /// Returns the end effector position, m, and ∂p/∂a_i at constant b, m.
    pub(crate) fn columns(&self, q: &DriveAngles) -> (Vector, [Vector; MAX_DRIVES]) {
        let i = Vector::new(0.0, 1.0);
        let mut arm = [Vector::default(); MAX_DRIVES];
        let mut lambda = *self.lambda.padded();
        let mut place = Vector::default();
        for (k, arm) in arm.iter_mut().enumerate().take(self.drives()) {
            *arm = self.arms[k] * unit(q[k]);
            place += *arm;
        }
        let mut columns = [Vector::default(); MAX_DRIVES];
        // From the outermost joint inwards: a joint turns all drives beyond it, and all together turn back to keep b.
        for (column, joint) in columns.iter_mut().zip(&*self.joints).rev() {
            let [near, far] = joint.ends;
            *column = joint.sense * i * (arm[far] - place * (lambda[far] / self.lambda_sum));
            arm[near] += arm[far];
            lambda[near] += lambda[far];
        }
        (place, columns)
    }

    /// Solves for a pose at p, m, and b, rad, by Newton's iteration from another one, within bounds of the relative
    /// angles.
    pub(crate) fn solved(
        &self,
        p: Vector,
        b: f64,
        from: &PerDrive,
        windows: &[[f64; 2]; MAX_DRIVES],
    ) -> Option<PerDrive> {
        self.solved_by(p, b, from, windows, usize::MAX)
    }

    /// As [`solved`](Self::solved), with at most `max_rejected` rejected steps.
    fn solved_by(
        &self,
        p: Vector,
        b: f64,
        from: &PerDrive,
        windows: &[[f64; 2]; MAX_DRIVES],
        max_rejected: usize,
    ) -> Option<PerDrive> {
        let (n, reach) = (self.joints.len(), self.farthest());
        let mut rejected = 0;
        let (even, none) = (PerDrive::from_fn(n, |_| 1.0), PerDrive::zeros(n));
        let mut a = *from;
        let (place, mut columns) = self.columns(&self.lift(&a, b));
        let mut residual = p - place;
        let (mut longest, mut slow_iterations) = (MAX_STEP_RAD, 0);
        for _ in 0..MAX_NEWTON_ITERATIONS {
            if residual.norm() <= RESIDUAL_TOLERANCE * reach {
                return Some(a);
            }
            let range = within(windows, &a, longest);
            let (step, _) = BoxedStep { columns: &columns, weight: &even, unconstrained: &none, range }.step(residual);
            let next = PerDrive::from_fn(n, |i| (a[i] + step[i]).clamp(windows[i][0], windows[i][1]));
            let (place, next_columns) = self.columns(&self.lift(&next, b));
            let next_residual = p - place;
            if next_residual.norm() < residual.norm() {
                slow_iterations += usize::from(next_residual.norm() > 0.5 * residual.norm());
                (a, residual, columns) = (next, next_residual, next_columns);
                longest = (2.0 * longest).min(MAX_STEP_RAD);
                if slow_iterations > MAX_SLOW_ITERATIONS {
                    break;
                }
            } else {
                longest = 0.25 * step.max_abs();
                rejected += 1;
                if longest < MIN_STEP_RAD || rejected > max_rejected {
                    break;
                }
            }
        }
        (residual.norm() <= STALLED_TOLERANCE * reach).then_some(a)
    }

    /// Continues a pose of p from one b to another, rad, in adaptive steps.
    pub(super) fn continued(
        &self,
        p: Vector,
        from: &PerDrive,
        mut b: f64,
        to: f64,
        windows: &[[f64; 2]; MAX_DRIVES],
        effort: ContinuationLimits,
    ) -> Option<PerDrive> {
        let mut a = *from;
        let mut step = to - b;
        let least = effort.min_step_fraction * step.abs();
        for _ in 0..effort.max_steps {
            let last = step.abs() >= (to - b).abs();
            let next = if last { to } else { b + step };
            match self.solved_by(p, next, &a, windows, effort.max_rejected) {
                Some(there) if last => return Some(there),
                Some(there) => {
                    (a, b) = (there, next);
                    step *= 2.0;
                }
                None => step *= 0.25,
            }
            if step.abs() < least {
                return None;
            }
        }
        None
    }

    /// Returns all critical poses of points at a distance from B, m; none for B itself.
    pub(super) fn starts(&self, distance: f64) -> Vec<CriticalPose> {
        let mut starts = Vec::new();
        if distance > 0.0 {
            self.criticals(distance, |critical| starts.push(critical));
        }
        starts
    }

    /// Returns the changes of b from critical poses to the given b, rad, the smallest first. Critical poses whose b
    /// equals the given one up to rounding are always included.
    pub(super) fn climbs<'a>(&self, starts: &'a [CriticalPose], b: f64) -> Vec<Climb<'a>> {
        let period = self.period();
        let mut climbs: Vec<Climb<'a>> = Vec::with_capacity(starts.len());
        for from in starts {
            let by = (b - from.b).rem_euclid(period);
            if by.min(period - by) <= CRITICAL_B_TOLERANCE_RAD {
                climbs.push(Climb { from, rise: if by <= CRITICAL_B_TOLERANCE_RAD { by } else { by - period } });
                continue;
            }
            if from.up {
                climbs.push(Climb { from, rise: by });
            }
            if from.down {
                climbs.push(Climb { from, rise: by - period });
            }
        }
        climbs.sort_by(|x, y| x.rise.abs().total_cmp(&y.rise.abs()));
        climbs
    }

    /// Follows a climb to a pose at p, m; p lies on the x axis. Accepts the critical pose itself if that fits up to
    /// rounding.
    pub(super) fn climbed(&self, p: Vector, climb: &Climb<'_>, effort: ContinuationLimits) -> Option<PerDrive> {
        let Climb { from, rise } = climb;
        self.climbed_strictly(p, climb, effort).or_else(|| {
            let there = || {
                (self.end_effector(&self.lift(&from.a, from.b + rise)) - p).norm()
                    <= CRITICAL_RESIDUAL * self.farthest()
            };
            (rise.abs() <= CRITICAL_B_TOLERANCE_RAD && there()).then_some(from.a)
        })
    }

    /// As [`climbed`](Self::climbed), without accepting the critical pose itself.
    pub(super) fn climbed_strictly(
        &self,
        p: Vector,
        climb: &Climb<'_>,
        effort: ContinuationLimits,
    ) -> Option<PerDrive> {
        let Climb { from: CriticalPose { a, b, .. }, rise } = climb;
        let (b, to) = (*b, b + rise);
        let windows = &self.windows();
        let leave = self.leaving(a, b, rise.signum());
        if leave.gains
            && let Some(there) = self.continued(p, a, b, to, windows, effort)
        {
            return Some(there);
        }
        let (way, bend) = leave.along?;
        for side in [1.0, -1.0] {
            let mut rise = rise.abs().min(0.5 * bend * MAX_FIRST_STEP_RAD * MAX_FIRST_STEP_RAD);
            for _ in 0..FIRST_STEP_TRIES {
                let by = side * (2.0 * rise / bend).sqrt();
                let beside = PerDrive::from_fn(a.len(), |i| (a[i] + by * way[i]).clamp(windows[i][0], windows[i][1]));
                let level = b + rise.copysign(to - b);
                if let Some(there) = self.solved_by(p, level, &beside, windows, effort.max_rejected) {
                    if let Some(there) = self.continued(p, &there, level, to, windows, effort) {
                        return Some(there);
                    }
                    break;
                }
                rise *= 0.1;
            }
        }
        None
    }

    /// Returns the ways in which b can leave its value at a critical pose: rising for sign 1, falling for sign −1.
    fn leaving(&self, a: &PerDrive, b: f64, sign: f64) -> Leaving {
        let none = Leaving { gains: false, along: None };
        let n = self.joints.len();
        let q = self.lift(a, b);
        let (place, columns) = self.columns(&q);
        let limits = |i: usize| self.joints[i].limits;
        let is_free = |i: &usize| a[*i] > limits(*i)[0] && a[*i] < limits(*i)[1];
        let free: Vec<usize> = (0..n).filter(is_free).collect();
        // μ is normal to every velocity that the free joints can give p.
        let Some(most) = free.iter().copied().max_by(|i, j| columns[*i].norm_sqr().total_cmp(&columns[*j].norm_sqr()))
        else {
            return none;
        };
        let along = columns[most] / columns[most].norm();
        let mu = Vector::new(-along.im, along.re);
        let by_b = dot(mu, Vector::new(0.0, 1.0) * place) / self.lambda_sum;
        if by_b.abs() <= GAIN_TOLERANCE * self.farthest() || !by_b.is_finite() {
            return none;
        }
        let gain = |i: usize| -sign * dot(mu, columns[i]) / by_b;
        let can_gain = |i: usize| {
            let [low, high] = limits(i);
            let gain = gain(i);
            low < high
                && gain.abs() > GAIN_TOLERANCE * self.lambda_sum
                && if gain > 0.0 { a[i] <= low } else { a[i] >= high }
        };
        let gains = (0..n).filter(|i| !is_free(i)).any(can_gain);
        // The second derivative of b along v is Σ (μ·c_k e_k) (∂q_k/∂v)² / (μ·∂p/∂b).
        let turned: Vec<PerDrive> = free
            .iter()
            .map(|i| self.lift_rates(&PerDrive::from_fn(n, |j| f64::from(u8::from(*i == j))), 0.0))
            .collect();
        let bends: Vec<f64> = (0..self.drives()).map(|k| sign * dot(mu, self.arms[k] * unit(q[k])) / by_b).collect();
        let across: Vec<f64> = free.iter().map(|i| dot(along, columns[*i])).collect();
        let size: f64 = across.iter().map(|x| x * x).sum();
        let f = free.len();
        let whole = DMatrix::from_fn(f, f, |i, j| {
            bends.iter().enumerate().map(|(k, bend)| bend * turned[i][k] * turned[j][k]).sum::<f64>()
        });
        let keeping = DMatrix::from_fn(f, f, |i, j| f64::from(u8::from(i == j)) - across[i] * across[j] / size);
        let eigen = SymmetricEigen::new(&keeping * whole * &keeping);
        let strongest = eigen.eigenvalues.imax();
        let bend = eigen.eigenvalues[strongest];
        let mut way = PerDrive::zeros(n);
        free.iter().enumerate().for_each(|(j, i)| way[*i] = eigen.eigenvectors[(j, strongest)]);
        let bends = bend.is_finite() && bend > GAIN_TOLERANCE * eigen.eigenvalues.amax();
        Leaving { gains, along: bends.then_some((way, bend)) }
    }
}

/// The ways in which b can change from a critical pose.
struct Leaving {
    /// Whether a joint at its limit changes b in the wanted direction by leaving the limit.
    gains: bool,
    /// The direction of largest curvature of b that keeps p, and that curvature.
    along: Option<(PerDrive, f64)>,
}

/// Returns the bounds of a step from a pose, at most `longest` either way, rad.
pub(super) fn within(windows: &[[f64; 2]; MAX_DRIVES], a: &PerDrive, longest: f64) -> [[f64; 2]; MAX_DRIVES] {
    std::array::from_fn(|i| {
        let [low, high] = windows[i];
        a.get(i).map_or([0.0; 2], |a| [(low - a).clamp(-longest, 0.0), (high - a).clamp(0.0, longest)])
    })
}
