//! [`OrbitTrimQuery`]: the query that evaluates motions in orbit.

use super::fault::OrbitMeasurement;
use super::fit::OrbitFit;
use super::motion::{OrbitBase, OrbitMotion};
use super::report::OrbitReport;
use crate::trim::doubt::{Doubt, DoubtSearch};
use crate::trim::error::TrimError;
use crate::trim::trimming::NoTrim;
use stillbase_mechanics::machine::Machine;
use stillbase_query::{Portion, ProgressCallback, Query, Shared};

/// Fraction of the work done when all faults are tested.
const TRIED_AT: f64 = 0.9;

/// Motions in orbit, with the options for their evaluation.
#[derive(Clone, Debug, PartialEq)]
pub struct OrbitTrimRequest {
    /// The machine of the file.
    pub machine: Shared<Machine>,
    /// The base, which is known.
    pub base: OrbitBase,
    /// The measured motions.
    pub motions: Shared<Vec<OrbitMotion>>,
    /// Whether to accept the columns as given, even if another sign, order or unit explains them far better.
    pub as_given: bool,
}

/// Result of the evaluation.
#[derive(Clone, Debug)]
pub struct OrbitOutcome {
    /// Suspected fault of a measurement that was nevertheless accepted as given.
    pub doubt: Option<Doubt>,
    /// What was identified, or the reason that nothing was.
    pub outcome: Result<OrbitReport, NoTrim>,
}

/// Evaluates motions in orbit: tests for faults, one in each portion, then fits the unknowns.
pub struct OrbitTrimQuery {
    request: OrbitTrimRequest,
    stage: Stage,
}

/// Stage of the work.
enum Stage {
    Begun,
    Doubting(Box<DoubtSearch<OrbitMeasurement>>),
}

impl Query for OrbitTrimQuery {
    type Input = OrbitTrimRequest;
    type Answer = OrbitOutcome;

    fn begin(request: OrbitTrimRequest) -> Self {
        Self { request, stage: Stage::Begun }
    }

    fn go_on(&mut self, _: ProgressCallback<'_>) -> Portion<OrbitOutcome> {
        let OrbitTrimRequest { machine: Shared(machine), base, motions: Shared(motions), as_given } = &self.request;
        let doubt = match std::mem::replace(&mut self.stage, Stage::Begun) {
            Stage::Begun => match OrbitMeasurement::of(machine, *base, motions) {
                Ok(measured) => {
                    self.stage = Stage::Doubting(DoubtSearch::of(machine, measured).into());
                    return Portion::More(0.0);
                }
                Err(why) => return Portion::Done(OrbitOutcome { doubt: None, outcome: Err(NoTrim::Unusable(why)) }),
            },
            Stage::Doubting(mut doubting) => {
                if doubting.next(machine) {
                    let share = TRIED_AT * doubting.share();
                    self.stage = Stage::Doubting(doubting);
                    return Portion::More(share);
                }
                doubting.doubt(machine)
            }
        };
        match doubt {
            Some(doubt) if !as_given => {
                Portion::Done(OrbitOutcome { doubt: None, outcome: Err(NoTrim::Doubted(doubt.into())) })
            }
            doubt => {
                let outcome = orbit_trim(machine, base, motions).map_err(NoTrim::NoFit);
                Portion::Done(OrbitOutcome { doubt, outcome })
            }
        }
    }
}

/// Identifies first moments, couplings and momenta of a machine from motions in orbit, whose columns are as they say. What
/// the motions do not determine stays as in the machine's file.
///
/// # Errors
/// If there are too few rows, a motion has lists of different lengths, a wheel turns that the base does not have, or a
/// result is not finite.
pub fn orbit_trim(machine: &Machine, base: &OrbitBase, motions: &[OrbitMotion]) -> Result<OrbitReport, TrimError> {
    Ok(OrbitReport::of(machine, base, motions, &OrbitFit::of(machine, base, motions)?))
}
