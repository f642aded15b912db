//! Zeros of angles: where the angles of the drives may count from, by the phases of a fit.
//!
//! If the true angles are q + δ, a fit with q explains the same data with g_k e^{iδ_k} for g_k, and C_kl e^{i(δ_l − δ_k)}
//! for C_kl. Residuals tell nothing of δ, so it is that which turns the measured phases onto those of the file.
//!
//! # Symbols
//! | letter | meaning |
//! |---|---|
//! | δ_k | what the angle of drive k lacks, rad |
//! | a_kl | weight times measured value times conjugate value of the file, of C_kl; a_0k of g_k |
//!
//! # Method
//! Σ Re(a_kl e^{i(δ_k − δ_l)}) with δ_0 = 0 is maximised: angular synchronisation. The start is the leading eigenvector of
//! the Hermitian matrix a, then each δ is found in closed form from all others, in turn.
//!
//! # Source
//! Singer (2011), *Angular synchronization by eigenvectors and semidefinite programming*.

use nalgebra::{Complex, DMatrix, DVector, SymmetricEigen};
use schemars::JsonSchema;
use serde::Serialize;

use super::doubting::FaultWords;
use super::fault::{Angles, ColumnNames, NamedAngles, list};
use super::tolerances::known_numbers;
use crate::trim::fit::IdentifiedNumbers;
use crate::trim::unknowns::Unknown;
use stillbase_mechanics::balance::Condition;
use stillbase_mechanics::machine::{Inertia, Machine};
use stillbase_mechanics::planar::{PerDrive, Vector};

/// Relative deviation of a phase, rad, that is expected of a built machine.
const PHASE_TOLERANCE: f64 = 0.01;
/// Zeros that differ by less are those of the file, rad.
const MIN_OFFSET: f64 = 0.01;
/// Maximum number of rounds in which each δ is found from all others.
const MAX_ROUNDS: usize = 200;
/// Number of unknowns that another zero has to bring into agreement with the file for each offset.
const MIN_FEWER: usize = 3;
/// Changes below this end the iteration, rad.
const LAST_CHANGE: f64 = 1e-9;
/// Maximum number of iterations of the eigenvalue solver.
const MAX_ITERATIONS: usize = 10_000;

/// The matrix a: index 0 is the base, k + 1 drive k.
struct Phases(DMatrix<Complex<f64>>);

impl Phases {
    fn of(machine: &Machine, numbers: &IdentifiedNumbers) -> Self {
        let (n, known) = (machine.drives(), known_numbers(machine));
        let mut all = DMatrix::zeros(n + 1, n + 1);
        for i in (0..numbers.unknowns.of_balance()).step_by(2) {
            let Unknown::Of(condition, _) = numbers.unknowns.at(i) else { continue };
            // g_k turns with δ_k, C_kl with δ_l − δ_k.
            let (from, to) = match condition {
                Condition::Force(k) => (0, k + 1),
                Condition::Coupling(k, l) => (k + 1, l + 1),
            };
            let value = |of: &DVector<f64>| Vector::new(of[i], of[i + 1]);
            let (measured, file) = (value(&numbers.measured), value(&numbers.nominal));
            let variance = 0.5 * (numbers.covariance[(i, i)] + numbers.covariance[(i + 1, i + 1)]).max(0.0);
            if known[i] && numbers.identifiable[i] && numbers.identifiable[i + 1] {
                let weight = 1.0 / (variance + PHASE_TOLERANCE * PHASE_TOLERANCE * file.norm_sqr());
                let a = measured * file.conj() * weight;
                (all[(to, from)], all[(from, to)]) = (a, a.conj());
            }
        }
        Self(all)
    }

    /// Returns the offset that some drives have in common; 0 if nothing tells it.
    fn common(&self, lacks: impl Fn(usize) -> bool) -> f64 {
        let n = self.0.nrows() - 1;
        let rest: Vec<usize> = (0..=n).filter(|k| *k == 0 || !lacks(k - 1)).collect();
        let own = (0..n).filter(|k| lacks(*k)).map(|k| k + 1);
        own.flat_map(|k| rest.iter().map(move |l| self.0[(k, *l)])).sum::<Vector>().arg()
    }

    /// Returns the offset of each drive; `None` if one is not told.
    fn each(&self) -> Option<Vec<f64>> {
        let n = self.0.nrows() - 1;
        let eigen = SymmetricEigen::try_new(self.0.clone(), f64::EPSILON, MAX_ITERATIONS)?;
        let leading = eigen.eigenvectors.column(eigen.eigenvalues.imax()).clone_owned();
        let turned = |k: usize| leading[k] * leading[0].conj();
        if (1..=n).any(|k| turned(k).norm() < 1e-9) {
            return None;
        }
        let mut offsets: Vec<f64> = (0..=n).map(|k| turned(k).arg()).collect();
        offsets[0] = 0.0;
        for _ in 0..MAX_ROUNDS {
            let mut change: f64 = 0.0;
            for k in 1..=n {
                let others = (0..=n).map(|l| self.0[(k, l)] * Vector::from_polar(1.0, offsets[l]));
                let next = others.sum::<Vector>().arg();
                change = change.max(Vector::from_polar(1.0, next - offsets[k]).arg().abs());
                offsets[k] = next;
            }
            if change < LAST_CHANGE {
                break;
            }
        }
        Some(offsets.split_off(1))
    }
}

/// Angles that may count from other zeros.
struct Zeros {
    words: FaultWords,
    /// δ of each drive, rad.
    offsets: PerDrive,
}

impl Zeros {
    /// Returns those that have one offset in common, then those with offsets of their own: all alike, those after a joint,
    /// each alone, and all in different ways. `numbers` are those of a fit.
    fn all(machine: &Machine, numbers: &IdentifiedNumbers, columns: &ColumnNames) -> Vec<Self> {
        let (n, phases) = (machine.drives(), Phases::of(machine, numbers));
        let after = (1..n).map(|from| (from..n).collect::<Vec<_>>());
        let alone = (0..n.saturating_sub(1)).map(|k| vec![k]);
        let drives = [(0..n).collect()].into_iter().chain(after).chain(alone);
        let mut all: Vec<Self> = drives.filter_map(|drives| Self::common(&phases, columns, &drives)).collect();
        all.extend(phases.each().and_then(|offsets| Self::each(columns, &offsets)));
        all
    }

    /// Some angles lack the same; `None` if nearly nothing.
    fn common(phases: &Phases, columns: &ColumnNames, drives: &[usize]) -> Option<Self> {
        let n = columns.angles.len();
        let offset = Some(phases.common(|k| drives.contains(&k))).filter(|offset| offset.abs() >= MIN_OFFSET)?;
        let names = list(&drives.iter().map(|k| columns.angles[*k].clone()).collect::<Vec<_>>());
        let added = format!("{} rad added to ", number(offset));
        let (what, want) = match columns.base_angle {
            Some(base) if drives.len() == n => (
                format!("{base} and the angles of the drives count from different zeros"),
                format!("{} rad added to {base}, or {} rad to each angle of a drive", number(-offset), number(offset)),
            ),
            None if drives.len() == n && n > 1 => (
                "all angles count from another zero, or the force sensor is turned".into(),
                format!("{added}each of {names}"),
            ),
            _ if drives.len() > 1 => (format!("{names} count from another zero"), format!("{added}each of {names}")),
            _ => (format!("{names} counts from another zero"), format!("{added}{names}")),
        };
        let offsets = PerDrive::from_fn(n, |k| if drives.contains(&k) { offset } else { 0.0 });
        Some(Self { words: FaultWords { what, want, mistakes: 1 }, offsets })
    }

    /// Angles lack different offsets; `None` if at most one lacks any.
    fn each(columns: &ColumnNames, offsets: &[f64]) -> Option<Self> {
        let off: Vec<usize> = (0..offsets.len()).filter(|k| offsets[*k].abs() >= MIN_OFFSET).collect();
        let added: Vec<String> =
            off.iter().map(|k| format!("{} rad to {}", number(offsets[*k]), columns.angles[*k])).collect();
        let words = FaultWords {
            what: "the angles count from other zeros than those of the machine's file, as of encoders set to zero at the start"
                .into(),
            want: format!("zeros as in the file: by its masses, {} added", list(&added)),
            // One offset is the simpler explanation.
            mistakes: off.len() + 1,
        };
        let offsets = PerDrive::from_fn(offsets.len(), |k| if off.contains(&k) { offsets[k] } else { 0.0 });
        (off.len() > 1).then_some(Self { words, offsets })
    }

    /// Returns the number of unknowns that differ from the file beyond their intervals, with angles that count from these
    /// zeros.
    fn off(&self, machine: &Machine, numbers: &IdentifiedNumbers) -> usize {
        let unknowns = &numbers.unknowns;
        let rounding = unknowns.rounding(&Inertia::of(machine));
        let is_off = |i: usize| {
            // The measured part i, turned back: the sum of two measured values with weights.
            let (turn, pair) = match unknowns.at(i) {
                Unknown::Of(Condition::Force(k), _) => (-self.offsets[k], i ^ 1),
                Unknown::Of(Condition::Coupling(k, l), _) => (self.offsets[k] - self.offsets[l], i ^ 1),
                Unknown::Momentum(_) => (0.0, i),
            };
            let (own, other) = (turn.cos(), if i.is_multiple_of(2) { -turn.sin() } else { turn.sin() });
            let (x, c) = (&numbers.measured, &numbers.covariance);
            let (value, variance) = match pair == i {
                true => (x[i], c[(i, i)]),
                false => (
                    own * x[i] + other * x[pair],
                    own * own * c[(i, i)] + 2.0 * own * other * c[(i, pair)] + other * other * c[(pair, pair)],
                ),
            };
            (value - numbers.nominal[i]).abs() > numbers.critical * variance.max(0.0).sqrt() + rounding[i]
        };
        let is_told = |i: &usize| {
            let pair = if *i < unknowns.of_balance() { i ^ 1 } else { *i };
            numbers.identifiable[*i] && numbers.identifiable[pair]
        };
        (0..unknowns.count()).filter(is_told).filter(|i| is_off(*i)).count()
    }
}

/// Returns a number of four decimals with a true minus sign.
fn number(value: f64) -> String {
    format!("{value:.4}").replace('-', "−")
}

/// Returns the faults that angles count from other zeros than those of the machine's file. `numbers` are those of the fit as
/// given.
pub(in crate::trim) fn zero_faults(
    machine: &Machine,
    numbers: &IdentifiedNumbers,
    columns: &ColumnNames,
) -> Vec<NamedAngles> {
    let zeros = Zeros::all(machine, numbers, columns).into_iter();
    zeros.map(|zeros| (zeros.words, Angles::shifted(zeros.offsets))).collect()
}

/// Returns the zeros with which fewest numbers differ from the file, each offset counted as one; `None` if no other zeros are
/// told.
pub(in crate::trim) fn nearest_zeros(
    machine: &Machine,
    numbers: &IdentifiedNumbers,
    columns: &ColumnNames,
) -> Option<NamedAngles> {
    let zeros = Zeros::all(machine, numbers, columns).into_iter();
    let best = zeros.min_by_key(|zeros| zeros.off(machine, numbers) + zeros.words.mistakes)?;
    Some((best.words, Angles::shifted(best.offsets)))
}

/// Returns what each angle lacks, rad; `None` if that is not told.
pub(in crate::trim) fn own_zeros(machine: &Machine, numbers: &IdentifiedNumbers) -> Option<PerDrive> {
    let offsets = Phases::of(machine, numbers).each()?;
    Some(PerDrive::from_fn(offsets.len(), |k| offsets[k]))
}

/// Returns what is to be added to each angle, in words.
pub(in crate::trim) fn zeros_in_words(columns: &ColumnNames, zeros: &PerDrive) -> String {
    let added = zeros.iter().zip(&columns.angles).map(|(zero, name)| format!("{} rad added to {name}", number(*zero)));
    list(&added.collect::<Vec<_>>())
}

/// A zero of angles with which fewer unknowns differ from the machine's file.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct OtherZero {
    /// Which angles count from another zero.
    pub what: String,
    /// What to add to which column.
    pub want: String,
    /// Number of unknowns off as given.
    pub off_given: usize,
    /// Number of unknowns off with the other zero.
    pub off_then: usize,
}

/// Returns the zero with which fewest unknowns differ from the file; `None` if no other zero makes several agree.
pub(in crate::trim) fn other_zero(
    machine: &Machine,
    numbers: &IdentifiedNumbers,
    columns: &ColumnNames,
) -> Option<OtherZero> {
    let none = PerDrive::zeros(machine.drives());
    let words = FaultWords { what: String::new(), want: String::new(), mistakes: 1 };
    let given = Zeros { words, offsets: none }.off(machine, numbers);
    let zeros = Zeros::all(machine, numbers, columns).into_iter().map(|zeros| (zeros.off(machine, numbers), zeros));
    let (then, best) = zeros.min_by_key(|(off, zeros)| off + zeros.words.mistakes)?;
    let FaultWords { what, want, mistakes } = best.words;
    let is_simpler = then + MIN_FEWER * mistakes <= given;
    is_simpler.then_some(OtherZero { what, want, off_given: given, off_then: then })
}
