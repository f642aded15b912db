//! [`Condition`]: one condition of (7) or (8), and the contribution of a mass on a link to it.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | a_k | coefficient in the position Σ_k a_k e(q_k) of the mass; e(q) is the unit vector at angle q | complex, m |
//! | m a_k | contribution of the mass to g_k | complex, kg m |
//! | m conj(a_k) a_l | contribution of the mass to C_kl | complex, kg m² |

use crate::machine::{Inertia, Machine, ResolvedLink};
use crate::planar::{MAX_DRIVES, Vector};
use stillbase_settings::number::subscript;

/// A quantity that must vanish for a machine to be balanced and invariant. Drives are counted from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Condition {
    /// Force balance (7): the first moment g_k.
    Force(usize),
    /// Invariance (8): the coupling C_kl, k < l. If l is the number of drives, that with links that keep their
    /// orientation.
    Coupling(usize, usize),
}

impl Condition {
    /// Returns the conditions of n drives: (7) of each drive, then (8) of each pair.
    pub fn all(n: usize) -> impl Iterator<Item = Self> {
        (0..n).map(Self::Force).chain(Inertia::pairs(n).map(|(k, l)| Self::Coupling(k, l)))
    }

    /// Returns the conditions of a machine: those of its drives, then those of each drive with links that keep their
    /// orientation, if there are any.
    pub fn all_of(machine: &Machine) -> impl Iterator<Item = Self> {
        let n = machine.drives();
        Self::all(n).chain(machine.ground().into_iter().flat_map(move |l| (0..n).map(move |k| Self::Coupling(k, l))))
    }

    /// Returns its symbol on a machine of some drives, with the numbers of its drives, from 1, as subscripts. 0 is the
    /// ground.
    pub fn symbol(self, drives: usize) -> String {
        match self {
            Self::Force(k) => format!("g{}", subscript(k + 1)),
            Self::Coupling(k, l) if l == drives => format!("C{}{}", subscript(0), subscript(k + 1)),
            Self::Coupling(k, l) => format!("C{}{}", subscript(k + 1), subscript(l + 1)),
        }
    }

    /// Returns its name in words, with the names of its drives.
    pub fn name(self, machine: &Machine) -> String {
        let drive = |k: usize| &machine.spec().drives[k].name;
        match self {
            Self::Force(k) => format!("the force balance of drive {}, (7)", drive(k)),
            Self::Coupling(k, l) if l == machine.drives() => {
                format!("the coupling of drive {} and links that keep their orientation, (8)", drive(k))
            }
            Self::Coupling(k, l) => format!("the coupling of drives {} and {}, (8)", drive(k), drive(l)),
        }
    }

    /// Returns the unit of its residual.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Force(_) => "kg m",
            Self::Coupling(..) => "kg m²",
        }
    }

    /// Returns the residual of the condition: g_k, kg m, or C_kl, kg m².
    pub fn residual(self, inertia: &Inertia) -> Vector {
        match self {
            Self::Force(k) => inertia.first_moment(k),
            Self::Coupling(k, l) => inertia.coupling(k, l),
        }
    }

    /// Returns the tolerance, kg m or kg m²: a residual up to this is treated as zero.
    pub fn tolerance(self, inertia: &Inertia) -> f64 {
        match self {
            Self::Force(_) => inertia.first_moment_tolerance(),
            Self::Coupling(..) => inertia.coupling_tolerance(),
        }
    }

    /// Returns the contribution, kg m or kg m², of a mass, kg, at Σ_k a_k e(q_k), m.
    pub fn of(self, mass: f64, a: &[Vector; MAX_DRIVES]) -> Vector {
        match self {
            Self::Force(k) => mass * a[k],
            Self::Coupling(k, l) => mass * a[k].conj() * a[l],
        }
    }

    /// Returns the contribution per kg of mass at the root of a link: m for (7), m² for (8).
    pub fn by_mass(self, part: &ResolvedLink) -> f64 {
        match self {
            Self::Force(k) => part.root[k],
            Self::Coupling(k, l) => part.root[k] * part.root[l],
        }
    }

    /// Returns the contribution per kg m of a link's first moment along its axis: a number for (7), m for (8).
    pub fn by_moment(self, part: &ResolvedLink) -> f64 {
        match self {
            Self::Force(k) if k == part.drive => part.sign,
            Self::Coupling(k, l) if k == part.drive => part.sign * part.root[l],
            Self::Coupling(k, l) if l == part.drive => part.sign * part.root[k],
            _ => 0.0,
        }
    }

    /// Returns the contribution to the imaginary part per kg m of a link's first moment to the left of its axis.
    pub fn by_cross_moment(self, part: &ResolvedLink) -> f64 {
        match self {
            // C_kl depends on conj(a_k), which reverses the sign.
            Self::Coupling(k, _) if k == part.drive => -self.by_moment(part),
            _ => self.by_moment(part),
        }
    }
}
