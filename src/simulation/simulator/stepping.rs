//! Integration of a step: in segments that end at the kinks of the reference, each with as many substeps as it needs.
//!
//! # Method
//! The classical fourth-order Runge–Kutta method gives two slopes at the end of a substep: those of its last stage and
//! of its final state. The next substep needs the latter anyway. Their difference exceeds the error of the substep and
//! so is an error estimate at almost no cost. If it exceeds [`ERROR_TOLERANCE`] of the peaks of the displayed
//! quantities, the segment is integrated again with twice as many substeps, up to [`MAX_SUBSTEPS`]. Doubling ends when
//! the estimate, or the difference between two such integrations, is small enough. The next step begins with the same
//! number of substeps and reduces it when possible. So stiff gains, springs and friction, and unforeseen kinks such as
//! those of saturated motors, cost more substeps only where they occur.
//!
//! Control corrects errors of forces and torques; position errors may accumulate. So every [`HALVING_PERIOD_STEPS`]-th
//! step is also integrated with twice as many substeps. The resulting position differences of end effector and base are
//! assumed for every step and summed. The larger of this sum and the worst difference of slopes is the figure `step` of
//! the audit. All decisions depend on the run alone, so that a replay takes the same substeps.

use super::guide::Guide;
use super::simulation::Simulation;
use super::step_control::{Mismatch, Segment, StepState, Substep};
use crate::frame::Peaks;
use crate::plant::{MAX_CONTACTS, MovingBody, ReducedState, RungeKuttaStage, SlipDirections, Slope, StateRates};
use stillbase_mechanics::dynamics::by_drives;
use stillbase_mechanics::kinematics::end_effector;
use stillbase_mechanics::planar::{DriveAngles, Vector, length};
use stillbase_planning::{Motion, Reference};

/// Tolerance of the difference between two solutions, as a fraction of the peaks of the displayed quantities.
const ERROR_TOLERANCE: f64 = 2e-5;
/// Maximum number of substeps of a step.
const MAX_SUBSTEPS: u32 = 64;
/// Number of steps between two error measurements by halving.
const HALVING_PERIOD_STEPS: u64 = 64;
/// Maximum number of segments of a step.
const MAX_SEGMENTS: usize = 64;
/// Tolerance, as a fraction of a step, within which a kink counts as lying at an end of a segment.
const KINK_TOLERANCE: f64 = 1e-7;
/// Distance from a kink, as a fraction of a step, at which the reference on one side of it is evaluated.
const KINK_OFFSET: f64 = 1e-8;
/// A jump of q̈ below this fraction of its peak is ignored.
const MIN_JUMP_RATIO: f64 = 1e-6;

impl Simulation {
    /// Prepares for a new guide: stores its kinks and estimates the peaks that it requires.
    pub(super) fn prepare(&mut self) {
        let n = self.drives;
        let (mut expected, mut level) = (Peaks::zero(n), 0.0_f64);
        self.step_control.kinks.clear();
        self.step_control.until = 0.0;
        if let Guide::Motion { motion, start, .. } = &self.guide {
            self.step_control.kinks = motion.kinks();
            self.step_control.until = start + 0.25 * motion.duration();
            let (arm, around) = (self.body().arm(), self.body().around());
            for i in 0..=16 {
                let r = motion.at(f64::from(i) / 16.0 * motion.duration());
                level = level.max(MIN_JUMP_RATIO * r.qdd.max_abs());
                let e = r.q.units();
                let (torque, wrench) =
                    stillbase_mechanics::dynamics::inverse_with_wrench(arm, &e, &r.qd, &r.qdd, around);
                let moments = &self.link_moments[usize::from(self.loaded)];
                let pull = stillbase_mechanics::dynamics::inertial_pull(moments, &e, &r.qd, &r.qdd);
                let torque = arm.motors().motor_torques(&torque);
                expected.torque_sum = expected.torque_sum.max(torque.iter().map(|t| t.abs()).sum());
                expected.force = expected.force.max(wrench.dynamic.force.norm());
                expected.moment = expected.moment.max(wrench.total().moment.abs());
                expected.inertial_pull = expected.inertial_pull.max(pull);
            }
        }
        (self.step_control.expected, self.step_control.level) = (expected, level);
    }

    /// Returns the maximum reach of the arm, m.
    pub(super) fn reach(&self) -> f64 {
        self.body().arm().end_effector.iter().map(|l| l.abs()).sum()
    }

    /// Returns the present scales of errors.
    pub(super) fn measure(&self) -> Mismatch {
        let mut peaks = self.peaks;
        let wanted = &self.step_control.expected;
        // At first use half of the required peaks, because the run has no peaks yet.
        if self.time() < self.step_control.until {
            let of = |seen: f64, wanted: f64| seen.max(0.5 * wanted);
            peaks.torque_sum = of(peaks.torque_sum, wanted.torque_sum);
            peaks.moment = of(peaks.moment, wanted.moment);
            peaks.force = of(peaks.force, wanted.force);
            peaks.inertial_pull = of(peaks.inertial_pull, wanted.inertial_pull);
        }
        if self.body().is_free() {
            // About the centre of mass, the moments of the arm and of its force may cancel: their size is the scale.
            peaks.moment = peaks.moment.max(peaks.arm_moment).max(wanted.moment);
        }
        Mismatch::measure(&peaks, self.reach())
    }

    /// Returns the reference at a time since the step began, s, continuous within the segment.
    #[inline]
    pub(super) fn aim(&self, at: f64, segment: &Segment) -> Reference {
        match &self.guide {
            Guide::Motion { motion, start, .. } => {
                // The end of the step equals the beginning of the next one exactly.
                let time = if at >= self.dt { (self.step + 1) as f64 * self.dt } else { self.time() + at };
                one_sided_reference(motion, time - start, segment.window, self.step_control.level)
            }
            Guide::Follow(follower) => follower.reference(at),
            Guide::Lead(follower) => follower.reference(at),
        }
    }

    /// Returns the reference at the present instant; at a kink, the one after it.
    pub(super) fn aim_now(&self) -> Reference {
        match &self.guide {
            Guide::Motion { motion, start, .. } => {
                let t = self.time() - start;
                let after = self.kink_at(t).map_or(f64::NEG_INFINITY, |kink| kink + KINK_OFFSET * self.dt);
                one_sided_reference(motion, t, [after, f64::INFINITY], self.step_control.level)
            }
            Guide::Follow(follower) => follower.reference(0.0),
            Guide::Lead(follower) => follower.reference(0.0),
        }
    }

    /// Returns the last kink that lies within the tolerance of a time of the motion, s.
    fn kink_at(&self, t: f64) -> Option<f64> {
        let (kinks, near) = (&self.step_control.kinks, KINK_TOLERANCE * self.dt);
        let next = kinks.partition_point(|kink| *kink <= t + near);
        next.checked_sub(1).map(|i| kinks[i]).filter(|kink| *kink >= t - near)
    }

    /// Returns the segment that begins at a time since the step began, s, and whether it ends at a kink.
    fn segment(&self, from: f64) -> (Segment, bool) {
        let (all, none) = ([f64::NEG_INFINITY, f64::INFINITY], (self.dt, false));
        let Guide::Motion { start, .. } = &self.guide else {
            return (Segment { from, to: none.0, window: all }, none.1);
        };
        let (t0, near, offset) = (self.time() - start, KINK_TOLERANCE * self.dt, KINK_OFFSET * self.dt);
        let mut window = all;
        if let Some(kink) = self.kink_at(t0 + from) {
            window[0] = kink + offset;
        }
        let kinks = &self.step_control.kinks;
        let next = kinks.get(kinks.partition_point(|kink| *kink <= t0 + from + near));
        let Some(kink) = next.filter(|kink| **kink <= t0 + self.dt + near) else {
            return (Segment { from, to: self.dt, window }, false);
        };
        window[1] = kink - offset;
        let to = if *kink >= t0 + self.dt - near { self.dt } else { kink - t0 };
        (Segment { from, to, window }, true)
    }

    /// Integrates a whole step. Returns whether the next step can begin with the slope at its end.
    pub(super) fn take_step(&mut self, reached: &mut StepState) -> bool {
        let measure = self.measure();
        let measured = represented_steps(self.step);
        let mut substeps = 1;
        for count in 1..=MAX_SEGMENTS {
            let (mut segment, mut kinked) = self.segment(reached.at);
            if count == MAX_SEGMENTS {
                (segment.to, segment.window[1], kinked) = (self.dt, f64::INFINITY, true);
            }
            if reached.at > 0.0 {
                self.reevaluate(reached, &segment);
            }
            let from = *reached;
            substeps = substeps.max(self.integrate_segment(&from, &segment, &measure, measured, reached));
            if segment.to >= self.dt {
                self.step_control.substeps = substeps.min(4 * self.step_control.substeps);
                return !kinked;
            }
        }
        false
    }

    /// Integrates a segment within the tolerance. Returns the number of substeps for the next step.
    fn integrate_segment(
        &mut self,
        from: &StepState,
        segment: &Segment,
        measure: &Mismatch,
        measured: Option<f64>,
        reached: &mut StepState,
    ) -> u32 {
        let share = (segment.to - segment.from) / self.dt;
        let count = |substeps: u32| (f64::from(substeps) * share - 1e-9).ceil().max(1.0) as u32;
        let mut substeps = self.step_control.substeps;
        let mut off = self.integrate(from, segment, count(substeps), reached);
        let mut error = off;
        // While motors are saturated, feedback corrects no errors: the tolerance is 50 times tighter.
        let full = self.control_loop.is_full(&from.slope.torque) || self.control_loop.is_full(&reached.slope.torque);
        let tolerance = if full { 0.02 * ERROR_TOLERANCE } else { ERROR_TOLERANCE };
        while off.share(measure) > tolerance && error.share(measure) > tolerance && substeps < MAX_SUBSTEPS {
            substeps *= 2;
            if count(substeps) == count(substeps / 2) {
                continue;
            }
            let coarse = reached.slope;
            off = self.integrate(from, segment, count(substeps), reached);
            error = self.slope_difference(&reached.slope, &coarse);
        }
        // Use the smaller of the two estimates.
        if off.share(measure) < error.share(measure) {
            error = off;
        }
        self.step_control.worst = self.step_control.worst.worse(error);
        if let Some(steps) = measured {
            let mut finer = *from;
            self.integrate(from, segment, 2 * count(substeps), &mut finer);
            let (a, b) = (&reached.slope, &finer.slope);
            let (each, drift) = (16.0 / 15.0 * steps, &mut self.step_control.drift);
            drift.tip += each * (tip(&self.bodies[0], a) - tip(&self.bodies[0], b)).norm();
            drift.shift += each * (a.base.at - b.base.at).norm();
            drift.angle += each * (a.base.angle - b.base.angle).abs();
        }
        // Half as many substeps give about eight times the difference.
        if off.share(measure) < tolerance / 16.0 { (substeps / 2).max(1) } else { substeps }
    }

    /// Integrates a segment in equal substeps and returns the maximum error estimate.
    fn integrate(&self, from: &StepState, segment: &Segment, substeps: u32, reached: &mut StepState) -> Mismatch {
        let sticks = self.body().contacts().any_can_stick();
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

    /// Returns the difference between two slopes at one instant.
    pub(super) fn slope_difference(&self, a: &Slope, b: &Slope) -> Mismatch {
        let felt = |x: &Slope| self.body().felt_moment(&x.wrench, &x.e, x.spin.torque);
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
    /// Makes one Runge–Kutta substep to a time since the step began, s.
    pub(super) fn substep(&self, from: &StepState, to: f64, segment: &Segment) -> Substep {
        let (mut end, mut stages) = (*from, [from.slope; 3]);
        let off = self.stepped(from, to, segment, Some(&mut stages), &mut end);
        Substep { end, stages, off }
    }

    /// Makes one substep without contacts that can stick and returns its error estimate.
    fn smooth(&self, from: &StepState, to: f64, segment: &Segment, end: &mut StepState) -> Mismatch {
        self.stepped(from, to, segment, None, end)
    }

    #[inline]
    fn stepped(&self, from: &StepState, to: f64, segment: &Segment, stages: Kept<'_>, end: &mut StepState) -> Mismatch {
        let size = self.body().turning();
        by_drives!(size, self.body().moves(), stepped_of(self, from, to, segment, stages, end))
    }

    /// Evaluates the slope at the present state again, because the reference or the stuck contacts have changed.
    pub(super) fn reevaluate(&self, here: &mut StepState, segment: &Segment) {
        here.aim = self.aim(here.at, segment);
        let size = self.body().turning();
        here.slope = by_drives!(size, self.body().moves(), slope_of(self, here));
    }

    /// Evaluates a Runge–Kutta stage at a state, for a reference.
    fn stage<const N: usize, const MOVES: bool>(
        &self,
        at: &ReducedState<N>,
        aim: &Reference,
        slip: &SlipDirections,
        stuck_torque: &mut [f64; MAX_CONTACTS],
    ) -> RungeKuttaStage<N> {
        self.body().stage::<N, MOVES>(at, slip, stuck_torque, |e, rate, base, velocity| {
            self.control_loop.command::<N, MOVES>(aim, at, (e, rate), (base, velocity), self.loaded)
        })
    }
}

/// Storage for the slopes of stages, if they are requested.
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
    let (half_way, aim) = (simulation.aim(middle, segment), simulation.aim(to, segment));
    let k1 = StateRates::of(&from.slope);
    let (mut state, kept) = StateRates::runge_kutta::<MOVES>(state, &k1, h, |at, is_end| {
        let aim = if is_end { &aim } else { &half_way };
        simulation.stage::<N, MOVES>(at, aim, slip, stuck_torque)
    });
    if body.contacts().any_can_stick() {
        state = body.with_stuck_stopped(state, slip);
    }
    let last = simulation.stage::<N, MOVES>(&ReducedState::of(&state), &aim, slip, stuck_torque);
    let drives = body.arm().drives();
    if let Some(stages) = stages {
        *stages = std::array::from_fn(|i| kept[i].slope(drives));
    }
    (end.at, end.state, end.slope, end.aim, end.slip) = (to, state, last.slope(drives), aim, *slip);
    between(body, &kept[2], &last)
}

/// Returns the difference between two stages at one instant.
#[inline(always)]
fn between<const N: usize>(body: &MovingBody, a: &RungeKuttaStage<N>, b: &RungeKuttaStage<N>) -> Mismatch {
    let felt = |x: &RungeKuttaStage<N>| body.felt_moment(&x.wrench, &x.e, x.spin.torque);
    let arm = &body.arm().end_effector;
    let tip = |x: &RungeKuttaStage<N>| x.base.at + (0..N).map(|k| x.e[k] * arm[k]).sum::<Vector>();
    Mismatch([
        (felt(a) - felt(b)).abs(),
        length(a.wrench.dynamic.force - b.wrench.dynamic.force),
        (0..N).fold(0.0, |max: f64, k| max.max((a.torque[k] - b.torque[k]).abs())),
        length(tip(a) - tip(b)),
    ])
}

#[inline(never)]
fn slope_of<const N: usize, const MOVES: bool>(simulation: &Simulation, at: &mut StepState) -> Slope {
    let stage = simulation.stage::<N, MOVES>(&ReducedState::of(&at.state), &at.aim, &at.slip, &mut at.stuck_torque);
    stage.slope(simulation.drives)
}

/// Returns the position of the end effector, m.
#[inline]
fn tip(body: &MovingBody, x: &Slope) -> Vector {
    x.base.at + end_effector(&body.arm().end_effector, &x.e)
}

/// Returns the number of steps that an error measured at this step represents; `None` if no error is measured at this
/// step. Early steps are measured more often, so that short runs are assessed too.
fn represented_steps(step: u64) -> Option<f64> {
    match step {
        0 => Some(1.0),
        1..HALVING_PERIOD_STEPS => step.is_power_of_two().then_some(step as f64),
        _ => step.is_multiple_of(HALVING_PERIOD_STEPS).then_some(HALVING_PERIOD_STEPS as f64),
    }
}

/// Returns the reference of a motion at a time, s. Outside the window it is extrapolated from the nearest bound, unless
/// q̈ differs there by at most `level`, rad/s².
#[inline]
fn one_sided_reference(motion: &Motion, t: f64, [after, before]: [f64; 2], level: f64) -> Reference {
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
