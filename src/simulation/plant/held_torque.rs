//! [`MovingBody::advance_under`]: steps of a plant under given torques, without control.

use super::{Actuation, MAX_CONTACTS, MovingBody, ReducedState, StateRates, WheelState};
use stillbase_mechanics::dynamics::by_drives;
use stillbase_mechanics::planar::{DriveAngles, PerDrive, Pose2, Vector};

/// Steps of equal length.
#[derive(Clone, Copy, Debug)]
pub struct EqualSteps {
    /// Length of a step, s; a negative one goes back in time.
    pub length: f64,
    /// Their number.
    pub count: usize,
}

impl MovingBody {
    /// Advances states of motion by steps of the classical fourth-order Runge–Kutta method, as a
    /// [`Simulation`](crate::Simulation) without substeps does. Motor torques are constant meanwhile; contacts have no
    /// friction.
    ///
    /// Angles `q`, rad, and rates `qd`, rad/s, have a row for each state and are replaced; torques, N m, have as many
    /// rows, or one for all states. Rows are as long as there are drives. The base must be fixed.
    ///
    /// If `goes_on` returns `false`, the states that are not yet advanced stay as they are.
    pub fn advance_under(
        &self,
        torques: &[f64],
        steps: EqualSteps,
        [q, qd]: [&mut [f64]; 2],
        goes_on: &dyn Fn() -> bool,
    ) {
        by_drives!(self.arm.drives, advance_rows(self, torques, steps, [q, qd], goes_on))
    }
}

/// Number of steps after which `goes_on` is asked again; they take about a millisecond.
const STEPS_PER_QUESTION: usize = 1024;

#[inline(never)]
fn advance_rows<const N: usize>(
    body: &MovingBody,
    torques: &[f64],
    steps: EqualSteps,
    [q, qd]: [&mut [f64]; 2],
    goes_on: &dyn Fn() -> bool,
) {
    let mut until_question = STEPS_PER_QUESTION;
    let (torques, q, qd) = (torques.as_chunks::<N>().0, q.as_chunks_mut::<N>().0, qd.as_chunks_mut::<N>().0);
    let rows = q.iter_mut().zip(qd).zip(torques.iter().cycle());
    for ((q, qd), torque) in rows {
        let stage = |at: &ReducedState<N>| {
            let given = |_: &_, _: &_, _, _| Actuation { torque: *torque, spin: WheelState::default(), rotor: 0.0 };
            body.stage::<N, false>(at, &[0; MAX_CONTACTS], &mut [0.0; MAX_CONTACTS], given)
        };
        let start = (DriveAngles(PerDrive::from(*q)), PerDrive::from(*qd));
        let mut state = body.state(&start.0, &start.1, Pose2::default(), Vector::default(), 0.0);
        let mut rates = stage(&ReducedState::of(&state)).rates;
        let mut left = steps.count;
        while left > 0 {
            let together = left.min(until_question);
            for _ in 0..together {
                (state, _) = StateRates::runge_kutta::<false>(&state, &rates, steps.length, |at, _| stage(at));
                rates = stage(&ReducedState::of(&state)).rates;
            }
            left -= together;
            until_question -= together;
            if until_question == 0 {
                if !goes_on() {
                    return;
                }
                until_question = STEPS_PER_QUESTION;
            }
        }
        (*q, *qd) = (*state.q.array(), rates.q);
    }
}
