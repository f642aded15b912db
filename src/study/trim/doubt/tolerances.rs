//! [`Tolerances`]: how far a built machine may be from its file, and how far one is that was measured.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | x | first moments, couplings, momenta, as among the [`Unknowns`] | |
//! | P | covariance of x of built machines whose bodies are off by the tolerances, independently | |
//! | L | P = L Lᵀ | |
//! | Λ | information on x, the inverse of its covariance as measured; 0 along what the data do not determine | |
//! | μ, v | eigenvalues and vectors of Lᵀ Λ L | |
//! | d² | Σ μ/(1 + μ) (v · L⁻¹(x − x₀))² = (x − x₀)ᵀ (P + Λ⁻¹)⁻¹ (x − x₀): squared distance from the file, in σ | |
//! | p | Σ μ/(1 + μ): how many numbers the data determine better than the tolerances do | |
//!
//! Only ratios of distances are compared, so the tolerances matter by their proportions.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

use crate::mechanics::balance::Condition;
use crate::mechanics::machine::{Inertia, Machine};
use crate::mechanics::planar::Vector;
use crate::study::trim::{Fit, Unknown, Unknowns};

/// Of the mass of a link with its counterweights, as a share.
const MASS: f64 = 0.03;
/// Of a centre of mass along its link, as a share of the link's length or a fifth of the reach if that is more; half of
/// that across.
const PLACE: f64 = 0.01;
/// Of inertias, as a share.
const INERTIA: f64 = 0.05;
/// A load at the end effector of which the file knows nothing, as a share of the whole mass.
const LOAD: f64 = 0.02;
/// Part of each variance that is independent of all others: what no error of one body explains.
const OTHER: f64 = 0.01;

/// Where only momenta are compared, first moments and couplings may be off by so many times their tolerances.
const ANY: f64 = 30.0;
/// First moments and couplings below this share of mass times reach, or reach squared, are those of a balanced machine.
const BALANCED: f64 = 1e-3;
/// Steps of the eigenvalue solver.
const MAX_STEPS: usize = 10_000;

/// P.
pub(super) struct Tolerances {
    covariance: DMatrix<f64>,
    balance: usize,
    /// Whether the file has so much of each number that it is told from that of a balanced machine.
    known: Vec<bool>,
}

/// d², of some numbers whatever the others are, and p.
#[derive(Clone, Copy, Debug)]
pub(super) struct Distance {
    /// Of D alone.
    pub momenta: f64,
    /// Of g and C alone.
    pub balance: f64,
    /// Of all.
    pub all: f64,
    /// p of all.
    pub numbers: f64,
    /// Of D, and of the g and C that the file has, with p; none of a machine that has none, because it is balanced.
    pub known: Option<[f64; 2]>,
}

/// Which numbers a file tells from those of a balanced machine: each D, and both parts of first moments and couplings
/// above a thousandth of mass times reach, or reach squared.
pub(super) fn known(machine: &Machine) -> Vec<bool> {
    let (unknowns, inertia) = (Unknowns::of(machine.drives()), Inertia::of(machine));
    let nominal = unknowns.nominal(&inertia);
    let is_known = |i: usize| {
        let size = match unknowns.at(i) {
            Unknown::Momentum(_) => return true,
            Unknown::Of(Condition::Force(_), _) => inertia.mass() * machine.reach(),
            Unknown::Of(Condition::Coupling(..), _) => inertia.mass() * machine.reach().powi(2),
        };
        nominal[i & !1].hypot(nominal[i | 1]) > BALANCED * size
    };
    (0..unknowns.count()).map(is_known).collect()
}

impl Tolerances {
    /// Of a machine.
    pub fn of(machine: &Machine) -> Self {
        let (n, inertia) = (machine.drives(), Inertia::of(machine));
        let unknowns = Unknowns::of(n);
        let empty = || Inertia::nothing(n, *machine.motors(), *machine.end_effector());
        let body = |mass: f64, own: f64, drive: usize, chain: &[Vector; _]| {
            let mut one = empty();
            one.add(mass, own, drive, chain);
            DVector::from_vec(unknowns.nominal(&one))
        };
        let mut columns = Vec::new();
        for (j, (link, part)) in machine.links().iter().zip(machine.resolved_links()).enumerate() {
            let chain = machine.com_chain(j);
            let now = body(link.mass, link.inertia, part.drive, &chain);
            columns.push(MASS * &now);
            let off = PLACE * part.length.abs().max(0.2 * machine.reach());
            for by in [Vector::new(off, 0.0), Vector::new(0.0, 0.5 * off)] {
                let moved = |sign: f64| {
                    let mut chain = chain;
                    chain[part.drive] += sign * by;
                    body(link.mass, link.inertia, part.drive, &chain)
                };
                let [more, less] = [moved(1.0), moved(-1.0)];
                columns.push(0.5 * (&more - &less));
                // Where D does not change to first order, it does to second.
                columns.push(0.5 * (more + less) - &now);
            }
            let turning = link.inertia + link.mass * part.length * part.length / 12.0;
            columns.push(body(0.0, INERTIA * turning, part.drive, &chain));
        }
        let held_by = machine.resolved_links()[machine.end_link()].drive;
        let end = machine.end_effector().map(|length| Vector::new(length, 0.0));
        columns.push(body(LOAD * inertia.mass(), 0.0, held_by, &end));
        for drive in 0..n {
            let mut column = DVector::zeros(unknowns.count());
            let rotor = &inertia.rotors[drive];
            (0..n).for_each(|k| column[unknowns.of_balance() + k] = INERTIA * rotor.inertia * rotor.rates[k]);
            columns.push(column);
        }
        let mut covariance = DMatrix::zeros(unknowns.count(), unknowns.count());
        columns.iter().for_each(|column| covariance.ger(1.0, column, column, 1.0));
        let least = 1e-12 * covariance.diagonal().amax();
        (0..unknowns.count()).for_each(|i| covariance[(i, i)] += OTHER * covariance[(i, i)] + least);
        Self { covariance, balance: unknowns.of_balance(), known: known(machine) }
    }

    /// How far a measured machine is from its file; `None` where that cannot be computed.
    pub fn distance(&self, fit: &Fit) -> Option<Distance> {
        let off = &fit.measured - &fit.nominal;
        let part = |of: &dyn Fn(usize) -> bool| -> Option<[f64; 2]> {
            let scale = |i: usize| if of(i) { 1.0 } else { ANY };
            let entry = |i: usize, j: usize| match of(i) == of(j) {
                true => scale(i) * scale(j) * self.covariance[(i, j)],
                false => 0.0,
            };
            let factor = DMatrix::from_fn(off.len(), off.len(), entry).cholesky()?.l();
            let seen = factor.tr_mul(&(&fit.information * &factor));
            let eigen = SymmetricEigen::try_new(seen, f64::EPSILON, MAX_STEPS)?;
            let apart = eigen.eigenvectors.tr_mul(&factor.solve_lower_triangular(&off)?);
            let share = eigen.eigenvalues.map(|value| value.max(0.0) / (1.0 + value.max(0.0)));
            let sum = share.iter().zip(apart.iter()).map(|(share, apart)| share * apart * apart).sum();
            Some([sum, share.sum()]).filter(|both| both.iter().all(|x: &f64| x.is_finite()))
        };
        let [momenta, _] = part(&|i| i >= self.balance)?;
        let [balance, _] = part(&|i| i < self.balance)?;
        let [all, numbers] = part(&|_| true)?;
        let is_balanced = !self.known[..self.balance].contains(&true);
        let known = if is_balanced { None } else { Some(part(&|i| self.known[i])?) };
        Some(Distance { momenta, balance, all, numbers, known })
    }
}
