//! [`RunAhead`]: continues a copy of a run to the end of its planned motion, to predict how far the base will move.

use super::run::Run;
use stillbase_query::{ByIdentity, Portion, ProgressCallback, Query};
use stillbase_simulation::frame::Totals;

/// Number of steps in a portion of the work.
const STEPS_PER_PORTION: u64 = 256;

/// A copy of the run on display that goes ahead of it.
#[derive(Debug)]
pub struct RunAhead {
    run: Run,
    /// The step at which its motion ends.
    last: u64,
}

impl Query for RunAhead {
    type Input = ByIdentity<Run>;
    type Answer = Totals;

    fn begin(ByIdentity(run): Self::Input) -> Self {
        let run = Run::clone(&run);
        Self { last: run.planned_steps() as u64, run }
    }

    fn go_on(&mut self, _: ProgressCallback<'_>) -> Portion<Totals> {
        let done = |run: &Run| run.simulation().step_count();
        let until = self.last.min(done(&self.run) + STEPS_PER_PORTION);
        while done(&self.run) < until {
            self.run.advance();
        }
        match done(&self.run) < self.last {
            true => Portion::More(done(&self.run) as f64 / self.last as f64),
            false => Portion::Done(self.run.frame().totals),
        }
    }
}
