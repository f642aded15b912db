//! A [`Batch`]: some machines of an ensemble, one after another, with what each comes to.

use std::ops::Range;

use super::deviate::CHUNK;
use super::ensemble::{Ensemble, Outcome, Sampler};
use super::simulate::simulate;
use crate::session::{Refusal, Run};

/// How outcomes come about.
#[derive(Clone, Copy, Debug)]
pub enum Mode<'a> {
    /// By perfect tracking.
    Tracking,
    /// By simulating each machine on the planned motion of a run.
    Simulated(&'a Run),
}

/// Some machines, one after another.
#[derive(Clone, Debug)]
pub struct Batch {
    /// Their numbers.
    pub samples: Range<u64>,
    /// What each comes to.
    pub outcomes: Vec<Outcome>,
    /// The same with perfect tracking, where machines were simulated.
    pub tracking: Vec<Outcome>,
    /// Deviations of the parameters, by machine; empty if they were not asked for.
    pub deviations: Vec<Vec<f64>>,
}

impl Batch {
    /// The machines of a chunk that are in a range.
    ///
    /// # Errors
    /// If one of them cannot be simulated.
    pub fn of(
        ensemble: &Ensemble,
        sampler: &mut Sampler,
        mode: Mode,
        (chunk, range): (u64, &Range<u64>),
        keep_deviations: bool,
    ) -> Result<Self, Refusal> {
        let first = chunk * CHUNK as u64;
        let samples = first.max(range.start)..(first + CHUNK as u64).min(range.end);
        let lanes = (samples.start - first) as usize..(samples.end - first) as usize;
        let tracking = sampler.outcomes(chunk)[lanes.clone()].to_vec();
        let deviations = |lane: usize| sampler.deviations().iter().map(|p| p[lane]).collect::<Vec<f64>>();
        let kept = if keep_deviations { lanes.clone().map(deviations).collect() } else { Vec::new() };
        let (outcomes, tracking) = match mode {
            Mode::Tracking => (tracking, Vec::new()),
            Mode::Simulated(run) => {
                let simulated = |lane| simulate(run, &ensemble.machine_of(&deviations(lane))?);
                (lanes.map(simulated).collect::<Result<_, _>>()?, tracking)
            }
        };
        Ok(Self { samples, outcomes, tracking, deviations: kept })
    }
}
