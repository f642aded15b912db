//! [`guarded`]: reads Parquet, whose reader panics at some damaged files.

use std::cell::Cell;
use std::panic::{self, AssertUnwindSafe};
use std::sync::Once;

thread_local! {
    /// Whether this thread reads a Parquet file, so that a panic is an error of the file and is not printed.
    static IS_GUARDED: Cell<bool> = const { Cell::new(false) };
}

/// Calls the Parquet reader, and turns its panics, which some damaged files cause, into the error of `damaged`. Panics of
/// other threads are printed as ever.
pub fn guarded<T, E>(read: impl FnOnce() -> Result<T, E>, damaged: impl FnOnce() -> E) -> Result<T, E> {
    static HOOK: Once = Once::new();
    // The hook belongs to the whole program, so it is laid once, and stays.
    HOOK.call_once(|| {
        let print = panic::take_hook();
        panic::set_hook(Box::new(move |of| {
            if !IS_GUARDED.get() {
                print(of);
            }
        }));
    });
    IS_GUARDED.set(true);
    let done = panic::catch_unwind(AssertUnwindSafe(read));
    IS_GUARDED.set(false);
    done.unwrap_or_else(|_| Err(damaged()))
}
