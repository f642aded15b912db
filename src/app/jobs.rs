//! [`Threads`]: worker threads for jobs.

use std::sync::mpsc::{RecvTimeoutError, SendError, Sender, channel};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use self::priority::{step_back, thread};
use stillbase_query::{Work, Workers};

/// Worker threads of one priority. Each running job has its own thread; if none can be started, the job runs on the
/// calling thread.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Threads {
    /// The job runs with lower priority than the window.
    Background,
    /// The job runs with the priority of the window: short work that must not wait, such as writing a change to the
    /// journal.
    Prompt,
}

/// Maximum time for which the window waits for short work; it leaves enough time for repaints at 60 Hz.
const SHORT_WORK_WAIT: Duration = Duration::from_millis(4);

impl Workers for Threads {
    fn start(&self, work: Work) {
        match self {
            Self::Background => BACKGROUND_POOL.start(work),
            Self::Prompt => on_thread(work, |work| work()),
        }
    }

    /// Waits a short time for the work; background work that takes longer gets a lower priority.
    fn start_short(&self, work: Work) {
        let (report, ended) = channel();
        let work = Box::new(move || {
            // Sending fails if the receiver has stopped waiting.
            let _ = report.send(thread());
            work();
            let _ = report.send(None);
        });
        on_thread(work, |work| work());
        let thread = ended.recv().unwrap_or_default();
        if ended.recv_timeout(SHORT_WORK_WAIT) == Err(RecvTimeoutError::Timeout) && *self == Self::Background {
            step_back(thread);
        }
    }
}

/// Passes the work to `run` on a new thread; if no thread can be started, runs the work on the calling thread.
fn on_thread(work: Work, run: impl FnOnce(Work) + Send + 'static) {
    // A thread that cannot start drops its closure; the work is sent separately, so that it is not lost.
    let (sender, receiver) = channel::<Work>();
    let thread = std::thread::Builder::new().name("job".into()).spawn(move || {
        if let Ok(work) = receiver.recv() {
            run(work);
        }
    });
    match thread {
        Ok(_) => drop(sender.send(work)),
        Err(_) => work(),
    }
}

/// Threads of lower priority. They are reused, because a new thread starts with the priority of the window. It delays
/// the window until its priority has been lowered.
static BACKGROUND_POOL: Pool = Pool { idle: Mutex::new(Vec::new()) };

/// Idle threads, the most recently used last.
struct Pool {
    idle: Mutex<Vec<Sender<Work>>>,
}

impl Pool {
    /// Passes work to an idle thread, or to a new one.
    fn start(&'static self, work: Work) {
        let idle = self.idle().pop();
        let refused = match idle {
            Some(idle) => idle.send(work).err(),
            None => Some(SendError(work)),
        };
        if let Some(SendError(work)) = refused {
            on_thread(work, |work| self.run(work));
        }
    }

    /// Runs this work, then all work that the pool passes to this thread. A panic ends only this thread.
    fn run(&self, mut work: Work) {
        step_back(None);
        loop {
            work();
            let (sender, receiver) = channel();
            self.idle().push(sender);
            match receiver.recv() {
                Ok(next) => work = next,
                Err(_) => return,
            }
        }
    }

    fn idle(&self) -> MutexGuard<'_, Vec<Sender<Work>>> {
        self.idle.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// On Linux each thread has its own priority, which its child threads inherit; elsewhere priorities are not changed.
#[cfg(all(target_os = "linux", feature = "window"))]
mod priority {
    pub type Thread = rustix::thread::Pid;

    /// The present thread.
    pub fn thread() -> Option<Thread> {
        Some(rustix::thread::gettid())
    }

    /// Lowers the priority of a thread, or of the present one. An error is ignored.
    pub fn step_back(thread: Option<Thread>) {
        let _ = rustix::process::setpriority_process(thread.or_else(self::thread), 19);
    }
}

/// Elsewhere, priorities stay unchanged, because a lower priority would apply to the whole program.
#[cfg(not(all(target_os = "linux", feature = "window")))]
mod priority {
    pub type Thread = ();

    pub fn thread() -> Option<Thread> {
        None
    }

    pub fn step_back(_: Option<Thread>) {}
}
