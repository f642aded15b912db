//! [`State`]: the instant that the numbers are of.

use thiserror::Error;

use crate::mechanics::machine::Inertia;
use crate::mechanics::planar::{DriveAngles, PerDrive};
use crate::planning::Reference;
use crate::session::scenario::Scenario;
use crate::session::{Refusal, Run, replay_while};
use crate::settings::number::fixed;
use crate::simulation::frame::Frame;

/// How the drives stand and move, as seen from the base.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// rad.
    pub q: DriveAngles,
    /// rad/s.
    pub qd: PerDrive,
    /// rad/s².
    pub qdd: PerDrive,
    /// The b that is to be held, rad: the one that control aims at, or that the motion starts with.
    pub b: Option<f64>,
    /// When that is.
    pub when: When,
}

/// An instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum When {
    /// Of the run, s.
    Run(f64),
    /// Of the planned motion, s, because the run rests and most terms would be 0.
    Plan(f64),
    /// A pose that was given.
    Given,
}

/// Why a scenario has no state at a time.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum NoInstant {
    /// It cannot be run so far.
    #[error(transparent)]
    Refused(#[from] Refusal),
    /// Its run ends before.
    #[error("want a time up to the end of the run, {} s", fixed(*end, 3))]
    Later {
        /// s.
        end: f64,
    },
}

/// Slower than this, rad/s and rad/s², is rest.
const REST: f64 = 1e-4;
/// The instant of a motion that stands for it, as a part of its time: rates and accelerations are both large there.
const PART: f64 = 0.25;

impl State {
    /// Of a pose, at rest.
    pub fn at_rest(q: DriveAngles) -> Self {
        Self::given(Reference::at_rest(q))
    }

    /// Of angles, rates and accelerations.
    pub fn given(Reference { q, qd, qdd }: Reference) -> Self {
        Self { q, qd, qdd, b: None, when: When::Given }
    }

    /// Of an instant of a run, relative to its base.
    pub fn now(frame: &Frame) -> Self {
        let n = frame.q.len();
        Self {
            q: DriveAngles(PerDrive::from_fn(n, |k| frame.relative(k))),
            qd: PerDrive::from_fn(n, |k| frame.qd[k] - frame.base_rate),
            qdd: frame.qdd,
            b: held(frame),
            when: When::Run(frame.time),
        }
    }

    /// Of a scenario's run at a time, s, as edits leave it.
    ///
    /// # Errors
    /// If it cannot be run so far, or ends before.
    pub fn at(scenario: &Scenario, time: f64) -> Result<Self, NoInstant> {
        let (mut found, mut end) = (None, 0.0);
        let done = replay_while(scenario, |_, frame| {
            end = frame.time;
            let is_there = frame.time >= time - 0.5 * scenario.step;
            found = is_there.then(|| Self::now(frame));
            !is_there
        });
        match (found, done) {
            (Some(state), _) => Ok(state),
            (None, Err(why)) if why != Refusal::Stopped => Err(why.into()),
            _ => Err(NoInstant::Later { end }),
        }
    }

    /// Of an instant of a run; while it rests, a quarter into its planned motion.
    pub fn of(run: &Run, frame: &Frame) -> Self {
        let rests = frame.qd.max_abs().max(frame.qdd.max_abs()) < REST;
        match run.motion().filter(|_| rests) {
            Some(motion) => {
                let time = PART * motion.duration();
                let lambda = Inertia::of(&run.scenario().machine).lambda();
                let b = Some(lambda.dot(&motion.at(0.0).q));
                Self { b, when: When::Plan(time), ..Self::given(motion.at(time)) }
            }
            None => Self::now(frame),
        }
    }
}

/// The b that control aims at.
fn held(frame: &Frame) -> Option<f64> {
    Some(frame.b_reference).filter(|b| b.is_finite())
}
