//! Waiting, never for ever.

use std::time::{Duration, Instant};

/// Slower machines get more time: seconds count so many times.
fn patience() -> u32 {
    std::env::var("STILLBASE_PATIENCE").ok().and_then(|times| times.parse().ok()).unwrap_or(1)
}

pub fn pause(ms: u64) {
    std::thread::sleep(Duration::from_millis(ms));
}

/// What comes within so many seconds.
pub fn within<T>(seconds: u32, mut look: impl FnMut() -> Option<T>) -> Option<T> {
    let until = Instant::now() + Duration::from_secs(1) * seconds * patience();
    loop {
        if let Some(found) = look() {
            return Some(found);
        }
        if Instant::now() > until {
            return None;
        }
        pause(60);
    }
}

/// What has to come within so many seconds.
#[track_caller]
pub fn wait_for<T>(what: &str, seconds: u32, look: impl FnMut() -> Option<T>) -> T {
    within(seconds, look).unwrap_or_else(|| panic!("waited {seconds} s in vain for {what}"))
}
