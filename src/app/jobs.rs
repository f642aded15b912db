//! [`Threads`]: who does the work of jobs where there are threads.

use std::sync::mpsc::channel;

use crate::query::Workers;

/// Each job on a thread of its own; where none can be had, at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Threads {
    /// The window goes first where there are fewer processors than work.
    Background,
    /// The job runs like the window: short work that must not wait, such as keeping a change.
    Prompt,
}

impl Workers for Threads {
    fn start(&self, work: Box<dyn FnOnce() + Send>) {
        // A thread that cannot start takes the work with it, so the work waits here for whoever can do it.
        let (hand, take) = channel::<Box<dyn FnOnce() + Send>>();
        let steps_back = *self == Self::Background;
        let thread = std::thread::Builder::new().name("job".into()).spawn(move || {
            if steps_back {
                step_back();
            }
            if let Ok(work) = take.recv() {
                work();
            }
        });
        match thread {
            Ok(_) => drop(hand.send(work)),
            Err(_) => work(),
        }
    }
}

/// Lets the window go first where there are fewer processors than work.
fn step_back() {
    // On Linux a thread has a priority of its own, which the threads that it starts take over; elsewhere this would set
    // back the whole program. A refusal changes nothing that matters.
    #[cfg(all(target_os = "linux", feature = "window"))]
    let _ = rustix::process::setpriority_process(Some(rustix::thread::gettid()), 19);
}
