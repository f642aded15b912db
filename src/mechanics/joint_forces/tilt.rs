//! Moments that tilt the base out of the plane of motion, which arise from the heights of the links.
//!
//! The motion is planar, but the links lie at different heights. A force f in the plane at height z has the moment (−z
//! f_y, z f_x, …) about B. Written as a complex number x + iy, it is i z f. So a force balanced machine, whose forces
//! cancel, may still transmit a couple.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | z_j | height of the CM of link j, or of the payload, above the reference plane through B | m |
//! | S | Σ_j m_j z_j | kg m |
//! | s_k | Σ_j m_j z_j a_jk: first moments weighted with z; the CM of link j is at Σ_k a_jk e_k | complex, kg m² |
//! | n_t | moment about B that tilts the base, n_x + i n_y | N m |
//! | z̄ | S / M, height of the centre of mass | m |
//!
//! # Closed form
//! n_t = i [S g + z_e F − Σ_k s_k (i q̈_k − q̇_k²) e_k], with gravity g and a force F at the payload's height z_e. The
//! couple from motion is the moment about height z̄. Its formula has s_k − z̄ g_k in place of s_k, with g_k = Σ_j m_j
//! a_jk.
//!
//! # Assumptions
//! Products of inertia I_xz, I_yz of each link about its own CM are zero. Each link is symmetric about a plane normal
//! to the drives' axis. With all z_j = 0, the default, n_t = 0.

use crate::dynamics::ExternalLoads;
use crate::machine::Machine;
use crate::planar::{MAX_DRIVES, PerDrive, UnitVectors, Vector};

/// Constants of a machine from which its tilting moment is computed.
#[derive(Clone, Debug, PartialEq)]
pub struct AxialMoments {
    drives: usize,
    /// S, kg m.
    total: f64,
    /// s_k, kg m².
    s: [Vector; MAX_DRIVES],
    /// s_k − z̄ g_k, kg m².
    couple: [Vector; MAX_DRIVES],
    /// z_e, m.
    end: f64,
    flat: bool,
}

/// Tilting moment n_x + i n_y about B, N m, that the manipulator exerts on the base, in two parts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TiltMoment {
    /// Part from motion.
    pub motion: Vector,
    /// Part from weight and from a force on the end effector.
    pub weight: Vector,
}

impl TiltMoment {
    /// Returns the sum of both parts.
    pub fn total(&self) -> Vector {
        self.motion + self.weight
    }
}

impl AxialMoments {
    /// Computes the constants as sums over the links and the payload.
    pub fn of(machine: &Machine) -> Self {
        let zero = Vector::default();
        let payload = machine.spec().payload;
        let links = machine.links().iter().enumerate().map(|(j, l)| (l.mass, l.axial, machine.com_chain(j)));
        let held = (payload.mass, payload.axial, machine.payload_chain());
        let (mut total, mut mass, mut s, mut g) = (0.0, 0.0, [zero; MAX_DRIVES], [zero; MAX_DRIVES]);
        for (m, z, a) in links.chain([held]) {
            total += m * z;
            mass += m;
            for k in 0..machine.drives() + usize::from(machine.ground().is_some()) {
                s[k] += m * z * a[k];
                g[k] += m * a[k];
            }
        }
        let mean = total / mass;
        Self {
            drives: machine.drives(),
            total,
            s,
            couple: std::array::from_fn(|k| s[k] - mean * g[k]),
            end: payload.axial,
            flat: payload.axial == 0.0 && machine.links().iter().all(|l| l.axial == 0.0),
        }
    }

    /// Returns S, the first moment along the axis, kg m.
    pub fn total(&self) -> f64 {
        self.total
    }

    /// Returns s_k, the first moments of the drives weighted with the heights, kg m².
    pub fn weighted(&self) -> &[Vector; MAX_DRIVES] {
        &self.s
    }

    /// Returns whether all heights are zero, the default in a machine file; then n_t = 0.
    pub fn is_flat(&self) -> bool {
        self.flat
    }

    /// Returns the largest |s_k − z̄ g_k|, kg m²: 0 if motion transmits no tilting couple, even if forces are not
    /// balanced.
    pub fn residual(&self) -> f64 {
        self.couple[..self.drives].iter().fold(0.0, |m, s| m.max(s.norm()))
    }

    /// Returns Σ_k |s_k − z̄ g_k|, kg m², by which orders of the links are compared where no motion is given.
    pub fn sum(&self) -> f64 {
        self.couple[..self.drives].iter().map(|s| s.norm()).sum()
    }

    /// Returns the tilting moment about B in the reference plane, N m.
    #[inline]
    pub fn tilt(&self, e: &UnitVectors, qd: &PerDrive, qdd: &PerDrive, around: &ExternalLoads) -> TiltMoment {
        let i = Vector::new(0.0, 1.0);
        TiltMoment {
            motion: i * self.pull(&self.s, e, qd, qdd),
            weight: i * (around.gravity * self.total + around.force * self.end),
        }
    }

    /// Returns the couple of the motion, n_x + i n_y, N m: the tilting moment about the height of the centre of mass.
    /// In a force balanced machine it equals the part of n_t from motion.
    pub fn couple(&self, e: &UnitVectors, qd: &PerDrive, qdd: &PerDrive) -> Vector {
        Vector::new(0.0, 1.0) * self.pull(&self.couple, e, qd, qdd)
    }

    /// Returns −Σ_k s_k (i q̈_k − q̇_k²) e_k, N m.
    #[inline]
    fn pull(&self, s: &[Vector; MAX_DRIVES], e: &UnitVectors, qd: &PerDrive, qdd: &PerDrive) -> Vector {
        let mut sum = Vector::default();
        for k in 0..self.drives {
            sum -= s[k] * (Vector::new(-qd[k] * qd[k], qdd[k]) * e[k]);
        }
        sum
    }
}
