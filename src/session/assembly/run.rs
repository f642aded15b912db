//! Runs a scenario of an assembly from the first to the last step.

use super::file::AssemblyScenario;
use super::frame::{AssemblyFrame, AssemblyVerdict};
use crate::refusal::Refusal;
use crate::replay::replay_while;

impl AssemblyScenario {
    /// Runs the scenario, and calls `see` with every step until it returns false. Returns the assessment.
    ///
    /// # Errors
    /// As [`replay_while`]; of a block that is not led the refusal names the block.
    pub fn run(&self, mut see: impl FnMut(&AssemblyFrame) -> bool) -> Result<AssemblyVerdict, Refusal> {
        let mut verdict = AssemblyVerdict::default();
        let done = replay_while(&self.leading(self.lead), |run, _| {
            let Some(shared) = run.shared() else { return false };
            verdict = *shared.verdict();
            see(shared.now())
        });
        match done {
            Ok(_) | Err(Refusal::Stopped) => Ok(verdict),
            Err(why) => Err(why),
        }
    }
}
