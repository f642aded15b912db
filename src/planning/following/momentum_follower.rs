//! Following the pointer at zero angular momentum, on any arm of three drives or more.
//!
//! # Method
//! Over a step the end effector has a constant acceleration. The drives follow with [J; D] q̇ = [v; h] of a
//! [`MomentumModel`], integrated by one Runge–Kutta step from the beginning of the step. The momentum h with which the
//! hand takes over ends within [`MOMENTUM_TIME`]. Afterwards it is zero at every instant. The end effector stops before
//! poses where such rates grow without bound, and before joint limits: it never moves faster than it can stop on a
//! straight line.

use std::sync::Arc;

use super::braking::{LAG_TIME, approach, greatest_feasible_fraction};
use super::follow::Target;
use crate::Reference;
use crate::off_plane::drift::Singularity;
use crate::off_plane::momentum::MomentumModel;
use crate::off_plane::null_space::{motion_of, rates, runge_kutta_step};
use crate::pose_space::Reach;
use stillbase_mechanics::kinematics::column;
use stillbase_mechanics::machine::{Machine, RelativeAngle};
use stillbase_mechanics::planar::{DriveAngles, PerDrive, Pose2, Vector, dot};

/// What the end effector stops before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Barrier {
    /// The rates of zero momentum grow without bound.
    Singular(Singularity),
    /// A relative joint angle is at a limit; its index in the machine's order.
    Limit(usize),
}

impl std::fmt::Display for Barrier {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Singular(why) => why.fmt(f),
            Self::Limit(_) => f.write_str("a joint is at its limit there"),
        }
    }
}

/// Time in which the momentum that the hand takes over ends, s.
const MOMENTUM_TIME: f64 = 0.3;
/// Bound on the acceleration of the end effector, as a fraction of its reach, 1/s².
const ACCELERATION_SHARE: f64 = 4.0;
/// Largest norm of the rates of the drives, rad/s.
const MAX_RATE: f64 = 3.0;
/// Largest norm of the rates times the reach, over the speed of the end effector; beyond it a pose counts as singular.
const MAX_GAIN: f64 = 15.0;
/// An angle is past its limit by more than this, rad.
const LIMIT_TOLERANCE: f64 = 1e-9;
/// The arm is lost beyond a barrier at this multiple of the allowed gain, or this much past a limit, rad.
const LOST: (f64, f64) = (1.5, 0.01);
/// Number of steps of the straight line to a stop, and the longest of them as a fraction of the reach.
const STOP_STEPS: (f64, f64) = (16.0, 0.02);
/// The end effector has arrived when its distance and speed are below this fraction of the reach, 1/s for the speed.
const ARRIVAL_SHARE: f64 = 1e-10;
/// It stops to wait when a barrier keeps it from going faster than this fraction of the reach, 1/s.
const WAITING_SHARE: f64 = 5e-3;

/// A reference that follows a target at zero angular momentum.
#[derive(Clone, Debug)]
pub struct MomentumFollower {
    model: Arc<MomentumModel>,
    angles: Arc<[RelativeAngle]>,
    /// Pose of the base in whose axes the model has its coordinates.
    anchor: Pose2,
    bound: f64,
    step: f64,
    /// What counts as a barrier: a gain above the first number, or an angle past its limit by more than the second, rad.
    allowed: (f64, f64),
    q: DriveAngles,
    v: Vector,
    acc: Vector,
    /// Angular momentum and its rate, kg m²/s, N m.
    h: f64,
    hd: f64,
    /// In space.
    target: Target,
}

impl MomentumFollower {
    /// Starts at the pose and rates of a reference and slows to rest. `anchor` is the pose of the base now, and `step` the
    /// time between calls of [`advance`](Self::advance), s. With four drives or more the rates are those of minimum norm
    /// from here on.
    pub fn new(model: Arc<MomentumModel>, machine: &Machine, anchor: Pose2, step: f64, from: &Reference) -> Self {
        let e = from.q.units();
        let tip = model.tip_units(&e);
        let v = (0..model.drives()).map(|k| column(model.tip(), &tip, k) * from.qd[k]).sum();
        let h = model.coefficients(&e).dot(&from.qd);
        let bound = ACCELERATION_SHARE * model.reach();
        let mut follower = Self {
            angles: machine.angles().into(),
            anchor,
            bound,
            step,
            allowed: (MAX_GAIN, LIMIT_TOLERANCE),
            q: from.q,
            v,
            acc: Vector::default(),
            h,
            hd: -h / MOMENTUM_TIME,
            target: Target { at: Vector::default(), reach: Reach::Inside },
            model,
        };
        let stop = follower.place() + 0.5 * v * v.norm() / bound;
        follower.target.at = anchor.place(stop);
        follower.steer();
        follower
    }

    /// Sets the target of the end effector in space, m.
    pub fn set_target(&mut self, at: Vector) {
        self.target = Target { at, reach: Reach::Inside };
        self.steer();
    }

    /// Returns the target of the end effector in space.
    pub fn target(&self) -> Target {
        self.target
    }

    /// Returns whether the reference stands still.
    pub fn is_at_rest(&self) -> bool {
        self.v == Vector::default() && self.acc == Vector::default() && self.h == 0.0
    }

    /// Returns the reference dt seconds into the present step.
    pub fn reference(&self, dt: f64) -> Reference {
        let still = PerDrive::zeros(self.q.len());
        let Some(q) = self.after(&self.acc, dt) else { return Reference { q: self.q, qd: still, qdd: still } };
        let (v, h) = (self.v + self.acc * dt, self.h + self.hd * dt);
        let (qd, qdd) = motion_of(&self.model, &q, [v, self.acc], [h, self.hd]).unwrap_or((still, still));
        Reference { q, qd, qdd }
    }

    /// Ends the present step and begins the next.
    pub fn advance(&mut self) {
        match self.after(&self.acc, self.step) {
            Some(q) => {
                self.q = q;
                self.v += self.acc * self.step;
                let next = self.h + self.hd * self.step;
                // The last step takes what is left of the momentum, up to rounding.
                self.h = if next.abs() <= 1e-9 * self.h.abs() { 0.0 } else { next };
            }
            None => (self.v, self.h) = (Vector::default(), 0.0),
        }
        self.hd = self.hd.abs().min(self.h.abs() / self.step).copysign(-self.h);
        self.steer();
    }

    fn place(&self) -> Vector {
        self.model.place(&self.q)
    }

    /// Returns the pose dt seconds into the present step with an acceleration of the end effector, m/s².
    fn after(&self, acc: &Vector, dt: f64) -> Option<DriveAngles> {
        let (v, h) = (self.v, self.h);
        self.integrate(&self.q, dt, |t| (v + *acc * t, h + self.hd * t))
    }

    /// Returns the pose after a Runge–Kutta step of dt, with velocity of the end effector and momentum over time.
    fn integrate(&self, from: &DriveAngles, dt: f64, at: impl Fn(f64) -> (Vector, f64)) -> Option<DriveAngles> {
        let slope = |q: &PerDrive, share: f64| {
            let (v, h) = at(share * dt);
            rates(&self.model, &DriveAngles(*q), v, h).ok_or(())
        };
        runge_kutta_step(&from.0, dt, slope).ok().map(DriveAngles)
    }

    /// Returns the norm of the rates times the reach, over the speed of the end effector, in the worst direction or more.
    fn gain(&self, q: &DriveAngles) -> Option<f64> {
        let [x, y] = [Vector::new(1.0, 0.0), Vector::new(0.0, 1.0)].map(|v| rates(&self.model, q, v, 0.0));
        let (x, y) = (x?, y?);
        Some((x.dot(&x) + y.dot(&y)).sqrt() * self.model.reach())
    }

    /// Returns the relative angle that passes its limit by most, with by how much, rad; below 0 if all are within.
    fn past_limit(&self, q: &DriveAngles) -> (usize, f64) {
        let past = self.angles.iter().map(|angle| angle.past_limit(q));
        past.enumerate().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0, f64::NEG_INFINITY))
    }

    /// Returns the barrier at a pose, for gains up to `slack` times the allowed one and for angles up to `past` more, rad.
    fn barrier(&self, q: &DriveAngles, (slack, past): (f64, f64)) -> Option<Barrier> {
        let (i, by) = self.past_limit(q);
        if by > self.allowed.1 + past {
            return Some(Barrier::Limit(i));
        }
        let is_open = self.gain(q).is_some_and(|gain| gain <= slack * self.allowed.0);
        (!is_open).then(|| Barrier::Singular(Singularity::near(&self.model, q)))
    }

    /// Returns the barrier that the coming step with an acceleration, m/s², or the straight line from there to a stop
    /// meets.
    fn meets(&self, acc: &Vector) -> Option<Barrier> {
        let singular = |q: &DriveAngles| Barrier::Singular(Singularity::near(&self.model, q));
        let Some(mut q) = self.after(acc, self.step) else { return Some(singular(&self.q)) };
        let v = self.v + *acc * self.step;
        // In the last step the brake takes only what is left, which adds up to half a step of the speed.
        let way = v * (0.5 * v.norm() / self.bound + 0.5 * self.step);
        let pieces = (way.norm() / (STOP_STEPS.1 * self.model.reach())).ceil().clamp(1.0, STOP_STEPS.0);
        for i in 0..=pieces as usize {
            if let Some(barrier) = self.barrier(&q, (1.0, 0.0)) {
                return Some(barrier);
            }
            if i as f64 == pieces || v == Vector::default() {
                break;
            }
            match self.integrate(&q, 1.0, |_| (way / pieces, 0.0)) {
                Some(next) => q = next,
                None => return Some(singular(&q)),
            }
        }
        None
    }

    /// Sets the acceleration of the coming step.
    fn steer(&mut self) {
        let reach = self.model.reach();
        // An arm that is led from a barrier, or from a little beyond one, may at least leave it.
        let here = (self.gain(&self.q).unwrap_or(f64::INFINITY), self.past_limit(&self.q).1);
        self.allowed = (MAX_GAIN.max(1.001 * here.0), LIMIT_TOLERANCE.max(here.1));
        let way = self.anchor.seen(self.target.at) - self.place();
        let (distance, speed) = (way.norm(), self.v.norm());
        let is_still = speed < ARRIVAL_SHARE * reach;
        let brake = self.bound.min(speed / self.step);
        let braking = if speed > 0.0 { -self.v * (brake / speed) } else { Vector::default() };
        if let Reach::Stopped { nearest, .. } = &mut self.target.reach {
            *nearest = self.anchor.place(self.model.place(&self.q));
            (self.v, self.acc) = if is_still { Default::default() } else { (self.v, braking) };
            return;
        }
        if is_still && distance < ARRIVAL_SHARE * reach {
            (self.v, self.acc) = (Vector::default(), Vector::default());
            return;
        }
        let along = way / distance.max(f64::MIN_POSITIVE);
        let gain = rates(&self.model, &self.q, along, 0.0).map_or(f64::INFINITY, |rates| rates.dot(&rates).sqrt());
        let wanted = along * approach(distance, self.bound).min(MAX_RATE / gain);
        let want = (wanted - self.v) / LAG_TIME;
        let want = want * (self.bound / want.norm().max(f64::MIN_POSITIVE)).min(1.0);
        self.acc = want;
        let Some(barrier) = self.meets(&want) else { return };
        let at = |t: f64| braking + (want - braking) * t;
        let fraction = greatest_feasible_fraction(|t| self.meets(&at(t)).is_none());
        self.acc = at(fraction);
        // While momentum is left, the arm may come to a barrier that braking alone does not avoid: it stops at once.
        let is_lost = self.after(&self.acc, self.step).is_none_or(|next| self.barrier(&next, LOST).is_some());
        if is_lost {
            (self.v, self.acc) = (Vector::default(), Vector::default());
            (self.h, self.hd) = (0.0, 0.0);
        }
        let is_held_back = speed < WAITING_SHARE * reach && dot(self.acc, self.v) <= 0.0;
        if is_lost || is_held_back {
            self.acc = if is_lost { Vector::default() } else { braking };
            self.target.reach = Reach::Stopped { nearest: self.anchor.place(self.place()), why: barrier };
        }
    }
}
