//! [`impossible_numbers`]: finds identified values that no machine can have, whatever its masses.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | a_j | (1, a_j1 … a_jn): mass m_j is at Σ_k a_jk e(q_k) | m |
//! | Z | Σ_j m_j conj(a_j) a_jᵀ + diag(0, J_k), J_k of drive k's links; entries: M, g_k, C_kl, D_k less rotors | |
//!
//! If no mass or inertia is negative, Z has no negative eigenvalue. D_k < 0 is the simplest violation; |C_kl|² > D_k
//! D_l and |g_k|² > M D_k are others.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

use crate::trim::Unknown;
use crate::trim::fit::IdentifiedNumbers;
use stillbase_mechanics::balance::Condition;
use stillbase_mechanics::machine::{Inertia, Machine};
use stillbase_mechanics::planar::Vector;

/// Upper bound on M, as a multiple of the mass in the file.
const MAX_MASS_FACTOR: f64 = 2.0;
/// Number of half widths of its 95 % interval by which an eigenvalue must lie below zero to count as negative.
const MIN_HALF_WIDTHS: f64 = 3.0;
/// Additional margin for rounding, on eigenvalues that are of order 1 if the file is right.
const EIGENVALUE_ROUNDING: f64 = 1e-6;
/// Maximum number of iterations of the eigenvalue solver.
const MAX_ITERATIONS: usize = 10_000;

/// Returns up to three unknowns whose values are impossible together, the largest contribution first; empty if positive
/// masses can explain all values.
pub(super) fn impossible_numbers(machine: &Machine, numbers: &IdentifiedNumbers) -> Vec<Unknown> {
    let (inertia, n) = (Inertia::of(machine), machine.drives());
    let unknowns = &numbers.unknowns;
    let from = unknowns.of_balance();
    let rotors = |k: usize| inertia.rotors[..n].iter().map(|rotor| rotor.inertia * rotor.rates[k]).sum::<f64>();
    let drives: Vec<usize> = (0..n).filter(|k| numbers.identifiable[from + k]).collect();
    let size = |k: usize| (inertia.momentum(k) - rotors(k)).abs().max(1e-9 * inertia.diagonal(k)).sqrt();
    let all_identifiable = |of: &[usize]| {
        let used = |condition: &Condition| match condition {
            Condition::Force(k) => of.contains(k),
            Condition::Coupling(k, l) => of.contains(k) && of.contains(l),
        };
        let conditions = unknowns.conditions().iter().enumerate();
        conditions.filter(|(_, c)| used(c)).all(|(i, _)| numbers.identifiable[2 * i] && numbers.identifiable[2 * i + 1])
    };
    // First each drive alone, then all drives with their first moments, if all these unknowns are identifiable.
    let alone = drives.iter().map(|k| (vec![*k], false));
    let groups = alone.chain(Some((drives.clone(), true)).filter(|(of, _)| all_identifiable(of)));
    for (of, moments) in groups {
        let offset = usize::from(moments);
        let scale = |i: usize| match i.checked_sub(offset) {
            Some(i) => 1.0 / size(of[i]),
            None => 1.0 / (MAX_MASS_FACTOR * inertia.mass()).sqrt(),
        };
        let place = |k: &usize| of.iter().position(|own| own == k).map(|i| i + offset);
        let mut z = DMatrix::<Vector>::zeros(of.len() + offset, of.len() + offset);
        if moments {
            z[(0, 0)] = Vector::new(1.0, 0.0);
        }
        for (i, k) in of.iter().enumerate() {
            let own = numbers.measured[from + k] - rotors(*k);
            z[(i + offset, i + offset)] = Vector::new(own * scale(i + offset).powi(2), 0.0);
        }
        // Row and column in Z of each condition: g_k for (7), C_kl for (8).
        let places: Vec<Option<(usize, usize)>> = unknowns
            .conditions()
            .iter()
            .map(|condition| match condition {
                Condition::Force(k) => place(k).filter(|_| moments).map(|k| (0, k)),
                Condition::Coupling(k, l) => place(k).zip(place(l)),
            })
            .collect();
        for (i, at) in places.iter().enumerate() {
            if let Some((a, b)) = *at {
                let value = Vector::new(numbers.measured[2 * i], numbers.measured[2 * i + 1]) * (scale(a) * scale(b));
                (z[(a, b)], z[(b, a)]) = (value, value.conj());
            }
        }
        let Some(eigen) = SymmetricEigen::try_new(z, f64::EPSILON, MAX_ITERATIONS) else { continue };
        let least = eigen.eigenvalues.imin();
        let (value, v) = (eigen.eigenvalues[least], eigen.eigenvectors.column(least));
        // Derivative of the eigenvalue with respect to the unknowns, at fixed eigenvector.
        let mut slope = DVector::zeros(unknowns.count());
        for (i, k) in of.iter().enumerate() {
            slope[from + k] = v[i + offset].norm_sqr() * scale(i + offset).powi(2);
        }
        for (i, at) in places.iter().enumerate() {
            if let Some((a, b)) = *at {
                let by = v[a].conj() * v[b] * (2.0 * scale(a) * scale(b));
                (slope[2 * i], slope[2 * i + 1]) = (by.re, -by.im);
            }
        }
        let half = numbers.critical * slope.dot(&(&numbers.covariance * &slope)).max(0.0).sqrt();
        if value + MIN_HALF_WIDTHS * half < -EIGENVALUE_ROUNDING {
            // Contribution of each unknown to the eigenvalue.
            let contribution =
                |i: usize| slope[i] * (numbers.measured[i] - if i < from { 0.0 } else { rotors(i - from) });
            let mut all: Vec<usize> = (0..unknowns.count()).filter(|i| contribution(*i) < 0.0).collect();
            all.sort_by(|a, b| contribution(*a).total_cmp(&contribution(*b)));
            return all.into_iter().take(3).map(|i| unknowns.at(i)).collect();
        }
    }
    Vec::new()
}
