//! [`Batch`]: consecutive machines of an ensemble with their outcomes.

use std::ops::Range;

use super::deviate::CHUNK;
use super::ensemble::{Ensemble, SampleOutcome, Sampler};
use super::simulate::simulate;
use stillbase_session::{Refusal, Run};

/// Method of computing outcomes.
#[derive(Clone, Copy, Debug)]
pub enum Mode<'a> {
    /// With perfect tracking.
    Tracking,
    /// By simulation of each machine on the planned motion of a run.
    Simulated(&'a Run),
}

/// Returns whether work goes on; threads ask it at the same time.
pub type GoesOn<'a> = &'a (dyn Fn() -> bool + Sync);

/// Consecutive machines with their outcomes.
#[derive(Clone, Debug)]
pub struct Batch {
    /// Sample numbers of the machines.
    pub samples: Range<u64>,
    /// Outcome of each machine.
    pub outcomes: Vec<SampleOutcome>,
    /// Outcomes with perfect tracking, if the machines were simulated.
    pub tracking: Vec<SampleOutcome>,
    /// Deviations of the parameters, by machine; empty if not requested.
    pub deviations: Vec<Vec<f64>>,
}

impl Batch {
    /// Computes the machines of a chunk that lie in a range, with their deviations if requested.
    ///
    /// # Errors
    /// Fails if one of them cannot be simulated, or `goes_on` returns `false`.
    pub fn of(
        ensemble: &Ensemble,
        sampler: &mut Sampler,
        mode: Mode,
        chunk: u64,
        range: &Range<u64>,
        (keep_deviations, goes_on): (bool, GoesOn<'_>),
    ) -> Result<Self, Refusal> {
        if !goes_on() {
            return Err(Refusal::Stopped);
        }
        let first = chunk * CHUNK as u64;
        let samples = first.max(range.start)..(first + CHUNK as u64).min(range.end);
        let lanes = (samples.start - first) as usize..(samples.end - first) as usize;
        let tracking = sampler.outcomes(chunk)[lanes.clone()].to_vec();
        let deviations = |lane: usize| sampler.deviations().iter().map(|p| p[lane]).collect::<Vec<f64>>();
        let kept = if keep_deviations { lanes.clone().map(deviations).collect() } else { Vec::new() };
        let (outcomes, tracking) = match mode {
            Mode::Tracking => (tracking, Vec::new()),
            Mode::Simulated(run) => {
                let simulated = |lane| simulate(run, &ensemble.machine_of(&deviations(lane))?, goes_on);
                (lanes.map(simulated).collect::<Result<_, _>>()?, tracking)
            }
        };
        Ok(Self { samples, outcomes, tracking, deviations: kept })
    }
}
