//! [`ControlLoop`]: control as it runs, all the time or sampled: encoders, delay, torque limits, and the wheel.
//!
//! # What is measured
//! | quantity | how |
//! |---|---|
//! | q_k − θ | by encoders, rounded to a count, at the instants of sampling |
//! | q̇_k − θ̇ | from the last two readings of the encoders; until there are two, the rate of the reference |
//! | p_B, θ and their rates | by other instruments (gyroscopes, a star tracker), exactly, at the same instants |
//!
//! All that control knows of the machine comes from these: also e(q) and q̇, at which it evaluates its model.
//!
//! # Before the first torque
//! A torque comes into effect `delay` after its reading. Until the first does, the motors do what they did while the
//! machine stood there: they hold the pose against what the model knows of weight. In motion, when control is changed
//! on the way, they keep the last torque.

use std::collections::VecDeque;

use crate::mechanics::planar::{DriveAngles, MAX_DRIVES, PerDrive, Pose2, Vector};
use crate::planning::Reference;
use crate::simulation::control::{Control, Controller, Reading};
use crate::simulation::plant::{Command, Point, Wheel, WheelState};

/// Control as it runs.
#[derive(Clone, Debug)]
pub struct ControlLoop {
    controller: Controller,
    limits: Option<PerDrive>,
    wheel: Option<Wheel>,
    /// The least and the greatest torque of the wheel in this step, N m.
    wheel_room: [f64; 2],
    /// s.
    step: f64,
    sampling: Option<Sampling>,
}

/// Control that is computed now and then.
#[derive(Clone, Debug)]
struct Sampling {
    /// Steps between samples.
    period: u64,
    /// Steps from a reading to its torque.
    delay: u64,
    /// One count of the encoders, rad; 0: exact.
    count: f64,
    /// s.
    step: f64,
    /// The newest reading with its step, and the one before: a step may be looked at again after an edit.
    last: Option<(u64, DriveAngles)>,
    before: Option<(u64, DriveAngles)>,
    /// Torques to come and the steps at which they do.
    pending: VecDeque<(u64, PerDrive)>,
    held: Option<PerDrive>,
}

impl ControlLoop {
    /// A controller at `step` s; motors give no more than `limits`, N m.
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
        Self { controller, limits, wheel, wheel_room: [0.0; 2], step, sampling }
    }

    /// Once a step: sees how much the wheel can still take up, and reads and computes, if it samples and its time has
    /// come.
    pub fn sample(&mut self, step: u64, reference: &Reference, reading: &Reading, loaded: bool, wheel_rate: f64) {
        self.wheel_room = self.wheel.map_or([0.0; 2], |wheel| wheel.room(wheel_rate, self.step));
        let Some(sampling) = &mut self.sampling else { return };
        if sampling.held.is_none() || step.is_multiple_of(sampling.period) {
            let (mut e, mut rates, mut seen) = (*reading.e, *reading.rates, *reading);
            if sampling.count > 0.0 {
                let (n, count) = (reading.q.len(), sampling.count);
                // An encoder sits on its motor.
                let motors = self.controller.arm().motors();
                let turned = motors.turns(&reading.q.0);
                seen.q = DriveAngles(PerDrive::from_fn(n, |k| (turned[k] / count).round() * count));
                motors.drive(&mut seen.q.0);
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

    /// Goes on at a step where another was, with what that has under way and the torque that the motors give; what it
    /// has from before its own start is forgotten.
    pub fn resume(&mut self, other: &Self, step: u64, torque: &PerDrive) {
        self.controller.preload_as(&other.controller);
        self.forget();
        let Some(now) = &mut self.sampling else { return };
        now.held = Some(*torque);
        if let Some(before) = &other.sampling {
            (now.last, now.before, now.held) = (before.last, before.before, before.held);
            // With a shorter delay nothing older may arrive after what is newer.
            let due = step + now.delay;
            now.pending.extend(before.pending.iter().filter(|(at, _)| *at <= due));
        }
    }

    /// Whether a motor gives all it has.
    pub fn is_full(&self, torque: &PerDrive) -> bool {
        self.limits.is_some_and(|limits| torque.iter().zip(limits.iter()).any(|(t, limit)| t.abs() >= *limit))
    }

    /// Whether nothing is decided once a step, so that the slope at the end of one is that at the start of the next.
    pub fn is_steady(&self) -> bool {
        self.sampling.is_none() && self.wheel.is_none()
    }

    /// Forgets readings and torques under way: the machine is put somewhere else.
    pub fn forget(&mut self) {
        if let Some(sampling) = &mut self.sampling {
            (sampling.last, sampling.before, sampling.held) = (None, None, None);
            sampling.pending.clear();
        }
    }

    /// The rotor of the wheel, kg m²; 0 for none.
    pub fn rotor(&self) -> f64 {
        self.wheel.map_or(0.0, |wheel| wheel.inertia)
    }

    /// What motors and wheel do at this instant, from angles and rates that are known exactly, at the machine's own
    /// size, on a base that `MOVES` or not.
    #[inline(always)]
    pub(super) fn command<const N: usize, const MOVES: bool>(
        &self,
        reference: &Reference,
        at: &Point<N>,
        motion: (&[Vector; N], &[f64; N]),
        base: (Pose2, Vector),
        loaded: bool,
    ) -> Command<N> {
        let mut torque = match &self.sampling {
            Some(Sampling { held: Some(held), .. }) => *held.array(),
            _ => {
                let (mut q, mut qd) = (at.q, *motion.1);
                if MOVES {
                    let (n, rate) = (N - 1, motion.1);
                    (0..n).for_each(|k| (q[k], qd[k]) = (q[k] - base.0.angle, qd[k] - rate[n]));
                    (q[n], qd[n]) = (0.0, 0.0);
                }
                self.controller.torque_at::<N, MOVES>(reference, (&q, &qd), motion, base, loaded)
            }
        };
        if let Some(limits) = &self.limits {
            torque.iter_mut().zip(limits.iter()).for_each(|(t, limit)| *t = t.clamp(-limit, *limit));
        }
        let spin = match &self.wheel {
            Some(wheel) => {
                let feels = self.on_base::<N, MOVES>(&torque, reference);
                wheel.give(-feels, at.wheel, self.wheel_room)
            }
            None => WheelState::default(),
        };
        Command { torque, spin, rotor: self.rotor() }
    }

    /// What the motors' stators take from the base, N m, with what gears make of the accelerations that are wanted.
    #[inline(always)]
    fn on_base<const N: usize, const MOVES: bool>(&self, torque: &[f64; N], reference: &Reference) -> f64 {
        let n = if MOVES { N - 1 } else { N };
        let (arm, wanted) = (self.controller.arm(), reference.qdd.array::<N>());
        let mut sum = torque.iter().sum::<f64>();
        if arm.motors().in_joints() {
            sum -= (0..n).filter(|k| arm.motors().on(*k).is_some()).map(|k| torque[k]).sum::<f64>();
        }
        let geared =
            |k: usize| if arm.taken_up[k] != 0.0 || n >= MAX_DRIVES { arm.taken_up[k] } else { arm.gears[n][k] };
        sum + (0..n).map(|k| geared(k) * wanted[k]).sum::<f64>()
    }
}
