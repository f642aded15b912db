//! Results over many machines: distributions, fractions within limits, and simulation against perfect tracking.

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::Serialize;
use std::borrow::Cow;

use super::ensemble::SampleOutcome;
use super::statistics::{Histogram, Quantiles, Yield};

/// Distribution of a quantity over all machines.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct Distribution {
    /// Mean.
    pub mean: f64,
    /// Standard deviation.
    pub deviation: f64,
    /// Quantiles at [`Quantiles::LEVELS`].
    pub quantiles: Quantiles,
    /// Largest relative error of the quantiles between the extremes, where they come from bins.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub quantile_error: Option<f64>,
    /// The machines with the least and with the greatest value, by their sample numbers; of a summary.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub extreme_machines: Option<[u64; 2]>,
    /// Histogram with equal intervals between the extremes, or with inner edges at those of bins.
    pub histogram: Histogram,
}

/// Number of intervals of a histogram.
const BINS: usize = 50;

impl Distribution {
    fn of(mut values: Vec<f64>) -> Option<Self> {
        values.sort_unstable_by(f64::total_cmp);
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let squares: f64 = values.iter().map(|x| (x - mean).powi(2)).sum();
        Some(Self {
            mean,
            deviation: (squares / (n - 1.0).max(1.0)).sqrt(),
            quantiles: Quantiles::of_sorted(&values, &Quantiles::LEVELS)?,
            quantile_error: None,
            extreme_machines: None,
            histogram: Histogram::of_sorted(&values, BINS)?,
        })
    }
}

/// Distributions of the four quantities of an outcome.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(into = "StatedDistributions")]
pub struct Distributions {
    /// Largest |n_B|, N m.
    pub peak_moment: Distribution,
    /// Largest dynamic |f_B|, N.
    pub peak_force: Distribution,
    /// Root mean square of n_B over time, N m.
    pub rms_moment: Distribution,
    /// Root mean square of the dynamic |f_B| over time, N.
    pub rms_force: Distribution,
}

/// How distributions are serialised: all four, and each once more under an older name that version 0.3 drops.
#[derive(JsonSchema, Serialize)]
struct StatedDistributions {
    peak_base_moment: Distribution,
    peak_base_force: Distribution,
    rms_base_moment: Distribution,
    rms_base_force: Distribution,
    peak_moment: Distribution,
    peak_force: Distribution,
    rms_moment: Distribution,
    rms_force: Distribution,
}

impl From<Distributions> for StatedDistributions {
    fn from(Distributions { peak_moment, peak_force, rms_moment, rms_force }: Distributions) -> Self {
        Self {
            peak_base_moment: peak_moment.clone(),
            peak_base_force: peak_force.clone(),
            rms_base_moment: rms_moment.clone(),
            rms_base_force: rms_force.clone(),
            peak_moment,
            peak_force,
            rms_moment,
            rms_force,
        }
    }
}

impl JsonSchema for Distributions {
    fn schema_name() -> Cow<'static, str> {
        StatedDistributions::schema_name()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        StatedDistributions::json_schema(generator)
    }
}

impl Distributions {
    /// Returns the distributions over machines; `None` if there are none.
    pub fn of(outcomes: &[SampleOutcome]) -> Option<Self> {
        let of = |f: fn(&SampleOutcome) -> f64| Distribution::of(outcomes.iter().map(f).collect());
        Some(Self {
            peak_moment: of(|o| o.peak_moment)?,
            peak_force: of(|o| o.peak_force)?,
            rms_moment: of(|o| o.rms_moment)?,
            rms_force: of(|o| o.rms_force)?,
        })
    }
}

/// Number of machines within a limit.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct LimitYield {
    /// Limit, N m or N; `None` if two limits apply together.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub limit: Option<f64>,
    /// Number and fraction of machines.
    #[serde(flatten)]
    pub count: Yield,
}

/// Numbers of machines within the given limits.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct Yields {
    /// Within the limit on peak |n_B|, N m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub moment: Option<LimitYield>,
    /// Within the limit on peak |f_B|, N.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub force: Option<LimitYield>,
    /// Within both limits.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub both: Option<LimitYield>,
}

impl Yields {
    /// Counts machines within limits on peak |n_B|, N m, and peak |f_B|, N.
    pub fn of(outcomes: &[SampleOutcome], moment: Option<f64>, force: Option<f64>) -> Self {
        let count = |good: &dyn Fn(&SampleOutcome) -> bool| {
            Yield::new(outcomes.iter().filter(|o| good(o)).count() as u64, outcomes.len() as u64)
        };
        let kept = |limit: Option<f64>, of: fn(&SampleOutcome) -> f64| {
            limit.map(|most| LimitYield { limit, count: count(&|o| of(o) <= most) })
        };
        let both = moment
            .zip(force)
            .map(|(n, f)| LimitYield { limit: None, count: count(&|o| o.peak_moment <= n && o.peak_force <= f) });
        Self { moment: kept(moment, |o| o.peak_moment), force: kept(force, |o| o.peak_force), both }
    }
}

/// Comparison of simulated machines with the same ones under perfect tracking.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct TrackingComparison {
    /// Largest difference of peak |n_B|, N m.
    pub peak_moment_difference: f64,
    /// Largest difference of peak |f_B|, N.
    pub peak_force_difference: f64,
    /// Ratio of the mean peak |n_B|: simulated to perfect tracking.
    pub peak_moment_ratio: f64,
    /// Ratio of the mean peak |f_B|: simulated to perfect tracking.
    pub peak_force_ratio: f64,
}

impl TrackingComparison {
    /// Compares the same machines in the same order; `None` if nothing was simulated.
    pub fn of(simulated: &[SampleOutcome], tracking: &[SampleOutcome]) -> Option<Self> {
        if tracking.is_empty() {
            return None;
        }
        let difference = |of: fn(&SampleOutcome) -> f64| {
            simulated.iter().zip(tracking).map(|(a, b)| (of(a) - of(b)).abs()).fold(0.0, f64::max)
        };
        let ratio = |of: fn(&SampleOutcome) -> f64| {
            let sum = |all: &[SampleOutcome]| all.iter().map(of).sum::<f64>();
            if sum(tracking) > 0.0 { sum(simulated) / sum(tracking) } else { 1.0 }
        };
        Some(Self {
            peak_moment_difference: difference(|o| o.peak_moment),
            peak_force_difference: difference(|o| o.peak_force),
            peak_moment_ratio: ratio(|o| o.peak_moment),
            peak_force_ratio: ratio(|o| o.peak_force),
        })
    }
}
