//! Torques, base wrench, momenta, energy: (1), (4), (5), (6) in closed form.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | Z_kl | C_kl e^{i (q_l − q_k)} | kg m² |
//! | H_kl | mass matrix, Re Z_kl + δ_kl J_k, and J r_k r_l of every rotor | kg m² |
//! | V_k | velocity terms, −Σ_l Im Z_kl q̇_l² | N m |
//! | τ | H q̈ + V − γᵀ g − (∂p/∂q)ᵀ F; motors in joints give A⁻ᵀ τ ([`Motors`](crate::machine::Motors)) | N m |
//! | D_k | Σ_l H_lk, and J r_k (1 − Σ_l r_l) of every rotor; angular momentum about B is D q̇ | kg m² |
//! | C_0k | coupling of drive k with links that keep their orientation: D_k += Re (C_0k e_k), see [`Inertia`] | kg m² |
//! | f_B | force on the base: dynamic −Σ g_k (i q̈_k − q̇_k²) e_k, static M g + F | N |
//! | n_B | moment on the base about B: dynamic −d/dt(D q̇), static r_CM × M g + p × F, end effector p | N m |
//!
//! # Source
//! (4) with the sign of gravity corrected: with g the acceleration of (1), the torque is H q̈ + V − γᵀ g.

use crate::machine::Inertia;
use crate::planar::{MAX_DRIVES, PerDrive, UnitVectors, Vector, Wrench, cross, dot};

/// Calls a function with the number of drives as a constant, so that its loops unroll.
#[macro_export]
macro_rules! by_drives {
    ($n:expr, $f:ident($($arg:expr),*)) => {
        $crate::by_drives!(@ $n, $f, [], ($($arg),*))
    };
    // The same with a second constant, which says whether the base moves.
    ($n:expr, $moves:expr, $f:ident($($arg:expr),*)) => {
        match $moves {
            false => $crate::by_drives!(@ $n, $f, [false], ($($arg),*)),
            true => $crate::by_drives!(@ $n, $f, [true], ($($arg),*)),
        }
    };
    (@ $n:expr, $f:ident, [$($moves:literal)?], $args:tt) => {
        match $n {
            1 => $f::<1 $(, $moves)?> $args,
            2 => $f::<2 $(, $moves)?> $args,
            3 => $f::<3 $(, $moves)?> $args,
            4 => $f::<4 $(, $moves)?> $args,
            5 => $f::<5 $(, $moves)?> $args,
            6 => $f::<6 $(, $moves)?> $args,
            7 => $f::<7 $(, $moves)?> $args,
            _ => $f::<8 $(, $moves)?> $args,
        }
    };
}

pub use by_drives;

/// External loads: the field of gravity, and a force at the end effector.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ExternalLoads {
    /// Acceleration of gravity g, m/s².
    pub gravity: Vector,
    /// Force F acting on the end effector, N.
    pub force: Vector,
}

/// Mass matrix H at a pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassMatrix {
    n: usize,
    h: [[f64; MAX_DRIVES]; MAX_DRIVES],
    taken_up: [f64; MAX_DRIVES],
}

impl MassMatrix {
    /// Returns H_kl, kg m².
    pub fn get(&self, k: usize, l: usize) -> f64 {
        self.h[k][l]
    }

    /// Returns D_k, kg m²: Σ_l H_lk, (A3), plus the contributions of rotors whose stators are on the base and of links
    /// that keep their orientation.
    pub fn momentum_coefficient(&self, k: usize) -> f64 {
        (0..self.n).map(|l| self.h[l][k]).sum::<f64>() + self.taken_up[k]
    }

    /// Returns H x.
    #[inline]
    pub fn times(&self, x: &PerDrive) -> PerDrive {
        by_drives!(self.n, times_padded(self, x))
    }

    /// Returns H⁻¹ x by the factorisation H = L D Lᵀ. H is positive definite for every machine whose links have mass.
    #[inline]
    pub fn solve(&self, x: &PerDrive) -> PerDrive {
        by_drives!(self.n, solve_padded(self, x))
    }

    fn trimmed<const N: usize>(&self) -> Square<N> {
        std::array::from_fn(|k| *leading_entries(&self.h[k]))
    }
}

// The functions below work on arrays with one element for each drive: padding them to MAX_DRIVES at every step would
// cost more than the arithmetic.
pub(crate) type Square<const N: usize> = [[f64; N]; N];

/// Returns the first N elements of a padded array.
#[inline]
pub fn leading_entries<const N: usize, T>(padded: &[T; MAX_DRIVES]) -> &[T; N] {
    const { assert!(N <= MAX_DRIVES) }
    &padded.as_chunks().0[0]
}

fn times_padded<const N: usize>(h: &MassMatrix, x: &PerDrive) -> PerDrive {
    matrix_times(&h.trimmed::<N>(), leading_entries(x.padded())).into()
}

fn solve_padded<const N: usize>(h: &MassMatrix, x: &PerDrive) -> PerDrive {
    solve(&h.trimmed::<N>(), *leading_entries(x.padded())).into()
}

/// Returns H x.
#[inline(always)]
pub fn matrix_times<const N: usize>(h: &Square<N>, x: &[f64; N]) -> [f64; N] {
    std::array::from_fn(|k| (0..N).map(|l| h[k][l] * x[l]).sum())
}

/// Factors of H = L D Lᵀ, without square roots.
pub struct Factors<const N: usize> {
    /// L, strictly below the diagonal.
    l: Square<N>,
    /// Reciprocals of the diagonal of D.
    inverse: [f64; N],
}

impl<const N: usize> Factors<N> {
    /// Factors a symmetric positive definite H.
    #[inline(always)]
    pub fn of(h: &Square<N>) -> Self {
        let (mut l, mut ld, mut inverse) = ([[0.0; N]; N], [[0.0; N]; N], [0.0; N]);
        for i in 0..N {
            for j in 0..i {
                ld[i][j] = h[i][j] - (0..j).map(|m| ld[i][m] * l[j][m]).sum::<f64>();
                l[i][j] = ld[i][j] * inverse[j];
            }
            inverse[i] = 1.0 / (h[i][i] - (0..i).map(|m| ld[i][m] * l[i][m]).sum::<f64>());
        }
        Self { l, inverse }
    }

    /// Returns H⁻¹ x.
    #[inline(always)]
    pub fn solve(&self, mut x: [f64; N]) -> [f64; N] {
        for i in 0..N {
            x[i] -= (0..i).map(|m| self.l[i][m] * x[m]).sum::<f64>();
        }
        for i in (0..N).rev() {
            x[i] = x[i] * self.inverse[i] - (i + 1..N).map(|m| self.l[m][i] * x[m]).sum::<f64>();
        }
        x
    }
}

#[inline]
fn solve<const N: usize>(h: &Square<N>, x: [f64; N]) -> [f64; N] {
    Factors::of(h).solve(x)
}

/// Computes the mass matrix H, kg m², and the velocity terms V, N m, (4).
#[inline]
pub fn mass_matrix(inertia: &Inertia, e: &UnitVectors, qd: &PerDrive) -> (MassMatrix, PerDrive) {
    by_drives!(inertia.drives, mass_matrix_of(inertia, e, qd))
}

fn mass_matrix_of<const N: usize>(inertia: &Inertia, e: &UnitVectors, qd: &PerDrive) -> (MassMatrix, PerDrive) {
    let (small, v) = assemble::<N>(inertia, leading_entries(e), leading_entries(qd.padded()));
    let mut h = [[0.0; MAX_DRIVES]; MAX_DRIVES];
    h.iter_mut().zip(small).for_each(|(to, from)| to[..N].copy_from_slice(&from));
    let mut taken_up = inertia.stator_reaction;
    if inertia.grounded {
        (0..N).for_each(|k| taken_up[k] += (inertia.ground_coupling(k) * e[k]).re);
    }
    (MassMatrix { n: N, h, taken_up }, v.into())
}

/// Returns the mass matrix H, kg m², and the velocity terms V, N m, from unit vectors e(q_k) and rates, rad/s.
#[inline(always)]
pub fn assemble<const N: usize>(inertia: &Inertia, e: &[Vector; N], qd: &[f64; N]) -> (Square<N>, [f64; N]) {
    let mut h = [[0.0; N]; N];
    let mut v = [0.0; N];
    for k in 0..N {
        h[k][k] = inertia.c[k][k].re + inertia.spin[k];
        for l in k + 1..N {
            let z = inertia.c[k][l] * (e[k].conj() * e[l]);
            let coupled = z.re + inertia.rotor_coupling[k][l];
            h[k][l] = coupled;
            h[l][k] = coupled;
            v[k] -= z.im * (qd[l] * qd[l]);
            v[l] += z.im * (qd[k] * qd[k]);
        }
    }
    (h, v)
}

/// Returns the torque that holds the machine at rest, −γᵀ g − (∂p/∂q)ᵀ F, N m.
#[inline]
pub fn holding_torque(inertia: &Inertia, e: &UnitVectors, around: &ExternalLoads) -> PerDrive {
    by_drives!(inertia.drives, holding_torque_of(inertia, e, around))
}

#[inline]
fn holding_torque_of<const N: usize>(inertia: &Inertia, e: &UnitVectors, around: &ExternalLoads) -> PerDrive {
    hold::<N>(inertia, leading_entries(e), around).into()
}

#[inline(always)]
fn hold<const N: usize>(inertia: &Inertia, e: &[Vector; N], around: &ExternalLoads) -> [f64; N] {
    // (i e) · a = e × a: multiplying by i turns e by a right angle.
    std::array::from_fn(|k| {
        -cross(inertia.g[k] * e[k], around.gravity) - inertia.end_effector[k] * cross(e[k], around.force)
    })
}

/// Returns the generalised torques for given accelerations, (4), N m. If all motors sit on the base, these are the
/// motor torques.
#[inline]
pub fn inverse(inertia: &Inertia, e: &UnitVectors, qd: &PerDrive, qdd: &PerDrive, around: &ExternalLoads) -> PerDrive {
    by_drives!(inertia.drives, inverse_of(inertia, e, qd, qdd, around))
}

#[inline]
fn inverse_of<const N: usize>(
    inertia: &Inertia,
    e: &UnitVectors,
    qd: &PerDrive,
    qdd: &PerDrive,
    around: &ExternalLoads,
) -> PerDrive {
    torques(inertia, leading_entries::<N, _>(e), leading_entries(qd.padded()), leading_entries(qdd.padded()), around)
        .into()
}

/// Returns the torques of [`inverse`], N m, for a number of drives N known at compile time.
#[inline(always)]
pub fn torques<const N: usize>(
    inertia: &Inertia,
    e: &[Vector; N],
    qd: &[f64; N],
    qdd: &[f64; N],
    around: &ExternalLoads,
) -> [f64; N] {
    let (h, v) = assemble(inertia, e, qd);
    let (inertial, holding) = (matrix_times(&h, qdd), hold(inertia, e, around));
    std::array::from_fn(|k| inertial[k] + v[k] + holding[k])
}

/// Returns the accelerations, rad/s², for given torques, N m.
#[inline]
pub fn forward(
    inertia: &Inertia,
    e: &UnitVectors,
    qd: &PerDrive,
    torque: &PerDrive,
    around: &ExternalLoads,
) -> PerDrive {
    by_drives!(inertia.drives, forward_of(inertia, e, qd, torque, around))
}

#[inline]
fn forward_of<const N: usize>(
    inertia: &Inertia,
    e: &UnitVectors,
    qd: &PerDrive,
    torque: &PerDrive,
    around: &ExternalLoads,
) -> PerDrive {
    let (e, qd, torque) =
        (leading_entries::<N, _>(e), leading_entries(qd.padded()), leading_entries::<N, _>(torque.padded()));
    let (h, v) = assemble(inertia, e, qd);
    let holding = hold(inertia, e, around);
    solve(&h, std::array::from_fn(|k| torque[k] - v[k] - holding[k])).into()
}

/// Wrench that the manipulator exerts on its base, in two parts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BaseWrench {
    /// Part from weight and from a force at the end effector: M g + F, and the moment of both about B.
    pub static_part: Wrench,
    /// Part from motion: −d/dt of the linear and of the angular momentum.
    pub dynamic: Wrench,
}

impl BaseWrench {
    /// Returns the sum of both parts.
    pub fn total(&self) -> Wrench {
        Wrench {
            force: self.static_part.force + self.dynamic.force,
            moment: self.static_part.moment + self.dynamic.moment,
        }
    }
}

/// Returns the base wrench, f_B, N, and n_B about B, N m, (1) and (5).
#[inline]
pub fn base_wrench(
    inertia: &Inertia,
    e: &UnitVectors,
    qd: &PerDrive,
    qdd: &PerDrive,
    around: &ExternalLoads,
) -> BaseWrench {
    inverse_with_wrench(inertia, e, qd, qdd, around).1
}

/// Returns the rate of the angular momentum about B, d/dt (D q̇), N m, from H q̈, V and q̈, without what links that keep
/// their orientation add.
#[inline(always)]
pub fn angular_rate<const N: usize>(inertia: &Inertia, inertial: &[f64; N], v: &[f64; N], qdd: &[f64; N]) -> f64 {
    (0..N).map(|k| inertial[k] + v[k] + inertia.stator_reaction[k] * qdd[k]).sum()
}

/// Returns the base wrench at one state of motion, force in N and moment about B in N m. `momentum_rate` is that of
/// [`angular_rate`], N m.
#[inline(always)]
pub fn wrench_with<const N: usize>(
    inertia: &Inertia,
    e: &[Vector; N],
    qd: &[f64; N],
    qdd: &[f64; N],
    around: &ExternalLoads,
    momentum_rate: f64,
) -> BaseWrench {
    let (mut pull, mut tip, mut first) = (Vector::default(), Vector::default(), Vector::default());
    for k in 0..N {
        let ge = inertia.g[k] * e[k];
        first += ge;
        pull -= ge * Vector::new(-qd[k] * qd[k], qdd[k]);
        tip += e[k] * inertia.end_effector[k];
    }
    let mut momentum_rate = momentum_rate;
    // If the base moves, the ground is one of its coordinates.
    if inertia.grounded && N == inertia.drives {
        first += inertia.g[N];
        for k in 0..N {
            let coupled = inertia.ground_coupling(k) * e[k];
            momentum_rate += coupled.re * qdd[k] - coupled.im * (qd[k] * qd[k]);
        }
    }
    BaseWrench {
        static_part: Wrench {
            force: inertia.mass * around.gravity + around.force,
            moment: cross(first, around.gravity) + cross(tip, around.force),
        },
        dynamic: Wrench { force: pull, moment: -momentum_rate },
    }
}

/// Returns torques, N m, and base wrench of a motion, in one evaluation.
#[inline]
pub fn inverse_with_wrench(
    inertia: &Inertia,
    e: &UnitVectors,
    qd: &PerDrive,
    qdd: &PerDrive,
    around: &ExternalLoads,
) -> (PerDrive, BaseWrench) {
    by_drives!(inertia.drives, inverse_with_wrench_of(inertia, e, qd, qdd, around))
}

#[inline(always)]
fn inverse_with_wrench_of<const N: usize>(
    inertia: &Inertia,
    e: &UnitVectors,
    qd: &PerDrive,
    qdd: &PerDrive,
    around: &ExternalLoads,
) -> (PerDrive, BaseWrench) {
    let (e, qd, qdd) = (leading_entries::<N, _>(e), leading_entries(qd.padded()), leading_entries(qdd.padded()));
    let (torque, wrench) = torques_with_wrench(inertia, e, qd, qdd, around);
    (torque.into(), wrench)
}

/// Returns torques and base wrench of [`inverse_with_wrench`] for a number of drives N known at compile time.
#[inline(always)]
pub fn torques_with_wrench<const N: usize>(
    inertia: &Inertia,
    e: &[Vector; N],
    qd: &[f64; N],
    qdd: &[f64; N],
    around: &ExternalLoads,
) -> ([f64; N], BaseWrench) {
    let (h, v) = assemble(inertia, e, qd);
    let (inertial, holding) = (matrix_times(&h, qdd), hold(inertia, e, around));
    let rate = angular_rate(inertia, &inertial, &v, qdd);
    let wrench = wrench_with(inertia, e, qd, qdd, around, rate);
    (std::array::from_fn(|k| inertial[k] + v[k] + holding[k]), wrench)
}

/// Returns Σ_j m_j |r̈_cj|, N: the sum of the magnitudes of the links' inertial forces. In such a sum, forces cannot
/// cancel. `moments` holds m_j a_jk, kg m, link by link, with one element for each drive.
#[inline]
pub fn inertial_pull(moments: &[Vector], e: &UnitVectors, qd: &PerDrive, qdd: &PerDrive) -> f64 {
    by_drives!(qd.len(), inertial_pull_of(moments, e, qd, qdd))
}

#[inline]
fn inertial_pull_of<const N: usize>(moments: &[Vector], e: &UnitVectors, qd: &PerDrive, qdd: &PerDrive) -> f64 {
    let (e, qd, qdd) =
        (leading_entries::<N, _>(e), leading_entries::<N, _>(qd.padded()), leading_entries::<N, _>(qdd.padded()));
    let turn: [_; N] = std::array::from_fn(|k| Vector::new(-qd[k] * qd[k], qdd[k]) * e[k]);
    let pull = |moment: &[Vector; N]| (0..N).map(|k| moment[k] * turn[k]).sum::<Vector>().norm_sqr().sqrt();
    moments.as_chunks().0.iter().map(pull).sum()
}

/// Σ_k g_k e_k = M r_CM, kg m.
pub fn first_moment(inertia: &Inertia, e: &UnitVectors) -> Vector {
    let still = if inertia.grounded { inertia.g[inertia.drives] } else { Vector::default() };
    (0..inertia.drives).map(|k| inertia.g[k] * e[k]).sum::<Vector>() + still
}

/// Centre of mass r_CM from B, m, (2).
pub fn centre_of_mass(inertia: &Inertia, e: &UnitVectors) -> Vector {
    first_moment(inertia, e) / inertia.mass
}

/// Linear momentum Σ_k γ_k q̇_k, kg m/s, (3).
pub fn linear_momentum(inertia: &Inertia, e: &UnitVectors, qd: &PerDrive) -> Vector {
    (0..inertia.drives).map(|k| inertia.g[k] * e[k] * Vector::new(0.0, qd[k])).sum()
}

/// Angular momentum about B, D q̇, kg m²/s, (6).
pub fn angular_momentum(inertia: &Inertia, e: &UnitVectors, qd: &PerDrive) -> f64 {
    let (h, _) = mass_matrix(inertia, e, qd);
    h.times(qd).iter().zip(qd.iter().zip(h.taken_up)).map(|(p, (qd, taken_up))| p + taken_up * qd).sum()
}

/// Kinetic energy ½ q̇ᵀ H q̇ and potential energy −M g · r_CM, J.
pub fn energy(inertia: &Inertia, e: &UnitVectors, qd: &PerDrive, gravity: Vector) -> (f64, f64) {
    let (h, _) = mass_matrix(inertia, e, qd);
    (0.5 * h.times(qd).dot(qd), -dot(gravity, first_moment(inertia, e)))
}
