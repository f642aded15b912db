//! Kinematics of the end effector: its position, (14), its Jacobian, and drive rates for a given velocity.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | p | end effector, Σ_k c_k e^{i q_k}; nine-link: l_1 e_1 − l_5 e_2 − l_9 e_3, (14) | m |
//! | J_k | ∂p/∂q_k = i c_k e^{i q_k} | m |

use nalgebra::{Complex, Matrix3, Vector3};

use crate::machine::{Chain, place_of};
use crate::planar::{PerDrive, UnitVectors, Vector, cross, dot};

const I: Vector = Complex::new(0.0, 1.0);

/// Returns the position p of the end effector, m, (14).
pub fn end_effector(tip: &Chain, e: &UnitVectors) -> Vector {
    place_of(tip, e)
}

/// Returns column k of the Jacobian with respect to absolute drive angles, m.
pub fn column(tip: &Chain, e: &UnitVectors, k: usize) -> Vector {
    I * e[k] * tip[k]
}

/// Returns the velocity of the end effector, ṗ = J q̇, m/s.
pub fn velocity(tip: &Chain, e: &UnitVectors, qd: &PerDrive) -> Vector {
    I * qd.iter().zip(tip.iter().zip(e)).map(|(qd, (w, e))| e * (w * qd)).sum::<Vector>()
}

/// Returns the acceleration of the end effector, p̈ = J q̈ + J̇ q̇, m/s².
pub fn acceleration(tip: &Chain, e: &UnitVectors, qd: &PerDrive, qdd: &PerDrive) -> Vector {
    (0..qd.len()).map(|k| Vector::new(-qd[k] * qd[k], qdd[k]) * e[k] * tip[k]).sum()
}

/// Returns the minimum-norm solution q̇ = J⁺ v = Jᵀ (J Jᵀ)⁻¹ v, rad/s, and its exact time derivative q̈, rad/s², for
/// v̇. `None` where J is rank deficient.
pub fn minimum_norm(tip: &Chain, e: &UnitVectors, n: usize, v: Vector, vd: Vector) -> Option<(PerDrive, PerDrive)> {
    let j = |k: usize| column(tip, e, k);
    let gram = |a: &dyn Fn(usize) -> Vector, b: &dyn Fn(usize) -> Vector| {
        (0..n).fold([0.0; 4], |g, k| {
            let (a, b) = (a(k), b(k));
            [g[0] + a.re * b.re, g[1] + a.re * b.im, g[2] + a.im * b.re, g[3] + a.im * b.im]
        })
    };
    let jj = gram(&j, &j);
    let scale = jj[0] + jj[3];
    let det = jj[0] * jj[3] - jj[1] * jj[2];
    if det <= 1e-14 * scale * scale {
        return None;
    }
    let solve = |r: Vector| Vector::new(jj[3] * r.re - jj[1] * r.im, jj[0] * r.im - jj[2] * r.re) / det;
    let y = solve(v);
    let qd = PerDrive::from_fn(n, |k| dot(j(k), y));
    // d/dt (J Jᵀ) y = (J̇ Jᵀ + J J̇ᵀ) y
    let jd = |k: usize| I * j(k) * qd[k];
    let m = gram(&jd, &j);
    let my = Vector::new(2.0 * m[0] * y.re + (m[1] + m[2]) * y.im, (m[1] + m[2]) * y.re + 2.0 * m[3] * y.im);
    let yd = solve(vd - my);
    let qdd = PerDrive::from_fn(n, |k| dot(jd(k), y) + dot(j(k), yd));
    Some((qd, qdd))
}

/// Returns the minimum-norm rates, rad/s, that give the end effector the velocity v, m/s, at constant Σ λ_k q_k.
/// They are q̇ = Aᵀ (A Aᵀ)⁻¹ (v, 0) with A = [J; λ]. Also returns their exact time derivative for v̇. `None` where
/// A is rank
/// deficient, as it always is for fewer than three drives.
pub fn minimum_norm_held(
    tip: &Chain,
    lambda: &PerDrive,
    e: &UnitVectors,
    v: Vector,
    vd: Vector,
) -> Option<(PerDrive, PerDrive)> {
    minimum_norm_with(tip, lambda, 0.0, |_| PerDrive::zeros(lambda.len()), e, v, vd)
}

/// Returns the minimum-norm rates, rad/s, that give the end effector the velocity v, m/s, and satisfy `extra` · q̇ =
/// `rate`, a constant. Also returns their exact time derivative for v̇. The row `extra` is appended to the Jacobian;
/// `extra_rate` returns the time derivative of this row at given rates. `None` where the extended Jacobian is rank
/// deficient.
pub fn minimum_norm_with(
    tip: &Chain,
    extra: &PerDrive,
    rate: f64,
    extra_rate: impl Fn(&PerDrive) -> PerDrive,
    e: &UnitVectors,
    v: Vector,
    vd: Vector,
) -> Option<(PerDrive, PerDrive)> {
    let n = extra.len();
    if n < 3 {
        return None;
    }
    // The extra row is scaled to the reach, so that all rows have similar magnitudes.
    let reach = tip.iter().map(|c| c.abs()).sum::<f64>();
    let scale = reach / extra.max_abs();
    let row = |j: Vector, k: usize| Vector3::new(j.re, j.im, scale * extra[k]);
    let a = |k: usize| row(column(tip, e, k), k);
    let gram = (0..n).fold(Matrix3::zeros(), |g, k| g + a(k) * a(k).transpose());
    let inverse = gram.try_inverse().filter(|_| gram.determinant() > 1e-14 * gram.trace().powi(3))?;
    let y = inverse * Vector3::new(v.re, v.im, scale * rate);
    let qd = PerDrive::from_fn(n, |k| a(k).dot(&y));
    let row_rate = extra_rate(&qd);
    let ad = |k: usize| {
        let jd = I * column(tip, e, k) * qd[k];
        Vector3::new(jd.re, jd.im, scale * row_rate[k])
    };
    let change = (0..n).fold(Matrix3::zeros(), |m, k| m + ad(k) * a(k).transpose());
    let yd = inverse * (Vector3::new(vd.re, vd.im, 0.0) - (change + change.transpose()) * y);
    let qdd = PerDrive::from_fn(n, |k| ad(k).dot(&y) + a(k).dot(&yd));
    Some((qd, qdd))
}

/// Returns the angle equal to `angle` modulo 2π that is nearest to `near`, rad.
pub fn closest_turn(angle: f64, near: f64) -> f64 {
    let turn = std::f64::consts::TAU;
    angle + turn * ((near - angle) / turn).round()
}

/// Returns the rates (q̇_k, q̇_l), rad/s, with i c_k e_k q̇_k + i c_l e_l q̇_l = v. `None` where the two links are
/// parallel.
pub fn two_link_rates(ck: f64, cl: f64, ek: Vector, el: Vector, v: Vector) -> Option<(f64, f64)> {
    let (jk, jl) = (I * ek * ck, I * el * cl);
    let det = cross(jk, jl);
    (det.abs() > 1e-12 * (ck * cl).abs()).then(|| (cross(v, jl) / det, cross(jk, v) / det))
}

/// Returns the worst force transmission of the parallelograms: min |sin(q_k − q_l)| over the pairs, 0 at a change
/// point.
pub fn least_transmission(e: &UnitVectors, n: usize) -> f64 {
    crate::machine::Inertia::pairs(n).fold(1.0, |m, (k, l)| m.min(cross(e[k], e[l]).abs()))
}
