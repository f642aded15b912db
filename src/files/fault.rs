//! Faults that tests ask for, to see what becomes of files: the n-th step of writing fails, or the program ends there
//! at once. Only debug builds have them.

use std::io;
#[cfg(debug_assertions)]
use std::sync::atomic::{AtomicBool, AtomicI64, Ordering::Relaxed};

/// A step of writing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Step {
    /// Begin, write, sync, take a name: each can fail.
    Fallible,
    /// Tidying up, where a failure does no harm: the program can only end there.
    Tidy,
}

/// Steps until the fault.
#[cfg(debug_assertions)]
static LEFT: AtomicI64 = AtomicI64::new(0);
#[cfg(debug_assertions)]
static ENDS: AtomicBool = AtomicBool::new(false);

/// Wants a fault: `fail:3` fails at the third step, `end:3` ends the program there.
#[cfg(debug_assertions)]
pub fn arm(wanted: &str) {
    if let Some((how, n)) = wanted.split_once(':') {
        ENDS.store(how == "end", Relaxed);
        LEFT.store(n.parse().unwrap_or(0), Relaxed);
    }
}

/// Whether the fault is due at this step; if so, [`strike`] is next.
#[cfg(debug_assertions)]
pub(super) fn is_due(step: Step) -> bool {
    (step == Step::Fallible || ENDS.load(Relaxed)) && LEFT.fetch_sub(1, Relaxed) == 1
}

/// Makes the wanted fault happen.
#[cfg(debug_assertions)]
pub(super) fn strike() -> io::Result<()> {
    if ENDS.load(Relaxed) {
        // Nothing is tidied up, as if it had been killed.
        std::process::exit(137);
    }
    Err(io::Error::other("a fault on purpose"))
}

#[cfg(not(debug_assertions))]
pub(super) fn is_due(_: Step) -> bool {
    false
}

#[cfg(not(debug_assertions))]
pub(super) fn strike() -> io::Result<()> {
    Ok(())
}

/// Fails here if the fault is due.
pub(super) fn at(step: Step) -> io::Result<()> {
    if is_due(step) { strike() } else { Ok(()) }
}
