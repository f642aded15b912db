//! [`DeferredWorkers`]: a queue of background work that waits until the window is drawn.

use std::mem::take;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use stillbase_query::{Work, Workers};

/// Worker threads that start no work while the window is drawn. New work on the same processor could delay the drawing
/// by a time slice of the operating system.
pub(super) struct DeferredWorkers {
    workers: Box<dyn Workers + Send + Sync>,
    line: Mutex<Queue>,
}

#[derive(Default)]
struct Queue {
    is_closed: bool,
    work: Vec<Work>,
}

impl DeferredWorkers {
    pub fn new(workers: impl Workers + Send + Sync + 'static) -> Self {
        Self { workers: Box::new(workers), line: Mutex::default() }
    }

    /// Holds new work back from now on.
    fn close(&self) {
        self.queue().is_closed = true;
    }

    /// Starts the work that was held back.
    pub fn open(&self) {
        let work = {
            let mut queue = self.queue();
            queue.is_closed = false;
            take(&mut queue.work)
        };
        for work in work {
            self.workers.start(work);
        }
    }

    fn queue(&self) -> MutexGuard<'_, Queue> {
        self.line.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Workers for DeferredWorkers {
    fn start(&self, work: Work) {
        let mut queue = self.queue();
        if queue.is_closed {
            queue.work.push(work);
        } else {
            drop(queue);
            self.workers.start(work);
        }
    }

    /// Short work is not held back, because the window waits for it.
    fn start_short(&self, work: Work) {
        self.workers.start_short(work);
    }
}

/// A guard that lives while the window is drawn: background work that nobody waits for starts after it is dropped.
pub struct DrawingGuard(Option<Arc<DeferredWorkers>>);

impl DrawingGuard {
    /// Creates the guard; without a queue, no work is held back.
    pub(super) fn begin(waiting: Option<&Arc<DeferredWorkers>>) -> Self {
        if let Some(waiting) = waiting {
            waiting.close();
        }
        Self(waiting.cloned())
    }
}

impl Drop for DrawingGuard {
    fn drop(&mut self) {
        if let Some(waiting) = &self.0 {
            waiting.open();
        }
    }
}
