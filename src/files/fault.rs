//! Fault injection for tests of file writing: the n-th step fails, or it and all later steps fail, or it ends the
//! program. Only in debug builds.

use std::io;
#[cfg(debug_assertions)]
use std::sync::atomic::{AtomicBool, AtomicI64, Ordering::Relaxed};

/// A step of writing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum WriteStep {
    /// Creating, writing, syncing or renaming: each can fail.
    Fallible,
    /// Cleaning up, where a single failure does no harm: faults that fail a single step do not count it.
    Tidy,
}

/// Number of steps until the fault.
#[cfg(debug_assertions)]
static STEPS_TO_FAULT: AtomicI64 = AtomicI64::new(0);
/// Whether the fault ends the program; otherwise the step fails.
#[cfg(debug_assertions)]
static ENDS_PROGRAM: AtomicBool = AtomicBool::new(false);

/// Whether all later steps fail, too, including those that clean up.
#[cfg(debug_assertions)]
static GOES_ON: AtomicBool = AtomicBool::new(false);

/// Sets the fault: with `fail:3` the third step fails, with `from:3` it and all later steps fail, with `end:3` it ends
/// the program.
#[cfg(debug_assertions)]
pub fn arm_fault(wanted: &str) {
    if let Some((how, n)) = wanted.split_once(':') {
        ENDS_PROGRAM.store(how == "end", Relaxed);
        GOES_ON.store(how == "from", Relaxed);
        STEPS_TO_FAULT.store(n.parse().unwrap_or(0), Relaxed);
    }
}

/// Counts a step and returns whether the fault is due at it; if so, the caller calls [`strike`].
#[cfg(debug_assertions)]
pub(super) fn is_due(step: WriteStep) -> bool {
    let (ends, goes_on) = (ENDS_PROGRAM.load(Relaxed), GOES_ON.load(Relaxed));
    if step != WriteStep::Fallible && !ends && !goes_on {
        return false;
    }
    let left = STEPS_TO_FAULT.fetch_sub(1, Relaxed);
    left == 1 || (goes_on && left < 1)
}

/// Executes the fault.
#[cfg(debug_assertions)]
pub(super) fn strike() -> io::Result<()> {
    if ENDS_PROGRAM.load(Relaxed) {
        // Nothing is cleaned up, as if the program had been killed.
        std::process::exit(137);
    }
    Err(io::Error::other("a fault on purpose"))
}

#[cfg(not(debug_assertions))]
pub(super) fn is_due(_: WriteStep) -> bool {
    false
}

#[cfg(not(debug_assertions))]
pub(super) fn strike() -> io::Result<()> {
    Ok(())
}

/// Counts a step and executes the fault if it is due.
pub(super) fn fail_if_due(step: WriteStep) -> io::Result<()> {
    if is_due(step) { strike() } else { Ok(()) }
}
