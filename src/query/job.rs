//! Work in the background: work that takes longer than a frame runs as a [`Job`]. A job reports its progress, and stops
//! when its handle is dropped.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::mpsc::{Receiver, TryRecvError, channel};

/// Work of a job.
pub type Work = Box<dyn FnOnce() + Send>;

/// An executor of work, such as a pool of worker threads.
pub trait Workers {
    /// Runs the work, at once or in the background.
    fn start(&self, work: Work);

    /// Runs work that is usually short. An implementation with a clock may wait for its end, up to a time that the user
    /// does not notice.
    fn start_short(&self, work: Work) {
        self.start(work);
    }
}

/// Workers that run all work as [`start_short`](Workers::start_short).
pub struct ShortJobs<'a>(pub &'a dyn Workers);

impl Workers for ShortJobs<'_> {
    fn start(&self, work: Work) {
        self.0.start_short(work);
    }
}

/// Workers without threads: every job is done when it starts, as in a browser and in tests.
#[derive(Clone, Copy, Debug)]
pub struct InlineWorkers;

impl Workers for InlineWorkers {
    fn start(&self, work: Work) {
        work();
    }
}

/// State shared by a job and its handle.
#[derive(Debug, Default)]
struct JobState {
    stopped: AtomicBool,
    /// Thousandths of the work that are done.
    done: AtomicU32,
}

impl JobState {
    fn stop(&self) {
        self.stopped.store(true, Ordering::Relaxed);
    }
}

/// The job's access to the shared state: it reports progress and reads whether to stop.
#[derive(Clone, Debug)]
pub struct Ticket(Arc<JobState>);

impl Ticket {
    /// Reports the fraction done, from 0 to 1; returns whether the job is to continue.
    pub fn goes_on(&self, done: f64) -> bool {
        self.0.done.store((1e3 * done.clamp(0.0, 1.0)) as u32, Ordering::Relaxed);
        !self.0.stopped.load(Ordering::Relaxed)
    }
}

/// Handle of work that is under way. When it is dropped, the work stops at its next report of progress.
#[derive(Debug)]
pub struct Job<T> {
    result: Receiver<T>,
    shared: Arc<JobState>,
}

impl<T: Send + 'static> Job<T> {
    /// Starts the work; calls `wake` when the work has ended.
    pub fn start(
        workers: &dyn Workers,
        wake: impl FnOnce() + Send + 'static,
        work: impl FnOnce(&Ticket) -> T + Send + 'static,
    ) -> Self {
        let (send, result) = channel();
        let shared = Arc::new(JobState::default());
        let ticket = Ticket(shared.clone());
        workers.start(Box::new(move || {
            let done = work(&ticket);
            // The receiver may have been dropped.
            let _ = send.send(done);
            wake();
        }));
        Self { result, shared }
    }

    /// Returns the fraction done, from 0 to 1.
    pub fn progress(&self) -> f64 {
        f64::from(self.shared.done.load(Ordering::Relaxed)) / 1e3
    }

    /// Requests a stop, which takes effect at the next report of progress.
    pub fn stop(&self) {
        self.shared.stop();
    }

    /// Waits for the result; `None` if the job ended without one.
    pub fn wait(self) -> Option<T> {
        self.result.recv().ok()
    }

    /// Returns the result if the job has ended, without waiting.
    pub fn poll(&self) -> Poll<T> {
        match self.result.try_recv() {
            Ok(result) => Poll::Done(result),
            Err(TryRecvError::Empty) => Poll::Working,
            Err(TryRecvError::Disconnected) => Poll::Broken,
        }
    }
}

impl<T> Drop for Job<T> {
    fn drop(&mut self) {
        self.shared.stop();
    }
}

/// State of a job.
#[derive(Debug)]
pub enum Poll<T> {
    /// The job is under way.
    Working,
    /// The result; it is returned once.
    Done(T),
    /// The job ended without a result, or its result has been returned already.
    Broken,
}
