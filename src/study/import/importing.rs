//! [`ImportQuery`]: the query that assesses a given motion and searches for a reactionless one in its place.

use super::drives::of_drives;
use super::given::GivenMotion;
use super::imported::ImportedMotion;
use super::judge::{AssessedMotion, MotionCandidate, MotionEvaluator};
use super::momentum::{ZERO_MOMENTUM, without_momentum};
use super::request::{MotionImportError, PreservedPath, Request};
use super::tip::of_tip;
use super::ways::{MotionProposals, unchanged_motion};
use crate::advice::{Advice, Remedy};
use stillbase_planning::curves::Coordinates;
use stillbase_planning::pose_space::NoPoseSpace;
use stillbase_query::{Portion, ProgressCallback, Query, part};
use stillbase_session::Refusal;

/// Minimum integration step of a proposal's scenario, s.
const MIN_STEP: f64 = 1e-4;
/// Number of instants at which a motion is evaluated: number per sample, minimum and maximum.
const INSTANTS_PER_SAMPLE: usize = 8;
const MIN_INSTANTS: usize = 4000;
const MAX_INSTANTS: usize = 200_000;
/// Fractions of the work done when the machine has been analysed, and when candidates have been found. Their simulation
/// is the rest.
const ANALYSED_AT: f64 = 0.05;
const SEARCHED_AT: f64 = 0.5;

/// Assesses a given motion and finds the first motion near it that has no reactions. One portion analyses the machine,
/// the next searches for candidates, and each further one simulates a candidate.
pub struct ImportQuery {
    request: Request,
    stage: Stage,
}

/// Stage of the work.
enum Stage {
    Begun,
    Looked(Box<MotionEvaluator>),
    Trying(Box<Trying>),
}

/// Candidates, simulated one after the other.
struct Trying {
    judge: MotionEvaluator,
    given: Option<AssessedMotion>,
    /// Candidates, the best first.
    candidates: Vec<MotionCandidate>,
    /// Number of candidates simulated.
    tried: usize,
    imported: ImportedMotion,
}

impl Query for ImportQuery {
    type Input = Request;
    type Answer = Result<ImportedMotion, MotionImportError>;

    fn begin(request: Request) -> Self {
        Self { request, stage: Stage::Begun }
    }

    fn go_on(&mut self, goes_on: ProgressCallback<'_>) -> Portion<Self::Answer> {
        // Once the progress callback has returned false, the result is incomplete and is dropped.
        let mut stopped = false;
        let mut goes_on = |done: f64| {
            stopped = stopped || !goes_on(done);
            !stopped
        };
        let portion = self.portion(&mut goes_on);
        if stopped { Portion::Stopped } else { portion }
    }
}

impl ImportQuery {
    fn portion(&mut self, goes_on: ProgressCallback<'_>) -> Portion<Result<ImportedMotion, MotionImportError>> {
        let motion = &*self.request.motion.0;
        match std::mem::replace(&mut self.stage, Stage::Begun) {
            Stage::Begun => {
                if motion.coordinates != Coordinates::Drives && self.request.keep == Some(PreservedPath::Joints) {
                    return Portion::Done(Err(MotionImportError::NoJoints));
                }
                let instants = INSTANTS_PER_SAMPLE * motion.samples.count();
                let judge = MotionEvaluator::new(&self.request.scenario.0, instants.clamp(MIN_INSTANTS, MAX_INSTANTS));
                self.stage = Stage::Looked(judge.into());
                Portion::More(ANALYSED_AT)
            }
            Stage::Looked(judge) => match ways(&self.request, &judge, &mut part(goes_on, [ANALYSED_AT, SEARCHED_AT])) {
                Ok(ways) => {
                    self.stage = Stage::Trying(Trying::of(motion, *judge, ways).into());
                    Portion::More(SEARCHED_AT)
                }
                Err(why) => Portion::Done(Err(why)),
            },
            Stage::Trying(mut trying) => match trying.next(motion, goes_on) {
                true => {
                    let share = trying.share(0.0);
                    self.stage = Stage::Trying(trying);
                    Portion::More(share)
                }
                false => Portion::Done(Ok(trying.imported)),
            },
        }
    }
}

/// Assesses the motion and searches for candidates.
fn ways(
    request: &Request,
    judge: &MotionEvaluator,
    goes_on: ProgressCallback<'_>,
) -> Result<MotionProposals, MotionImportError> {
    let motion = &*request.motion.0;
    let (samples, drives) = (&motion.samples, motion.coordinates == Coordinates::Drives);
    match &judge.space {
        Ok(space) if drives => of_drives(request, judge, space, samples, goes_on),
        Ok(space) => of_tip(request, judge, space, samples, goes_on),
        Err(NoPoseSpace::Free) => unchanged_motion(judge, samples, drives, goes_on),
        Err(why) => without_momentum(request, judge, why, goes_on),
    }
}

/// Returns the integration step of a scenario that runs the motion, s.
fn step_of(motion: &GivenMotion, judge: &MotionEvaluator) -> f64 {
    motion.samples.spacing().clamp(MIN_STEP, judge.scenario.step.max(MIN_STEP))
}

impl Trying {
    fn of(
        motion: &GivenMotion,
        judge: MotionEvaluator,
        MotionProposals { given, candidates }: MotionProposals,
    ) -> Self {
        let account = given.as_ref().map(|given| given.account.clone());
        let mut imported = ImportedMotion::of(motion, &judge, account);
        let b = imported.given.as_ref().map_or(0.0, |given| given.b_mean);
        imported.as_given = judge.as_given(motion, b, step_of(motion, &judge));
        let candidates = candidates.unwrap_or_else(|why| {
            imported.reason = Some(why);
            Vec::new()
        });
        Self { judge, given, candidates, tried: 0, imported }
    }

    /// Returns the fraction of the whole work done, given the fraction of the next candidate.
    fn share(&self, fraction_of_next: f64) -> f64 {
        SEARCHED_AT + (1.0 - SEARCHED_AT) * (self.tried as f64 + fraction_of_next) / self.candidates.len().max(1) as f64
    }

    /// Simulates the next candidate; returns whether another call is needed.
    fn next(&mut self, motion: &GivenMotion, goes_on: ProgressCallback<'_>) -> bool {
        let Some(candidate) = self.candidates.get(self.tried) else { return false };
        let step = step_of(motion, &self.judge);
        let scenario = self.judge.scenario(candidate.task.clone(), step, candidate.method);
        let mut own = part(goes_on, [self.share(0.0), self.share(1.0)]);
        match self.judge.proposal(candidate, &scenario, self.given.as_ref(), &mut own) {
            Ok(proposal) if proposal.reactionless || candidate.method == ZERO_MOMENTUM && proposal.turns_no_base => {
                match self.judge.as_given(motion, candidate.task.b, step) {
                    Some(as_given) => self.imported.propose(proposal, [scenario, as_given]),
                    None => self.imported.reason = Some("the samples make no task".into()),
                }
                return false;
            }
            Ok(proposal) if candidate.method == ZERO_MOMENTUM => {
                let left = proposal.simulated_peak_base_moment;
                let what = format!("without angular momentum the simulation still leaves up to {left:.2e} N m: want ");
                self.imported.reason = Some(Advice::from(what).name(Remedy::Smoothing).then(", or fewer samples"));
            }
            Ok(proposal) => {
                let given = self.imported.given.as_ref();
                self.imported.reason = Some(self.judge.why_not_reactionless(&proposal, given));
            }
            Err(Refusal::Stopped) => return true,
            Err(why) if candidate.method == ZERO_MOMENTUM => {
                let no_b = self.judge.space.as_ref().err().map(|why| format!("{why}. ")).unwrap_or_default();
                let way = "Without angular momentum its end effector cannot go this way";
                self.imported.reason = Some(format!("{no_b}{way}: {why}").into());
            }
            Err(why) => self.imported.reason = Some(why.to_string().into()),
        }
        self.tried += 1;
        true
    }
}
