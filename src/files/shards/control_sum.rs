//! [`ControlSum`]: a sum over what a table counts, which adds up as the table does.
//!
//! Whatever engine adds up rows, a count or digit that was changed or lost on the way no longer fits it, but for one chance
//! in two thousand million.

use stillbase_study::tolerance::{OCTAVE_BINS, Octave};

/// A prime just below 2³¹. The next, 2³¹ − 1, would not tell a digit to the base 2³¹ from the next digit.
const PRIME: u64 = 2_147_483_629;

/// A sum of counts with their weights, modulo a prime. It must never change, because files store it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct ControlSum(u64);

/// Returns the weight of what is counted at a place: any number from 1 to the prime, exclusive.
fn weight(place: u64) -> u64 {
    // Neighbours must have unlike weights, as if drawn by chance: the finalizer of SplitMix64.
    let mut x = place.wrapping_add(0x9e37_79b9_7f4a_7c15);
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    1 + (x ^ (x >> 31)) % (PRIME - 1)
}

/// Places of what is counted: of a number of an outcome its bins, then count and sums of each octave; limits and machines are after all.
const PLACES: u64 = 1 << 32;
const COUNT: u64 = 1 << 31;
const LIMIT: u64 = 1 << 40;
const MACHINES: u64 = 1 << 41;

impl ControlSum {
    /// Returns the sum of a column, which may have been added up over parts.
    pub fn of_column(sum: u64) -> Self {
        Self(sum % PRIME)
    }

    /// Returns the sum of an octave of a number of an outcome, at its exponent, with the numbers of machines of its bins.
    pub fn of_octave(number: usize, at: u64, octave: &Octave, bins: &[u64]) -> Self {
        let from = number as u64 * PLACES + at * OCTAVE_BINS;
        let mut sum = Self::default();
        let Octave { count, sum: total, low, squares, .. } = *octave;
        for (place, x) in (from + COUNT..).zip([count.into(), total, low, squares]) {
            sum.count(place, x);
        }
        for (place, machines) in (from..).zip(bins) {
            sum.count(place, u128::from(*machines));
        }
        sum
    }

    /// Returns the sum of the machines within one of the limits, whose value it is.
    pub fn of_limit(limit: usize, value: f64, count: u64) -> Self {
        let mut sum = Self::default();
        sum.count(LIMIT + limit as u64, u128::from(count));
        sum.count(value.to_bits() ^ LIMIT, u128::from(count));
        sum
    }

    /// Returns the sum of consecutive machines, by the number of the first.
    pub fn of_machines(first: u64, count: u64) -> Self {
        let mut sum = Self::default();
        sum.count(MACHINES + first, u128::from(count));
        sum
    }

    fn count(&mut self, place: u64, x: u128) {
        let rest = (x % u128::from(PRIME)) as u64;
        self.0 = (self.0 + weight(place) * rest) % PRIME;
    }

    /// Adds another sum.
    pub fn add(&mut self, other: Self) {
        self.0 = (self.0 + other.0) % PRIME;
    }

    /// Returns the sum, below 2³¹.
    pub fn total(self) -> u64 {
        self.0
    }
}
