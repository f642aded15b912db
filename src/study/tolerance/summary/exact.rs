//! [`Recount`]: machines of a summary that are drawn again, for quantiles that are exact ([`BinValues`], [`KnownRanks`]) and
//! for limits that it did not count.

use std::collections::BTreeMap;

use super::super::SampleOutcome;
use super::Limits;
use super::bin::bin_of;

/// A bin of one of the numbers of an outcome: the place of the number, then the bin.
pub type BinPlace = (usize, u64);

/// Largest number of values that are kept at once, 8 bytes each; of bins with more, quantiles are not found exactly.
pub const MAX_VALUES: u64 = 16_000_000;

/// The numbers of some bins.
#[derive(Clone, Debug, Default)]
pub struct BinValues {
    values: BTreeMap<BinPlace, Vec<f64>>,
}

impl BinValues {
    /// Returns collections without numbers, one for each pass over the machines, for bins with their counts. One pass keeps
    /// at most [`MAX_VALUES`], or one bin.
    pub fn passes(bins: &BTreeMap<BinPlace, u64>) -> Vec<Self> {
        let (mut passes, mut room) = (Vec::<Self>::new(), 0);
        for (place, count) in bins {
            if passes.is_empty() || *count > room {
                passes.push(Self::default());
                room = MAX_VALUES;
            }
            room = room.saturating_sub(*count);
            passes.last_mut().into_iter().for_each(|pass| {
                pass.values.insert(*place, Vec::new());
            });
        }
        passes
    }

    /// Makes room for the numbers of bins with their counts.
    pub fn reserve(&mut self, bins: &BTreeMap<BinPlace, u64>) {
        for (place, values) in &mut self.values {
            values.reserve_exact(bins.get(place).map_or(0, |count| *count as usize));
        }
    }

    /// Keeps the numbers of machines that fall into the bins.
    fn add(&mut self, outcomes: &[SampleOutcome]) {
        for ((number, bin), values) in &mut self.values {
            let all = outcomes.iter().map(|outcome| outcome.numbers()[*number]);
            values.extend(all.filter(|x| bin_of(*x) == *bin));
        }
    }

    /// Takes over the numbers of another collection of the same bins, which keeps its bins.
    fn take_over(&mut self, other: &mut Self) {
        for (place, values) in &mut other.values {
            self.values.entry(*place).or_default().append(values);
        }
    }

    /// Returns the numbers of each bin, sorted.
    pub(super) fn into_sorted(mut self) -> BTreeMap<BinPlace, Vec<f64>> {
        self.values.values_mut().for_each(|values| values.sort_unstable_by(f64::total_cmp));
        self.values
    }
}

/// What is kept of machines that are drawn again.
#[derive(Clone, Debug, Default)]
pub struct Recount {
    /// The numbers of some bins.
    pub values: BinValues,
    /// Limits within which machines are counted.
    pub limits: Limits,
    /// Number of machines within the limit of the moment, that of the force, and both.
    pub kept: [u64; 3],
    /// Number of machines since the last [`take_over`](Self::take_over).
    pub waiting: u64,
}

impl Recount {
    /// Adds machines.
    pub fn add(&mut self, outcomes: &[SampleOutcome]) {
        self.values.add(outcomes);
        if self.limits != Limits::default() {
            outcomes.iter().for_each(|outcome| self.limits.count(outcome, &mut self.kept));
        }
        self.waiting += outcomes.len() as u64;
    }

    /// Takes over what another one with the same bins and limits kept, so that it goes on without machines.
    pub fn take_over(&mut self, other: &mut Self) {
        self.values.take_over(&mut other.values);
        self.kept.iter_mut().zip(std::mem::take(&mut other.kept)).for_each(|(own, kept)| *own += kept);
        other.waiting = 0;
    }
}

/// Exact numbers at some ranks of bins.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct KnownRanks {
    pub(super) values: BTreeMap<(BinPlace, u64), f64>,
}
