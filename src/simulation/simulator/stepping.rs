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
use crate::mechanics::dynamics::by_drives;
use crate::mechanics::kinematics::end_effector;
use crate::mechanics::planar::{DriveAngles, Vector, length};
use crate::planning::{Motion, Reference};
use crate::simulation::frame::Peaks;
use crate::simulation::plant::{MAX_CONTACTS, MovingBody, Point, Rates, SlipDirections, Slope, Stage};

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
                let torque = arm.motors().torques(&torque);
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

    /// A whole step, from here to its end; whether the slope there is that with which the next one begins.
    pub(super) fn take_step(&mut self, reached: &mut StepState) -> bool {
        let measure = self.measure();
        let looked_at = stands_for(self.step);
        let mut substeps = 1;
        for count in 1..=MOST_SEGMENTS {
            let (mut segment, mut kinked) = self.segment(reached.at);
            if count == MOST_SEGMENTS {
                (segment.to, segment.window[1], kinked) = (self.dt, f64::INFINITY, true);
            }
            if reached.at > 0.0 {
                self.look_again(reached, &segment);
            }
            let from = *reached;
            substeps = substeps.max(self.pass(&from, &segment, &measure, looked_at, reached));
            if segment.to >= self.dt {
                self.step_control.substeps = substeps.min(4 * self.step_control.substeps);
                return !kinked;
            }
        }
        false
    }

    /// A segment, to its end; in how many substeps of a step the next one should go on.
    fn pass(
        &mut self,
        from: &StepState,
        segment: &Segment,
        measure: &Mismatch,
        looked_at: Option<f64>,
        reached: &mut StepState,
    ) -> u32 {
        let share = (segment.to - segment.from) / self.dt;
        let count = |substeps: u32| (f64::from(substeps) * share - 1e-9).ceil().max(1.0) as u32;
        let mut substeps = self.step_control.substeps;
        let mut off = self.walk(from, segment, count(substeps), reached);
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
            off = self.walk(from, segment, count(substeps), reached);
            error = self.apart(&reached.slope, &coarse);
        }
        // Of two bounds the smaller.
        if off.share(measure) < error.share(measure) {
            error = off;
        }
        self.step_control.worst = self.step_control.worst.worse(error);
        if let Some(steps) = looked_at {
            let mut finer = *from;
            self.walk(from, segment, 2 * count(substeps), &mut finer);
            let (a, b) = (&reached.slope, &finer.slope);
            let (each, drift) = (16.0 / 15.0 * steps, &mut self.step_control.drift);
            drift.tip += each * (tip(&self.bodies[0], a) - tip(&self.bodies[0], b)).norm();
            drift.shift += each * (a.base.at - b.base.at).norm();
            drift.angle += each * (a.base.angle - b.base.angle).abs();
        }
        // Half as many make about eight times the difference.
        if off.share(measure) < fine / 16.0 { (substeps / 2).max(1) } else { substeps }
    }

    /// A segment in equal substeps, to its end; the most by which two answers differ.
    fn walk(&self, from: &StepState, segment: &Segment, substeps: u32, reached: &mut StepState) -> Mismatch {
        let sticks = self.body().contacts().stick();
        if substeps == 1 && !sticks {
            return self.smooth(from, segment.to, segment, reached);
        }
        let mut worst = Mismatch::default();
        *reached = *from;
        for i in 1..=substeps {
            let share = f64::from(i) / f64::from(substeps);
            let to = if i == substeps { segment.to } else { segment.from + share * (segment.to - segment.from) };
            let off = match sticks {
                true => self.contact(reached, to, segment),
                false => {
                    let from = *reached;
                    self.smooth(&from, to, segment, reached)
                }
            };
            worst = worst.worse(off);
        }
        worst
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
    pub(super) fn substep(&self, from: &StepState, to: f64, segment: &Segment) -> Substep {
        let (mut end, mut stages) = (*from, [from.slope; 3]);
        let off = self.stepped(from, to, segment, Some(&mut stages), &mut end);
        Substep { end, stages, off }
    }

    /// The same where nothing can stick: how far apart two answers are.
    fn smooth(&self, from: &StepState, to: f64, segment: &Segment, end: &mut StepState) -> Mismatch {
        self.stepped(from, to, segment, None, end)
    }

    #[inline]
    fn stepped(&self, from: &StepState, to: f64, segment: &Segment, stages: Kept<'_>, end: &mut StepState) -> Mismatch {
        let size = self.body().turning();
        by_drives!(size, self.body().moves(), stepped_of(self, from, to, segment, stages, end))
    }

    /// Takes the slope where a step has come to anew: the reference, or what is stuck, is another.
    pub(super) fn look_again(&self, here: &mut StepState, segment: &Segment) {
        here.aim = self.aim(here.at, segment);
        let size = self.body().turning();
        here.slope = by_drives!(size, self.body().moves(), slope_of(self, here));
    }

    /// What a point leads to, with a reference.
    fn stage<const N: usize, const MOVES: bool>(
        &self,
        at: &Point<N>,
        aim: &Reference,
        slip: &SlipDirections,
        stuck_torque: &mut [f64; MAX_CONTACTS],
    ) -> Stage<N> {
        self.body().stage::<N, MOVES>(at, slip, stuck_torque, |e, rate, base, velocity| {
            self.control_loop.command::<N, MOVES>(aim, at, (e, rate), (base, velocity), self.loaded)
        })
    }
}

/// Where slopes of stages are to be kept.
type Kept<'a> = Option<&'a mut [Slope; 3]>;

#[inline(never)]
fn stepped_of<const N: usize, const MOVES: bool>(
    simulation: &Simulation,
    from: &StepState,
    to: f64,
    segment: &Segment,
    stages: Kept<'_>,
    end: &mut StepState,
) -> Mismatch {
    let (h, middle) = (to - from.at, 0.5 * (from.at + to));
    let (state, slip, stuck_torque) = (&from.state, &from.slip, &mut end.stuck_torque);
    *stuck_torque = from.stuck_torque;
    let body = simulation.body();
    let k1 = Rates::of(&from.slope);
    let aim = simulation.aim(middle, segment);
    let k2 = simulation.stage::<N, MOVES>(&Point::along::<MOVES>(state, &k1, 0.5 * h), &aim, slip, stuck_torque);
    let k3 = simulation.stage::<N, MOVES>(&Point::along::<MOVES>(state, &k2.rates, 0.5 * h), &aim, slip, stuck_torque);
    let aim = simulation.aim(to, segment);
    let k4 = simulation.stage::<N, MOVES>(&Point::along::<MOVES>(state, &k3.rates, h), &aim, slip, stuck_torque);
    let mut state = Rates::stepped::<MOVES>(state, [&k1, &k2.rates, &k3.rates, &k4.rates], h);
    if body.contacts().stick() {
        state = body.stuck(state, slip);
    }
    let last = simulation.stage::<N, MOVES>(&Point::of(&state), &aim, slip, stuck_torque);
    let drives = body.arm().drives();
    if let Some(stages) = stages {
        *stages = [&k2, &k3, &k4].map(|k| k.slope(drives));
    }
    (end.at, end.state, end.slope, end.aim, end.slip) = (to, state, last.slope(drives), aim, *slip);
    between(body, &k4, &last)
}

/// How far apart two answers for one instant are.
#[inline(always)]
fn between<const N: usize>(body: &MovingBody, a: &Stage<N>, b: &Stage<N>) -> Mismatch {
    let felt = |x: &Stage<N>| x.wrench.total().moment - x.spin.torque;
    let arm = &body.arm().end_effector;
    let tip = |x: &Stage<N>| x.base.at + (0..N).map(|k| x.e[k] * arm[k]).sum::<Vector>();
    Mismatch([
        (felt(a) - felt(b)).abs(),
        length(a.wrench.dynamic.force - b.wrench.dynamic.force),
        (0..N).fold(0.0, |most: f64, k| most.max((a.torque[k] - b.torque[k]).abs())),
        length(tip(a) - tip(b)),
    ])
}

#[inline(never)]
fn slope_of<const N: usize, const MOVES: bool>(simulation: &Simulation, at: &mut StepState) -> Slope {
    let stage = simulation.stage::<N, MOVES>(&Point::of(&at.state), &at.aim, &at.slip, &mut at.stuck_torque);
    stage.slope(simulation.drives)
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
