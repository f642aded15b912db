//! Machines on all cores, their results in order.

use std::ops::Range;
use std::sync::{Mutex, PoisonError};
use std::thread;

use stillbase::mechanics::machine::Machine;
use stillbase::session::{Refusal, Run};
use stillbase::study::tolerance::{CHUNK, Ensemble, Outcome, Sampler, simulate};

/// Chunks of a wave, for each thread: enough that no thread waits long for the slowest.
const CHUNKS: usize = 32;

/// How outcomes come about.
#[derive(Clone, Copy)]
pub enum Mode<'a> {
    /// By perfect tracking.
    Tracking,
    /// By simulating each machine.
    Simulated(&'a Run),
}

/// Some samples, one after another.
pub struct Batch {
    /// Their numbers.
    pub samples: Range<u64>,
    /// What each comes to.
    pub outcomes: Vec<Outcome>,
    /// The same with perfect tracking, where machines were simulated.
    pub tracking: Vec<Outcome>,
    /// Deviations of the parameters, by sample; empty if they were not asked for.
    pub deviations: Vec<Vec<f64>>,
    failed: Option<Refusal>,
}

/// Shows every sample of a range in order.
///
/// # Errors
/// If a simulation fails, or what `see` says.
pub fn evaluate<E: From<Refusal>>(
    ensemble: &Ensemble,
    mode: Mode,
    range: Range<u64>,
    keep_deviations: bool,
    mut see: impl FnMut(Batch) -> Result<(), E>,
) -> Result<(), E> {
    let threads = thread::available_parallelism().map_or(1, usize::from);
    let chunks = range.start / CHUNK as u64..range.end.div_ceil(CHUNK as u64);
    let mut samplers: Vec<Sampler> = (0..threads).map(|_| ensemble.sampler()).collect();
    let wave = match mode {
        Mode::Tracking => threads * CHUNKS,
        Mode::Simulated(_) => threads,
    };
    let mut first = chunks.start;
    while first < chunks.end && range.start < range.end {
        let last = chunks.end.min(first + wave as u64);
        let within = |chunk: u64| {
            let from = chunk * CHUNK as u64;
            from.max(range.start)..(from + CHUNK as u64).min(range.end)
        };
        let mut batches: Vec<Option<Batch>> = (first..last).map(|_| None).collect();
        let queue = Mutex::new((first..last).zip(batches.iter_mut()));
        thread::scope(|scope| {
            for sampler in &mut samplers {
                scope.spawn(|| {
                    loop {
                        let next = queue.lock().unwrap_or_else(PoisonError::into_inner).next();
                        let Some((chunk, batch)) = next else { break };
                        *batch = Some(one(ensemble, sampler, mode, chunk, within(chunk), keep_deviations));
                    }
                });
            }
        });
        for mut batch in batches.into_iter().flatten() {
            if let Some(refusal) = batch.failed.take() {
                return Err(refusal.into());
            }
            see(batch)?;
        }
        first = last;
    }
    Ok(())
}

fn one(
    ensemble: &Ensemble,
    sampler: &mut Sampler,
    mode: Mode,
    chunk: u64,
    samples: Range<u64>,
    keep_deviations: bool,
) -> Batch {
    let place = |sample: u64| (sample - chunk * CHUNK as u64) as usize;
    let lanes = place(samples.start)..place(samples.end);
    let tracking = sampler.outcomes(chunk)[lanes.clone()].to_vec();
    let deviations = |lane: usize| sampler.deviations().iter().map(|p| p[lane]).collect::<Vec<f64>>();
    let kept = if keep_deviations { lanes.clone().map(deviations).collect() } else { Vec::new() };
    let whole = Batch { samples, outcomes: tracking, tracking: Vec::new(), deviations: kept, failed: None };
    let Mode::Simulated(run) = mode else { return whole };
    let machine = |lane| -> Result<Machine, Refusal> { Ok(ensemble.machine_of(&deviations(lane))?) };
    let simulated = lanes.map(|lane| simulate(run, &machine(lane)?)).collect::<Result<Vec<_>, Refusal>>();
    match simulated {
        Ok(outcomes) => Batch { tracking: whole.outcomes, outcomes, ..whole },
        Err(refusal) => Batch { failed: Some(refusal), ..whole },
    }
}
