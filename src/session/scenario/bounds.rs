//! How long a run may take, and in which steps.

use crate::settings::range::Range;

/// The longest run, s.
pub const MAX_TIME: f64 = 3600.0;

/// The most steps of a run: an hour of 1 ms each, and some to spare.
pub const MAX_STEPS: u64 = 4_000_000;

/// What a step may be.
pub const STEP: Range = Range::new(1e-5, 0.01, "s");

/// How long a run may be told to take.
pub(super) const DURATION: Range = Range::new(0.0, MAX_TIME, "s");

/// Where a bound on |b̈| may lie.
pub(super) const POSE_ACCELERATION: Range = Range::new(1e-6, 1e6, "rad/s²");

/// 1st, 2nd, 3rd, 4th …
pub(crate) fn ordinal(n: usize) -> String {
    let ending = match (n % 10, n % 100) {
        (_, 11..=13) => "th",
        (1, _) => "st",
        (2, _) => "nd",
        (3, _) => "rd",
        _ => "th",
    };
    format!("{n}{ending}")
}

/// The most frames a session keeps: three minutes of motion at 1 kHz, some 150 MB.
pub(crate) const MAX_FRAMES: usize = 180_000;
