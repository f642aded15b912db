//! The GPU that tests share.
//!
//! The standard harness knows no "skipped at run time". So a test that finds no adapter says so on standard error and
//! returns, and where `STILLBASE_REQUIRE_GPU=1` is set, as CI does, it fails instead: no green run without pictures.

use std::io::Write as _;
use std::sync::{LazyLock, Mutex, MutexGuard, PoisonError};
use stillbase::picture::render::offscreen::{Gpu, NoAdapter};

static GPU: LazyLock<Result<Mutex<Gpu>, NoAdapter>> = LazyLock::new(|| Gpu::new().map(Mutex::new));

/// The adapter, or `None` where there is none and none is required.
pub fn gpu() -> Option<MutexGuard<'static, Gpu>> {
    match &*GPU {
        // A failed test must not fail the others.
        Ok(gpu) => Some(gpu.lock().unwrap_or_else(PoisonError::into_inner)),
        Err(error) => {
            missing(error);
            None
        }
    }
}

/// A GPU of one's own, with nothing drawn on it yet.
pub fn fresh() -> Option<Gpu> {
    Gpu::new().map_err(|error| missing(&error)).ok()
}

fn missing(error: &NoAdapter) {
    let required = std::env::var_os("STILLBASE_REQUIRE_GPU").is_some_and(|value| value == "1");
    assert!(!required, "STILLBASE_REQUIRE_GPU=1, but {error}");
    let test = std::thread::current().name().unwrap_or("a test").to_owned();
    // Past the harness, which keeps the output of passing tests to itself.
    _ = writeln!(std::io::stderr(), "ignored: {test}: {error}");
}
