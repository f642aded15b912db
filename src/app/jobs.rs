//! [`Threads`]: who does the work of jobs where there are threads.

use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

use self::priority::{step_back, thread};
use crate::query::Workers;

/// Each job on a thread of its own; where none can be had, at once.
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
    fn start(&self, work: Box<dyn FnOnce() + Send>) {
        let steps_back = *self == Self::Background;
        on_thread(Box::new(move || {
            if steps_back {
                step_back(None);
            }
            work();
        }));
    }

    /// Work that turns out to be long lets the window go first from then on.
    fn start_short(&self, work: Box<dyn FnOnce() + Send>) {
        let (told, ended) = channel();
        on_thread(Box::new(move || {
            // The other end may wait no more.
            let _ = told.send(thread());
            work();
            let _ = told.send(None);
        }));
        let thread = ended.recv().unwrap_or_default();
        if ended.recv_timeout(UNSEEN) == Err(RecvTimeoutError::Timeout) && *self == Self::Background {
            step_back(thread);
        }
    }
}

/// Where no thread can be had, at once.
fn on_thread(work: Box<dyn FnOnce() + Send>) {
    // A thread that cannot start takes the work with it, so the work waits here for whoever can do it.
    let (hand, take) = channel::<Box<dyn FnOnce() + Send>>();
    let thread = std::thread::Builder::new().name("job".into()).spawn(move || {
        if let Ok(work) = take.recv() {
            work();
        }
    });
    match thread {
        Ok(_) => drop(hand.send(work)),
        Err(_) => work(),
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
