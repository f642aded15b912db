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
use crate::plant::{Actuation, ReducedState, Wheel, WheelState};
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
    /// Step, s.
    step: f64,
    sampling: Option<Sampling>,
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
    pending: VecDeque<(u64, PerDrive)>,
    /// Torque in effect, N m.
    held: Option<PerDrive>,
}

impl ControlLoop {
    /// Builds the control loop for steps of `step` s; `limits` bound the motor torques, N m.
    pub fn new(
        controller: Controller,
        control: &Control,
        step: f64,
        limits: Option<PerDrive>,
        wheel: Option<Wheel>,
    ) -> Self {
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
        Self { controller, limits, wheel, wheel_range: [0.0; 2], step, sampling }
    }

    /// Begins a step: computes the torque range of the wheel and, at a sampling instant, takes a reading and computes
    /// the torques.
    pub fn sample(&mut self, step: u64, reference: &Reference, reading: &Reading, loaded: bool, wheel_rate: f64) {
        self.wheel_range = self.wheel.map_or([0.0; 2], |wheel| wheel.torque_range(wheel_rate, self.step));
        let Some(sampling) = &mut self.sampling else { return };
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
            let torque = self.controller.torque(reference, &seen, loaded);
            if sampling.held.is_none() {
                sampling.held = Some(if sampling.delay > 0 { self.controller.holding(&seen, loaded) } else { torque });
            }
            sampling.pending.push_back((step + sampling.delay, torque));
        }
        while let Some((_, torque)) = sampling.pending.pop_front_if(|(due, _)| *due <= step) {
            sampling.held = Some(torque);
        }
    }

    /// Continues another control loop at a step: takes over the readings and torques of `other`, and discards its own.
    /// If `other` is continuous, holds `torque`, the present motor torque, N m.
    pub fn resume(&mut self, other: &Self, step: u64, torque: &PerDrive) {
        self.controller.preload_as(&other.controller);
        self.forget();
        let Some(now) = &mut self.sampling else { return };
        now.held = Some(*torque);
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
        if let Some(sampling) = &mut self.sampling {
            (sampling.last, sampling.before, sampling.held) = (None, None, None);
            sampling.pending.clear();
        }
    }

    /// Returns the inertia of the wheel, kg m²; 0 without a wheel.
    pub fn rotor(&self) -> f64 {
        self.wheel.map_or(0.0, |wheel| wheel.inertia)
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
        let mut torque = match &self.sampling {
            Some(Sampling { held: Some(held), .. }) => *held.array(),
            _ => {
                let (mut q, mut qd) = (at.q, *motion.1);
                if MOVES {
                    let (n, rate) = (N - 1, motion.1);
                    (0..n).for_each(|k| (q[k], qd[k]) = (q[k] - base.0.angle, qd[k] - rate[n]));
                    (q[n], qd[n]) = (0.0, 0.0);
                }
                let ((e, rate), (base, velocity)) = (motion, base);
                let state = ControlledState { q: &q, qd: &qd, e, rate, base, velocity };
                self.controller.torque_at::<N, MOVES>(reference, &state, loaded)
            }
        };
        if let Some(limits) = &self.limits {
            torque.iter_mut().zip(limits.iter()).for_each(|(t, limit)| *t = t.clamp(-limit, *limit));
        }
        let spin = match &self.wheel {
            Some(wheel) => {
                let moment = self.on_base::<N, MOVES>(&torque, reference);
                wheel.command(-moment, at.wheel, self.wheel_range)
            }
            None => WheelState::default(),
        };
        Actuation { torque, spin, rotor: self.rotor() }
    }

    /// Returns the moment that the base exerts on the motors' stators, N m. Geared rotors count as if drives had the
    /// reference accelerations.
    #[inline(always)]
    fn on_base<const N: usize, const MOVES: bool>(&self, torque: &[f64; N], reference: &Reference) -> f64 {
        let n = if MOVES { N - 1 } else { N };
        let (arm, wanted) = (self.controller.arm(), reference.qdd.array::<N>());
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
