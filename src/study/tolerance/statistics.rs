//! Distributions of what was sampled: quantiles, histograms, yield.
//!
//! # Source
//! Quantiles by linear interpolation between order statistics (R. J. Hyndman, Y. Fan, *Sample quantiles in statistical
//! packages* (1996), type 7). Interval of a share: E. B. Wilson, *Probable inference, the law of succession, and
//! statistical inference* (1927).

use serde::Serialize;

/// Quantiles of a sample.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Quantiles {
    /// Which shares lie below, 0 to 1.
    pub levels: Vec<f64>,
    /// What they lie below.
    pub values: Vec<f64>,
}

impl Quantiles {
    /// The levels of a summary: the extremes, 1, 5, 25, 50, 75, 95, 99 %.
    pub const LEVELS: [f64; 9] = [0.0, 0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99, 1.0];

    /// Of a sample in rising order, `None` if it is empty.
    pub fn of_sorted(sorted: &[f64], levels: &[f64]) -> Option<Self> {
        let values = levels.iter().map(|level| quantile(sorted, *level)).collect::<Option<Vec<f64>>>()?;
        Some(Self { levels: levels.to_vec(), values })
    }
}

/// The value below which a share of a sample in rising order lies; `None` if it is empty.
pub(super) fn quantile(sorted: &[f64], level: f64) -> Option<f64> {
    let last = sorted.len().checked_sub(1)?;
    let place = level.clamp(0.0, 1.0) * last as f64;
    let below = (place.floor() as usize).min(last);
    let above = (below + 1).min(last);
    Some(sorted[below] + (place - below as f64) * (sorted[above] - sorted[below]))
}

/// How many of a sample lie in equal intervals between its extremes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Histogram {
    /// Ends of the intervals: one more than counts.
    pub edges: Vec<f64>,
    /// How many lie in each; its upper end belongs to the next, but for the last.
    pub counts: Vec<u64>,
}

impl Histogram {
    /// Of a sample in rising order, `None` if it is empty.
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

/// How many keep within a limit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Yield {
    /// How many do.
    pub good: u64,
    /// Of how many.
    pub of: u64,
    /// Their share, 0 to 1.
    pub share: f64,
    /// Between these the true share lies, with 95 % confidence.
    pub interval: [f64; 2],
}

impl Yield {
    /// `good` of `of`; of none nothing is known.
    pub fn new(good: u64, of: u64) -> Self {
        if of == 0 {
            return Self { good, of, share: 0.0, interval: [0.0, 1.0] };
        }
        // The normal deviate of 97.5 %.
        const Z: f64 = 1.959963984540054;
        let (n, p) = (of as f64, good as f64 / of as f64);
        let centre = (p + Z * Z / (2.0 * n)) / (1.0 + Z * Z / n);
        let half = Z / (1.0 + Z * Z / n) * (p * (1.0 - p) / n + Z * Z / (4.0 * n * n)).sqrt();
        let low = if good == 0 { 0.0 } else { (centre - half).max(0.0) };
        let high = if good == of { 1.0 } else { (centre + half).min(1.0) };
        Self { good, of, share: p, interval: [low, high] }
    }
}
