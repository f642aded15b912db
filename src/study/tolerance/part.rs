//! [`PartReport`]: results of a part of the machines of a study, or of all of them.

use std::ops::Range;

use schemars::JsonSchema;
use serde::Serialize;

use super::{
    Agreement, Bands, Distributions, Ensemble, GoesOn, Limits, SampleOutcome, Shares, TrackingComparison,
    UncertainParameter, Yields, simulate,
};
use stillbase_session::{Refusal, Run};

/// Consecutive machines of an ensemble.
#[derive(Clone, Debug)]
pub struct EnsemblePart<'a> {
    /// The run whose planned motion the machines perform.
    pub run: &'a Run,
    /// The ensemble that they were drawn from.
    pub ensemble: &'a Ensemble,
    /// Number of machines in the whole study.
    pub samples: u64,
    /// Sample numbers of this part.
    pub machines: Range<u64>,
    /// Whether the machines were simulated.
    pub simulated: bool,
}

/// Results of some machines.
#[derive(Clone, Debug, PartialEq)]
pub struct PartResults {
    /// Distributions of peaks and root mean squares.
    pub distributions: Distributions,
    /// Fractions of machines within limits.
    pub yields: Yields,
    /// Comparison of the simulation with perfect tracking.
    pub against_tracking: Option<TrackingComparison>,
}

impl PartResults {
    /// Returns the results of machines from their outcomes and, if they were simulated, those with perfect tracking; `None`
    /// if there are no machines.
    pub fn of(outcomes: &[SampleOutcome], tracking: &[SampleOutcome], limits: Limits) -> Option<Self> {
        Some(Self {
            distributions: Distributions::of(outcomes)?,
            yields: Yields::of(outcomes, limits.moment, limits.force),
            against_tracking: TrackingComparison::of(outcomes, tracking),
        })
    }
}

/// Results of a part of the machines.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct PartReport {
    /// Name of the scenario.
    pub scenario: String,
    /// Whether the machines were simulated; otherwise they track perfectly.
    pub simulated: bool,
    /// Number of machines in the whole study.
    pub samples: u64,
    /// First sample number of this part, and its last plus one.
    pub shard: [u64; 2],
    /// Seed of the random machines.
    pub seed: u64,
    /// Duration of the motion, s.
    pub duration: f64,
    /// The same, under an older name that version 0.3 drops.
    pub motion_time: f64,
    /// Parameters that vary.
    pub parameters: Vec<UncertainParameter>,
    /// Outcome of the machine without deviations, with perfect tracking or simulated like the others.
    pub nominal: SampleOutcome,
    /// Distributions of peaks and root mean squares.
    #[serde(flatten)]
    pub distributions: Distributions,
    /// Fractions of machines within limits.
    #[serde(rename = "yield")]
    pub yields: Yields,
    /// Contribution of each tolerance.
    pub shares: Shares,
    /// n_B and |f_B| over time.
    pub bands: Bands,
    /// Agreement of first-order results with exact and sampled ones.
    pub agreement: Agreement,
    /// Comparison of the simulation with perfect tracking.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub against_tracking: Option<TrackingComparison>,
}

impl PartReport {
    /// Returns the report on assessed machines.
    ///
    /// # Errors
    /// Fails if the machines were simulated, but the nominal machine cannot be, or `goes_on` ends that.
    pub fn of(part: &EnsemblePart<'_>, results: PartResults, goes_on: GoesOn<'_>) -> Result<Self, Refusal> {
        let &EnsemblePart { run, ensemble, samples, ref machines, simulated } = part;
        let PartResults { distributions, yields, against_tracking } = results;
        let bands = Bands::of(ensemble, samples);
        // Computed like the other machines: simulated with the same base, control and friction, or with perfect
        // tracking.
        let nominal = match simulated {
            true => simulate(run, ensemble.machine(), goes_on)?,
            false => ensemble.nominal_outcome(),
        };
        Ok(Self {
            scenario: run.scenario().name.clone(),
            simulated,
            samples,
            shard: [machines.start, machines.end],
            seed: ensemble.seed(),
            duration: run.plan().motion.duration(),
            motion_time: run.plan().motion.duration(),
            parameters: ensemble.parameters().to_vec(),
            nominal,
            distributions,
            yields,
            shares: Shares::of(ensemble),
            agreement: Agreement::of(&bands),
            bands,
            against_tracking,
        })
    }
}

/// Returns the samples of the i-th of n equal parts of a study, i from 1.
pub fn shard(samples: u64, i: u64, n: u64) -> Range<u64> {
    let end = |i: u64| (u128::from(samples) * u128::from(i) / u128::from(n.max(1))) as u64;
    end(i.saturating_sub(1))..end(i)
}
