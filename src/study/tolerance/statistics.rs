//! Statistics of samples: quantiles, histograms, yield.
//!
//! # Source
//! Quantiles by linear interpolation between order statistics (R. J. Hyndman, Y. Fan, *Sample quantiles in statistical
//! packages* (1996), type 7). Confidence interval of a proportion: E. B. Wilson, *Probable inference, the law of
//! succession, and statistical inference* (1927).

use schemars::JsonSchema;
use serde::Serialize;

/// Quantiles of a sample.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct Quantiles {
    /// Levels, 0 to 1: the fraction of the sample below each value.
    pub levels: Vec<f64>,
    /// Value at each level.
    pub values: Vec<f64>,
}

impl Quantiles {
    /// Levels of a summary: the extremes, 1, 5, 25, 50, 75, 95, 99 %.
    pub const LEVELS: [f64; 9] = [0.0, 0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99, 1.0];

    /// Returns the quantiles of a sample in ascending order; `None` if it is empty.
    pub fn of_sorted(sorted: &[f64], levels: &[f64]) -> Option<Self> {
        let values = levels.iter().map(|level| quantile(sorted, *level)).collect::<Option<Vec<f64>>>()?;
        Some(Self { levels: levels.to_vec(), values })
    }
}

/// Returns the quantile of a sample in ascending order at a level from 0 to 1; `None` if it is empty.
pub(super) fn quantile(sorted: &[f64], level: f64) -> Option<f64> {
    let (below, above, part) = ranks(sorted.len() as u64, level)?;
    let [below, above] = [below, above].map(|rank| sorted[rank as usize]);
    Some(below + part * (above - below))
}

/// Returns the ranks, from 0, between which the quantile of a number of values lies, and its part of the way; `None` if
/// there are no values.
pub(super) fn ranks(count: u64, level: f64) -> Option<(u64, u64, f64)> {
    let last = count.checked_sub(1)?;
    let place = level.clamp(0.0, 1.0) * last as f64;
    let below = (place.floor() as u64).min(last);
    Some((below, (below + 1).min(last), place - below as f64))
}

/// Histogram of a sample, with equal intervals between its extremes; those of a summary end at edges of its bins.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct Histogram {
    /// Edges of the intervals: one more than counts.
    pub edges: Vec<f64>,
    /// Number of values in each interval; the upper edge belongs to the next interval, except for the last.
    pub counts: Vec<u64>,
}

impl Histogram {
    /// Returns the histogram of a sample in ascending order; `None` if it is empty.
    pub fn of_sorted(sorted: &[f64], bins: usize) -> Option<Self> {
        let (low, high) = (*sorted.first()?, *sorted.last()?);
        let bins = bins.max(1);
        let edge = |i: usize| if i == bins { high } else { low + (high - low) * i as f64 / bins as f64 };
        let edges: Vec<f64> = (0..=bins).map(edge).collect();
        let below = |i: usize| match i == bins {
            true => sorted.len(),
            false => sorted.partition_point(|x| *x < edges[i]),
        };
        let counts = (0..bins).map(|i| (below(i + 1) - below(i)) as u64).collect();
        Some(Self { edges, counts })
    }
}

/// Number and fraction of machines within a limit.
#[derive(Clone, Copy, Debug, PartialEq, JsonSchema, Serialize)]
pub struct Yield {
    /// Number of machines within the limit.
    pub good: u64,
    /// Number of machines.
    #[serde(rename = "of")]
    pub total: u64,
    /// Fraction within the limit, 0 to 1.
    pub share: f64,
    /// 95 % confidence interval of the true fraction.
    pub interval: [f64; 2],
}

impl Yield {
    /// Returns the yield of `good` out of `total`; for `total` = 0 the interval is 0 to 1.
    pub fn new(good: u64, total: u64) -> Self {
        if total == 0 {
            return Self { good, total, share: 0.0, interval: [0.0, 1.0] };
        }
        // 97.5 % quantile of the standard normal distribution.
        const Z: f64 = 1.959963984540054;
        let (n, p) = (total as f64, good as f64 / total as f64);
        let centre = (p + Z * Z / (2.0 * n)) / (1.0 + Z * Z / n);
        let half = Z / (1.0 + Z * Z / n) * (p * (1.0 - p) / n + Z * Z / (4.0 * n * n)).sqrt();
        let low = if good == 0 { 0.0 } else { (centre - half).max(0.0) };
        let high = if good == total { 1.0 } else { (centre + half).min(1.0) };
        Self { good, total, share: p, interval: [low, high] }
    }
}
