//! [`Threads`]: who does the work of jobs where there are threads.

use std::sync::mpsc::{RecvTimeoutError, SendError, Sender, channel};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use self::priority::{step_back, thread};
use crate::query::{Work, Workers};

/// Each job that runs has a thread to itself; where none can be had, it is done at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Threads {
    /// The window goes first where there are fewer processors than work.
    Background,
    /// The job runs like the window: short work that must not wait, such as keeping a change.
    Prompt,
}

/// How long short work is waited for: with it a repaint is still one of sixty a second.
const UNSEEN: Duration = Duration::from_millis(4);

impl Workers for Threads {
    fn start(&self, work: Work) {
        match self {
            Self::Background => PATIENT.start(work),
            Self::Prompt => on_thread(work, |work| work()),
        }
    }

    /// Work that turns out to be long lets the window go first from then on.
    fn start_short(&self, work: Work) {
        let (told, ended) = channel();
        let work = Box::new(move || {
            // The other end may wait no more.
            let _ = told.send(thread());
            work();
            let _ = told.send(None);
        });
        on_thread(work, |work| work());
        let thread = ended.recv().unwrap_or_default();
        if ended.recv_timeout(UNSEEN) == Err(RecvTimeoutError::Timeout) && *self == Self::Background {
            step_back(thread);
        }
    }
}

/// Has it done on a new thread in this way; where none can be had, it is done at once.
fn on_thread(work: Work, way: impl FnOnce(Work) + Send + 'static) {
    // A thread that cannot start takes the work with it, so the work waits here for whoever can do it.
    let (hand, take) = channel::<Work>();
    let thread = std::thread::Builder::new().name("job".into()).spawn(move || {
        if let Ok(work) = take.recv() {
            way(work);
        }
    });
    match thread {
        Ok(_) => drop(hand.send(work)),
        Err(_) => work(),
    }
}

/// Threads that let the window go first. They stay for the next job: a new thread begins as urgent as the window, and
/// would hold it up before it steps back.
static PATIENT: Pool = Pool { idle: Mutex::new(Vec::new()) };

/// Threads without work, the one that worked last at the end.
struct Pool {
    idle: Mutex<Vec<Sender<Work>>>,
}

impl Pool {
    /// Hands work to an idle thread, or to a new one.
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

    /// Does this work and all that is handed over afterwards. A panic ends the thread, and nothing else.
    fn run(&self, mut work: Work) {
        step_back(None);
        loop {
            work();
            let (hand, take) = channel();
            self.idle().push(hand);
            match take.recv() {
                Ok(next) => work = next,
                Err(_) => return,
            }
        }
    }

    fn idle(&self) -> MutexGuard<'_, Vec<Sender<Work>>> {
        self.idle.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// On Linux a thread has a priority of its own, which the threads that it starts take over; elsewhere it has none.
#[cfg(all(target_os = "linux", feature = "window"))]
mod priority {
    pub type Thread = rustix::thread::Pid;

    /// The present thread.
    pub fn thread() -> Option<Thread> {
        Some(rustix::thread::gettid())
    }

    /// Lets the window go first where there are fewer processors than work; the present thread, or another. A refusal
    /// changes nothing that matters.
    pub fn step_back(thread: Option<Thread>) {
        let _ = rustix::process::setpriority_process(thread.or_else(self::thread), 19);
    }
}

/// Elsewhere a lower priority would set back the whole program.
#[cfg(not(all(target_os = "linux", feature = "window")))]
mod priority {
    pub type Thread = ();

    pub fn thread() -> Option<Thread> {
        None
    }

    pub fn step_back(_: Option<Thread>) {}
}
