//! Critical values of b for a point, the only ones at which its feasible set of b can end. There b is stationary with
//! respect to the joints that are not at a limit.

use std::f64::consts::{PI, TAU};

use nalgebra::{DMatrix, SymmetricEigen};

use super::pattern::{LimitState, Pattern, SIGN_INTERVALS, Signs, place};
use super::space::PoseSpace;
use stillbase_mechanics::planar::{MAX_DRIVES, PerDrive, Vector, dot, unit};

/// A pose at which b is stationary, and whether b can rise or fall from there.
#[derive(Clone, Copy, Debug)]
pub(super) struct CriticalPose {
    /// b if the end effector is on the positive x axis, rad.
    pub b: f64,
    /// Whether b can rise from here while the end effector stays.
    pub up: bool,
    /// Whether b can fall.
    pub down: bool,
    /// Identifies the same critical value at other distances: its pattern, signs, side and whole turns.
    pub name: u64,
    pub spot: CriticalPoint,
    /// Relative angles, rad.
    pub a: PerDrive,
    /// Whether `up` and `down` are certain; where several values of b merge they may not be.
    pub sure: bool,
    /// Number of compounds: groups of drives that turn as one because their relative angles are at limits.
    count: usize,
}

impl CriticalPose {
    /// Whether b certainly can rise from here.
    pub fn rises(&self) -> bool {
        self.sure && self.up
    }

    /// Whether b certainly can fall from here.
    pub fn falls(&self) -> bool {
        self.sure && self.down
    }

    /// Whether a connected set of poses that comes from lower b certainly does not end here.
    pub fn passes_up(&self) -> bool {
        self.sure && !self.down
    }

    /// Whether a connected set of poses that comes from higher b certainly does not end here.
    pub fn passes_down(&self) -> bool {
        self.sure && !self.up
    }

    /// Merges another critical pose at the same b. Where a curve of critical poses meets a limit, both may be the same
    /// pose. Then the one with more compounds decides whether b can rise or fall. If each has two, b can rise or fall
    /// only if it can do so from both poses. In all other cases, one of the two poses suffices.
    pub fn merge(&mut self, other: &Self) {
        let near = |apart: f64| self.a.iter().zip(other.a.iter()).all(|(x, y)| (x - y).abs() < apart);
        let one = near(SAME_POSE_RAD);
        // Between poses that are near but not the same, b may vary by less than the tolerance of equal values.
        self.sure &= other.sure && (!one || near(SAME_ANGLES_RAD));
        if one && self.count != other.count {
            if other.count > self.count {
                *self = Self { sure: self.sure, ..*other };
            }
            return;
        }
        // The curve that is less in `PartialOrd` is kept. The result is then independent of the order of merging, and
        // the same at other
        // distances.
        if other.spot.curve < self.spot.curve {
            (self.spot, self.a, self.count) = (other.spot, other.a, other.count);
        }
        if one && self.count == 2 {
            self.up &= other.up;
            self.down &= other.down;
        } else {
            self.up |= other.up;
            self.down |= other.down;
        }
        self.name = self.name.wrapping_add(other.name);
    }
}

/// A place on the curves of critical poses: the curve, and the parameter along it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct CriticalPoint {
    pub curve: CriticalCurve,
    /// With two compounds, the angle γ between their arms, 0 to π; with more, the t of ν = ν_max sin t.
    pub t: f64,
}

/// A curve of critical poses over varying distance from B. Its parameter is [`CriticalPoint::t`].
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
pub(super) struct CriticalCurve {
    pattern: u32,
    bits: u32,
    /// Whether it is mirrored in the line from B to the point.
    mirrored: bool,
    /// Whole turns subtracted from each relative angle that follows from the directions of the arms.
    turns: [i8; MAX_DRIVES],
}

impl CriticalCurve {
    fn of(pattern: usize, bits: u32) -> Self {
        Self { pattern: pattern as u32, bits, ..Self::default() }
    }

    fn mirrored(mut self, mirrored: bool) -> Self {
        self.mirrored = mirrored;
        self
    }
}

/// Tolerance of the joint limits for rounding of the inverse kinematics, rad.
const LIMIT_TOLERANCE_RAD: f64 = 1e-9;

/// Tolerance of the distance from B of a corner (all joints at limits), as a fraction of the reach: twice the
/// effect of [`LIMIT_TOLERANCE_RAD`]. Only poses within [`CORNER_ANGLE_RAD`] of a corner are checked.
const CORNER_TOLERANCE: f64 = 2e-9;
const CORNER_ANGLE_RAD: f64 = 1e-3;

/// The gain in b of leaving a limit is treated as zero below this fraction of the largest λ.
const GAIN_TOLERANCE: f64 = 1e-12;

/// Poses with equal b are one pose if no angle differs by more than this, rad: a stationary b fixes angles poorly.
const SAME_POSE_RAD: f64 = 0.1;

/// Poses are equal within the tolerance of the limits if no angle differs by more than this, rad.
const SAME_ANGLES_RAD: f64 = 1e-6;

/// Tolerance of the joint limits along a curve, rad: the effect of roots with an error of 1e-11.
const CURVE_LIMIT_TOLERANCE_RAD: f64 = 1e-6;

/// Newton's iteration has converged after a step below this.
const NEWTON_TOLERANCE: f64 = 1e-11;

impl PoseSpace {
    /// Visits each critical value of b for points at a distance from B above 0, m, with its relative angles. Returns
    /// false if rounding affects some of them: all arms may be on one line, or all joints at limits.
    pub(super) fn criticals(&self, distance: f64, mut found: impl FnMut(CriticalPose)) -> bool {
        let mut regular = true;
        for (i, pattern) in self.patterns().iter().enumerate() {
            let name = (i as u64) << 44;
            let curve = CriticalCurve::of(i, 0);
            if pattern.count == 2 {
                regular &= self.triangle(pattern, name, curve, distance, &mut found);
            } else {
                for signs in &pattern.signs {
                    let curve = CriticalCurve::of(i, signs.bits);
                    regular &= self.stationary(pattern, signs, name, curve, distance, &mut found);
                }
            }
        }
        regular
    }

    /// Returns the distance from B, m, and b for the point on the x axis, rad, of a pose on a curve; `None` outside the
    /// limits.
    pub(super) fn along(&self, curve: &CriticalCurve, t: f64) -> Option<(f64, f64)> {
        let c = self.patterns().get(curve.pattern as usize)?;
        let mut angle = [0.0; MAX_DRIVES];
        let distance = if c.count == 2 {
            let [l, m] = [c.length[0], c.length[1]];
            let sum = l + m * unit(-t);
            (angle[0], angle[1]) = (-sum.arg(), -sum.arg() - t);
            sum.norm()
        } else {
            let (nu, cos, sum) = c.stretched(curve.bits, t);
            (0..c.count).for_each(|i| angle[i] = (nu * c.lambda[i]).atan2(cos[i]) - sum.arg());
            sum.norm()
        };
        let side = if curve.mirrored { -1.0 } else { 1.0 };
        let turn = |i: usize| side * angle[i] - c.lean[i];
        let mut a = PerDrive::zeros(self.joints.len());
        for (i, joint) in self.joints.iter().enumerate() {
            let [low, high] = joint.limits;
            a[i] = match c.at[i] {
                LimitState::Least => low,
                LimitState::Greatest => high,
                LimitState::Free => {
                    let [near, far] = joint.ends.map(|k| turn(c.of[k]));
                    joint.sense * (far - near) + c.shift[i] - TAU * f64::from(curve.turns[i])
                }
            };
            if a[i] < low - CURVE_LIMIT_TOLERANCE_RAD || a[i] > high + CURVE_LIMIT_TOLERANCE_RAD {
                return None;
            }
        }
        Some((distance, turn(c.of[0]) * self.lambda_sum + self.b(&self.unturned(&a))))
    }

    /// Visits the critical poses of two compounds: the point leaves no freedom, and each pose has a single b. Returns
    /// false if a pose is in a corner of the limits, or if [`poses_of`](Self::poses_of) does.
    fn triangle(
        &self,
        c: &Pattern,
        name: u64,
        curve: CriticalCurve,
        r: f64,
        found: &mut impl FnMut(CriticalPose),
    ) -> bool {
        let [l, m] = [c.length[0], c.length[1]];
        let cos = (r * r + l * l - m * m) / (2.0 * r * l);
        if cos.abs() > 1.0 + 1e-12 {
            return true;
        }
        let mut regular = true;
        let bend = cos.clamp(-1.0, 1.0).acos();
        let first = l * unit(bend);
        let psi = [bend, (r - first).arg()];
        let t = (psi[0] - psi[1]).abs();
        for sign in [1.0, -1.0] {
            let turn = |i: usize| sign * psi[i] - c.lean[i];
            let name = name | u64::from(sign < 0.0) << 28;
            let spot = CriticalPoint { curve: curve.mirrored(sign < 0.0), t };
            let mut noted = |critical: CriticalPose| {
                regular &= !self.in_corner(c, &critical.a, r);
                found(critical);
            };
            let decided = self.poses_of(c, name, spot, turn, &mut noted, || {
                // μ such that Λ = Re(μ̄ i L e^{iψ}) for both compounds.
                let first = Vector::new(first.re, sign * first.im);
                let [j, k] = [first, r - first].map(|arm| Vector::new(-arm.im, arm.re));
                let det = j.re * k.im - j.im * k.re;
                let mu = (det.abs() > 1e-9 * l * m).then(|| {
                    Vector::new(c.lambda[0] * k.im - c.lambda[1] * j.im, j.re * c.lambda[1] - k.re * c.lambda[0]) / det
                });
                (mu, [false; 2])
            });
            regular &= decided;
            if bend == 0.0 {
                break;
            }
        }
        regular
    }

    /// Whether the free joint of two compounds reaches a limit at this distance from B, m, within the overshoot that
    /// the tolerance of the limits allows. All curves that meet in a corner give the same answer. Two drives have
    /// only one curve, so no corner.
    fn in_corner(&self, c: &Pattern, a: &PerDrive, r: f64) -> bool {
        let Some(i) = (0..self.joints.len()).find(|i| c.at[*i] == LimitState::Free && self.joints.len() > 1) else {
            return false;
        };
        let limits = self.joints[i].limits;
        limits.into_iter().filter(|limit| (a[i] - limit).abs() < CORNER_ANGLE_RAD).any(|limit| {
            let mut corner = *a;
            corner[i] = limit;
            let q = self.unturned(&corner);
            let p: Vector = self.arms.iter().zip(q.iter()).map(|(tip, q)| *tip * unit(*q)).sum();
            (p.norm() - r).abs() < CORNER_TOLERANCE * self.farthest()
        })
    }

    /// Visits the critical poses of three compounds and more: one equation in ν for each choice of signs. Returns
    /// false if all arms are on one line, ν = 0 within rounding, or if [`poses_of`](Self::poses_of) does.
    fn stationary(
        &self,
        c: &Pattern,
        signs: &Signs,
        name: u64,
        curve: CriticalCurve,
        r: f64,
        found: &mut impl FnMut(CriticalPose),
    ) -> bool {
        let n = c.count;
        let mut regular = signs.cells & 1 == 0 || (signs.values[0] - r * r).abs() > 1e-11 * r * r;
        roots(c, signs, r * r, |t, turns| {
            let (nu, cos, sum) = c.stretched(signs.bits, t);
            if nu < 1e-9 * c.most {
                return;
            }
            let chi = sum.arg();
            let mut alpha = [0.0; MAX_DRIVES];
            (0..n).for_each(|i| alpha[i] = (nu * c.lambda[i]).atan2(cos[i]));
            let mut ways_up = None;
            for side in [1.0, -1.0] {
                let turn = |i: usize| side * (alpha[i] - chi) - c.lean[i];
                let name = name | u64::from(signs.bits) << 36 | (turns as u64) << 29 | u64::from(side < 0.0) << 28;
                let spot = CriticalPoint { curve: curve.mirrored(side < 0.0), t };
                regular &= self.poses_of(c, name, spot, turn, found, || {
                    let [up, down] = *ways_up.get_or_insert_with(|| ways(n, nu, &cos, &c.lambda));
                    let mu = unit(PI - side * chi) / (side * nu);
                    (Some(mu), if side > 0.0 { [up, down] } else { [down, up] })
                });
            }
        });
        regular
    }

    /// Visits the poses of compounds turned by `turn`, in each winding within the limits. If there are any, `which` is
    /// called; it returns μ and whether b can rise or fall with all held joints fixed. Returns false if rounding
    /// decides how b changes when a held joint leaves its limit.
    fn poses_of(
        &self,
        c: &Pattern,
        name: u64,
        mut spot: CriticalPoint,
        turn: impl Fn(usize) -> f64,
        found: &mut impl FnMut(CriticalPose),
        which: impl FnOnce() -> (Option<Vector>, [bool; 2]),
    ) -> bool {
        // The least feasible value of each angle.
        let mut a = PerDrive::zeros(self.joints.len());
        for (i, joint) in self.joints.iter().enumerate() {
            let [low, high] = joint.limits;
            a[i] = match c.at[i] {
                LimitState::Least => low,
                LimitState::Greatest => high,
                LimitState::Free => {
                    let [near, far] = joint.ends.map(|k| turn(c.of[k]));
                    let own = joint.sense * (far - near) + c.shift[i];
                    let turns = ((own - low + LIMIT_TOLERANCE_RAD) / TAU).floor();
                    let angle = own - TAU * turns;
                    spot.curve.turns[i] = turns as i8;
                    if angle > high + LIMIT_TOLERANCE_RAD {
                        return true;
                    }
                    angle
                }
            };
        }
        let (mu, [mut up, mut down]) = which();
        let mut undecided = false;
        if let Some(mu) = mu.filter(|_| c.held) {
            // The derivative of the Lagrangian b − μ·p by each drive angle. For a joint it is the sum over all drives
            // that the joint turns.
            let mut gain = PerDrive::from_fn(self.drives(), |k| {
                let q = turn(c.of[k]) + c.delta[k];
                self.lambda[k] - self.arms[k] * dot(mu, Vector::new(0.0, 1.0) * unit(q))
            });
            let scale = self.lambda.max_abs();
            for (joint, at) in self.joints.iter().zip(c.at).rev() {
                let [near, far] = joint.ends;
                let own = joint.sense * gain[far];
                if at == LimitState::Free {
                    continue;
                }
                gain[near] += gain[far];
                if joint.limits[0] == joint.limits[1] {
                    continue;
                }
                if own.abs() <= GAIN_TOLERANCE * scale {
                    undecided = true;
                } else {
                    let rises = (own > 0.0) == (at == LimitState::Least);
                    up |= rises;
                    down |= !rises;
                }
            }
        }
        // `first` is the b of the machine turned rigidly by the angle of drive 1. The relative angles, with their
        // windings, add the
        // rest of b.
        let first = turn(c.of[0]) * self.lambda_sum;
        self.each_winding(0, c, a, name, &mut |a, name| {
            let b = first + self.b(&self.unturned(a));
            let mut spot = spot;
            for (i, turns) in spot.curve.turns[..a.len()].iter_mut().enumerate() {
                *turns -= (name >> (4 * i) & 15) as i8;
            }
            found(CriticalPose { b, up, down, name, spot, a: *a, sure: true, count: c.count });
        });
        !undecided || (up && down)
    }

    /// Visits each choice of whole turns that puts all free angles within their limits, in ascending order.
    fn each_winding(&self, i: usize, c: &Pattern, mut a: PerDrive, name: u64, take: &mut impl FnMut(&PerDrive, u64)) {
        let Some(joint) = self.joints.get(i) else { return take(&a, name) };
        if c.at[i] != LimitState::Free {
            return self.each_winding(i + 1, c, a, name, take);
        }
        let [low, high] = joint.limits;
        let mut angle = a[i];
        let mut turns = 0;
        while angle <= high + LIMIT_TOLERANCE_RAD {
            a[i] = angle.clamp(low, high);
            self.each_winding(i + 1, c, a, name | turns << (4 * i), take);
            angle += TAU;
            turns += 1;
        }
    }
}

/// Returns whether b can rise, and whether it can fall, from a stationary pose to second order while the point is
/// kept. These are the signs of the form −Σ C x²/ν on Σ C x = Σ Λ x = 0, with C = |L| cos α.
fn ways(n: usize, nu: f64, c: &[f64; MAX_DRIVES], lambda: &[f64; MAX_DRIVES]) -> [bool; 2] {
    if n == 3 {
        let x = [
            c[1] * lambda[2] - c[2] * lambda[1],
            c[2] * lambda[0] - c[0] * lambda[2],
            c[0] * lambda[1] - c[1] * lambda[0],
        ];
        let form = -(0..3).map(|i| c[i] * x[i] * x[i]).sum::<f64>() / nu;
        return [form > 0.0, form < 0.0];
    }
    signature(n, nu, c, lambda).unwrap_or_else(|| by_basis(n, nu, c, lambda))
}

/// As [`ways`], by Haynsworth's inertia theorem. Counts the positive and negative eigenvalues of the form and of the
/// Schur complement of the conditions. On the subspace there are two fewer of each. `None` if a pivot is nearly zero.
fn signature(n: usize, nu: f64, c: &[f64; MAX_DRIVES], lambda: &[f64; MAX_DRIVES]) -> Option<[bool; 2]> {
    let size = c[..n].iter().fold(0.0_f64, |most, c| most.max(c.abs()));
    let (mut positive, mut negative) = (0, 0);
    let (mut sum, mut mixed, mut inverse, mut scale) = (0.0, 0.0, 0.0, 0.0);
    for (c, lambda) in c[..n].iter().zip(lambda) {
        if c.abs() < 1e-6 * size {
            return None;
        }
        if *c < 0.0 {
            positive += 1
        } else {
            negative += 1
        }
        sum += c;
        mixed += lambda;
        inverse += lambda * lambda / c;
        scale += (lambda * lambda / c).abs();
    }
    let det = sum * inverse - mixed * mixed;
    if det.abs() < 1e-6 * (size * scale + mixed * mixed) {
        return None;
    }
    // For ν > 0; for ν < 0 they are swapped.
    let complement = match (det < 0.0, sum > 0.0) {
        (true, _) => [1, 1],
        (false, true) => [2, 0],
        (false, false) => [0, 2],
    };
    let ways = [positive + complement[0] > 2, negative + complement[1] > 2];
    Some(if nu > 0.0 { ways } else { [ways[1], ways[0]] })
}

/// As [`ways`], from a basis of the null space of the two conditions.
fn by_basis(n: usize, nu: f64, c: &[f64; MAX_DRIVES], lambda: &[f64; MAX_DRIVES]) -> [bool; 2] {
    // Orthogonalisation: the first two rows span the conditions, the others their null space.
    let mut rows: Vec<Vec<f64>> = Vec::with_capacity(n);
    let candidates = [c[..n].to_vec(), lambda[..n].to_vec()].into_iter();
    let axes = (0..n).map(|i| (0..n).map(|j| if i == j { 1.0 } else { 0.0 }).collect::<Vec<f64>>());
    let size = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    for mut v in candidates.chain(axes) {
        let before = size(&v);
        for _ in 0..2 {
            for row in &rows {
                let along: f64 = row.iter().zip(&v).map(|(a, b)| a * b).sum();
                v.iter_mut().zip(row).for_each(|(v, row)| *v -= along * row);
            }
        }
        let left = size(&v);
        if left > 1e-9 * before.max(1e-300) && rows.len() < n {
            rows.push(v.into_iter().map(|x| x / left).collect());
        }
    }
    let basis = rows.get(2..).unwrap_or_default();
    let form = DMatrix::from_fn(basis.len(), basis.len(), |i, j| {
        -(0..n).map(|k| c[k] * basis[i][k] * basis[j][k]).sum::<f64>() / nu
    });
    let values = SymmetricEigen::new(form).eigenvalues;
    let least = 1e-9 * values.amax();
    [values.iter().any(|v| *v > least), values.iter().any(|v| *v < -least)]
}

/// Finds each t at which |p|² of the stationary poses equals `square`, with the number of turning points before it.
fn roots(c: &Pattern, signs: &Signs, square: f64, mut found: impl FnMut(f64, usize)) {
    if !(signs.least..=signs.greatest).contains(&square) {
        return;
    }
    let miss = |t: f64| {
        let (value, slope) = c.square(signs.bits, t);
        (value - square, slope)
    };
    let alive = |cell: usize| signs.cells >> cell & 1 == 1;
    let value = |i: usize| signs.values[i] - square;
    // Between turning points |p|² is monotone. A turning point in a cell beyond the limits is not known exactly. The
    // monotone interval before it ends at the cell's start, the next begins at the cell's end. Each bound of an
    // interval has a cell, t and the value.
    let end = |i: usize| (place(i), value(i));
    let (mut first, mut from) = (0, end(0));
    for turns in 0..=signs.turns.len() {
        let (last, to, next) = match signs.turns.get(turns) {
            None => (SIGN_INTERVALS, end(SIGN_INTERVALS), (SIGN_INTERVALS, end(SIGN_INTERVALS))),
            Some(turn) if alive(turn.cell) => {
                let to = (turn.t, turn.value - square);
                (turn.cell + 1, to, (turn.cell, to))
            }
            Some(turn) => (turn.cell, end(turn.cell), (turn.cell + 1, end(turn.cell + 1))),
        };
        if from.1 == 0.0 {
            found(from.0, turns);
        } else if from.0 < to.0 && (from.1 * to.1 < 0.0 || (to.1 == 0.0 && next.1.0 > to.0)) {
            // Bisection for the cell in which the sign changes.
            let (mut low, mut high) = (first, last);
            while high - low > 1 {
                let middle = (low + high) / 2;
                *(if value(middle) * from.1 > 0.0 { &mut low } else { &mut high }) = middle;
            }
            if alive(low) {
                let a = if low == first { from } else { end(low) };
                let b = if high == last { to } else { end(high) };
                found(if b.1 == 0.0 { b.0 } else { bracketed(&miss, [a.0, b.0], [a.1, b.1]) }, turns);
            }
        }
        (first, from) = next;
    }
    if from.1 == 0.0 {
        found(from.0, signs.turns.len());
    }
}

/// Finds a zero of a function with a known slope between two places of opposite sign. Newton's iteration is replaced
/// by bisection where it leaves the bracket or converges slowly.
fn bracketed(f: &impl Fn(f64) -> (f64, f64), [mut a, mut b]: [f64; 2], [fa, fb]: [f64; 2]) -> f64 {
    let mut x = a + (b - a) * (fa / (fa - fb));
    let mut last = b - a;
    for _ in 0..80 {
        let (fx, slope) = f(x);
        if fx == 0.0 {
            break;
        }
        *(if fx * fa < 0.0 { &mut b } else { &mut a }) = x;
        let mut step = -fx / slope;
        let newton = x + step > a && x + step < b && step.abs() < 0.5 * last.abs();
        if !newton {
            step = 0.5 * (a + b) - x;
        }
        x += step;
        last = step;
        // The error after a Newton step is of the order of its square.
        if step.abs() <= if newton { NEWTON_TOLERANCE } else { 2.0 * f64::EPSILON } {
            break;
        }
    }
    x
}
