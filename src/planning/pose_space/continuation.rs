//! Poses of a point and a b, continued from the critical poses of the point.
//!
//! # Method
//! With p fixed, b is a function on the poses of p, and the poses at one b form pieces. Follow such a piece as b rises:
//! it ends, parts or joins another first at a critical pose, from which b can fall; and whatever falls from there comes
//! down to that piece without another stop. The same holds downwards. So each piece is found by climbing from a critical
//! pose below it, or descending from one above it; only pieces on which b goes round without end have none.
//!
//! From a critical pose b changes first along the joints that can leave their limit with a gain, or else, with t² only,
//! along the strongest curvature of b among the directions that keep p. From then on Newton's iteration at a given b takes
//! steps that are least in a, with every a_i within its limits; steps of b are halved where it finds nothing.

use nalgebra::{DMatrix, SymmetricEigen};

use super::boxed::Boxed;
use super::critical::Critical;
use super::space::PoseSpace;
use crate::mechanics::planar::{DriveAngles, MAX_DRIVES, PerDrive, Vector, dot, unit};

/// Steps of Newton's iteration at most, the longest, and the shortest, rad.
const MAX_ITERATIONS: usize = 30;
const LONGEST: f64 = 0.7;
const SHORTEST: f64 = 1e-11;
/// A pose that misses its point by less than this share of the reach is there; one of rounding's making by less than that.
const AT: f64 = 1e-13;
const ROUNDED: f64 = 1e-10;
/// A b as near to a critical one as this, rad, may be off it by rounding; its pose then is on its point up to this share
/// of the reach.
const BESIDE_END: f64 = 1e-9;
const ON_POINT: f64 = 5e-10;
/// So many steps that do not halve the distance lead nowhere.
const MAX_SLOW: usize = 6;
/// How hard a way to a b is tried.
#[derive(Clone, Copy, Debug)]
pub(super) struct Effort {
    /// Steps of b at most.
    max_steps: usize,
    /// The shortest of them, as a share of the whole way.
    least_step: f64,
    /// So many steps of Newton's iteration that bring nothing lead nowhere.
    max_vain: usize,
}

/// Where no pose is found yet.
pub(super) const THOROUGH: Effort = Effort { max_steps: 60, least_step: 1e-5, max_vain: usize::MAX };
/// Where others are wanted.
pub(super) const BRIEF: Effort = Effort { max_steps: 8, least_step: 0.05, max_vain: usize::MAX };
/// Where most likely there is none.
pub(super) const GLANCE: Effort = Effort { max_steps: 4, least_step: 0.2, max_vain: 2 };
/// The longest way along a curvature, rad.
const MAX_LEAP: f64 = 0.2;
/// How often a shorter one is tried.
const MAX_LEAPS: usize = 4;
/// Gains and curvatures below this share of the largest are rounding.
const GAIN_TOLERANCE: f64 = 1e-9;

/// A way from a critical pose to a b: by how much b has to rise, rad.
#[derive(Clone, Copy, Debug)]
pub(super) struct Climb<'a> {
    pub from: &'a Critical,
    pub rise: f64,
}

impl PoseSpace {
    /// Where each relative angle may be, rad, one turn where it has no limits.
    pub(super) fn windows(&self) -> [[f64; 2]; MAX_DRIVES] {
        std::array::from_fn(|i| self.joints.get(i).map_or([0.0; 2], |joint| joint.limits))
    }

    /// The end effector, m, and ∂p/∂a_i with b held, m.
    pub(in crate::planning) fn columns(&self, q: &DriveAngles) -> (Vector, [Vector; MAX_DRIVES]) {
        let i = Vector::new(0.0, 1.0);
        let mut arm = [Vector::default(); MAX_DRIVES];
        let mut lambda = *self.lambda.padded();
        let mut place = Vector::default();
        for (k, arm) in arm.iter_mut().enumerate().take(self.drives()) {
            *arm = self.tip[k] * unit(q[k]);
            place += *arm;
        }
        let mut columns = [Vector::default(); MAX_DRIVES];
        // Outermost first: a joint turns all drives beyond it, and all together turn back to keep b.
        for (column, joint) in columns.iter_mut().zip(&*self.joints).rev() {
            let [near, far] = joint.ends;
            *column = joint.sense * i * (arm[far] - place * (lambda[far] / self.sum));
            arm[near] += arm[far];
            lambda[near] += lambda[far];
        }
        (place, columns)
    }

    /// The pose at p, m, and b, rad, that Newton's iteration finds from another one within these ranges.
    pub(in crate::planning) fn solved(
        &self,
        p: Vector,
        b: f64,
        from: &PerDrive,
        windows: &[[f64; 2]; MAX_DRIVES],
    ) -> Option<PerDrive> {
        self.solved_by(p, b, from, (windows, usize::MAX))
    }

    /// The same, with so many steps at most that bring nothing.
    fn solved_by(
        &self,
        p: Vector,
        b: f64,
        from: &PerDrive,
        (windows, max_vain): (&[[f64; 2]; MAX_DRIVES], usize),
    ) -> Option<PerDrive> {
        let (n, reach) = (self.joints.len(), self.farthest());
        let mut vain = 0;
        let (even, none) = (PerDrive::from_fn(n, |_| 1.0), PerDrive::zeros(n));
        let mut a = *from;
        let (place, mut columns) = self.columns(&self.lift(&a, b));
        let mut off = p - place;
        let (mut longest, mut slow) = (LONGEST, 0);
        for _ in 0..MAX_ITERATIONS {
            if off.norm() <= AT * reach {
                return Some(a);
            }
            let range = within(windows, &a, longest);
            let (step, _) = Boxed { columns: &columns, weight: &even, wish: &none, range }.step(off);
            let next = PerDrive::from_fn(n, |i| (a[i] + step[i]).clamp(windows[i][0], windows[i][1]));
            let (place, beside) = self.columns(&self.lift(&next, b));
            let left = p - place;
            if left.norm() < off.norm() {
                slow += usize::from(left.norm() > 0.5 * off.norm());
                (a, off, columns) = (next, left, beside);
                longest = (2.0 * longest).min(LONGEST);
                if slow > MAX_SLOW {
                    break;
                }
            } else {
                longest = 0.25 * step.max_abs();
                vain += 1;
                if longest < SHORTEST || vain > max_vain {
                    break;
                }
            }
        }
        (off.norm() <= ROUNDED * reach).then_some(a)
    }

    /// The same from a pose of p at another b, step by step.
    pub(super) fn continued(
        &self,
        p: Vector,
        (from, mut b): (&PerDrive, f64),
        to: f64,
        (windows, effort): (&[[f64; 2]; MAX_DRIVES], Effort),
    ) -> Option<PerDrive> {
        let mut a = *from;
        let mut step = to - b;
        let least = effort.least_step * step.abs();
        for _ in 0..effort.max_steps {
            let last = step.abs() >= (to - b).abs();
            let next = if last { to } else { b + step };
            match self.solved_by(p, next, &a, (windows, effort.max_vain)) {
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

    /// All critical poses of points at a distance from B, m; of B itself none.
    pub(super) fn starts(&self, distance: f64) -> Vec<Critical> {
        let mut starts = Vec::new();
        if distance > 0.0 {
            self.criticals(distance, |critical| starts.push(critical));
        }
        starts
    }

    /// The ways from critical poses to a b, rad, the shortest first; b beside the end of a set by rounding is at that end.
    pub(super) fn climbs<'a>(&self, starts: &'a [Critical], b: f64) -> Vec<Climb<'a>> {
        let period = self.period();
        let mut climbs: Vec<Climb<'a>> = Vec::with_capacity(starts.len());
        for from in starts {
            let by = (b - from.b).rem_euclid(period);
            if by.min(period - by) <= BESIDE_END {
                climbs.push(Climb { from, rise: if by <= BESIDE_END { by } else { by - period } });
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

    /// The pose at p, m, on the x axis, to which a way leads.
    pub(super) fn climbed(&self, p: Vector, climb: &Climb<'_>, effort: Effort) -> Option<PerDrive> {
        let Climb { from, rise } = climb;
        self.left(p, climb, effort).or_else(|| {
            let there = || (self.place(&self.lift(&from.a, from.b + rise)) - p).norm() <= ON_POINT * self.farthest();
            (rise.abs() <= BESIDE_END && there()).then_some(from.a)
        })
    }

    /// The same without what rounding makes of an end.
    pub(super) fn left(&self, p: Vector, climb: &Climb<'_>, effort: Effort) -> Option<PerDrive> {
        let Climb { from: Critical { a, b, .. }, rise } = climb;
        let (b, to) = (*b, b + rise);
        let windows = &self.windows();
        let leave = self.leaving(a, b, rise.signum());
        if leave.gains
            && let Some(there) = self.continued(p, (a, b), to, (windows, effort))
        {
            return Some(there);
        }
        let (way, bend) = leave.along?;
        for side in [1.0, -1.0] {
            let mut rise = rise.abs().min(0.5 * bend * MAX_LEAP * MAX_LEAP);
            for _ in 0..MAX_LEAPS {
                let by = side * (2.0 * rise / bend).sqrt();
                let beside = PerDrive::from_fn(a.len(), |i| (a[i] + by * way[i]).clamp(windows[i][0], windows[i][1]));
                let level = b + rise.copysign(to - b);
                if let Some(there) = self.solved_by(p, level, &beside, (windows, effort.max_vain)) {
                    if let Some(there) = self.continued(p, (&there, level), to, (windows, effort)) {
                        return Some(there);
                    }
                    break;
                }
                rise *= 0.1;
            }
        }
        None
    }

    /// How b can change from a critical pose by a sign.
    fn leaving(&self, a: &PerDrive, b: f64, sign: f64) -> Leaving {
        let none = Leaving { gains: false, along: None };
        let n = self.joints.len();
        let q = self.lift(a, b);
        let (place, columns) = self.columns(&q);
        let limits = |i: usize| self.joints[i].limits;
        let is_free = |i: &usize| a[*i] > limits(*i)[0] && a[*i] < limits(*i)[1];
        let free: Vec<usize> = (0..n).filter(is_free).collect();
        // μ is across what all free joints can do.
        let Some(most) = free.iter().copied().max_by(|i, j| columns[*i].norm_sqr().total_cmp(&columns[*j].norm_sqr()))
        else {
            return none;
        };
        let along = columns[most] / columns[most].norm();
        let mu = Vector::new(-along.im, along.re);
        let by_b = dot(mu, Vector::new(0.0, 1.0) * place) / self.sum;
        if by_b.abs() <= GAIN_TOLERANCE * self.farthest() || !by_b.is_finite() {
            return none;
        }
        let gain = |i: usize| -sign * dot(mu, columns[i]) / by_b;
        let can_gain = |i: usize| {
            let [low, high] = limits(i);
            let gain = gain(i);
            low < high && gain.abs() > GAIN_TOLERANCE * self.sum && if gain > 0.0 { a[i] <= low } else { a[i] >= high }
        };
        let gains = (0..n).filter(|i| !is_free(i)).any(can_gain);
        // The second derivative of b along v is Σ (μ·c_k e_k) (∂q_k/∂v)² / (μ·∂p/∂b).
        let turned: Vec<PerDrive> = free
            .iter()
            .map(|i| self.lift_rates(&PerDrive::from_fn(n, |j| f64::from(u8::from(*i == j))), 0.0))
            .collect();
        let bends: Vec<f64> = (0..self.drives()).map(|k| sign * dot(mu, self.tip[k] * unit(q[k])) / by_b).collect();
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

/// How b can change from a critical pose.
struct Leaving {
    /// Whether a joint that stands at its limit gains by leaving it.
    gains: bool,
    /// The direction of the strongest curvature that keeps p, and that curvature.
    along: Option<(PerDrive, f64)>,
}

/// What of ranges is left about a pose, and not farther than so many rad.
pub(super) fn within(windows: &[[f64; 2]; MAX_DRIVES], a: &PerDrive, longest: f64) -> [[f64; 2]; MAX_DRIVES] {
    std::array::from_fn(|i| {
        let [low, high] = windows[i];
        a.get(i).map_or([0.0; 2], |a| [(low - a).clamp(-longest, 0.0), (high - a).clamp(0.0, longest)])
    })
}
