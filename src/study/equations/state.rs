//! [`DriveState`]: the instant at which the equations are evaluated.

use thiserror::Error;

use stillbase_mechanics::machine::Inertia;
use stillbase_mechanics::planar::{DriveAngles, PerDrive};
use stillbase_planning::Reference;
use stillbase_session::scenario::Scenario;
use stillbase_session::{Refusal, Run, replay_while};
use stillbase_settings::number::fixed;
use stillbase_simulation::frame::Frame;

/// Angles, rates and accelerations of the drives relative to the base.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DriveState {
    /// Drive angles, rad.
    pub q: DriveAngles,
    /// Drive rates, rad/s.
    pub qd: PerDrive,
    /// Drive accelerations, rad/s².
    pub qdd: PerDrive,
    /// The required b, rad: the reference of control, or b at the start of the planned motion; `None` if there is none.
    pub b: Option<f64>,
    /// Time of the instant.
    pub when: InstantKind,
}

/// Time of an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum InstantKind {
    /// Time in the run, s.
    Run(f64),
    /// Time in the planned motion, s; used while the run is at rest, because most terms would be 0.
    Plan(f64),
    /// No time: the state was given.
    Given,
}

/// Reason that a scenario has no state at a time.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum NoInstant {
    /// The scenario cannot be run up to this time.
    #[error(transparent)]
    Refused(#[from] Refusal),
    /// The run ends before this time.
    #[error("want a time up to the end of the run, {} s", fixed(*end, 3))]
    Later {
        /// Duration of the run, s.
        end: f64,
    },
}

/// Rates and accelerations below this, rad/s and rad/s², count as rest.
const REST_BELOW: f64 = 1e-4;
/// While a run is at rest, its planned motion is evaluated at this fraction of its duration, where rates and
/// accelerations are both large.
const PLAN_FRACTION: f64 = 0.25;

impl DriveState {
    /// Returns the state of a pose at rest.
    pub fn at_rest(q: DriveAngles) -> Self {
        Self::of_reference(Reference::at_rest(q))
    }

    /// Returns the state with given angles, rates and accelerations.
    pub fn of_reference(Reference { q, qd, qdd }: Reference) -> Self {
        Self { q, qd, qdd, b: None, when: InstantKind::Given }
    }

    /// Returns the state of a frame of a run, relative to the base.
    pub fn now(frame: &Frame) -> Self {
        let n = frame.q.len();
        Self {
            q: DriveAngles(PerDrive::from_fn(n, |k| frame.relative(k))),
            qd: PerDrive::from_fn(n, |k| frame.qd[k] - frame.base_rate),
            qdd: PerDrive::from_fn(n, |k| frame.qdd[k] - frame.base_angular_acceleration),
            b: held(frame),
            when: InstantKind::Run(frame.time),
        }
    }

    /// Runs a scenario, with its edits, to a time, s, and returns the state there.
    ///
    /// # Errors
    /// Fails if the scenario cannot be run up to this time, the run ends earlier, or `goes_on` ends it.
    pub fn at(scenario: &Scenario, time: f64, goes_on: impl Fn() -> bool) -> Result<Self, NoInstant> {
        let (mut found, mut end, mut stopped) = (None, 0.0, false);
        let done = replay_while(scenario, |_, frame| {
            end = frame.time;
            let is_there = frame.time >= time - 0.5 * scenario.step;
            found = is_there.then(|| Self::now(frame));
            stopped = !goes_on();
            !(is_there || stopped)
        });
        match (found, done) {
            (Some(state), _) => Ok(state),
            (None, Err(why)) if stopped || why != Refusal::Stopped => Err(why.into()),
            _ => Err(NoInstant::Later { end }),
        }
    }

    /// Returns the state of a frame; while the run is at rest, the state at a quarter of its planned motion.
    pub fn of(run: &Run, frame: &Frame) -> Self {
        let rests = frame.qd.max_abs().max(frame.qdd.max_abs()) < REST_BELOW;
        match run.motion().filter(|_| rests) {
            Some(motion) => {
                let time = PLAN_FRACTION * motion.duration();
                let lambda = Inertia::of(&run.scenario().machine).lambda();
                let b = Some(lambda.dot(&motion.at(0.0).q));
                Self { b, when: InstantKind::Plan(time), ..Self::of_reference(motion.at(time)) }
            }
            None => Self::now(frame),
        }
    }
}

/// Returns the b that control tracks.
fn held(frame: &Frame) -> Option<f64> {
    Some(frame.b_reference).filter(|b| b.is_finite())
}
