//! [`Waiting`]: work beside the window that waits until the window is drawn.

use std::mem::take;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::query::{Work, Workers};

/// Workers who do not begin while the window is drawn: work that begins meanwhile, on the same processor, can hold up the
/// drawing for a time slice of the system.
pub(super) struct Waiting {
    workers: Box<dyn Workers + Send + Sync>,
    line: Mutex<Line>,
}

#[derive(Default)]
struct Line {
    is_closed: bool,
    work: Vec<Work>,
}

impl Waiting {
    pub fn new(workers: impl Workers + Send + Sync + 'static) -> Self {
        Self { workers: Box::new(workers), line: Mutex::default() }
    }

    /// What is started waits from now on.
    fn close(&self) {
        self.line().is_closed = true;
    }

    /// What waits begins.
    pub fn open(&self) {
        let work = {
            let mut line = self.line();
            line.is_closed = false;
            take(&mut line.work)
        };
        for work in work {
            self.workers.start(work);
        }
    }

    fn line(&self) -> MutexGuard<'_, Line> {
        self.line.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Workers for Waiting {
    fn start(&self, work: Work) {
        let mut line = self.line();
        if line.is_closed {
            line.work.push(work);
        } else {
            drop(line);
            self.workers.start(work);
        }
    }

    /// The window waits for short work, which cannot wait for the window.
    fn start_short(&self, work: Work) {
        self.workers.start_short(work);
    }
}

/// The window is drawn while it lives: work beside it that nobody waits for begins afterwards.
pub struct Drawing(Option<Arc<Waiting>>);

impl Drawing {
    /// Where work is done at once, nothing waits.
    pub(super) fn begin(waiting: Option<&Arc<Waiting>>) -> Self {
        if let Some(waiting) = waiting {
            waiting.close();
        }
        Self(waiting.cloned())
    }
}

impl Drop for Drawing {
    fn drop(&mut self) {
        if let Some(waiting) = &self.0 {
            waiting.open();
        }
    }
}
