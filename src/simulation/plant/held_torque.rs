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
    pub fn advance_under(&self, torques: &[f64], steps: EqualSteps, q: &mut [f64], qd: &mut [f64]) {
        by_drives!(self.arm.drives, advance_rows(self, torques, steps, q, qd))
    }
}

#[inline(never)]
fn advance_rows<const N: usize>(body: &MovingBody, torques: &[f64], steps: EqualSteps, q: &mut [f64], qd: &mut [f64]) {
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
        for _ in 0..steps.count {
            (state, _) = StateRates::runge_kutta::<false>(&state, &rates, steps.length, |at, _| stage(at));
            rates = stage(&ReducedState::of(&state)).rates;
        }
        (*q, *qd) = (*state.q.array(), rates.q);
    }
}
