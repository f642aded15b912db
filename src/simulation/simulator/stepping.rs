//! How a step is taken: in segments that end on the kinks of the reference, each in as many substeps as it needs.
//!
//! # Method
//! Classical fourth-order Runge–Kutta gives two slopes at the end of a substep: that of its last stage, and that of the
//! state it comes to, which the next substep begins with anyway. They differ by more than the error of the substep, so
//! their difference is an estimate of it that costs next to nothing. Where it is more than [`FINE`] of the peaks of
//! what is shown, the segment is done again in twice as many substeps, until the estimate, or the difference between
//! two such runs, is small enough, up to [`MOST_SUBSTEPS`]; the next step begins with as many, and goes back when it
//! can. So stiff gains, springs and friction, and kinks that nobody can foresee, as of motors that saturate, cost more
//! steps where they are and none elsewhere; everything else costs what four stages cost.
//!
//! Errors of forces and torques fade as control takes them up; those of where things are may add up. So every
//! [`HALVED_EVERY`]-th step is done in twice as many substeps besides, and by how far end effector and base then stand
//! elsewhere is taken to happen at every step. The worse of the two, the worst disagreement and what adds up, is the
//! figure `step` of the audit. All of it depends on the run alone, so a replay takes the same substeps.

use super::guide::Guide;
use super::simulation::Simulation;
use super::step_control::{Mismatch, Segment, StepState, Substep};
use crate::mechanics::kinematics::end_effector;
use crate::mechanics::planar::{DriveAngles, Vector};
use crate::planning::{Motion, Reference};
use crate::simulation::frame::Peaks;
use crate::simulation::plant::{MAX_CONTACTS, MovingBody, SlipDirections, Slope, State};

/// How far two answers may differ, as a share of the peaks of what is shown.
const FINE: f64 = 2e-5;
/// The most substeps of a step.
const MOST_SUBSTEPS: u32 = 64;
/// How often small errors are measured by halving, in steps.
const HALVED_EVERY: u64 = 64;
/// The most segments of a step.
const MOST_SEGMENTS: usize = 64;
/// Kinks nearer to an end of a segment than this share of a step are at it, and how far beside them they are looked at.
const NEAR: f64 = 1e-7;
const BESIDE: f64 = 1e-8;
/// A change of q̈ below this share of its peak is a bend, and no jump.
const BEND: f64 = 1e-6;

impl Simulation {
    /// Takes in a new guide: where it has kinks, and about how much it asks for.
    pub(super) fn prepare(&mut self) {
        let n = self.drives;
        let (mut expected, mut level) = (Peaks::zero(n), 0.0_f64);
        self.step_control.kinks.clear();
        self.step_control.until = 0.0;
        if let Guide::Motion { motion, start } = &self.guide {
            self.step_control.kinks = motion.kinks();
            self.step_control.until = start + 0.25 * motion.duration();
            let (arm, around) = (self.body().arm(), self.body().around());
            for i in 0..=16 {
                let r = motion.at(f64::from(i) / 16.0 * motion.duration());
                level = level.max(BEND * r.qdd.max_abs());
                let e = r.q.units();
                let (torque, wrench) = crate::mechanics::dynamics::inverse_with_wrench(arm, &e, &r.qd, &r.qdd, around);
                let moments = &self.link_moments[usize::from(self.loaded)];
                let pull = crate::mechanics::dynamics::inertial_pull(moments, &e, &r.qd, &r.qdd);
                expected.torque_sum = expected.torque_sum.max(torque.iter().map(|t| t.abs()).sum());
                expected.force = expected.force.max(wrench.dynamic.force.norm());
                expected.moment = expected.moment.max(wrench.total().moment.abs());
                expected.inertial_pull = expected.inertial_pull.max(pull);
            }
        }
        (self.step_control.expected, self.step_control.level) = (expected, level);
    }

    /// How far the arm reaches at most, m.
    pub(super) fn reach(&self) -> f64 {
        self.body().arm().end_effector.iter().map(|l| l.abs()).sum()
    }

    /// How far two answers may differ now.
    pub(super) fn measure(&self) -> Mismatch {
        let mut peaks = self.peaks;
        let wanted = &self.step_control.expected;
        // At first half of what the reference asks for: there are no peaks yet.
        if self.time() < self.step_control.until {
            let of = |seen: f64, wanted: f64| seen.max(0.5 * wanted);
            peaks.torque_sum = of(peaks.torque_sum, wanted.torque_sum);
            peaks.moment = of(peaks.moment, wanted.moment);
            peaks.force = of(peaks.force, wanted.force);
            peaks.inertial_pull = of(peaks.inertial_pull, wanted.inertial_pull);
        }
        Mismatch::measure(&peaks, self.reach())
    }

    /// The reference at a time since the step began, s, as the segment has it.
    #[inline]
    pub(super) fn aim(&self, at: f64, segment: &Segment) -> Reference {
        match &self.guide {
            Guide::Motion { motion, start } => {
                // The end of the step is where the next one begins, to the last digit.
                let time = if at >= self.dt { (self.step + 1) as f64 * self.dt } else { self.time() + at };
                beside(motion, time - start, segment.window, self.step_control.level)
            }
            Guide::Follow(follower) => follower.reference(at),
        }
    }

    /// The reference at the present instant, and after a kink there.
    pub(super) fn aim_now(&self) -> Reference {
        match &self.guide {
            Guide::Motion { motion, start } => {
                let t = self.time() - start;
                let after = self.kink_at(t).map_or(f64::NEG_INFINITY, |kink| kink + BESIDE * self.dt);
                beside(motion, t, [after, f64::INFINITY], self.step_control.level)
            }
            Guide::Follow(follower) => follower.reference(0.0),
        }
    }

    /// The last kink at a time of the motion, s, or as near as makes no difference.
    fn kink_at(&self, t: f64) -> Option<f64> {
        let (kinks, near) = (&self.step_control.kinks, NEAR * self.dt);
        let next = kinks.partition_point(|kink| *kink <= t + near);
        next.checked_sub(1).map(|i| kinks[i]).filter(|kink| *kink >= t - near)
    }

    /// The segment that begins at a time since the step did, s, and whether it ends on a kink.
    fn segment(&self, from: f64) -> (Segment, bool) {
        let (all, none) = ([f64::NEG_INFINITY, f64::INFINITY], (self.dt, false));
        let Guide::Motion { start, .. } = &self.guide else {
            return (Segment { from, to: none.0, window: all }, none.1);
        };
        let (t0, near, beside) = (self.time() - start, NEAR * self.dt, BESIDE * self.dt);
        let mut window = all;
        if let Some(kink) = self.kink_at(t0 + from) {
            window[0] = kink + beside;
        }
        let kinks = &self.step_control.kinks;
        let next = kinks.get(kinks.partition_point(|kink| *kink <= t0 + from + near));
        let Some(kink) = next.filter(|kink| **kink <= t0 + self.dt + near) else {
            return (Segment { from, to: self.dt, window }, false);
        };
        window[1] = kink - beside;
        let to = if *kink >= t0 + self.dt - near { self.dt } else { kink - t0 };
        (Segment { from, to, window }, true)
    }

    /// A whole step, and whether the slope at its end is that with which the next one begins.
    pub(super) fn take_step(&mut self) -> (StepState, bool) {
        let measure = self.measure();
        let looked_at = stands_for(self.step);
        let mut reached =
            StepState { at: 0.0, state: self.state, slope: self.now, slip: self.slip, stuck_torque: self.stuck_torque };
        let mut substeps = 1;
        for count in 1..=MOST_SEGMENTS {
            let (mut segment, mut kinked) = self.segment(reached.at);
            if count == MOST_SEGMENTS {
                (segment.to, segment.window[1], kinked) = (self.dt, f64::INFINITY, true);
            }
            if reached.at > 0.0 {
                reached.slope =
                    self.slope(&reached.state, reached.at, &segment, &reached.slip, &mut reached.stuck_torque);
            }
            let (end, most) = self.pass(&reached, &segment, &measure, looked_at);
            substeps = substeps.max(most);
            reached = end;
            if segment.to >= self.dt {
                self.step_control.substeps = substeps.min(4 * self.step_control.substeps);
                return (reached, !kinked);
            }
        }
        (reached, false)
    }

    /// A segment, and in how many substeps of a step the next one should go on.
    fn pass(
        &mut self,
        from: &StepState,
        segment: &Segment,
        measure: &Mismatch,
        looked_at: Option<f64>,
    ) -> (StepState, u32) {
        let share = (segment.to - segment.from) / self.dt;
        let count = |substeps: u32| (f64::from(substeps) * share - 1e-9).ceil().max(1.0) as u32;
        let mut substeps = self.step_control.substeps;
        let (mut reached, mut off) = self.walk(from, segment, count(substeps));
        let mut error = off;
        // While motors give all they have, feedback corrects no errors: the tolerance is 50 times tighter.
        let full = self.control_loop.is_full(&from.slope.torque) || self.control_loop.is_full(&reached.slope.torque);
        let fine = if full { 0.02 * FINE } else { FINE };
        while off.share(measure) > fine && error.share(measure) > fine && substeps < MOST_SUBSTEPS {
            substeps *= 2;
            if count(substeps) == count(substeps / 2) {
                continue;
            }
            let coarse = reached.slope;
            (reached, off) = self.walk(from, segment, count(substeps));
            error = self.apart(&reached.slope, &coarse);
        }
        // Of two bounds the smaller.
        if off.share(measure) < error.share(measure) {
            error = off;
        }
        self.step_control.worst = self.step_control.worst.worse(error);
        if let Some(steps) = looked_at {
            let (finer, _) = self.walk(from, segment, 2 * count(substeps));
            let (a, b) = (&reached.slope, &finer.slope);
            let (each, drift) = (16.0 / 15.0 * steps, &mut self.step_control.drift);
            drift.tip += each * (tip(&self.bodies[0], a) - tip(&self.bodies[0], b)).norm();
            drift.shift += each * (a.base.at - b.base.at).norm();
            drift.angle += each * (a.base.angle - b.base.angle).abs();
        }
        // Half as many make about eight times the difference.
        let next = if off.share(measure) < fine / 16.0 { (substeps / 2).max(1) } else { substeps };
        (reached, next)
    }

    /// A segment in equal substeps, and the most by which two answers differ.
    fn walk(&self, from: &StepState, segment: &Segment, substeps: u32) -> (StepState, Mismatch) {
        let (mut reached, mut worst) = (*from, Mismatch::default());
        let sticks = self.body().contacts().stick();
        for i in 1..=substeps {
            let share = f64::from(i) / f64::from(substeps);
            let to = if i == substeps { segment.to } else { segment.from + share * (segment.to - segment.from) };
            let off = match sticks {
                true => self.contact(&mut reached, to, segment),
                false => {
                    let substep = self.substep(&reached, to, segment);
                    reached = substep.end;
                    self.apart(&substep.last, &reached.slope)
                }
            };
            worst = worst.worse(off);
        }
        (reached, worst)
    }

    /// How far apart two answers for one instant are.
    pub(super) fn apart(&self, a: &Slope, b: &Slope) -> Mismatch {
        let felt = |x: &Slope| x.wrench.total().moment - x.spin.torque;
        let tip = |x: &Slope| tip(self.body(), x);
        Mismatch([
            (felt(a) - felt(b)).abs(),
            (a.wrench.dynamic.force - b.wrench.dynamic.force).norm(),
            a.torque.minus(&b.torque).max_abs(),
            (tip(a) - tip(b)).norm(),
        ])
    }
}

impl Simulation {
    /// One step of classical Runge–Kutta to a time since the step began, s.
    #[inline]
    pub(super) fn substep(&self, from: &StepState, to: f64, segment: &Segment) -> Substep {
        let (h, middle) = (to - from.at, 0.5 * (from.at + to));
        let (state, k1, slip, mut stuck_torque) = (&from.state, &from.slope, &from.slip, from.stuck_torque);
        let half_way = self.aim(middle, segment);
        let k2 = self.instant(&state.along(k1, 0.5 * h), &half_way, slip, &mut stuck_torque);
        let k3 = self.instant(&state.along(&k2, 0.5 * h), &half_way, slip, &mut stuck_torque);
        let there = self.aim(to, segment);
        let k4 = self.instant(&state.along(&k3, h), &there, slip, &mut stuck_torque);
        let mut state = state.stepped([k1, &k2, &k3, &k4], h);
        if self.body().contacts().stick() {
            state = self.body().stuck(state, slip);
        }
        let slope = self.instant(&state, &there, slip, &mut stuck_torque);
        Substep { end: StepState { at: to, state, slope, slip: *slip, stuck_torque }, last: k4, between: [k2, k3] }
    }

    /// What a state leads to, at a time since the step began, s.
    pub(super) fn slope(
        &self,
        state: &State,
        at: f64,
        segment: &Segment,
        slip: &SlipDirections,
        stuck_torque: &mut [f64; MAX_CONTACTS],
    ) -> Slope {
        self.instant(state, &self.aim(at, segment), slip, stuck_torque)
    }
}

/// Where the end effector is, m.
#[inline]
fn tip(body: &MovingBody, x: &Slope) -> Vector {
    x.base.at + end_effector(&body.arm().end_effector, &x.e)
}

/// How many steps the error measured at this one stands for, if it is measured; at first more often, so that short runs
/// are judged too.
fn stands_for(step: u64) -> Option<f64> {
    match step {
        0 => Some(1.0),
        1..HALVED_EVERY => step.is_power_of_two().then_some(step as f64),
        _ => step.is_multiple_of(HALVED_EVERY).then_some(HALVED_EVERY as f64),
    }
}

/// The reference of a motion, as it is within a window of its times, s; where q̈ changes by no more than `level`,
/// rad/s², to get there, as it is.
#[inline]
fn beside(motion: &Motion, t: f64, [after, before]: [f64; 2], level: f64) -> Reference {
    let within = t.max(after).min(before);
    let reference = motion.at(t);
    if within == t {
        return reference;
    }
    let mut inside = motion.at(within);
    if inside.qdd.minus(&reference.qdd).max_abs() <= level {
        return reference;
    }
    inside.q = DriveAngles(inside.q.0.plus(t - within, &inside.qd));
    inside
}
