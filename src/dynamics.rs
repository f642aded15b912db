//! Torques, base wrench, momenta, energy: (1), (4), (5), (6) in closed form.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | Z_kl | C_kl e^{i (q_l − q_k)} | kg m² |
//! | H_kl | mass matrix, Re Z_kl + δ_kl J_k | kg m² |
//! | V_k | velocity terms, −Σ_l Im Z_kl q̇_l² | N m |
//! | τ | H q̈ + V − γᵀ g − Jᵀ F | N m |
//! | f_B, n_B | what the manipulator transmits to its base: dynamic −Σ g_k (i q̈_k − q̇_k²) e_k and −d/dt(D q̇); static M g and r_CM × M g | N, N m |
//!
//! # Source
//! (4) with the sign of gravity put right: with g the acceleration of (1), the torque is H q̈ + V − γᵀ g.

use crate::machine::Inertia;
use crate::planar::{MAX_DRIVES, PerDrive, Units, Vector, Wrench, cross, dot};

/// Calls a function with the number of drives as a constant, so that its loops unroll.
macro_rules! by_drives {
    ($n:expr, $f:ident($($arg:expr),*)) => {
        match $n {
            1 => $f::<1>($($arg),*),
            2 => $f::<2>($($arg),*),
            3 => $f::<3>($($arg),*),
            4 => $f::<4>($($arg),*),
            5 => $f::<5>($($arg),*),
            6 => $f::<6>($($arg),*),
            7 => $f::<7>($($arg),*),
            _ => $f::<8>($($arg),*),
        }
    };
}
/// A force held at the end effector and the field it all moves in.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Surroundings {
    /// Acceleration of gravity g, m/s².
    pub gravity: Vector,
    /// Force F acting on the end effector, N.
    pub force: Vector,
}

/// Mass matrix and velocity terms at a pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassMatrix {
    n: usize,
    h: [[f64; MAX_DRIVES]; MAX_DRIVES],
}

impl MassMatrix {
    /// H_kl, kg m².
    pub fn get(&self, k: usize, l: usize) -> f64 {
        self.h[k][l]
    }

    /// D_k = Σ_l H_lk, kg m², (A3).
    pub fn momentum_row(&self, k: usize) -> f64 {
        (0..self.n).map(|l| self.h[l][k]).sum()
    }

    /// H x.
    #[inline]
    pub fn times(&self, x: &PerDrive) -> PerDrive {
        by_drives!(self.n, times(self, x))
    }

    /// H⁻¹ x by Cholesky's factors; H is positive definite for every machine whose links have mass.
    #[inline]
    pub fn solve(&self, x: &PerDrive) -> PerDrive {
        by_drives!(self.n, solve(self, x))
    }
}

#[inline]
fn times<const N: usize>(h: &MassMatrix, x: &PerDrive) -> PerDrive {
    let x = x.padded();
    PerDrive::from_fn(N, |k| (0..N).map(|l| h.h[k][l] * x[l]).sum())
}

#[inline]
fn solve<const N: usize>(h: &MassMatrix, x: &PerDrive) -> PerDrive {
    let mut l = [[0.0; N]; N];
    let mut y = [0.0; N];
    let x = x.padded();
    for i in 0..N {
        for j in 0..=i {
            let s: f64 = h.h[i][j] - (0..j).map(|m| l[i][m] * l[j][m]).sum::<f64>();
            l[i][j] = if i == j { s.sqrt() } else { s / l[j][j] };
        }
        y[i] = (x[i] - (0..i).map(|m| l[i][m] * y[m]).sum::<f64>()) / l[i][i];
    }
    for i in (0..N).rev() {
        y[i] = (y[i] - (i + 1..N).map(|m| l[m][i] * y[m]).sum::<f64>()) / l[i][i];
    }
    PerDrive::from(y)
}

/// H and V, (4).
#[inline]
pub fn mass_matrix(inertia: &Inertia, e: &Units, qd: &PerDrive) -> (MassMatrix, PerDrive) {
    by_drives!(inertia.drives, assemble(inertia, e, qd))
}

#[inline]
fn assemble<const N: usize>(inertia: &Inertia, e: &Units, qd: &PerDrive) -> (MassMatrix, PerDrive) {
    let mut h = [[0.0; MAX_DRIVES]; MAX_DRIVES];
    let mut v = [0.0; N];
    let qd = qd.padded();
    for k in 0..N {
        h[k][k] = inertia.c[k][k].re + inertia.spin[k];
        for l in k + 1..N {
            let z = inertia.c[k][l] * e[k].conj() * e[l];
            h[k][l] = z.re;
            h[l][k] = z.re;
            v[k] -= z.im * qd[l] * qd[l];
            v[l] += z.im * qd[k] * qd[k];
        }
    }
    (MassMatrix { n: N, h }, PerDrive::from(v))
}

/// −γᵀ g − Jᵀ F, the part of the torque that holds still, N m.
#[inline]
pub fn holding_torque(inertia: &Inertia, e: &Units, around: &Surroundings) -> PerDrive {
    by_drives!(inertia.drives, hold(inertia, e, around))
}

#[inline]
fn hold<const N: usize>(inertia: &Inertia, e: &Units, around: &Surroundings) -> PerDrive {
    // (i e) · a = e × a for a unit vector e turned by a right angle
    PerDrive::from_fn(N, |k| -cross(inertia.g[k] * e[k], around.gravity) - inertia.tip[k] * cross(e[k], around.force))
}

/// Motor torques for given accelerations, (4), N m.
#[inline]
pub fn inverse(inertia: &Inertia, e: &Units, qd: &PerDrive, qdd: &PerDrive, around: &Surroundings) -> PerDrive {
    by_drives!(inertia.drives, inverse_of(inertia, e, qd, qdd, around))
}

#[inline]
fn inverse_of<const N: usize>(
    inertia: &Inertia,
    e: &Units,
    qd: &PerDrive,
    qdd: &PerDrive,
    around: &Surroundings,
) -> PerDrive {
    let (h, v) = assemble::<N>(inertia, e, qd);
    let (moving, holding) = (times::<N>(&h, qdd), hold::<N>(inertia, e, around));
    PerDrive::from_fn(N, |k| moving[k] + v[k] + holding[k])
}

/// Accelerations for given motor torques, rad/s².
#[inline]
pub fn forward(inertia: &Inertia, e: &Units, qd: &PerDrive, torque: &PerDrive, around: &Surroundings) -> PerDrive {
    by_drives!(inertia.drives, forward_of(inertia, e, qd, torque, around))
}

#[inline]
fn forward_of<const N: usize>(
    inertia: &Inertia,
    e: &Units,
    qd: &PerDrive,
    torque: &PerDrive,
    around: &Surroundings,
) -> PerDrive {
    let (h, v) = assemble::<N>(inertia, e, qd);
    let holding = hold::<N>(inertia, e, around);
    solve::<N>(&h, &PerDrive::from_fn(N, |k| torque[k] - v[k] - holding[k]))
}

/// What the manipulator transmits to its base, in its two parts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BaseWrench {
    /// From weight and from a force held at the end effector: M g + F and its moment about B.
    pub statical: Wrench,
    /// From motion: −d/dt of the linear and of the angular momentum.
    pub dynamic: Wrench,
}

impl BaseWrench {
    /// The sum of both parts.
    pub fn total(&self) -> Wrench {
        Wrench { force: self.statical.force + self.dynamic.force, moment: self.statical.moment + self.dynamic.moment }
    }
}

/// f_B and n_B, (1) and (5).
#[inline]
pub fn base_wrench(inertia: &Inertia, e: &Units, qd: &PerDrive, qdd: &PerDrive, around: &Surroundings) -> BaseWrench {
    inverse_with_wrench(inertia, e, qd, qdd, around).1
}

#[inline]
fn wrench_with<const N: usize>(
    inertia: &Inertia,
    e: &Units,
    qd: &PerDrive,
    qdd: &PerDrive,
    around: &Surroundings,
    momentum_rate: f64,
) -> BaseWrench {
    let (mut pull, mut tip, mut first) = (Vector::default(), Vector::default(), Vector::default());
    for k in 0..N {
        let ge = inertia.g[k] * e[k];
        first += ge;
        pull -= ge * Vector::new(-qd[k] * qd[k], qdd[k]);
        tip += e[k] * inertia.tip[k];
    }
    BaseWrench {
        statical: Wrench {
            force: inertia.mass * around.gravity + around.force,
            moment: cross(first, around.gravity) + cross(tip, around.force),
        },
        dynamic: Wrench { force: pull, moment: -momentum_rate },
    }
}

/// Torques and base wrench of a motion, in one evaluation.
#[inline]
pub fn inverse_with_wrench(
    inertia: &Inertia,
    e: &Units,
    qd: &PerDrive,
    qdd: &PerDrive,
    around: &Surroundings,
) -> (PerDrive, BaseWrench) {
    by_drives!(inertia.drives, inverse_with_wrench_of(inertia, e, qd, qdd, around))
}

#[inline]
fn inverse_with_wrench_of<const N: usize>(
    inertia: &Inertia,
    e: &Units,
    qd: &PerDrive,
    qdd: &PerDrive,
    around: &Surroundings,
) -> (PerDrive, BaseWrench) {
    let (h, v) = assemble::<N>(inertia, e, qd);
    let (inertial, holding) = (times::<N>(&h, qdd), hold::<N>(inertia, e, around));
    let rate = (0..N).map(|k| inertial[k] + v[k]).sum();
    let wrench = wrench_with::<N>(inertia, e, qd, qdd, around, rate);
    (PerDrive::from_fn(N, |k| inertial[k] + v[k] + holding[k]), wrench)
}

/// Σ_k g_k e_k = M r_CM, kg m.
pub fn first_moment(inertia: &Inertia, e: &Units) -> Vector {
    (0..inertia.drives).map(|k| inertia.g[k] * e[k]).sum()
}

/// Centre of mass r_CM from B, m, (2).
pub fn centre_of_mass(inertia: &Inertia, e: &Units) -> Vector {
    first_moment(inertia, e) / inertia.mass
}

/// Linear momentum Σ_k γ_k q̇_k, kg m/s, (3).
pub fn linear_momentum(inertia: &Inertia, e: &Units, qd: &PerDrive) -> Vector {
    (0..inertia.drives).map(|k| inertia.g[k] * e[k] * Vector::new(0.0, qd[k])).sum()
}

/// Angular momentum about B, D q̇, kg m²/s, (6).
pub fn angular_momentum(inertia: &Inertia, e: &Units, qd: &PerDrive) -> f64 {
    let (h, _) = mass_matrix(inertia, e, qd);
    h.times(qd).iter().sum()
}

/// Kinetic energy ½ q̇ᵀ H q̇ and potential energy −M g · r_CM, J.
pub fn energy(inertia: &Inertia, e: &Units, qd: &PerDrive, gravity: Vector) -> (f64, f64) {
    let (h, _) = mass_matrix(inertia, e, qd);
    (0.5 * h.times(qd).dot(qd), -dot(gravity, first_moment(inertia, e)))
}
