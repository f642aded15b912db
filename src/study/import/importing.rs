//! [`Importing`]: the query for what a given motion does, and for the motion that is proposed in its place.

use super::freedoms;
use super::given::GivenMotion;
use super::imported::Imported;
use super::judge::{Candidate, Judge};
use super::request::{ImportError, Keep, Request};
use super::ways::{Ways, of_drives, of_tip};
use crate::planning::Motion;
use crate::planning::curves::Coordinates;
use crate::planning::pose_space::NoPoseSpace;
use crate::query::{Portion, Query, Watch};
use crate::session::Refusal;

/// The shortest step of a proposal, s.
const MIN_STEP: f64 = 1e-4;
/// How many instants of a motion are looked at: so many for each sample, at least and at most.
const INSTANTS_PER_SAMPLE: usize = 8;
const MIN_INSTANTS: usize = 4000;
const MAX_INSTANTS: usize = 200_000;

/// What a given motion does, and the first of the motions near it that has no reactions: a candidate in a portion.
pub struct Importing {
    request: Request,
    work: Option<Work>,
}

/// A motion that is assessed.
struct Work {
    judge: Judge,
    given: Option<Motion>,
    /// Those that are left, the best first.
    candidates: std::vec::IntoIter<Candidate>,
    imported: Imported,
}

impl Query for Importing {
    type Input = Request;
    type Answer = Result<Imported, ImportError>;

    fn begin(request: Request) -> Self {
        Self { request, work: None }
    }

    fn go_on(&mut self, goes_on: Watch<'_>) -> Portion<Self::Answer> {
        let Some(work) = &mut self.work else {
            return match Work::of(&self.request) {
                Ok(work) => {
                    self.work = Some(work);
                    Portion::More(0.0)
                }
                Err(why) => Portion::Done(Err(why)),
            };
        };
        let step = self.request.motion.0.samples.spacing().clamp(MIN_STEP, work.judge.scenario.step.max(MIN_STEP));
        match work.try_next(&self.request.motion.0, step, goes_on) {
            Err(Refusal::Stopped) => Portion::Stopped,
            Ok(true) => Portion::More(0.0),
            _ => Portion::Done(Ok(work.imported.clone())),
        }
    }
}

impl Work {
    fn of(request: &Request) -> Result<Self, ImportError> {
        let motion = &*request.motion.0;
        let (samples, drives) = (&motion.samples, motion.coordinates == Coordinates::Drives);
        if !drives && request.keep == Some(Keep::Joints) {
            return Err(ImportError::NoJoints);
        }
        let instants = (INSTANTS_PER_SAMPLE * samples.count()).clamp(MIN_INSTANTS, MAX_INSTANTS);
        let judge = Judge::new(&request.scenario.0, instants);
        let Ways { given, candidates } = match &judge.space {
            Ok(space) if drives => of_drives(request, &judge, space, samples)?,
            Ok(space) => match space.planes() {
                Ok(planes) => of_tip(request, &judge, (space, planes), samples)?,
                Err(_) => freedoms::of_tip(request, &judge, space, samples)?,
            },
            Err(NoPoseSpace::Free) => freedoms::as_given(&judge, samples, drives)?,
            Err(why) => {
                let given = freedoms::as_given(&judge, samples, drives)?;
                Ways { candidates: Err(why.to_string()), ..given }
            }
        };
        let mut imported = Imported::of(motion, &judge, given.as_ref());
        let candidates = candidates.unwrap_or_else(|why| {
            imported.reason = Some(why);
            Vec::new()
        });
        Ok(Self { judge, given, candidates: candidates.into_iter(), imported })
    }

    /// Simulates the next candidate; whether another one is to be tried.
    ///
    /// # Errors
    /// If the rest is not wanted.
    fn try_next(&mut self, motion: &GivenMotion, step: f64, goes_on: Watch<'_>) -> Result<bool, Refusal> {
        let Some(candidate) = self.candidates.next() else { return Ok(false) };
        let scenario = self.judge.scenario(candidate.task.clone(), step, candidate.way);
        match self.judge.proposal(&candidate, &scenario, self.given.as_ref(), goes_on) {
            Ok(proposal) if proposal.reactionless => {
                match self.judge.as_given(motion, candidate.task.b, step) {
                    Some(as_given) => self.imported.propose(proposal, [scenario, as_given]),
                    None => self.imported.reason = Some("the samples make no task".into()),
                }
                return Ok(false);
            }
            Ok(proposal) => {
                let given = self.imported.given.as_ref();
                self.imported.reason = Some(self.judge.why_not_reactionless(&proposal, given));
            }
            Err(Refusal::Stopped) => return Err(Refusal::Stopped),
            Err(why) => self.imported.reason = Some(why.to_string()),
        }
        Ok(true)
    }
}
