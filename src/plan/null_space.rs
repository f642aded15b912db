//! Why invariance matters: motions of zero angular momentum on machines whose mass matrix depends on the pose.
//!
//! At each pose the rates with D(q) · q̇ = 0 transmit no moment: n − 1 directions. Where D is constant they are the planes
//! b = const, and a closed path of the end effector brings the joints back. Where it is not, they fit together to no
//! surface (for three drives and more): each time the end effector comes round, the joints have drifted.
//!
//! # Symbols
//! | letter | meaning | shape, unit |
//! |---|---|---|
//! | H, D_k | mass matrix, Σ_l H_lk; angular momentum about B is D q̇, (6), (A3) | n, kg m² |
//! | Z_kl | C_kl e^{i (q_l − q_k)} | complex, kg m² |
//! | J | ∂p/∂q in absolute drive angles | 2×n, m |
//! | dD | ∂D_k/∂q_m − ∂D_m/∂q_k = −2 Im Z_km | n×n, kg m² |
//!
//! # Source
//! D_k = J_k + Σ_l Re Z_kl, so ∂D_k/∂q_m = −Im Z_km for m ≠ k and ∂D_k/∂q_k = Σ_{l≠k} Im Z_kl. By Frobenius, D q̇ = 0 is
//! integrable where D ∧ dD = 0. For three drives that 3-form is
//! 2 Im[(H_11 C_23 − C_21 C_13) e^{i(q_3−q_2)} + (H_22 C_31 − C_32 C_21) e^{i(q_1−q_3)} + (H_33 C_12 − C_13 C_32) e^{i(q_2−q_1)}]:
//! it vanishes in all poses only if its coefficients do, and where H is positive definite only if every C_kl is zero.

use nalgebra::{Matrix3, Vector3};
use thiserror::Error;

use super::curve::CurvePoint;
use super::path::PathPoint;
use super::table::Table;
use crate::dynamics::mass_matrix;
use crate::kinematics::{acceleration, column, end_effector};
use crate::machine::{BALANCED, Inertia};
use crate::planar::{DriveAngles, MAX_DRIVES, PerDrive, Units, Vector};

/// D_k = Σ_l H_lk at a pose, kg m², (A3).
#[inline]
pub fn momentum_row(model: &Inertia, e: &Units) -> PerDrive {
    let n = model.drives();
    let (h, _) = mass_matrix(model, e, &PerDrive::zeros(n));
    PerDrive::from_fn(n, |k| h.momentum_row(k))
}

/// Ḋ_k at a pose for rates q̇, kg m²/s.
#[inline]
pub fn momentum_row_rate(model: &Inertia, e: &Units, qd: &PerDrive) -> PerDrive {
    let n = model.drives();
    // Re Z_kl changes at −Im Z_kl (q̇_l − q̇_k).
    PerDrive::from_fn(n, |k| (0..n).map(|l| -coupling(model, e, k, l).im * (qd[l] - qd[k])).sum())
}

/// Z_kl, kg m².
#[inline]
fn coupling(model: &Inertia, e: &Units, k: usize, l: usize) -> Vector {
    model.coupling(k, l) * (e[k].conj() * e[l])
}

/// The rates that transmit no moment at a pose: an orthonormal basis of D · q̇ = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NullSpace {
    basis: [PerDrive; MAX_DRIVES],
    len: usize,
}

impl NullSpace {
    /// At a pose q, rad.
    pub fn of(model: &Inertia, q: &DriveAngles) -> Self {
        let n = model.drives();
        let d = momentum_row(model, &q.units());
        let norm = d.dot(&d).sqrt();
        // The reflection that takes D to the first axis takes the other axes to a basis of what is normal to D.
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

    /// n − 1 rates of the drives, each of length 1, at right angles to each other and to D.
    pub fn basis(&self) -> &[PerDrive] {
        &self.basis[..self.len]
    }
}

/// The rates of three drives that give the end effector the velocity v, m/s, at angular momentum h, kg m²/s about B:
/// [J; D] q̇ = [v; h]. `None` for other numbers of drives, or where the matrix has lost rank.
pub fn rates(model: &Inertia, q: &DriveAngles, v: Vector, h: f64) -> Option<PerDrive> {
    let (lines, scale) = lines(model, &q.units())?;
    solve(&lines, v, h / scale)
}

/// J and D of three drives, D divided by its length so that both are of one size for an arm of a metre.
fn lines(model: &Inertia, e: &Units) -> Option<(Matrix3<f64>, f64)> {
    if model.drives() != 3 {
        return None;
    }
    let d = momentum_row(model, e);
    let reach = model.tip.iter().map(|c| c.abs()).sum::<f64>();
    let scale = d.dot(&d).sqrt() / reach;
    let j = [0, 1, 2].map(|k| column(&model.tip, e, k));
    let m =
        Matrix3::new(j[0].re, j[1].re, j[2].re, j[0].im, j[1].im, j[2].im, d[0] / scale, d[1] / scale, d[2] / scale);
    (m.determinant().abs() > 1e-9 * reach.powi(3)).then_some((m, scale))
}

fn solve(lines: &Matrix3<f64>, v: Vector, h: f64) -> Option<PerDrive> {
    let x = lines.lu().solve(&Vector3::new(v.re, v.im, h))?;
    x.iter().all(|x| x.is_finite()).then(|| PerDrive::from([x[0], x[1], x[2]]))
}

/// How far D q̇ = 0 is from being integrable at a pose, (kg m²)²: the largest component of D ∧ dD,
/// 2 |D_j Im Z_kl + D_k Im Z_lj + D_l Im Z_jk| over three drives j, k, l. 0 for one or two drives, and where D is constant.
pub fn twist(model: &Inertia, q: &DriveAngles) -> f64 {
    let (n, e) = (model.drives(), q.units());
    let d = momentum_row(model, &e);
    let z = |k: usize, l: usize| coupling(model, &e, k, l).im;
    let mut most = 0.0_f64;
    for j in 0..n {
        for k in j + 1..n {
            for l in k + 1..n {
                most = most.max(2.0 * (d[j] * z(k, l) + d[k] * z(l, j) + d[l] * z(j, k)).abs());
            }
        }
    }
    most
}

/// Whether the machine has a pose constant: a b(q) whose surfaces are all that motions of zero momentum stay on.
///
/// One or two drives always do. Three and more do if H_jj C_kl = C_kj C_jl for any three of them; where every drive has
/// some inertia of its own that is an invariant mass matrix, D constant and b = Σ λ_k q_k.
pub fn is_integrable(model: &Inertia) -> bool {
    let n = model.drives();
    let whole: f64 = (0..n).map(|k| model.diagonal(k)).sum();
    let holds = |j: usize, k: usize, l: usize| {
        let left = model.diagonal(j) * model.coupling(k, l) - model.coupling(k, j) * model.coupling(j, l);
        left.norm() <= BALANCED * whole * whole
    };
    Inertia::pairs(n).all(|(k, l)| (0..n).filter(|j| *j != k && *j != l).all(|j| holds(j, k, l)))
}

/// Why a motion of zero momentum does not follow a curve.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum NullSpaceError {
    /// Not three.
    #[error("{drives} drives: a curve in the plane at zero momentum takes three")]
    Drives {
        /// How many.
        drives: usize,
    },
    /// The start is elsewhere.
    #[error("the start pose has the end effector {miss:.2e} m off the curve's first point: want it there")]
    Start {
        /// m.
        miss: f64,
    },
    /// The end is not the start.
    #[error("the curve ends {gap:.2e} m from where it begins: want a closed one")]
    Open {
        /// m.
        gap: f64,
    },
    /// [J; D] has lost rank.
    #[error("at s = {s:.3} of the curve, time {cycle} round, no rates of zero momentum follow it")]
    Singular {
        /// Along the curve.
        s: f64,
        /// Counted from 1.
        cycle: usize,
    },
}

/// A circle run through once, counter-clockwise, from a point of it, m.
pub fn circle(centre: Vector, start: Vector) -> impl Fn(f64) -> CurvePoint + Clone {
    let radius = start - centre;
    move |s| {
        let turn = std::f64::consts::TAU;
        let at = radius * crate::planar::unit(turn * s);
        let i = Vector::new(0.0, 1.0);
        CurvePoint { p: centre + at, first: i * turn * at, second: -turn * turn * at }
    }
}

/// Spaces between the nodes of a followed curve.
const SPACES: usize = 256;
/// Steps of the integration from node to node.
const STEPS: usize = 4;
/// Newton steps that bring the end effector back onto the curve after each step.
const CORRECTIONS: usize = 4;
/// How near it is brought, as a part of the arm.
const ON_CURVE: f64 = 1e-14;
/// How far off a single step may leave it, as a part of the arm; further off it has jumped over a singular pose.
const OFF_CURVE: f64 = 1e-4;

/// Follows a curve of the end effector at zero angular momentum, [J; D] q′ = [p′; 0], by the fourth-order rule; after each
/// step the end effector is put back onto the curve by rates of zero momentum. Any time law, from rest to rest, keeps the
/// moment at zero.
///
/// # Errors
/// If there are not three drives, the start is not on the curve, or [J; D] loses rank.
pub fn zero_momentum_path(
    model: &Inertia,
    start: DriveAngles,
    curve: impl Fn(f64) -> CurvePoint,
) -> Result<Table, NullSpaceError> {
    round(model, start, &curve, SPACES, 1)
}

fn round(
    model: &Inertia,
    start: DriveAngles,
    curve: &impl Fn(f64) -> CurvePoint,
    spaces: usize,
    cycle: usize,
) -> Result<Table, NullSpaceError> {
    let drives = model.drives();
    if drives != 3 || start.len() != 3 {
        return Err(NullSpaceError::Drives { drives });
    }
    let reach = model.tip.iter().map(|c| c.abs()).sum::<f64>();
    let miss = (curve(0.0).p - end_effector(&model.tip, &start.units())).norm();
    if miss.is_nan() || miss > 1e-8 * reach {
        return Err(NullSpaceError::Start { miss });
    }
    let singular = |s: f64| NullSpaceError::Singular { s, cycle };
    let slope = |q: &DriveAngles, s: f64| rates(model, q, curve(s).first, 0.0).ok_or(singular(s));
    let steps = spaces * STEPS;
    let h = 1.0 / steps as f64;
    let mut q = start;
    let mut nodes = Vec::with_capacity(spaces + 1);
    for i in 0..=steps {
        let s = i as f64 * h;
        if i % STEPS == 0 {
            nodes.push(node(model, &q, &curve(s)).ok_or(singular(s))?);
        }
        if i == steps {
            break;
        }
        let k1 = slope(&q, s)?;
        let k2 = slope(&DriveAngles(q.0.plus(h / 2.0, &k1)), s + h / 2.0)?;
        let k3 = slope(&DriveAngles(q.0.plus(h / 2.0, &k2)), s + h / 2.0)?;
        let k4 = slope(&DriveAngles(q.0.plus(h, &k3)), s + h)?;
        q = DriveAngles(q.0.plus(h / 6.0, &k1).plus(h / 3.0, &k2).plus(h / 3.0, &k3).plus(h / 6.0, &k4));
        let goal = curve((i + 1) as f64 * h).p;
        for j in 0..CORRECTIONS {
            let gap = goal - end_effector(&model.tip, &q.units());
            if j == 0 && (gap.is_nan() || gap.norm() > OFF_CURVE * reach) {
                return Err(singular(s));
            }
            if gap.norm() <= ON_CURVE * reach {
                break;
            }
            q.0 = q.0.plus(1.0, &rates(model, &q, gap, 0.0).ok_or(singular(s))?);
        }
    }
    Table::even(nodes).ok_or(singular(0.0))
}

/// q, q′ and q″ with D q′ = 0 and D q″ + D′ q′ = 0.
fn node(model: &Inertia, q: &DriveAngles, point: &CurvePoint) -> Option<PathPoint> {
    let e = q.units();
    let (lines, scale) = lines(model, &e)?;
    let first = solve(&lines, point.first, 0.0)?;
    let bent = acceleration(&model.tip, &e, &first, &PerDrive::zeros(3));
    let turned = momentum_row_rate(model, &e, &first).dot(&first);
    let second = solve(&lines, point.second - bent, -turned / scale)?;
    Some(PathPoint { q: *q, first, second })
}

/// Where the joints are each time the end effector has come round.
#[derive(Clone, Debug, PartialEq)]
pub struct Drift {
    /// q at the start and after each cycle, rad.
    pub ends: Vec<DriveAngles>,
    /// The first cycle.
    pub first: Table,
}

impl Drift {
    /// q after the last cycle less q at the start, rad.
    pub fn total(&self) -> PerDrive {
        let last = self.ends.len() - 1;
        self.ends[last].0.minus(&self.ends[0].0)
    }
}

/// Follows a closed curve of the end effector time after time at zero angular momentum.
///
/// # Errors
/// As [`zero_momentum_path`], or if the curve is not closed.
pub fn drift(
    model: &Inertia,
    start: DriveAngles,
    curve: impl Fn(f64) -> CurvePoint,
    cycles: usize,
) -> Result<Drift, NullSpaceError> {
    drift_in(model, start, curve, cycles, SPACES)
}

/// The same in so many spaces a cycle, 2 to 4096, each of four steps: the error falls with their fourth power.
///
/// # Errors
/// As [`drift`].
pub fn drift_in(
    model: &Inertia,
    start: DriveAngles,
    curve: impl Fn(f64) -> CurvePoint,
    cycles: usize,
    spaces: usize,
) -> Result<Drift, NullSpaceError> {
    let reach = model.tip.iter().map(|c| c.abs()).sum::<f64>();
    let gap = (curve(1.0).p - curve(0.0).p).norm();
    if gap.is_nan() || gap > 1e-10 * reach {
        return Err(NullSpaceError::Open { gap });
    }
    let spaces = spaces.clamp(2, 4096);
    let end = |table: &Table| table.nodes().last().map_or(start, |node| node.q);
    let first = round(model, start, &curve, spaces, 1)?;
    let mut ends = vec![start, end(&first)];
    for cycle in 2..=cycles {
        ends.push(end(&round(model, ends[cycle - 1], &curve, spaces, cycle)?));
    }
    Ok(Drift { ends, first })
}
