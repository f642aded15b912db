//! Spread of n_B(t) and |f_B|(t) over the random machines: exact where possible, to first order, and sampled.
//!
//! Mean and variance of n_B and of f_B's components are exact: from mean and covariance of the constants. The mean
//! and the standard deviation of |f_B| have no such closed form. A norm is not linear, and it has no first-order
//! expansion where the nominal f_B is zero. So these two and all percentiles are sampled. [`Agreement`] compares
//! first-order with other results.

use schemars::JsonSchema;
use serde::Serialize;

use super::deviate::CHUNK;
use super::ensemble::Ensemble;
use super::statistics::quantile;

/// Percentiles of a band.
pub const PERCENTILES: [f64; 5] = [5.0, 25.0, 50.0, 75.0, 95.0];

/// Bands of moment and force over time.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct Bands {
    /// Instants, s.
    pub time: Vec<f64>,
    /// Number of machines sampled for percentiles: the first ones that the seed gives.
    pub samples: u64,
    /// n_B, N m.
    pub moment: MomentBand,
    /// |f_B|, dynamic, N.
    pub force: ForceBand,
}

/// Band of n_B over time, N m.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct MomentBand {
    /// n_B of the nominal machine: the mean to first order, unless distributions are truncated.
    pub nominal: Vec<f64>,
    /// Exact mean.
    pub mean: Vec<f64>,
    /// Exact standard deviation.
    pub deviation: Vec<f64>,
    /// Standard deviation to first order.
    pub first_order_deviation: Vec<f64>,
    /// Sampled mean.
    pub sampled_mean: Vec<f64>,
    /// Sampled standard deviation.
    pub sampled_deviation: Vec<f64>,
    /// Sampled percentiles, by [`PERCENTILES`], then by instant.
    pub percentiles: Vec<Vec<f64>>,
}

/// Band of |f_B| over time, N.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct ForceBand {
    /// |f_B| of the nominal machine: the mean to first order.
    pub nominal: Vec<f64>,
    /// Exact root mean square over the machines.
    pub rms: Vec<f64>,
    /// Root mean square with the components of f_B to first order.
    pub first_order_rms: Vec<f64>,
    /// First-order standard deviation of the component along the nominal f_B; 0 where the nominal f_B is zero.
    pub first_order_deviation: Vec<f64>,
    /// Sampled mean.
    pub sampled_mean: Vec<f64>,
    /// Sampled standard deviation.
    pub sampled_deviation: Vec<f64>,
    /// Sampled percentiles, by [`PERCENTILES`], then by instant.
    pub percentiles: Vec<Vec<f64>>,
}

/// Maximum number of machines sampled for percentiles.
const MAX_MACHINES: u64 = 4096;

/// Maximum number of stored values, machines times instants; exceeded if it would allow fewer than a hundred machines.
const MAX_STORED_VALUES: u64 = 4_000_000;

impl Bands {
    /// Computes the bands of an ensemble, with percentiles of its first `samples` machines. At most 4096 machines are
    /// sampled, fewer if there are many instants.
    pub fn of(ensemble: &Ensemble, samples: u64) -> Self {
        let count = ensemble.time().len();
        let samples = samples.clamp(1, MAX_MACHINES).min((MAX_STORED_VALUES / count as u64).max(100));
        let (mut moments, mut forces) = (vec![Vec::new(); count], vec![Vec::new(); count]);
        let mut sampler = ensemble.sampler();
        for chunk in 0..samples.div_ceil(CHUNK as u64) {
            sampler.courses(chunk, |s, machine, n, f| {
                if chunk * (CHUNK as u64) + (machine as u64) < samples {
                    moments[s].push(n);
                    forces[s].push(f);
                }
            });
        }
        let [moments, forces] = [moments, forces].map(|courses| courses.into_iter().map(Sampled::of).collect());
        Self {
            time: ensemble.time().to_vec(),
            samples,
            moment: MomentBand::of(ensemble, moments),
            force: ForceBand::of(ensemble, forces),
        }
    }
}

/// Sample statistics at one instant.
struct Sampled {
    mean: f64,
    deviation: f64,
    percentiles: [f64; PERCENTILES.len()],
}

impl Sampled {
    fn of(mut values: Vec<f64>) -> Self {
        values.sort_unstable_by(f64::total_cmp);
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let squares: f64 = values.iter().map(|x| (x - mean).powi(2)).sum();
        Self {
            mean,
            deviation: (squares / (n - 1.0).max(1.0)).sqrt(),
            percentiles: PERCENTILES.map(|p| quantile(&values, p / 100.0).unwrap_or(mean)),
        }
    }
}

/// Returns the percentiles by level, then by instant.
fn by_percentile(sampled: &[Sampled]) -> Vec<Vec<f64>> {
    (0..PERCENTILES.len()).map(|i| sampled.iter().map(|s| s.percentiles[i]).collect()).collect()
}

/// Returns the first-order variance Σ_p (slope_p σ_p)².
fn first_order(ensemble: &Ensemble, slopes: impl Fn(usize) -> f64) -> f64 {
    ensemble.parameters().iter().enumerate().map(|(p, parameter)| (slopes(p) * parameter.deviation).powi(2)).sum()
}

impl MomentBand {
    fn of(ensemble: &Ensemble, sampled: Vec<Sampled>) -> Self {
        let at = |f: &dyn Fn(usize) -> f64| (0..sampled.len()).map(f).collect::<Vec<f64>>();
        Self {
            nominal: at(&|s| ensemble.nominal()[s].0),
            mean: at(&|s| ensemble.mean_at(s).0),
            deviation: at(&|s| ensemble.variance_at(s)[0].sqrt()),
            first_order_deviation: at(&|s| {
                let [slope, ..] = ensemble.slopes_at(s);
                first_order(ensemble, |p| slope[p]).sqrt()
            }),
            sampled_mean: sampled.iter().map(|s| s.mean).collect(),
            sampled_deviation: sampled.iter().map(|s| s.deviation).collect(),
            percentiles: by_percentile(&sampled),
        }
    }
}

impl ForceBand {
    fn of(ensemble: &Ensemble, sampled: Vec<Sampled>) -> Self {
        let at = |f: &dyn Fn(usize) -> f64| (0..sampled.len()).map(f).collect::<Vec<f64>>();
        Self {
            nominal: at(&|s| ensemble.nominal()[s].1.norm()),
            rms: at(&|s| {
                let [_, x, y] = ensemble.variance_at(s);
                (ensemble.mean_at(s).1.norm_sqr() + x + y).sqrt()
            }),
            first_order_rms: at(&|s| {
                let [_, x, y] = ensemble.slopes_at(s);
                let variance = first_order(ensemble, |p| x[p].hypot(y[p]));
                (ensemble.nominal()[s].1.norm_sqr() + variance).sqrt()
            }),
            first_order_deviation: at(&|s| {
                let ([_, x, y], f) = (ensemble.slopes_at(s), ensemble.nominal()[s].1);
                // The nominal f_B of a balanced machine consists of rounding errors and has no direction.
                let all = first_order(ensemble, |p| x[p].hypot(y[p])).sqrt();
                if f.norm() <= 1e-9 * all {
                    return 0.0;
                }
                let along = f / f.norm();
                first_order(ensemble, |p| along.re * x[p] + along.im * y[p]).sqrt()
            }),
            sampled_mean: sampled.iter().map(|s| s.mean).collect(),
            sampled_deviation: sampled.iter().map(|s| s.deviation).collect(),
            percentiles: by_percentile(&sampled),
        }
    }
}

/// Difference of two results over time, in standard deviations at each instant unless stated otherwise.
#[derive(Clone, Copy, Debug, Default, PartialEq, JsonSchema, Serialize)]
pub struct BandDifference {
    /// Largest difference.
    #[serde(rename = "worst")]
    pub largest: f64,
    /// Time of the largest difference, s.
    pub time: f64,
    /// Fraction of the instants at which the difference exceeds the tolerance of [`Agreement`].
    pub share: f64,
}

/// Agreement of first-order results with exact or sampled ones.
#[derive(Clone, Copy, Debug, PartialEq, JsonSchema, Serialize)]
pub struct Agreement {
    /// Tolerance if neither result is sampled, in standard deviations.
    pub tolerance: f64,
    /// Tolerance if one result is sampled: at least four standard errors, in standard deviations.
    pub sampled_tolerance: f64,
    /// Mean of n_B: nominal against exact.
    pub moment_mean: BandDifference,
    /// Standard deviation of n_B: first-order against exact.
    pub moment_deviation: BandDifference,
    /// Root mean square of |f_B|: with first-order components against exact, as a fraction of the exact one.
    pub force_rms: BandDifference,
    /// Mean of |f_B|: nominal against sampled.
    pub force_mean: BandDifference,
    /// Standard deviation of |f_B|: first-order against sampled.
    pub force_deviation: BandDifference,
    /// Mean of n_B: sampled against exact. This is the sampling error alone, without first-order errors.
    pub sampling: BandDifference,
}

impl Agreement {
    /// Compares the results in the bands.
    pub fn of(bands: &Bands) -> Self {
        let Bands { time, samples, moment, force } = bands;
        let tolerance = 0.05;
        let sampled_tolerance = (4.0 / (*samples as f64).sqrt()).max(tolerance);
        let gap = |a: &[f64], b: &[f64], deviation: &[f64], tolerance: f64| {
            // Instants at which the machines hardly differ are ignored.
            let least = 1e-6 * deviation.iter().fold(0.0_f64, |m, d| m.max(*d));
            let mut gap = BandDifference::default();
            for (s, t) in time.iter().enumerate().filter(|(s, _)| deviation[*s] > least) {
                let apart = (a[s] - b[s]).abs() / deviation[s];
                if apart > gap.largest {
                    (gap.largest, gap.time) = (apart, *t);
                }
                gap.share += f64::from(u8::from(apart > tolerance)) / time.len() as f64;
            }
            gap
        };
        Self {
            tolerance,
            sampled_tolerance,
            moment_mean: gap(&moment.nominal, &moment.mean, &moment.deviation, tolerance),
            moment_deviation: gap(&moment.first_order_deviation, &moment.deviation, &moment.deviation, tolerance),
            force_rms: gap(&force.first_order_rms, &force.rms, &force.rms, tolerance),
            force_mean: gap(&force.nominal, &force.sampled_mean, &force.sampled_deviation, sampled_tolerance),
            force_deviation: gap(
                &force.first_order_deviation,
                &force.sampled_deviation,
                &force.sampled_deviation,
                sampled_tolerance,
            ),
            sampling: gap(&moment.sampled_mean, &moment.mean, &moment.deviation, sampled_tolerance),
        }
    }
}
