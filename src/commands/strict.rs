//! `--strict`: what is judged and not good ends with exit status 1, and a message that says what that is.

use clap::Args;
use stillbase_session::verdict::{Statement, StatusLight, Verdict};
use stillbase_settings::number::significant;

use super::failure::Failure;

/// Whether a judgement decides on the exit status.
#[derive(Args)]
pub struct Strict {
    /// End with exit status 1 after the answer if what it judges is not good, and say why: not balanced, not
    /// reactionless, past a limit, off its target
    #[arg(long)]
    strict: bool,
}

impl Strict {
    /// Ends with exit status 1 if something is not good; `faults` says what, each in a few words.
    ///
    /// # Errors
    /// If the judgement counts and something is not good.
    pub fn require(&self, faults: impl IntoIterator<Item = String>) -> Result<(), Failure> {
        let faults: Vec<String> = faults.into_iter().collect();
        match self.strict && !faults.is_empty() {
            true => Err(Failure::no_answer(format!("--strict: {}", faults.join("; ")))),
            false => Ok(()),
        }
    }
}

/// Returns what of a finished run is not good: that it does not spare its base, exceeds limits of joints and drives, or
/// misses its target.
pub fn run_faults(name: &str, verdict: &Verdict) -> Vec<String> {
    let base = (!verdict.spares_base()).then(|| verdict.word().to_owned());
    let joint = verdict.past_limit.as_ref();
    let joint = joint.map(|(angle, by)| format!("past the limit of the angle {angle} by {} rad", significant(*by)));
    let drive = verdict.exceeded_limit.as_ref();
    let drive = drive
        .map(|(limit, factor)| format!("past a limit of a drive: {limit}, by the factor {}", significant(*factor)));
    let miss = verdict.miss().map(|miss| format!("off its target by {} m", significant(miss)));
    [base, joint, drive, miss].into_iter().flatten().map(|fault| format!("{name}: {fault}")).collect()
}

/// Returns those of some statements that are bad, each with its subject.
pub fn bad_statements<'a>(
    statements: impl IntoIterator<Item = (&'static str, &'a Statement)>,
) -> impl Iterator<Item = String> {
    let bad = statements.into_iter().filter(|(_, statement)| statement.outcome == StatusLight::Bad);
    bad.map(|(subject, statement)| format!("{subject}: {}", statement.words))
}
