//! [`ArmOnBase`]: torques of the drives and wrench on the base as an arm moves on a base that is fixed, floats, or is
//! held by a wheel.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | R, M_t | common centre of mass of arm and base, and their mass | m, kg |
//! | m_b, I_b, ρ | mass of the base, its inertia about its centre of mass, that centre seen from the base pin B | kg, kg m², m |
//! | C'_kl | couplings about R: C_kl − ḡ_k g_l / M_t | kg m² |
//! | φ_k | angles in space: q_k + θ of the drives, θ of the base as the last one | rad |
//! | L | angular momentum about R, Σ_kl H_kl φ̇_l | kg m²/s |
//!
//! # Source
//! A free base is one more drive, with g_θ = m_b ρ, C_θθ = m_b |ρ|², J_θ = I_b. Its translation drops out of the equations
//! if everything is referred to R: the torques are H φ̈ + V with H formed from C'. Torques between drives and base
//! cancel, so a base that floats has L = 0 and L̇ = Σ_k (H φ̈ + V)_k = 0. These give θ̇ and θ̈. A wheel that holds the base
//! gives L̇ at θ̇ = θ̈ = 0. Gravity accelerates all parts alike and loads no drive.
//!
//! The force on a free base is m_b times the acceleration of its centre of mass. The moment about B is
//! I_b θ̈ + ρ × f − L̇, as the arm holds the rest of L.

use crate::dynamics::{
    BaseWrench, ExternalLoads, assemble, by_drives, holding_torque, inverse, inverse_with_wrench, matrix_times,
};
use crate::machine::{Inertia, MachineError};
use crate::planar::{MAX_DRIVES, PerDrive, UnitVectors, Vector, Wrench, cross};

/// Mass properties of a base that may move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FloatingBase {
    /// m_b, kg.
    pub mass: f64,
    /// I_b about its own centre of mass, kg m².
    pub inertia: f64,
    /// ρ, its centre of mass seen from B, m.
    pub com: Vector,
}

/// An arm and its base about their common centre of mass R.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeBody {
    /// Inertia of all rotating parts about R; the base is the last of n + 1 coordinates.
    pub rotating: Inertia,
    /// M_t, kg.
    pub mass: f64,
    /// Position of B relative to R as a chain, m: the coefficients of the unit vectors e_k.
    pub base_chain: [Vector; MAX_DRIVES],
    base: FloatingBase,
}

impl FreeBody {
    /// Returns an arm and its base.
    ///
    /// # Errors
    /// If there are more than [`MAX_DRIVES`] − 1 drives.
    pub fn of(arm: &Inertia, base: &FloatingBase) -> Result<Self, MachineError> {
        let n = arm.drives;
        if n >= MAX_DRIVES {
            let want = format!("at most {} on a base that moves", MAX_DRIVES - 1);
            return Err(MachineError::Count { what: "drives", count: n, want });
        }
        let mut rotating = arm.clone();
        rotating.turn_base();
        // Links that keep their orientation beside the base turn with it.
        (rotating.drives, rotating.grounded) = (n + 1, false);
        let mut of_base = [Vector::default(); MAX_DRIVES];
        of_base[n] = base.com;
        rotating.add(base.mass, base.inertia, n, &of_base);
        let (g, mass) = (rotating.g, rotating.mass);
        for k in 0..=n {
            for l in 0..=n {
                rotating.c[k][l] -= g[k].conj() * g[l] / mass;
            }
        }
        Ok(Self { rotating, mass, base_chain: g.map(|g| -g / mass), base: *base })
    }

    /// Returns what drives that move beside the base at rest have in sum.
    pub fn beside_rest(&self, e: &UnitVectors, qd: &PerDrive, qdd: &PerDrive) -> RestingBase {
        by_drives!(self.rotating.drives, beside_rest_of(self, e, qd, qdd))
    }
}

/// Sums over the drives and a free base that is at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RestingBase {
    /// Σ_kl H_kl, the inertia about R of all as one body, kg m².
    pub inertia: f64,
    /// Σ_kl H_kl q̇_l, the angular momentum about R, kg m²/s.
    pub momentum: f64,
    /// Its time derivative, N m.
    pub moment: f64,
    /// B relative to R, m.
    pub pin: Vector,
}

/// What carries an arm.
#[derive(Clone, Debug, PartialEq)]
enum Carrier {
    /// A base at rest, in the surroundings of the arm.
    Fixed(ExternalLoads),
    /// A free base; it turns if it floats, and keeps its orientation if a wheel holds it.
    Free { body: Box<FreeBody>, floats: bool },
}

/// An arm on its base.
#[derive(Clone, Debug, PartialEq)]
pub struct ArmOnBase {
    arm: Inertia,
    carrier: Carrier,
}

impl ArmOnBase {
    /// Returns an arm on a fixed base.
    pub fn fixed(arm: Inertia, around: &ExternalLoads) -> Self {
        Self { arm, carrier: Carrier::Fixed(*around) }
    }

    /// Returns an arm on a free base that turns as the arm moves.
    ///
    /// # Errors
    /// As [`FreeBody::of`].
    pub fn floating(arm: Inertia, base: &FloatingBase) -> Result<Self, MachineError> {
        Self::free(arm, base, true)
    }

    /// Returns an arm on a free base that a wheel holds in its orientation.
    ///
    /// # Errors
    /// As [`FreeBody::of`].
    pub fn held(arm: Inertia, base: &FloatingBase) -> Result<Self, MachineError> {
        Self::free(arm, base, false)
    }

    fn free(arm: Inertia, base: &FloatingBase, floats: bool) -> Result<Self, MachineError> {
        let body = Box::new(FreeBody::of(&arm, base)?);
        Ok(Self { arm, carrier: Carrier::Free { body, floats } })
    }

    /// Returns the arm.
    pub fn arm(&self) -> &Inertia {
        &self.arm
    }

    /// Returns the arm and its base about their common centre of mass, if the base is free.
    pub fn free_body(&self) -> Option<&FreeBody> {
        match &self.carrier {
            Carrier::Fixed(_) => None,
            Carrier::Free { body, .. } => Some(body),
        }
    }

    /// Returns whether torques are constant linear functions of the accelerations.
    pub fn is_linear(&self) -> bool {
        match &self.carrier {
            Carrier::Fixed(around) => {
                let weightless = around.gravity.norm_sqr() == 0.0 || self.arm.is_force_balanced();
                self.arm.is_invariant() && weightless && around.force.norm_sqr() == 0.0
            }
            Carrier::Free { body, .. } => body.rotating.is_invariant(),
        }
    }

    /// Returns whether the torque of each motor is H_kk q̈_k.
    pub fn is_decoupled(&self) -> bool {
        let floats = matches!(self.carrier, Carrier::Free { floats: true, .. });
        self.is_linear() && self.arm.is_decoupled() && !floats
    }

    /// Returns the torques of the drives that move the arm, N m, without those that hold it still. A base that floats
    /// has no angular momentum.
    #[inline]
    pub fn moving_torque(&self, e: &UnitVectors, qd: &PerDrive, qdd: &PerDrive) -> PerDrive {
        match &self.carrier {
            Carrier::Fixed(_) => inverse(&self.arm, e, qd, qdd, &ExternalLoads::default()),
            Carrier::Free { .. } => self.dynamics(e, qd, qdd).0,
        }
    }

    /// Returns the torques of the drives that hold the arm still, N m.
    #[inline]
    pub fn holding_torque(&self, e: &UnitVectors) -> PerDrive {
        match &self.carrier {
            Carrier::Fixed(around) => holding_torque(&self.arm, e, around),
            Carrier::Free { .. } => PerDrive::zeros(self.arm.drives),
        }
    }

    /// Returns the torques of the drives, N m, and the wrench on the base about B, in axes of the base. Rates and
    /// accelerations are relative to the base. A base that floats turns so that L is zero.
    #[inline]
    pub fn dynamics(&self, e: &UnitVectors, qd: &PerDrive, qdd: &PerDrive) -> (PerDrive, BaseWrench) {
        match &self.carrier {
            Carrier::Fixed(around) => inverse_with_wrench(&self.arm, e, qd, qdd, around),
            Carrier::Free { body, floats } => {
                by_drives!(body.rotating.drives, dynamics_of(body, *floats, e, [qd, qdd]))
            }
        }
    }
}

/// Returns unit vectors and rates of all coordinates with the base at rest.
fn beside<const N: usize>(e: &UnitVectors, of_drives: [&PerDrive; 2]) -> ([Vector; N], [[f64; N]; 2]) {
    let padded = |x: &PerDrive| std::array::from_fn(|k| if k + 1 < N { x[k] } else { 0.0 });
    let e = std::array::from_fn(|k| if k + 1 < N { e[k] } else { Vector::new(1.0, 0.0) });
    (e, of_drives.map(padded))
}

/// Returns the torques of the drives and the wrench on the base, in its axes. A base that `floats` turns
/// so that L is zero; otherwise it keeps its orientation.
#[inline]
fn dynamics_of<const N: usize>(
    body: &FreeBody,
    floats: bool,
    e: &UnitVectors,
    rates: [&PerDrive; 2],
) -> (PerDrive, BaseWrench) {
    let n = N - 1;
    let sum = |x: &[f64; N]| x.iter().sum::<f64>();
    let (e, [mut rate, mut acceleration]) = beside::<N>(e, rates);
    let (h, mut v) = assemble(&body.rotating, &e, &rate);
    if floats {
        let all = sum(&matrix_times(&h, &[1.0; N]));
        let turning = -sum(&matrix_times(&h, &rate)) / all;
        rate.iter_mut().for_each(|rate| *rate += turning);
        (_, v) = assemble(&body.rotating, &e, &rate);
        let turning = -(sum(&matrix_times(&h, &acceleration)) + sum(&v)) / all;
        acceleration.iter_mut().for_each(|acceleration| *acceleration += turning);
    }
    let inertial = matrix_times(&h, &acceleration);
    let torque: [f64; N] = std::array::from_fn(|k| inertial[k] + v[k]);
    let FloatingBase { mass, inertia, com } = body.base;
    let mut force = Vector::default();
    for k in 0..N {
        let lever = body.base_chain[k] + if k == n { com } else { Vector::default() };
        force += mass * lever * e[k] * Vector::new(-rate[k] * rate[k], acceleration[k]);
    }
    let moment = inertia * acceleration[n] + cross(com, force) - sum(&torque);
    let wrench = BaseWrench { static_part: Wrench::default(), dynamic: Wrench { force, moment } };
    (PerDrive::from_fn(n, |k| torque[k]), wrench)
}

fn beside_rest_of<const N: usize>(body: &FreeBody, e: &UnitVectors, qd: &PerDrive, qdd: &PerDrive) -> RestingBase {
    let (e, [rate, acceleration]) = beside::<N>(e, [qd, qdd]);
    let (h, v) = assemble(&body.rotating, &e, &rate);
    let sum = |x: &[f64; N]| x.iter().sum::<f64>();
    RestingBase {
        inertia: sum(&matrix_times(&h, &[1.0; N])),
        momentum: sum(&matrix_times(&h, &rate)),
        moment: sum(&matrix_times(&h, &acceleration)) + sum(&v),
        pin: (0..N).map(|k| body.base_chain[k] * e[k]).sum(),
    }
}
