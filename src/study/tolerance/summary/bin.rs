//! Bins and [`Octave`]s: the numbers of many machines that agree in their leading bits.
//!
//! # Symbols
//! | letter | meaning |
//! |---|---|
//! | x | a number, 0 or more, as IEEE 754 stores it: 11 bits of exponent, 52 bits of mantissa |
//! | octave | the exponent of x |
//! | bin | exponent and the upper ten bits of the mantissa of x, so that a bin is at most 0.1 % wide |
//! | r | the mantissa of x, as a whole number: x is the lower edge of its octave plus r times the last place |
//! | u, l | the upper 42 and the lower 10 bits of r |

/// Number of bits of the mantissa.
const MANTISSA_BITS: u32 = 52;

/// Number of bits of the mantissa that are in the bin.
const BIN_BITS: u32 = 10;

/// Number of bits of l.
const LOW_BITS: u32 = 10;

/// Number of bits of u.
const UPPER_BITS: u32 = MANTISSA_BITS - LOW_BITS;

/// Largest relative width of a bin of numbers that are not subnormal.
pub const BIN_WIDTH: f64 = 1.0 / (1 << BIN_BITS) as f64;

/// Number of octaves of finite numbers.
pub const OCTAVES: u64 = 0x7ff;

/// Number of bins of an octave.
pub const OCTAVE_BINS: u64 = 1 << BIN_BITS;

/// Returns the bin of a number that is 0 or more.
pub fn bin_of(x: f64) -> u64 {
    // Zero may have a sign.
    (x + 0.0).to_bits() >> (MANTISSA_BITS - BIN_BITS)
}

/// Returns the lower edge of a bin.
pub fn lower_edge(bin: u64) -> f64 {
    f64::from_bits(bin << (MANTISSA_BITS - BIN_BITS))
}

/// Returns r of a number.
fn mantissa(x: f64) -> u64 {
    (x + 0.0).to_bits() & ((1 << MANTISSA_BITS) - 1)
}

/// A number with the machine that has it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extreme {
    /// The number.
    pub value: f64,
    /// Sample number of the machine; of several machines the first.
    pub machine: u64,
}

impl Extreme {
    fn lesser(self, other: Self) -> Self {
        let first = other.value == self.value && other.machine < self.machine;
        if other.value < self.value || first { other } else { self }
    }

    fn greater(self, other: Self) -> Self {
        let first = other.value == self.value && other.machine < self.machine;
        if other.value > self.value || first { other } else { self }
    }
}

/// Machines whose numbers have one exponent: their extremes and their sums, which are whole numbers, so that they are exact
/// in any order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Octave {
    /// Number of machines.
    pub count: u64,
    /// The least number.
    pub least: Extreme,
    /// The greatest number.
    pub greatest: Extreme,
    /// Σ r.
    pub sum: u128,
    /// Σ l.
    pub low: u128,
    /// Σ u².
    pub squares: u128,
}

impl Octave {
    /// An octave without machines.
    pub const EMPTY: Self = Self {
        count: 0,
        least: Extreme { value: f64::INFINITY, machine: u64::MAX },
        greatest: Extreme { value: f64::NEG_INFINITY, machine: u64::MAX },
        sum: 0,
        low: 0,
        squares: 0,
    };

    /// Adds the number of a machine.
    #[inline]
    pub fn add(&mut self, x: f64, machine: u64) {
        let r = mantissa(x);
        let u = u128::from(r >> LOW_BITS);
        let here = Extreme { value: x + 0.0, machine };
        self.count += 1;
        self.least = self.least.lesser(here);
        self.greatest = self.greatest.greater(here);
        self.sum += u128::from(r);
        self.low += u128::from(r & ((1 << LOW_BITS) - 1));
        self.squares += u * u;
    }

    /// Adds the machines of another one. Sums of a stranger's file may be too large; then they are no longer plausible.
    pub fn merge(&mut self, other: &Self) {
        self.count = self.count.saturating_add(other.count);
        self.least = self.least.lesser(other.least);
        self.greatest = self.greatest.greater(other.greatest);
        self.sum = self.sum.saturating_add(other.sum);
        self.low = self.low.saturating_add(other.low);
        self.squares = self.squares.saturating_add(other.squares);
    }

    /// Returns whether machines with numbers of this octave, counted by bin in ascending order, can bring it about. The
    /// extremes lie in the outer bins; counts of bins bound the sums of u and of u².
    pub fn is_plausible(&self, octave: u64, bins: &[u64]) -> bool {
        let filled = || (octave * OCTAVE_BINS..).zip(bins).filter(|(_, count)| **count > 0).map(|(bin, _)| bin);
        let Self { count, least, greatest, sum, low, squares } = *self;
        let is_within = |extreme: Extreme, bin: Option<u64>| {
            let x = extreme.value;
            x.is_finite() && x >= 0.0 && Some(bin_of(x)) == bin
        };
        let are_extremes = match count {
            0 => false,
            1 => least == greatest,
            _ => least.value < greatest.value || least == greatest,
        };
        let (mut total, mut smallest, mut largest) = (0_u128, [0_u128; 2], [0_u128; 2]);
        for (bin, machines) in (0..).zip(bins) {
            let (from, machines) = (bin << (UPPER_BITS - BIN_BITS), u128::from(*machines));
            let to = from + (1_u128 << (UPPER_BITS - BIN_BITS)) - 1;
            total += machines;
            for (i, [from, to]) in [[from, to], [from * from, to * to]].into_iter().enumerate() {
                // Counts of a stranger's file may be any.
                smallest[i] = smallest[i].saturating_add(machines.saturating_mul(from));
                largest[i] = largest[i].saturating_add(machines.saturating_mul(to));
            }
        }
        let upper =
            sum.checked_sub(low).filter(|upper| upper.trailing_zeros() >= LOW_BITS).map(|upper| upper >> LOW_BITS);
        let within = |i: usize, x: u128| (smallest[i]..=largest[i]).contains(&x);
        are_extremes
            && is_within(least, filled().next())
            && is_within(greatest, filled().last())
            && total == u128::from(count)
            && low <= u128::from(count) << LOW_BITS
            && upper.is_some_and(|upper| within(0, upper))
            && within(1, squares)
    }

    /// Returns the sum of the numbers of an octave, exact but for one rounding.
    pub fn total(&self, octave: u64) -> f64 {
        let hidden = if octave > 0 { 1_u128 << MANTISSA_BITS } else { 0 };
        last_place(octave) * (hidden * u128::from(self.count) + self.sum) as f64
    }

    /// Returns the sum of the squares of the differences from a mean. The numbers count with 43 bits.
    pub fn squares_about(&self, octave: u64, mean: f64) -> f64 {
        if self.count == 0 {
            return 0.0;
        }
        let count = u128::from(self.count);
        let sum = (self.sum - self.low) >> LOW_BITS;
        // About a number among them all is exact; to another mean it is a shift.
        let near = sum / count;
        let about = (self.squares + count * near * near).saturating_sub(2 * near * sum);
        let off = sum - near * count;
        let place = last_place(octave) * f64::from(1 << LOW_BITS);
        // The lower bits are on average as they are.
        let lower = self.low as f64 / self.count as f64 * last_place(octave);
        let shift = f64::from_bits((octave << MANTISSA_BITS) | ((near as u64) << LOW_BITS)) - mean + lower;
        place * place * about as f64 + 2.0 * shift * place * off as f64 + self.count as f64 * shift * shift
    }
}

/// Returns the value of the last place of the numbers of an octave.
fn last_place(octave: u64) -> f64 {
    // 2 to the power of exponent − 1075, in two factors, of which neither is too small.
    f64::from_bits(octave.max(1) << MANTISSA_BITS) * (1.0 / (1_u64 << MANTISSA_BITS) as f64)
}
