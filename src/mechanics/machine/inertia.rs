//! A machine collapsed into a few constants: cost does not grow with the number of links.
//!
//! # Symbols
//! | letter | meaning | shape, unit |
//! |---|---|---|
//! | a_jk | CM of link j is Σ_k a_jk e^{i q_k} | complex, m |
//! | g_k | first moment Σ_j m_j a_jk; γ_k = i g_k e^{i q_k}, (3), (A1) | complex, kg m |
//! | C_kl | coupling Σ_j m_j conj(a_jk) a_jl | Hermitian, kg m² |
//! | J_k | spin: inertia of all links that follow drive k | kg m² |

use super::{Chain, Machine};
use crate::mechanics::planar::{MAX_DRIVES, PerDrive, Vector};

/// The constants g, C, J of a machine with its payload.
#[derive(Clone, Debug, PartialEq)]
pub struct Inertia {
    pub(crate) drives: usize,
    pub(crate) mass: f64,
    pub(crate) g: [Vector; MAX_DRIVES],
    pub(crate) c: [[Vector; MAX_DRIVES]; MAX_DRIVES],
    pub(crate) spin: [f64; MAX_DRIVES],
    pub(crate) end_effector: Chain,
}

impl Inertia {
    /// Sums over the links and the payload.
    pub fn of(machine: &Machine) -> Self {
        let zero = Vector::new(0.0, 0.0);
        let mut sum = Self {
            drives: machine.drives(),
            mass: 0.0,
            g: [zero; MAX_DRIVES],
            c: [[zero; MAX_DRIVES]; MAX_DRIVES],
            spin: [0.0; MAX_DRIVES],
            end_effector: *machine.end_effector(),
        };
        for (j, (link, part)) in machine.links().iter().zip(machine.resolved_links()).enumerate() {
            sum.add(link.mass, link.inertia, part.drive, &machine.com_chain(j));
        }
        let payload = machine.spec().payload;
        let held_by = machine.resolved_links()[machine.end_link()].drive;
        sum.add(payload.mass, payload.inertia, held_by, &machine.payload_chain());
        sum
    }

    pub(crate) fn add(&mut self, mass: f64, inertia: f64, drive: usize, a: &[Vector; MAX_DRIVES]) {
        self.mass += mass;
        self.spin[drive] += inertia;
        for k in 0..self.drives {
            self.g[k] += mass * a[k];
            for l in 0..self.drives {
                self.c[k][l] += mass * a[k].conj() * a[l];
            }
        }
    }

    /// Number of drives.
    pub fn drives(&self) -> usize {
        self.drives
    }

    /// Total mass M, kg.
    pub fn mass(&self) -> f64 {
        self.mass
    }

    /// First moment g_k, kg m; the bracket of (A1).
    pub fn first_moment(&self, k: usize) -> Vector {
        self.g[k]
    }

    /// Coupling C_kl, kg m²; for k ≠ l the bracket of (8).
    pub fn coupling(&self, k: usize, l: usize) -> Vector {
        self.c[k][l]
    }

    /// H_kk = C_kk + J_k, kg m²: the same in every pose.
    pub fn diagonal(&self, k: usize) -> f64 {
        self.c[k][k].re + self.spin[k]
    }

    /// Inertia of each drive when all C_kl vanish: D_k = H_kk, (11).
    pub fn diagonals(&self) -> PerDrive {
        PerDrive::from_fn(self.drives, |k| self.diagonal(k))
    }

    /// λ_k = D_k / D_1 of an invariant machine, (12).
    pub fn lambda(&self) -> PerDrive {
        PerDrive::from_fn(self.drives, |k| self.diagonal(k) / self.diagonal(0))
    }

    /// The pairs k < l in the paper's order (1,2), (1,3), (2,3) …, counted from 0.
    pub fn pairs(n: usize) -> impl Iterator<Item = (usize, usize)> {
        (0..n).flat_map(move |k| (k + 1..n).map(move |l| (k, l)))
    }

    /// Largest |g_k|, kg m: 0 is force balance, (7).
    pub fn force_residual(&self) -> f64 {
        self.g[..self.drives].iter().fold(0.0, |m, g| m.max(g.norm()))
    }

    /// Largest |C_kl|, k ≠ l, kg m²: 0 is an invariant mass matrix, (8).
    pub fn invariance_residual(&self) -> f64 {
        Self::pairs(self.drives).fold(0.0, |m, (k, l)| m.max(self.c[k][l].norm()))
    }

    /// Whether no force reaches the base: every |g_k| below 1e-9 of what the mass and size make possible.
    pub fn is_force_balanced(&self) -> bool {
        self.force_residual() <= BALANCED * self.mass * self.size()
    }

    /// Whether the mass matrix is the same in every pose.
    pub fn is_invariant(&self) -> bool {
        self.invariance_residual() <= BALANCED * self.mass * self.size().powi(2)
    }

    fn size(&self) -> f64 {
        (0..self.drives).map(|k| self.diagonal(k)).sum::<f64>().max(0.0).sqrt() / self.mass.sqrt()
    }
}

/// Residuals below this part of the machine's own scale count as zero.
pub const BALANCED: f64 = 1e-9;
