//! [`BinValues`]: the numbers of some bins one by one, for quantiles that are exact, which [`KnownRanks`] keeps.

use std::collections::BTreeMap;

use super::super::SampleOutcome;
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
    pub fn add(&mut self, outcomes: &[SampleOutcome]) {
        for ((number, bin), values) in &mut self.values {
            let all = outcomes.iter().map(|outcome| outcome.numbers()[*number]);
            values.extend(all.filter(|x| bin_of(*x) == *bin));
        }
    }

    /// Takes over the numbers of another collection of the same bins, which keeps its bins.
    pub fn take_over(&mut self, other: &mut Self) {
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

/// Exact numbers at some ranks of bins.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct KnownRanks {
    pub(super) values: BTreeMap<(BinPlace, u64), f64>,
}
