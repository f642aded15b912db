//! The GPU that tests share.

use std::sync::{LazyLock, Mutex, MutexGuard, PoisonError};

use stillbase::picture::render::offscreen::{Gpu, NoAdapter};

static GPU: LazyLock<Result<Mutex<Gpu>, NoAdapter>> = LazyLock::new(|| Gpu::new().map(Mutex::new));

/// Why nothing can be drawn here, if so.
pub fn missing() -> Option<&'static NoAdapter> {
    GPU.as_ref().err()
}

/// The adapter; where there is none, no test is called that asks for it.
pub fn gpu() -> MutexGuard<'static, Gpu> {
    let gpu = GPU.as_ref().unwrap_or_else(|error| panic!("{error}"));
    // A failed test must not fail the others.
    gpu.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A GPU of one's own, with nothing drawn on it yet.
pub fn fresh() -> Gpu {
    Gpu::new().unwrap_or_else(|error| panic!("{error}"))
}
