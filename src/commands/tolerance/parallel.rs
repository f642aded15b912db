//! Evaluates machines on all cores, with results in order.

use std::ops::Range;
use std::sync::{Mutex, PoisonError};
use std::thread;

use stillbase_session::Refusal;
use stillbase_study::tolerance::{Batch, CHUNK, Ensemble, Mode, Sampler};

/// Number of chunks per thread in one wave; the results of a wave are passed on together. Simulations use one chunk.
/// Between two waves, threads
/// wait for the slowest; with many chunks, they wait for a small part of the time.
const CHUNKS_PER_THREAD: usize = 32;

/// Evaluates every sample of a range, and calls `see` with the batches in order.
///
/// # Errors
/// If a simulation fails, or `see` returns an error.
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
        Mode::Tracking => threads * CHUNKS_PER_THREAD,
        Mode::Simulated(_) => threads,
    };
    let mut first = chunks.start;
    while first < chunks.end && range.start < range.end {
        let last = chunks.end.min(first + wave as u64);
        let mut batches: Vec<Option<Result<Batch, Refusal>>> = (first..last).map(|_| None).collect();
        let queue = Mutex::new((first..last).zip(batches.iter_mut()));
        thread::scope(|scope| {
            for sampler in &mut samplers {
                scope.spawn(|| {
                    loop {
                        let next = queue.lock().unwrap_or_else(PoisonError::into_inner).next();
                        let Some((chunk, batch)) = next else { break };
                        *batch = Some(Batch::of(ensemble, sampler, mode, chunk, &range, keep_deviations));
                    }
                });
            }
        });
        batches.into_iter().flatten().try_for_each(|batch| see(batch?))?;
        first = last;
    }
    Ok(())
}
