//! [`watched`]: work that Ctrl-C stops.

use std::panic::resume_unwind;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use pyo3::prelude::*;
use stillbase_commands::StopFlag;

/// Time between two looks at signals.
const LOOKS_EVERY: Duration = Duration::from_millis(50);

/// Stack of a thread, bytes: as much as that of a program.
const STACK_SIZE: usize = 8 << 20;

/// Does work in a thread of its own, while this one looks at the signals of Python; the interpreter is free meanwhile.
/// If the handler of a signal raises an exception, as that of Ctrl-C does, the flag tells the work to stop. No thread
/// goes on after the end.
///
/// # Errors
/// The exception of the handler, or that there is no thread.
pub fn watched<T: Send>(py: Python<'_>, work: impl FnOnce(&StopFlag) -> T + Send) -> PyResult<T> {
    let (stop, (ends, mut ended)) = (StopFlag::default(), channel::<()>());
    thread::scope(|scope| {
        let own = &stop;
        let worker = thread::Builder::new().stack_size(STACK_SIZE).spawn_scoped(scope, move || {
            // Dropped at the end, also after a panic.
            let _ends = ends;
            work(own)
        })?;
        let exception = loop {
            let waited = py.detach(|| {
                let ended = &mut ended;
                ended.recv_timeout(LOOKS_EVERY)
            });
            match waited {
                Err(RecvTimeoutError::Timeout) => {}
                Ok(()) | Err(RecvTimeoutError::Disconnected) => break None,
            }
            if let Err(exception) = py.check_signals() {
                stop.stop();
                break Some(exception);
            }
        };
        let done = py.detach(|| worker.join()).unwrap_or_else(|panic| resume_unwind(panic));
        exception.map_or(Ok(done), Err)
    })
}
