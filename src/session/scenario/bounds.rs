//! Bounds on the duration and the step size of a run.

use stillbase_settings::range::Range;

/// Maximum duration of a run, s.
pub const MAX_TIME: f64 = 3600.0;

/// Maximum number of steps of a run: more than an hour in steps of 1 ms.
pub const MAX_STEPS: u64 = 4_000_000;

/// Range of the step size.
pub const STEP_RANGE: Range = Range::new(1e-5, 0.01, "s");

/// Range of the duration of a run.
pub(super) const DURATION_RANGE: Range = Range::new(0.0, MAX_TIME, "s");

/// Range of the bound on |b̈|.
pub(super) const POSE_ACCELERATION: Range = Range::new(1e-6, 1e6, "rad/s²");

/// Returns an ordinal number: 1st, 2nd, 3rd, 4th …
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

/// Maximum number of frames of a session: three minutes of motion at 1 kHz, some 150 MB.
pub(crate) const MAX_FRAMES: usize = 180_000;
