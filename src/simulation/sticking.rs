//! Stick and slip: within a step, the instants at which Coulomb friction changes its mind are found and stepped to, so
//! that the result does not depend on where steps happen to end.

use super::Simulation;
use crate::plant::{Contacts, Grip, MAX_CONTACTS, Slope, State};

/// The most changes that are looked for within one step.
const MOST: usize = MAX_CONTACTS + 4;

/// Slides contacts that can no longer hold.
pub(super) fn release(contacts: &Contacts, grip: &mut Grip, taken: &[f64; MAX_CONTACTS]) {
    for i in (0..contacts.len()).filter(|i| contacts.sticks(*i)) {
        if grip[i] == 0 && taken[i].abs() >= contacts.coulomb(i) * (1.0 - 1e-12) {
            grip[i] = if taken[i] > 0.0 { 1 } else { -1 };
        }
    }
}

/// What every contact does in a state of motion.
pub(super) fn grips(contacts: &Contacts, qd: &[f64]) -> Grip {
    let mut grip = [0; MAX_CONTACTS];
    for i in (0..contacts.len()).filter(|i| contacts.sticks(*i)) {
        let v = contacts.sliding(i, qd);
        grip[i] = if v.abs() < 1e-12 { 0 } else { v.signum() as i8 };
    }
    grip
}

impl Simulation {
    /// A step of `h` seconds that may be cut where contacts stick or slip.
    pub(super) fn travel(&self, first: &Slope, h: f64) -> (State, Grip) {
        let (mut state, mut grip, mut start, mut done) = (self.state, self.grip, *first, 0.0);
        let contacts = self.body().contacts();
        if contacts.is_empty() {
            return (self.rk4(&state, &start, 0.0, h, &grip), grip);
        }
        for _ in 0..MOST {
            let left = h - done;
            let end = self.rk4(&state, &start, done, left, &grip);
            let rates = self.body().rates(&end);
            let along = |i: usize, qd: &[f64]| f64::from(grip[i]) * contacts.sliding(i, qd);
            // The one that would stop first, were rates straight lines in time.
            let stops = (0..contacts.len()).filter(|i| contacts.sticks(*i) && grip[*i] != 0);
            let first = stops
                .filter(|i| along(*i, &rates) < 0.0)
                .map(|i| (i, along(i, &start.qd).max(0.0) / (along(i, &start.qd).max(0.0) - along(i, &rates))))
                .min_by(|a, b| a.1.total_cmp(&b.1));
            let Some((i, _)) = first else {
                return (self.body().stuck(end, &grip), grip);
            };
            let stop = |tau: f64| {
                let state = self.rk4(&state, &start, done, tau, &grip);
                let v = along(i, &self.body().rates(&state));
                (state, v)
            };
            let (mut low, mut high) = ((0.0, along(i, &start.qd)), (left, along(i, &rates)));
            let (mut found, mut at) = (state, 0.0);
            if low.1 > 1e-13 {
                // The Illinois rule.
                let mut side = 0;
                for _ in 0..40 {
                    let tau = (low.0 * high.1 - high.0 * low.1) / (high.1 - low.1);
                    let (there, v) = stop(tau);
                    (found, at) = (there, tau);
                    if v > 0.0 {
                        low = (tau, v);
                        high.1 *= if side == 1 { 0.5 } else { 1.0 };
                        side = 1;
                    } else {
                        high = (tau, v);
                        low.1 *= if side == -1 { 0.5 } else { 1.0 };
                        side = -1;
                    }
                    if v.abs() < 1e-15 || (high.0 - low.0) < 1e-13 * h {
                        break;
                    }
                }
                done += at;
            }
            grip[i] = 0;
            state = self.body().stuck(found, &grip);
            let mut taken = self.taken;
            start = self.instant(&state, done, &grip, &mut taken);
            if low.1 > 1e-13 {
                release(contacts, &mut grip, &taken);
            }
        }
        let end = self.rk4(&state, &start, done, h - done, &grip);
        (self.body().stuck(end, &grip), grip)
    }
}
