//! `--strict`: what is judged and not good ends with exit status 1.

use clap::Args;
use stillbase_session::scenario::Scenario;
use stillbase_session::verdict::{TARGET_TOLERANCE, Verdict};
use stillbase_simulation::frame::Frame;

use super::failure::Failure;

/// Whether a judgement decides on the exit status.
#[derive(Args)]
pub struct Strict {
    /// End with exit status 1 after the answer if what it judges is not good: not balanced, not reactionless, past a
    /// limit, off its target
    #[arg(long)]
    strict: bool,
}

impl Strict {
    /// Ends with exit status 1 unless the judgement is good.
    ///
    /// # Errors
    /// If the judgement counts and is not good.
    pub fn require(&self, is_good: bool) -> Result<(), Failure> {
        if self.strict && !is_good { Err(Failure::Told) } else { Ok(()) }
    }
}

/// Returns whether a finished run spares its base, keeps the limits of joints and drives, and ends at its target.
pub fn is_good(verdict: &Verdict) -> bool {
    let misses = verdict.has_target && (verdict.target_distance > TARGET_TOLERANCE || verdict.target_distance.is_nan());
    verdict.spares_base() && verdict.past_limit.is_none() && verdict.exceeded_limit.is_none() && !misses
}

/// Returns the same of a scenario and its last frame.
pub fn is_run_good(scenario: &Scenario, last: &Frame) -> bool {
    is_good(&Verdict::of(scenario, last))
}
