//! [`Bin`] and [`Octave`]: the numbers of many machines that agree in their leading bits.
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

/// Machines whose numbers are in one bin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bin {
    /// Number of machines.
    pub count: u64,
    /// The least number.
    pub least: Extreme,
    /// The greatest number.
    pub greatest: Extreme,
}

impl Bin {
    /// A bin without machines.
    pub const EMPTY: Self = Self {
        count: 0,
        least: Extreme { value: f64::INFINITY, machine: u64::MAX },
        greatest: Extreme { value: f64::NEG_INFINITY, machine: u64::MAX },
    };

    /// Adds the machines of another bin.
    #[inline]
    pub fn merge(&mut self, other: &Self) {
        self.count += other.count;
        self.least = self.least.lesser(other.least);
        self.greatest = self.greatest.greater(other.greatest);
    }

    /// Returns whether machines with numbers of this bin can bring it about.
    pub fn is_plausible(&self, bin: u64) -> bool {
        let Self { count, least, greatest } = *self;
        let within = |x: f64| x.is_finite() && x >= 0.0 && bin_of(x) == bin;
        let fits = match count {
            0 => false,
            1 => least == greatest,
            _ => least.value <= greatest.value,
        };
        fits && within(least.value) && within(greatest.value)
    }

    /// Returns whether the number at a rank is known: at both ends, or if all numbers are equal.
    pub fn is_known_at(&self, rank: u64) -> bool {
        rank == 0 || rank + 1 == self.count || self.least.value == self.greatest.value
    }

    /// Returns the number at a rank among those of this bin, from 0: exact at both ends, in between as if the others lay
    /// evenly.
    pub fn at_rank(&self, rank: u64) -> f64 {
        let (low, high) = (self.least.value, self.greatest.value);
        match self.count {
            0 | 1 => low,
            count => low + (high - low) * (rank as f64 / (count - 1) as f64),
        }
    }
}

/// Sums over machines whose numbers have one exponent. They are whole numbers, so that they are exact, in any order.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Octave {
    /// Number of machines.
    pub count: u64,
    /// Σ r.
    pub sum: u128,
    /// Σ l.
    pub low: u128,
    /// Σ u².
    pub squares: u128,
}

impl Octave {
    /// Adds a number.
    #[inline]
    pub fn add(&mut self, x: f64) {
        let r = mantissa(x);
        let u = u128::from(r >> LOW_BITS);
        self.count += 1;
        self.sum += u128::from(r);
        self.low += u128::from(r & ((1 << LOW_BITS) - 1));
        self.squares += u * u;
    }

    /// Adds the machines of another one.
    pub fn merge(&mut self, other: &Self) {
        self.count += other.count;
        self.sum += other.sum;
        self.low += other.low;
        self.squares += other.squares;
    }

    /// Returns the sums with those of another one added; `None` if they are larger than any machines have.
    pub fn checked_add(&self, other: &Self) -> Option<Self> {
        let add = |a: u128, b: u128| a.checked_add(b).filter(|sum| *sum < 1 << 126);
        Some(Self {
            count: self.count.checked_add(other.count)?,
            sum: add(self.sum, other.sum)?,
            low: add(self.low, other.low)?,
            squares: add(self.squares, other.squares)?,
        })
    }

    /// Returns whether as many numbers can have these sums, with those of bins of this octave: the least and the greatest
    /// possible sums of u and of u² follow from counts and extremes.
    pub fn is_plausible<'a>(&self, bins: impl Iterator<Item = &'a Bin>) -> bool {
        let (mut count, mut least, mut most) = (0, [0; 2], [0; 2]);
        for bin in bins {
            count += bin.count;
            let [low, high] = [bin.least, bin.greatest].map(|of| u128::from(mantissa(of.value) >> LOW_BITS));
            // The machines with the extremes count themselves.
            let others = u128::from(bin.count.saturating_sub(1));
            let once = u128::from(bin.count.min(1));
            for (i, [low, high]) in [[low, high], [low * low, high * high]].into_iter().enumerate() {
                least[i] += others * low + once * high;
                most[i] += others * high + once * low;
            }
        }
        let total = self.sum.checked_sub(self.low).map(|upper| (upper >> LOW_BITS, upper & ((1 << LOW_BITS) - 1)));
        let within = |i: usize, x: u128| (least[i]..=most[i]).contains(&x);
        count == self.count
            && self.low <= u128::from(count) << LOW_BITS
            && total.is_some_and(|(upper, rest)| rest == 0 && within(0, upper))
            && within(1, self.squares)
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
