//! [`PartReport`]: what a part of the machines of a study comes to; all of them, if the part is the whole.

use std::ops::Range;

use serde::Serialize;

use super::{AgainstTracking, Agreement, Bands, Distributions, Ensemble, Outcome, Parameter, Shares, Yields, simulate};
use crate::session::scenario::Tolerance;
use crate::session::{Refusal, Run};

/// Machines of an ensemble that were judged, one after another.
#[derive(Clone, Copy, Debug)]
pub struct Part<'a> {
    /// The run whose planned motion they do.
    pub run: &'a Run,
    /// What they were drawn from.
    pub ensemble: &'a Ensemble,
    /// Machines of the whole study.
    pub samples: u64,
    /// Number of the first of these.
    pub first: u64,
    /// What each comes to.
    pub outcomes: &'a [Outcome],
    /// The same with perfect tracking, where machines were simulated.
    pub tracking: &'a [Outcome],
    /// Whether machines were simulated.
    pub simulated: bool,
}

/// What a part of the machines comes to.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PartReport {
    /// Its name.
    pub scenario: String,
    /// Whether machines were simulated; else they track perfectly.
    pub simulated: bool,
    /// Machines of the whole study.
    pub samples: u64,
    /// First sample of this part, and the one after its last.
    pub shard: [u64; 2],
    /// Which random machines.
    pub seed: u64,
    /// s.
    pub motion_time: f64,
    /// What varies.
    pub parameters: Vec<Parameter>,
    /// The machine without deviations, by perfect tracking or simulated, as the machines are.
    pub nominal: Outcome,
    /// Peaks and root mean squares.
    #[serde(flatten)]
    pub distributions: Distributions,
    /// How many keep within limits.
    #[serde(rename = "yield")]
    pub yields: Yields,
    /// Which tolerance matters.
    pub shares: Shares,
    /// n_B and |f_B| over time.
    pub bands: Bands,
    /// Of first order with all orders.
    pub agreement: Agreement,
    /// Of perfect tracking with the simulation.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub against_tracking: Option<AgainstTracking>,
}

impl PartReport {
    /// Of judged machines, by the limits of a tolerance; none if there is no machine.
    ///
    /// # Errors
    /// If machines were simulated, and the one without deviations cannot be.
    pub fn of(part: &Part<'_>, tolerance: &Tolerance) -> Result<Option<Self>, Refusal> {
        let Part { run, ensemble, samples, first, outcomes, tracking, simulated } = *part;
        let Some(distributions) = Distributions::of(outcomes) else { return Ok(None) };
        let bands = Bands::of(ensemble, samples);
        // By the same way as the machines beside it: the same base, control and friction, or perfect tracking for all.
        let nominal = match simulated {
            true => simulate(run, ensemble.machine())?,
            false => ensemble.nominal_outcome(),
        };
        Ok(Some(Self {
            scenario: run.scenario().name.clone(),
            simulated,
            samples,
            shard: [first, first + outcomes.len() as u64],
            seed: ensemble.seed(),
            motion_time: run.plan().motion.duration(),
            parameters: ensemble.parameters().to_vec(),
            nominal,
            distributions,
            yields: Yields::of(outcomes, tolerance.moment_limit, tolerance.force_limit),
            shares: Shares::of(ensemble),
            agreement: Agreement::of(&bands),
            bands,
            against_tracking: AgainstTracking::of(outcomes, tracking),
        }))
    }
}

/// The samples of the i-th of n equal parts of a study, i from 1.
pub fn shard(samples: u64, (i, n): (u64, u64)) -> Range<u64> {
    let end = |i: u64| (u128::from(samples) * u128::from(i) / u128::from(n.max(1))) as u64;
    end(i.saturating_sub(1))..end(i)
}
