//! Work beside the window: what takes longer than a frame runs as a [`Job`], tells how far it is, and stops when nobody
//! waits for it any more.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::mpsc::{Receiver, TryRecvError, channel};

/// What a job does.
pub type Work = Box<dyn FnOnce() + Send>;

/// Who does the work.
pub trait Workers {
    /// Has it done, at once or beside.
    fn start(&self, work: Work);

    /// The same of work that is short as a rule: who reads a clock may wait for its end, as long as nobody sees it.
    fn start_short(&self, work: Work) {
        self.start(work);
    }
}

/// The same who take all that is given to them for short.
pub struct Short<'a>(pub &'a dyn Workers);

impl Workers for Short<'_> {
    fn start(&self, work: Work) {
        self.0.start_short(work);
    }
}

/// No threads: every job is done when it starts, as in a browser and in tests.
#[derive(Clone, Copy, Debug)]
pub struct AtOnce;

impl Workers for AtOnce {
    fn start(&self, work: Work) {
        work();
    }
}

/// What a job and whoever waits for it share.
#[derive(Debug, Default)]
struct Shared {
    stopped: AtomicBool,
    /// Thousandths that are done.
    done: AtomicU32,
}

impl Shared {
    fn stop(&self) {
        self.stopped.store(true, Ordering::Relaxed);
    }
}

/// Told by a job as it goes.
#[derive(Clone, Debug)]
pub struct Ticket(Arc<Shared>);

impl Ticket {
    /// How much is done, from 0 to 1; whether the rest is still wanted.
    pub fn goes_on(&self, done: f64) -> bool {
        self.0.done.store((1e3 * done.clamp(0.0, 1.0)) as u32, Ordering::Relaxed);
        !self.0.stopped.load(Ordering::Relaxed)
    }
}

/// Work that is under way. Dropped, it stops at its next word.
#[derive(Debug)]
pub struct Job<T> {
    result: Receiver<T>,
    shared: Arc<Shared>,
}

impl<T: Send + 'static> Job<T> {
    /// Starts it; `wake` is called when it has ended.
    pub fn start(
        workers: &dyn Workers,
        wake: impl FnOnce() + Send + 'static,
        work: impl FnOnce(&Ticket) -> T + Send + 'static,
    ) -> Self {
        let (send, result) = channel();
        let shared = Arc::new(Shared::default());
        let ticket = Ticket(shared.clone());
        workers.start(Box::new(move || {
            let done = work(&ticket);
            // Nobody may wait any more.
            let _ = send.send(done);
            wake();
        }));
        Self { result, shared }
    }

    /// How much is done, from 0 to 1.
    pub fn progress(&self) -> f64 {
        f64::from(self.shared.done.load(Ordering::Relaxed)) / 1e3
    }

    /// Has it stop at its next word.
    pub fn stop(&self) {
        self.shared.stop();
    }

    /// Waits for its result; a job that broke off has none.
    pub fn wait(self) -> Option<T> {
        self.result.recv().ok()
    }

    /// Whether its result is there; a job that broke off has none.
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

/// How a job stands.
#[derive(Debug)]
pub enum Poll<T> {
    /// Under way.
    Working,
    /// Its result, given once.
    Done(T),
    /// It ended without one.
    Broken,
}
