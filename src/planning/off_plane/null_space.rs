//! Why invariance matters: motions of zero angular momentum on machines whose mass matrix depends on the pose.
//!
//! At each pose the rates with D(q) · q̇ = 0 transmit no moment; they span n − 1 directions. If D is constant, they
//! span the planes b = const. With three drives, a closed path of the end effector then brings the joints back. If D
//! is not constant, three drives or more rarely have such surfaces: usually the joints drift with every cycle.
//!
//! # Symbols
//! | letter | meaning | shape, unit |
//! |---|---|---|
//! | H, D_k, J_k | n×n mass matrix; coefficients of the momentum D q̇ of [`MomentumModel`], (6), (A3); spin of [`Inertia`] | kg m² |
//! | Z_kl | C_kl e^{i (q_l − q_k)} | complex, kg m² |
//! | J | ∂p/∂q in absolute drive angles; p is the position of the end effector | 2×n, m |
//! | dD | ∂D_m/∂q_k − ∂D_k/∂q_m = 2 Im Z_km | n×n, kg m² |
//!
//! # Source
//! D_k = C_kk + J_k + Σ_{l≠k} Re Z_kl, so ∂D_k/∂q_m = −Im Z_km for m ≠ k and ∂D_k/∂q_k = Σ_{l≠k} Im Z_kl. By
//! Frobenius, D q̇ = 0 is integrable if D ∧ dD = 0. For three drives without rotors it is 2 Im[(H_11 C_23 − C_21 C_13)
//! e^{i(q_3−q_2)} + (H_22 C_31 − C_32 C_21) e^{i(q_1−q_3)} + (H_33 C_12 − C_13 C_32) e^{i(q_2−q_1)}]. It vanishes in
//! all poses only if its coefficients do; if H is positive definite, these vanish only if every C_kl is zero.

use std::convert::Infallible;

use nalgebra::{Matrix3, Vector3};

use super::momentum::MomentumModel;
use crate::curves::PathPoint;
use crate::curves::table::PathTable;
use stillbase_mechanics::kinematics::{acceleration, column, minimum_norm, minimum_norm_with};
use stillbase_mechanics::machine::{BALANCE_TOLERANCE, Inertia};
use stillbase_mechanics::planar::{DriveAngles, MAX_DRIVES, PerDrive, UnitVectors, Vector};

/// The rates that transmit no moment at a pose: an orthonormal basis of D · q̇ = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NullSpace {
    basis: [PerDrive; MAX_DRIVES],
    len: usize,
}

impl NullSpace {
    /// Returns the null space at a pose q, rad.
    pub fn of(model: &MomentumModel, q: &DriveAngles) -> Self {
        let n = model.drives();
        let d = model.coefficients(&q.units());
        let norm = d.dot(&d).sqrt();
        // The Householder reflection that maps D to the first axis maps the other axes to a basis of D's complement.
        let mut v = d;
        v[0] += norm.copysign(d[0]);
        let square = v.dot(&v);
        let scale = if square > 0.0 { 2.0 / square } else { 0.0 };
        let mut basis = [PerDrive::zeros(n); MAX_DRIVES];
        for (k, column) in basis.iter_mut().enumerate().take(n - 1) {
            *column = v.scaled(-scale * v[k + 1]);
            column[k + 1] += 1.0;
        }
        Self { basis, len: n - 1 }
    }

    /// Returns n − 1 orthonormal vectors of drive rates, orthogonal to D.
    pub fn basis(&self) -> &[PerDrive] {
        &self.basis[..self.len]
    }
}

/// Returns the rates of zero momentum nearest to the wanted rates w: w − D (D · w)/(D · D).
pub fn projected(model: &MomentumModel, q: &DriveAngles, w: &PerDrive) -> PerDrive {
    let d = model.coefficients(&q.units());
    w.plus(-share(&d, w), &d)
}

/// Returns (D · w)/(D · D), or 0 if D = 0.
fn share(d: &PerDrive, w: &PerDrive) -> f64 {
    let square = d.dot(d);
    if square > 0.0 { d.dot(w) / square } else { 0.0 }
}

/// Number of intervals between the nodes of a motion.
const NODE_INTERVALS: usize = 256;
/// Number of integration steps from node to node.
const STEPS_PER_INTERVAL: usize = 4;

/// Integrates a motion of zero momentum from a pose, for any number of drives, by the classical fourth-order
/// Runge–Kutta method. The derivative q′ is the wanted direction w, rad, projected onto the rates of zero momentum. On
/// an invariant machine the motion is a straight line. Returns `None` unless pose and direction are finite and have
/// one entry for each drive.
pub fn motion(model: &MomentumModel, start: DriveAngles, w: &PerDrive) -> Option<PathTable> {
    let n = model.drives();
    if start.len() != n || w.len() != n || !start.iter().chain(w.iter()).all(|x| x.is_finite()) {
        return None;
    }
    let h = 1.0 / (NODE_INTERVALS * STEPS_PER_INTERVAL) as f64;
    let slope = |q: &PerDrive, _| Ok::<_, Infallible>(projected(model, &DriveAngles(*q), w));
    let mut q = start.0;
    let mut nodes = Vec::with_capacity(NODE_INTERVALS + 1);
    for i in 0..=NODE_INTERVALS * STEPS_PER_INTERVAL {
        if i % STEPS_PER_INTERVAL == 0 {
            nodes.push(node(model, DriveAngles(q), w));
        }
        let Ok(next) = runge_kutta_step(&q, h, slope);
        q = next;
    }
    PathTable::even(nodes)
}

/// Makes a classical fourth-order Runge–Kutta step of length h from q. `slope` returns q′ at a q and at a share of the step,
/// 0, ½ or 1.
///
/// # Errors
/// The first of `slope`.
pub(crate) fn runge_kutta_step<E>(
    q: &PerDrive,
    h: f64,
    slope: impl Fn(&PerDrive, f64) -> Result<PerDrive, E>,
) -> Result<PerDrive, E> {
    let k1 = slope(q, 0.0)?;
    let k2 = slope(&q.plus(h / 2.0, &k1), 0.5)?;
    let k3 = slope(&q.plus(h / 2.0, &k2), 0.5)?;
    let k4 = slope(&q.plus(h, &k3), 1.0)?;
    Ok(q.plus(h / 6.0, &k1).plus(h / 3.0, &k2).plus(h / 3.0, &k3).plus(h / 6.0, &k4))
}

/// Returns q, q′ = w − σ D and q″ = −σ′ D − σ D′, with σ = (D · w)/(D · D).
fn node(model: &MomentumModel, q: DriveAngles, w: &PerDrive) -> PathPoint {
    let e = q.units();
    let d = model.coefficients(&e);
    let sigma = share(&d, w);
    let first = w.plus(-sigma, &d);
    let rate = model.coefficient_rates(&e, &first);
    let square = d.dot(&d);
    let sigma_rate = if square > 0.0 { (rate.dot(w) - 2.0 * sigma * d.dot(&rate)) / square } else { 0.0 };
    PathPoint { q, first, second: d.scaled(-sigma_rate).plus(-sigma, &rate) }
}

/// Returns the rates that give the end effector the velocity v, m/s, at angular momentum h, kg m²/s: [J; D] q̇
/// = [v; h]. With more than three drives, or if no motion has angular momentum, these are the rates of minimum norm.
/// Returns `None` for fewer than three drives with angular momentum, or if the matrix has lost rank.
pub fn rates(model: &MomentumModel, q: &DriveAngles, v: Vector, h: f64) -> Option<PerDrive> {
    if model.drives() > 3 || model.is_zero() {
        return least(model, q, v, Vector::default(), h).map(|(rates, _)| rates);
    }
    let (lines, scale) = jacobian_with_momentum(model, &q.units())?;
    solve(&lines, v, h / scale)
}

/// Returns the rates of [`rates`] and their time derivatives, for the velocity of the end effector and its derivative, m/s
/// and m/s², and for the angular momentum and its derivative, kg m²/s and N m.
pub fn motion_of(
    model: &MomentumModel,
    q: &DriveAngles,
    [v, vd]: [Vector; 2],
    [h, hd]: [f64; 2],
) -> Option<(PerDrive, PerDrive)> {
    if !determines(model) {
        let (first, second) = least(model, q, v, vd, h)?;
        if hd == 0.0 {
            return Some((first, second));
        }
        // The rates of minimum norm are linear in (v, h) at each pose.
        let turning = least(model, q, Vector::default(), Vector::default(), hd)?.0;
        return Some((first, second.plus(1.0, &turning)));
    }
    let e = q.units();
    let (lines, scale) = jacobian_with_momentum(model, &e)?;
    let first = solve(&lines, v, h / scale)?;
    let bent = acceleration(model.tip(), &model.tip_units(&e), &first, &PerDrive::zeros(3));
    let turned = model.coefficient_rates(&e, &first).dot(&first);
    Some((first, solve(&lines, vd - bent, (hd - turned) / scale)?))
}

/// Curves that a machine's end effector can follow at zero angular momentum.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MomentumFreedom {
    /// None: a single drive, which has momentum as soon as it turns unless its rotor cancels it.
    None,
    /// One curve through each pose: two drives.
    OneCurve,
    /// Any curve within reach.
    AnyCurve,
}

impl MomentumFreedom {
    /// Classifies a machine.
    pub fn of(model: &MomentumModel) -> Self {
        match model.drives() {
            1 => Self::None,
            2 if !model.is_zero() => Self::OneCurve,
            _ => Self::AnyCurve,
        }
    }
}

/// Returns whether the velocity of the end effector and the momentum determine the rates of the drives. This holds for
/// three drives with angular momentum.
fn determines(model: &MomentumModel) -> bool {
    model.drives() == 3 && !model.is_zero()
}

/// Returns the rates of minimum norm that give the end effector the velocity v, m/s, at angular momentum h, kg m²/s.
/// Also returns their exact derivative for v̇ = `vd`, m/s², and constant h.
fn least(model: &MomentumModel, q: &DriveAngles, v: Vector, vd: Vector, h: f64) -> Option<(PerDrive, PerDrive)> {
    let e = q.units();
    if model.is_zero() {
        return minimum_norm(model.tip(), &model.tip_units(&e), model.drives(), v, vd);
    }
    let d = model.coefficients(&e);
    let tip = model.tip_units(&e);
    minimum_norm_with(model.tip(), &d, h, |qd| model.coefficient_rates(&e, qd), &tip, v, vd)
}

/// Returns [J; D/scale] of three drives, and the scale, kg m, that makes the norm of D/scale equal to the arm length.
/// Returns `None` for other numbers of drives, or if the matrix has lost rank.
fn jacobian_with_momentum(model: &MomentumModel, e: &UnitVectors) -> Option<(Matrix3<f64>, f64)> {
    if model.drives() != 3 {
        return None;
    }
    let d = model.coefficients(e);
    let (reach, tip) = (model.reach(), model.tip_units(e));
    let scale = d.dot(&d).sqrt() / reach;
    let j = [0, 1, 2].map(|k| column(model.tip(), &tip, k));
    let m =
        Matrix3::new(j[0].re, j[1].re, j[2].re, j[0].im, j[1].im, j[2].im, d[0] / scale, d[1] / scale, d[2] / scale);
    (m.determinant().abs() > 1e-9 * reach.powi(3)).then_some((m, scale))
}

/// Solves `lines` q̇ = [v; h] for q̇; `None` if the matrix is singular.
fn solve(lines: &Matrix3<f64>, v: Vector, h: f64) -> Option<PerDrive> {
    let x = lines.lu().solve(&Vector3::new(v.re, v.im, h))?;
    x.iter().all(|x| x.is_finite()).then(|| PerDrive::from([x[0], x[1], x[2]]))
}

/// Returns the violation of integrability of D q̇ = 0 at a pose, (kg m²)²: the largest component of D ∧ dD. The
/// component of three drives j, k, l is 2 |D_j Im Z_kl + D_k Im Z_lj + D_l Im Z_jk|.
/// The violation is 0 for one or two drives, and if D is constant.
pub fn integrability_violation(model: &MomentumModel, q: &DriveAngles) -> f64 {
    let (n, e) = (model.drives(), q.units());
    let d = model.coefficients(&e);
    let z = |k: usize, l: usize| model.coupling(&e, k, l).im;
    let mut largest = 0.0_f64;
    for j in 0..n {
        for k in j + 1..n {
            for l in k + 1..n {
                largest = largest.max(2.0 * (d[j] * z(k, l) + d[k] * z(l, j) + d[l] * z(j, k)).abs());
            }
        }
    }
    largest
}

/// Returns whether the machine has a pose constant: a b(q) that is constant along every motion of zero momentum.
///
/// One or two drives always have one. Others have one if E_j C_kl = C_kj C_jl for every three drives. E_j is D_j with
/// all C_kl set to 0. If H is positive definite without rotors, H and D are then constant and b = Σ λ_k q_k.
pub fn is_integrable(model: &Inertia) -> bool {
    let n = model.drives();
    let whole: f64 = (0..n).map(|k| model.diagonal(k)).sum();
    // D without couplings, in place of H_jj: a rotor adds a different inertia to D than to H.
    let own = model.momenta();
    let holds = |j: usize, k: usize, l: usize| {
        let residual = own[j] * model.coupling(k, l) - model.coupling(k, j) * model.coupling(j, l);
        residual.norm() <= BALANCE_TOLERANCE * whole * whole
    };
    Inertia::pairs(n).all(|(k, l)| (0..n).filter(|j| *j != k && *j != l).all(|j| holds(j, k, l)))
}
