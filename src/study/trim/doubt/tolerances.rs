//! [`Tolerances`]: expected deviations of a built machine from its file, and the distance of a measured machine from
//! the file.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | x | first moments, couplings, momenta, in the order of [`Unknowns`] | |
//! | P | covariance of x over built machines whose bodies deviate by the tolerances, independently | |
//! | L | P = L Lᵀ | |
//! | Λ | information on x, the inverse of its measured covariance; 0 along directions that are not identifiable | |
//! | μ, v | eigenvalues and eigenvectors of Lᵀ Λ L | |
//! | d² | Σ μ/(1 + μ) (v · L⁻¹(x − x₀))² = (x − x₀)ᵀ (P + Λ⁻¹)⁻¹ (x − x₀): squared distance from the file, in σ | |
//! | p | Σ μ/(1 + μ): number of unknowns that the data determine better than the tolerances | |
//!
//! Only ratios of distances are compared, so only the proportions of the tolerances matter.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

use crate::trim::fit::IdentifiedNumbers;
use crate::trim::{Unknown, Unknowns};
use stillbase_mechanics::balance::Condition;
use stillbase_mechanics::machine::{Inertia, Machine};
use stillbase_mechanics::planar::Vector;

/// Relative tolerance of a link's mass, counterweights included.
const MASS_TOLERANCE: f64 = 0.03;
/// Tolerance of a centre of mass along its link, as a fraction of the larger of the link's length and a fifth of the
/// reach. Half as much across.
const COM_TOLERANCE: f64 = 0.01;
/// Relative tolerance of inertias.
const INERTIA_TOLERANCE: f64 = 0.05;
/// Unknown load at the end effector, as a fraction of the total mass.
const LOAD_TOLERANCE: f64 = 0.02;
/// Fraction of each variance that is added independently: errors that no single body explains.
const INDEPENDENT_FRACTION: f64 = 0.01;

/// Factor on the tolerances of those unknowns that are not compared, which makes them nearly free.
const FREE_FACTOR: f64 = 30.0;
/// First moments and couplings below this fraction of mass times reach, or mass times reach squared, are treated as
/// zero.
const BALANCED_BELOW: f64 = 1e-3;
/// Maximum number of iterations of the eigenvalue solver.
const MAX_ITERATIONS: usize = 10_000;

/// Covariance P of the tolerances.
pub(super) struct Tolerances {
    covariance: DMatrix<f64>,
    balance: usize,
    /// Whether the file's value of each unknown differs from that of a balanced machine.
    known: Vec<bool>,
}

/// Squared distances d² of some unknowns, with the others nearly free, and p.
#[derive(Clone, Copy, Debug)]
pub(super) struct Distance {
    /// d² of the momenta D.
    pub momenta: f64,
    /// d² of first moments g and couplings C.
    pub balance: f64,
    /// d² of all unknowns.
    pub all: f64,
    /// p of all unknowns.
    pub numbers: f64,
    /// d² and p of D and of those g and C that are not zero in the file. `None` if all of these are zero.
    pub known: Option<[f64; 2]>,
}

/// Returns whether the file's value of each unknown differs from that of a balanced machine. That is true of each D,
/// and of both parts of first moments and couplings above a thousandth of mass times reach (couplings: reach squared).
pub(super) fn known_numbers(machine: &Machine) -> Vec<bool> {
    let (unknowns, inertia) = (Unknowns::of(machine.drives()), Inertia::of(machine));
    let nominal = unknowns.nominal(&inertia);
    let is_known = |i: usize| {
        let size = match unknowns.at(i) {
            Unknown::Momentum(_) => return true,
            Unknown::Of(Condition::Force(_), _) => inertia.mass() * machine.reach(),
            Unknown::Of(Condition::Coupling(..), _) => inertia.mass() * machine.reach().powi(2),
        };
        nominal[i & !1].hypot(nominal[i | 1]) > BALANCED_BELOW * size
    };
    (0..unknowns.count()).map(is_known).collect()
}

impl Tolerances {
    /// Returns the tolerances of a machine.
    pub fn of(machine: &Machine) -> Self {
        let (n, inertia) = (machine.drives(), Inertia::of(machine));
        let unknowns = Unknowns::of(n);
        let empty = || Inertia::massless(n, *machine.motors(), *machine.end_effector());
        let body = |mass: f64, own: f64, drive: usize, chain: &[Vector; _]| {
            let mut one = empty();
            one.add(mass, own, drive, chain);
            DVector::from_vec(unknowns.nominal(&one))
        };
        let mut columns = Vec::new();
        for (j, (link, part)) in machine.links().iter().zip(machine.resolved_links()).enumerate() {
            let chain = machine.com_chain(j);
            let now = body(link.mass, link.inertia, part.drive, &chain);
            columns.push(MASS_TOLERANCE * &now);
            let off = COM_TOLERANCE * part.length.abs().max(0.2 * machine.reach());
            for by in [Vector::new(off, 0.0), Vector::new(0.0, 0.5 * off)] {
                let moved = |sign: f64| {
                    let mut chain = chain;
                    chain[part.drive] += sign * by;
                    body(link.mass, link.inertia, part.drive, &chain)
                };
                let [more, less] = [moved(1.0), moved(-1.0)];
                columns.push(0.5 * (&more - &less));
                // D may not change to first order, so its second-order change is included.
                columns.push(0.5 * (more + less) - &now);
            }
            let turning = link.inertia + link.mass * part.length * part.length / 12.0;
            columns.push(body(0.0, INERTIA_TOLERANCE * turning, part.drive, &chain));
        }
        let held_by = machine.resolved_links()[machine.end_link()].drive;
        let end = machine.end_effector().map(|length| Vector::new(length, 0.0));
        columns.push(body(LOAD_TOLERANCE * inertia.mass(), 0.0, held_by, &end));
        for drive in 0..n {
            let mut column = DVector::zeros(unknowns.count());
            let rotor = &inertia.rotors[drive];
            (0..n).for_each(|k| column[unknowns.of_balance() + k] = INERTIA_TOLERANCE * rotor.inertia * rotor.rates[k]);
            columns.push(column);
        }
        let mut covariance = DMatrix::zeros(unknowns.count(), unknowns.count());
        columns.iter().for_each(|column| covariance.ger(1.0, column, column, 1.0));
        let least = 1e-12 * covariance.diagonal().amax();
        (0..unknowns.count()).for_each(|i| covariance[(i, i)] += INDEPENDENT_FRACTION * covariance[(i, i)] + least);
        Self { covariance, balance: unknowns.of_balance(), known: known_numbers(machine) }
    }

    /// Returns the distance of a measured machine from its file; `None` if it cannot be computed.
    pub fn distance(&self, numbers: &IdentifiedNumbers) -> Option<Distance> {
        let off = &numbers.measured - &numbers.nominal;
        let part = |of: &dyn Fn(usize) -> bool| -> Option<[f64; 2]> {
            let scale = |i: usize| if of(i) { 1.0 } else { FREE_FACTOR };
            let entry = |i: usize, j: usize| match of(i) == of(j) {
                true => scale(i) * scale(j) * self.covariance[(i, j)],
                false => 0.0,
            };
            let factor = DMatrix::from_fn(off.len(), off.len(), entry).cholesky()?.l();
            let seen = factor.tr_mul(&(&numbers.information * &factor));
            let eigen = SymmetricEigen::try_new(seen, f64::EPSILON, MAX_ITERATIONS)?;
            let apart = eigen.eigenvectors.tr_mul(&factor.solve_lower_triangular(&off)?);
            let share = eigen.eigenvalues.map(|value| value.max(0.0) / (1.0 + value.max(0.0)));
            let sum = share.iter().zip(apart.iter()).map(|(share, apart)| share * apart * apart).sum();
            Some([sum, share.sum()]).filter(|both| both.iter().all(|x: &f64| x.is_finite()))
        };
        let [momenta, _] = part(&|i| i >= self.balance)?;
        let [balance, _] = part(&|i| i < self.balance)?;
        let [all, count] = part(&|_| true)?;
        let is_balanced = !self.known[..self.balance].contains(&true);
        let known = if is_balanced { None } else { Some(part(&|i| self.known[i])?) };
        Some(Distance { momenta, balance, all, numbers: count, known })
    }
}
