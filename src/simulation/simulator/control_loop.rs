//! [`ControlLoop`]: continuous or sampled control with encoders, delay, torque limits and reaction wheel.
//!
//! # Measurements
//! | quantity | method |
//! |---|---|
//! | q_k − θ | by encoders, rounded to a count, at the instants of sampling |
//! | q̇_k − θ̇ | from the last two readings of the encoders; until there are two, the rate of the reference |
//! | p_B, θ and their rates | by other instruments (gyroscopes, a star tracker), exactly, at the same instants |
//!
//! Sampled control with encoders uses only these, for its model too. Without encoders, q and q̇ are exact.
//!
//! # Before the first torque
//! A torque takes effect one `delay` after the reading from which it is computed. Until the first torque takes effect,
//! the motors hold the pose against the weight of the model. If control is changed in motion, they keep the last torque
//! until then.

use std::collections::VecDeque;

use crate::control::{Control, ControlledState, Controller, Reading};
use crate::plant::{Actuation, Base, BaseKind, ReducedState, Wheel, WheelState};
use stillbase_mechanics::planar::{DriveAngles, MAX_DRIVES, PerDrive, Pose2, Vector};
use stillbase_planning::Reference;

/// Control during a run.
#[derive(Clone, Debug)]
pub struct ControlLoop {
    controller: Controller,
    limits: Option<PerDrive>,
    wheel: Option<Wheel>,
    /// Minimum and maximum torque of the wheel in this step, N m.
    wheel_range: [f64; 2],
    /// Inertia of a free base whose attitude the wheel keeps, kg m²; `None` for another base, or without a wheel.
    attitude: Option<f64>,
    /// Torque of a wheel with a rate of its own, N m, and the step from which on it is computed anew.
    wheel_hold: Option<(u64, f64)>,
    /// Step, s.
    step: f64,
    sampling: Option<Sampling>,
}

/// Commanded torques of motors and wheel, N m.
#[derive(Clone, Copy, Debug)]
struct Torques {
    motors: PerDrive,
    /// Torque of a wheel that keeps the attitude of a free base, before its limits; 0 for another wheel.
    wheel: f64,
}

/// State of sampled control.
#[derive(Clone, Debug)]
struct Sampling {
    /// Number of steps between samples.
    period: u64,
    /// Number of steps from a reading to its torque.
    delay: u64,
    /// Resolution of the encoders, rad; 0 if exact.
    count: f64,
    /// Step, s.
    step: f64,
    /// Newest reading and its step. After an edit, the same step may be read again.
    last: Option<(u64, DriveAngles)>,
    /// Reading before the newest one, at an earlier step.
    before: Option<(u64, DriveAngles)>,
    /// Torques that are not yet in effect, N m, each with the step at which it takes effect.
    pending: VecDeque<(u64, Torques)>,
    /// Torques in effect.
    held: Option<Torques>,
}

impl ControlLoop {
    /// Builds the control loop for steps of `step` s; `limits` bound the motor torques, N m.
    pub fn new(controller: Controller, control: &Control, step: f64, limits: Option<PerDrive>, base: &Base) -> Self {
        let sampling = control.is_sampled().then(|| {
            let (period, delay) = (control.period(step), (control.delay / step).round() as u64);
            Sampling {
                period,
                delay,
                count: if control.encoder > 0.0 { std::f64::consts::TAU / control.encoder } else { 0.0 },
                step,
                last: None,
                before: None,
                pending: VecDeque::with_capacity((delay / period) as usize + 2),
                held: None,
            }
        });
        let wheel = base.wheel;
        let attitude = (base.kind == BaseKind::Free && wheel.is_some()).then_some(base.inertia);
        Self { controller, limits, wheel, wheel_range: [0.0; 2], attitude, wheel_hold: None, step, sampling }
    }

    /// Begins a step: computes the torque range of the wheel and, at a sampling instant, takes a reading and computes
    /// the torques.
    pub fn sample(&mut self, step: u64, reference: &Reference, reading: &Reading, loaded: bool, wheel_rate: f64) {
        self.wheel_range = self.wheel.map_or([0.0; 2], |wheel| wheel.torque_range(wheel_rate, self.step));
        let Some(sampling) = &mut self.sampling else {
            if self.is_wheel_due(step) {
                let now = self.torques(reference, reading, loaded, None);
                self.hold_wheel(step, now.wheel);
            }
            return;
        };
        if sampling.held.is_none() || step.is_multiple_of(sampling.period) {
            let (mut e, mut rates, mut seen) = (*reading.e, *reading.rates, *reading);
            if sampling.count > 0.0 {
                let (n, count) = (reading.q.len(), sampling.count);
                // Encoders measure the motors' own angles.
                let motors = self.controller.arm().motors();
                let turned = motors.to_motors(&reading.q.0);
                seen.q = DriveAngles(PerDrive::from_fn(n, |k| (turned[k] / count).round() * count));
                motors.transform_to_drives(&mut seen.q.0);
                if let Some(last) = sampling.last.replace((step, seen.q)).filter(|(at, _)| *at < step) {
                    sampling.before = Some(last);
                }
                seen.qd = match sampling.before {
                    Some((at, before)) => {
                        let time = (step - at) as f64 * sampling.step;
                        seen.q.0.minus(&before.0).scaled(1.0 / time)
                    }
                    None => reference.qd,
                };
                let turning = reading.rates.get(n).copied().unwrap_or(0.0);
                let absolute = PerDrive::from_fn(n, |k| seen.q[k] + reading.base.angle);
                e[..n].copy_from_slice(&DriveAngles(absolute).units()[..n]);
                (0..n).for_each(|k| rates[k] = seen.qd[k] + turning);
                (seen.e, seen.rates) = (&e, &rates);
            }
            let (delay, is_first) = (sampling.delay, sampling.held.is_none());
            let due = self.is_wheel_due(step);
            let torques =
                self.torques(reference, &seen, loaded, self.wheel_hold.filter(|_| !due).map(|(_, held)| held));
            if due {
                self.hold_wheel(step, torques.wheel);
            }
            let at_first = match (is_first, delay > 0) {
                (false, _) => None,
                (true, false) => Some(torques),
                (true, true) => Some(Torques { motors: self.controller.holding(&seen, loaded), wheel: 0.0 }),
            };
            let Some(sampling) = &mut self.sampling else { return };
            sampling.held = at_first.or(sampling.held);
            sampling.pending.push_back((step + delay, torques));
        }
        let Some(sampling) = &mut self.sampling else { return };
        while let Some((_, torque)) = sampling.pending.pop_front_if(|(due, _)| *due <= step) {
            sampling.held = Some(torque);
        }
    }

    /// Continues another control loop at a step: takes over the readings and torques of `other`, and discards its own.
    /// If `other` is continuous, holds `torque`, the present motor torque, N m.
    /// The wheel holds `wheel`, N m, accordingly.
    pub fn resume(&mut self, other: &Self, step: u64, torque: &PerDrive, wheel: f64) {
        self.controller.preload_as(&other.controller);
        self.forget();
        let Some(now) = &mut self.sampling else { return };
        now.held = Some(Torques { motors: *torque, wheel });
        if let Some(before) = &other.sampling {
            (now.last, now.before, now.held) = (before.last, before.before, before.held);
            // With a shorter delay, an older torque must not take effect after a newer one.
            let due = step + now.delay;
            now.pending.extend(before.pending.iter().filter(|(at, _)| *at <= due));
        }
    }

    /// Returns whether a motor is at its torque limit.
    pub fn is_full(&self, torque: &PerDrive) -> bool {
        self.limits.is_some_and(|limits| torque.iter().zip(limits.iter()).any(|(t, limit)| t.abs() >= *limit))
    }

    /// Returns whether control is continuous and without a wheel. Then the slope at the end of a step is also the slope
    /// at the start of the next.
    pub fn is_steady(&self) -> bool {
        self.sampling.is_none() && self.wheel.is_none()
    }

    /// Discards readings and torques, which no longer apply once the machine has been placed elsewhere.
    pub fn forget(&mut self) {
        self.wheel_hold = None;
        if let Some(sampling) = &mut self.sampling {
            (sampling.last, sampling.before, sampling.held) = (None, None, None);
            sampling.pending.clear();
        }
    }

    /// Returns the inertia of the wheel, kg m²; 0 without a wheel.
    pub fn rotor(&self) -> f64 {
        self.wheel.map_or(0.0, |wheel| wheel.inertia)
    }

    /// Returns whether a wheel with a rate of its own computes its torque anew at a step.
    fn is_wheel_due(&self, step: u64) -> bool {
        let has_rate = self.attitude.is_some() && self.wheel.is_some_and(|wheel| wheel.period(self.step) > 0);
        has_rate && self.wheel_hold.is_none_or(|(next, _)| step >= next)
    }

    /// Holds the torque of a wheel with a rate of its own, N m, until its next sample.
    fn hold_wheel(&mut self, step: u64, torque: f64) {
        let period = self.wheel.map_or(1, |wheel| wheel.period(self.step));
        self.wheel_hold = Some(((step / period + 1) * period, torque));
    }

    /// Returns the torques for a reading. The wheel keeps the torque `held`, N m, if there is one.
    fn torques(&self, reference: &Reference, reading: &Reading, loaded: bool, held: Option<f64>) -> Torques {
        let turning = reading.rates.get(reading.q.len()).copied().unwrap_or(0.0);
        let mut wheel = 0.0;
        let motors = self.controller.torque(reference, reading, loaded, |moment, inertia| {
            wheel = held.unwrap_or_else(|| self.wanted(moment, inertia, reading.base.angle, turning));
            self.within(wheel)
        });
        if let Some(own) = self.attitude.filter(|_| !self.controller.models_attitude()) {
            let moment = -self.on_base(&motors, reference);
            wheel = held.unwrap_or_else(|| self.wanted(moment, own, reading.base.angle, turning));
        }
        Torques { motors, wheel }
    }

    /// Returns the torque of the wheel, N m, that takes up a moment, N m, and gives an inertia, kg m², the acceleration
    /// that attitude feedback wants for the angle, rad, and rate, rad/s, of the base. Returns 0 without such a wheel.
    #[inline]
    fn wanted(&self, moment: f64, inertia: f64, angle: f64, rate: f64) -> f64 {
        match (self.attitude, &self.wheel) {
            (Some(_), Some(wheel)) => moment - inertia * wheel.attitude_feedback(angle, rate),
            _ => 0.0,
        }
    }

    /// Returns a torque of the wheel within the limits of this step, N m.
    #[inline]
    fn within(&self, torque: f64) -> f64 {
        torque.max(self.wheel_range[0]).min(self.wheel_range[1])
    }

    /// Returns the commands of motors and wheel at the exact state `at`, with unit vectors and rates in `motion`. `N`
    /// is the number of rotational coordinates; `MOVES` says whether the base moves.
    #[inline(always)]
    pub(super) fn command<const N: usize, const MOVES: bool>(
        &self,
        reference: &Reference,
        at: &ReducedState<N>,
        motion: (&[Vector; N], &[f64; N]),
        base: (Pose2, Vector),
        loaded: bool,
    ) -> Actuation<N> {
        let (angle, turning) = (base.0.angle, if MOVES { motion.1[N - 1] } else { 0.0 });
        let mut attitude = self.wheel_hold.map_or(0.0, |(_, held)| held);
        let mut torque = match &self.sampling {
            Some(Sampling { held: Some(held), .. }) => {
                attitude = held.wheel;
                *held.motors.array()
            }
            _ => {
                let (mut q, mut qd) = (at.q, *motion.1);
                if MOVES {
                    let (n, rate) = (N - 1, motion.1);
                    (0..n).for_each(|k| (q[k], qd[k]) = (q[k] - base.0.angle, qd[k] - rate[n]));
                    (q[n], qd[n]) = (0.0, 0.0);
                }
                let ((e, rate), (base, velocity)) = (motion, base);
                let state = ControlledState { q: &q, qd: &qd, e, rate, base, velocity };
                self.controller.torque_at::<N, MOVES>(reference, &state, loaded, |moment, inertia| {
                    if self.wheel_hold.is_none() {
                        attitude = self.wanted(moment, inertia, angle, turning);
                    }
                    self.within(attitude)
                })
            }
        };
        if let Some(limits) = &self.limits {
            torque.iter_mut().zip(limits.iter()).for_each(|(t, limit)| *t = t.clamp(-limit, *limit));
        }
        let spin = match &self.wheel {
            Some(wheel) => {
                let n = if MOVES { N - 1 } else { N };
                let is_held = self.sampling.is_some() || self.wheel_hold.is_some();
                let wanted = match self.attitude {
                    Some(_) if is_held || self.controller.models_attitude() => attitude,
                    Some(own) => self.wanted(-self.on_base(&torque[..n], reference), own, angle, turning),
                    None => -self.on_base(&torque[..n], reference),
                };
                wheel.command(wanted, at.wheel, self.wheel_range)
            }
            None => WheelState::default(),
        };
        Actuation { torque, spin, rotor: self.rotor() }
    }

    /// Returns the moment that the base exerts on the motors' stators, N m. Geared rotors count as if drives had the
    /// reference accelerations.
    fn on_base(&self, torque: &[f64], reference: &Reference) -> f64 {
        let n = torque.len();
        let (arm, wanted) = (self.controller.arm(), &reference.qdd);
        let mut sum = torque.iter().sum::<f64>();
        if arm.motors().in_joints() {
            sum -= (0..n).filter(|k| arm.motors().on(*k).is_some()).map(|k| torque[k]).sum::<f64>();
        }
        let geared = |k: usize| {
            if arm.stator_reaction[k] != 0.0 || n >= MAX_DRIVES {
                arm.stator_reaction[k]
            } else {
                arm.rotor_coupling[n][k]
            }
        };
        sum + (0..n).map(|k| geared(k) * wanted[k]).sum::<f64>()
    }
}
