//! [`OrbitTrimQuery`]: the query that evaluates motions in orbit.

use super::consistency::{contradiction, dead_signal};
use super::fault::{EXACT, OrbitMeasurement, SLACK};
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
    /// The doubts found so far.
    doubts: Vec<Doubt>,
}

/// Stage of the work.
enum Stage {
    /// The number of searches done: of all motions together, then of each alone. One spoilt file of several is found so.
    Begun(usize),
    Doubting(usize, Box<DoubtSearch<OrbitMeasurement>>),
}

impl Query for OrbitTrimQuery {
    type Input = OrbitTrimRequest;
    type Answer = OrbitOutcome;

    fn begin(request: OrbitTrimRequest) -> Self {
        Self { request, stage: Stage::Begun(0), doubts: Vec::new() }
    }

    fn go_on(&mut self, _: ProgressCallback<'_>) -> Portion<OrbitOutcome> {
        let OrbitTrimRequest { machine: Shared(machine), base, motions: Shared(motions), as_given } = &self.request;
        // All together, and each alone if there are several.
        let searches = if motions.len() > 1 { 1 + motions.len() } else { 1 };
        let share = |done: usize, part: f64| TRIED_AT * (done as f64 + part) / searches as f64;
        let doubt = match std::mem::replace(&mut self.stage, Stage::Begun(searches)) {
            Stage::Begun(done) if done >= searches => {
                let doubt = chosen(std::mem::take(&mut self.doubts));
                // What no usual mistake explains may still be no motion.
                if doubt.is_none()
                    && !as_given
                    && let Some(why) = contradiction(machine, motions)
                {
                    return Portion::Done(OrbitOutcome { doubt: None, outcome: Err(NoTrim::Unusable(why)) });
                }
                doubt
            }
            Stage::Begun(0) if let Some(why) = unusable(&self.request) => {
                return Portion::Done(OrbitOutcome { doubt: None, outcome: Err(NoTrim::Unusable(why)) });
            }
            Stage::Begun(done) => {
                let part = done.checked_sub(1).map_or(motions.as_slice(), |alone| &motions[alone..=alone]);
                self.stage = match OrbitMeasurement::search(machine, *base, part) {
                    Ok(doubting) => Stage::Doubting(done, doubting.into()),
                    Err(why) if done == 0 => {
                        return Portion::Done(OrbitOutcome { doubt: None, outcome: Err(NoTrim::Unusable(why)) });
                    }
                    // Alone, a motion may be too short.
                    Err(_) => Stage::Begun(done + 1),
                };
                return Portion::More(share(done, 0.0));
            }
            Stage::Doubting(done, mut doubting) => {
                if doubting.next(machine) {
                    let share = share(done, doubting.share());
                    self.stage = Stage::Doubting(done, doubting);
                    return Portion::More(share);
                }
                let found = doubting.doubt(machine).map(|doubt| Doubt { motion: done.checked_sub(1), ..doubt });
                self.doubts.extend(found);
                self.stage = Stage::Begun(done + 1);
                return Portion::More(share(done, 1.0));
            }
        };
        match doubt {
            Some(doubt) if !as_given => {
                Portion::Done(OrbitOutcome { doubt: None, outcome: Err(NoTrim::Doubted(doubt.into())) })
            }
            doubt => {
                let outcome = orbit_trim(machine, base, motions).map_err(NoTrim::NoFit);
                // Where the model leaves much, intervals mean nothing.
                let unexplained = outcome.as_ref().ok().filter(|_| !as_given).and_then(OrbitReport::unexplained);
                let outcome = unexplained.map_or(outcome, |doubt| Err(NoTrim::Doubted(doubt.into())));
                Portion::Done(OrbitOutcome { doubt, outcome })
            }
        }
    }
}

/// Returns the error of the first motion whose lists do not belong together, or that has a dead signal. Dead signals are
/// accepted if columns are taken as given.
fn unusable(request: &OrbitTrimRequest) -> Option<TrimError> {
    let OrbitTrimRequest { machine: Shared(machine), base, motions: Shared(motions), as_given } = request;
    let unsound = motions.iter().enumerate().find_map(|(i, motion)| motion.check(i, machine.drives()).err());
    let dead = || if *as_given { None } else { dead_signal(machine, base, motions) };
    unsound.or_else(dead)
}

/// Returns the doubt to report. A fault of all motions together counts in three cases: it is the likeliest of one motion alone,
/// no motion is doubted alone, or it is likelier than the faults of single motions and leaves as little unexplained. Otherwise
/// one motion is spoilt: that with the greatest odds.
fn chosen(mut doubts: Vec<Doubt>) -> Option<Doubt> {
    let first = |doubt: &Doubt| doubt.causes.first().map(|cause| cause.what.clone());
    let odds = |doubt: &Doubt| doubt.causes.first().map_or(0.0, |cause| cause.odds);
    let together = doubts.iter().position(|doubt| doubt.motion.is_none()).map(|place| doubts.remove(place));
    let left = |doubt: &Doubt| doubt.causes.first().map_or(f64::INFINITY, |cause| cause.residuals[0].share);
    let explains_as_well =
        |common: &Doubt, alone: &Doubt| odds(common) > odds(alone) && left(common) <= SLACK * left(alone).max(EXACT);
    let is_common = |doubt: &Doubt| {
        doubts.iter().any(|alone| first(alone) == first(doubt))
            || doubts.iter().all(|alone| explains_as_well(doubt, alone))
    };
    match together.filter(is_common) {
        Some(common) => Some(common),
        None => doubts.into_iter().max_by(|a, b| odds(a).total_cmp(&odds(b))),
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
