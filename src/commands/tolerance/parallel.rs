//! Evaluates machines on all cores, with results in order, or shared out among workers.

use std::ops::Range;
use std::panic::resume_unwind;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;

use stillbase_session::Refusal;
use stillbase_study::tolerance::{Batch, CHUNK, Ensemble, GoesOn, Mode, Sampler};

/// Number of chunks per thread in one wave; the results of a wave are passed on together. Simulations use one chunk.
/// Between two waves, threads wait for the slowest; with many chunks, they wait for a small part of the time.
const CHUNKS_PER_THREAD: usize = 32;

/// Gives every batch of machines of some ranges to one of several workers, in no order, and returns the workers.
///
/// # Errors
/// If a simulation fails, or `goes_on` returns `false`.
pub fn share_out<W: Send>(
    ensemble: &Ensemble,
    mode: Mode,
    ranges: &[Range<u64>],
    worker: impl Fn() -> W,
    see: impl Fn(&mut W, &Batch) + Sync,
    goes_on: GoesOn<'_>,
) -> Result<Vec<W>, Refusal> {
    let mut workers: Vec<W> = (0..thread::available_parallelism().map_or(1, usize::from)).map(|_| worker()).collect();
    for range in ranges.iter().filter(|range| !range.is_empty()) {
        let next = AtomicU64::new(range.start / CHUNK as u64);
        let after = range.end.div_ceil(CHUNK as u64);
        let work = |worker: &mut W| {
            let mut sampler = ensemble.sampler();
            loop {
                let chunk = next.fetch_add(1, Ordering::Relaxed);
                if chunk >= after {
                    return Ok(());
                }
                match Batch::of(ensemble, &mut sampler, mode, chunk, range, (false, goes_on)) {
                    Ok(batch) => see(worker, &batch),
                    Err(why) => {
                        // The others end with the chunk that they have.
                        next.store(after, Ordering::Relaxed);
                        return Err(why);
                    }
                }
            }
        };
        let done: Vec<Result<(), Refusal>> = thread::scope(|scope| {
            let threads: Vec<_> = workers.iter_mut().map(|worker| scope.spawn(|| work(worker))).collect();
            let end = |thread: thread::ScopedJoinHandle<'_, _>| thread.join().unwrap_or_else(|e| resume_unwind(e));
            threads.into_iter().map(end).collect()
        });
        done.into_iter().collect::<Result<(), _>>()?;
    }
    Ok(workers)
}

/// Evaluates every sample of a range, and calls `see` with the batches in order.
///
/// # Errors
/// If a simulation fails, `goes_on` returns `false`, or `see` returns an error.
pub fn evaluate<E: From<Refusal>>(
    ensemble: &Ensemble,
    mode: Mode,
    range: Range<u64>,
    (keep_deviations, goes_on): (bool, GoesOn<'_>),
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
                        *batch = Some(Batch::of(ensemble, sampler, mode, chunk, &range, (keep_deviations, goes_on)));
                    }
                });
            }
        });
        batches.into_iter().flatten().try_for_each(|batch| see(batch?))?;
        first = last;
    }
    Ok(())
}
