//! Following the pointer and the slider: a smooth reference that stays on the plane of its b.
//!
//! The reference moves in the coordinates (a, b) of a [`PoseSpace`]. Acceleration is constant over a step and bounded:
//! the vector ä as a whole, not component by component, and b̈ separately. While the slider of b rests, b stays
//! constant to the last bit, so the motion is reactionless.

use std::sync::Arc;

use super::braking::{LAG_TIME, approach, greatest_feasible_fraction, norm};
use super::held::{HeldReference, Pull};
use crate::Reference;
use crate::pose_space::{PoseSpace, Reach};
use stillbase_mechanics::planar::{PerDrive, Pose2, Vector};

/// Target position of the end effector, and whether it can be reached.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    /// Target position, m.
    pub at: Vector,
    /// Whether it can be reached.
    pub reach: Reach,
}

impl Target {
    /// Converts a target in the axes of a base to one in space.
    #[must_use]
    pub fn on(self, base: Pose2) -> Self {
        let reach = match self.reach {
            Reach::Outside { nearest, feasible_b, displayed_b, other_sheet } => {
                Reach::Outside { nearest: base.place(nearest), feasible_b, displayed_b, other_sheet }
            }
            Reach::Stopped { nearest, why } => Reach::Stopped { nearest: base.place(nearest), why },
            reach => reach,
        };
        Self { at: base.place(self.at), reach }
    }
}

/// Bounds on the accelerations of the reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Bound of |ä|, rad/s².
    pub joint: f64,
    /// Bound of |b̈|, rad/s²; the base moment is at most D_1 times this.
    pub pose: f64,
}

/// The aim counts as reached when distance and speed are below this, rad and rad/s.
const ARRIVAL_TOLERANCE: f64 = 1e-11;

/// A reference that follows a target on the plane of a pose constant.
#[derive(Clone, Debug)]
pub struct Follower {
    map: Arc<PoseSpace>,
    bounds: Bounds,
    step: f64,
    a: Courses,
    b: Course,
    aim: PerDrive,
    aim_rate: PerDrive,
    b_aim: f64,
    target: Target,
    /// A drag of a link that begins once the reference is at rest; the end effector then stays.
    pull: Option<Pull>,
    /// The reference during a drag of a link.
    held: Option<HeldReference>,
}

/// A coordinate with its derivatives; the second is constant over the present step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Course {
    x: f64,
    v: f64,
    acc: f64,
}

impl Course {
    fn after(self, dt: f64) -> Self {
        Self { x: self.x + dt * (self.v + 0.5 * dt * self.acc), v: self.v + dt * self.acc, acc: self.acc }
    }
}

/// The relative angles with their derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Courses {
    x: PerDrive,
    v: PerDrive,
    acc: PerDrive,
}

impl Courses {
    fn after(&self, dt: f64) -> Self {
        let at = |i: usize| Course { x: self.x[i], v: self.v[i], acc: self.acc[i] }.after(dt);
        let n = self.x.len();
        Self { x: PerDrive::from_fn(n, |i| at(i).x), v: PerDrive::from_fn(n, |i| at(i).v), acc: self.acc }
    }

    fn resting(x: PerDrive) -> Self {
        let still = PerDrive::zeros(x.len());
        Self { x, v: still, acc: still }
    }
}

impl Follower {
    /// Starts at the pose and rates of a reference and slows to rest; b stops as early as it can. `step` is the time
    /// between calls of [`advance`](Self::advance), s.
    pub fn new(map: Arc<PoseSpace>, bounds: Bounds, step: f64, from: &Reference) -> Self {
        let (x, b) = map.project(&from.q);
        let (v, bd) = map.project_rates(&from.qd);
        let mut follower = Self {
            bounds,
            step,
            a: Courses { x, v, acc: PerDrive::zeros(x.len()) },
            b: Course { x: b, v: bd, acc: 0.0 },
            aim: x,
            aim_rate: PerDrive::zeros(x.len()),
            // The nearest b at which b can stop.
            b_aim: b + 0.5 * bd * bd.abs() / bounds.pose,
            target: Target { at: map.forward(&x, b), reach: Reach::Inside },
            map,
            pull: None,
            held: None,
        };
        follower.aim_at_stop();
        follower.steer();
        follower
    }

    /// Sets the aim to the pose at which the reference can stop soonest.
    fn aim_at_stop(&mut self) {
        let stop = norm(&self.a.v) / self.bounds.joint;
        self.aim = self.map.clamped(&self.a.x.plus(0.5 * stop, &self.a.v));
        self.aim_rate = PerDrive::zeros(self.aim.len());
        self.target = Target { at: self.aim_point(), reach: Reach::Inside };
    }

    /// Drags a point of a link while the end effector stays where it is or comes to rest. On machines of fewer than
    /// [four drives](PoseSpace::leaves_freedoms) no link can be dragged.
    pub fn set_pull(&mut self, pull: Pull) {
        if let Some(held) = &mut self.held {
            held.pull(pull);
            return;
        }
        if self.pull.is_none() && !self.is_at_rest() {
            let (x, v) = (self.b.x, self.b.v);
            self.b_aim = x + 0.5 * v * v.abs() / self.bounds.pose;
            self.aim_at_stop();
            self.steer();
        }
        self.pull = Some(pull);
        self.hold();
    }

    /// Begins a pending drag if the reference is at rest.
    fn hold(&mut self) {
        if let Some(pull) = self.pull.filter(|_| self.map.leaves_freedoms() && self.is_at_rest()) {
            let bounds = (self.bounds.joint, self.step);
            self.held = Some(HeldReference::new(self.map.clone(), self.a.x, self.b.x, bounds, pull));
            self.pull = None;
            self.b_aim = self.b.x;
            self.target = Target { at: self.map.forward(&self.a.x, self.b.x), reach: Reach::Inside };
        }
    }

    /// Ends the drag of a link; the end effector stays where it was held.
    fn let_go(&mut self) {
        self.pull = None;
        if let Some((x, v)) = self.held.take().map(|held| held.angles()) {
            self.a = Courses { v, ..Courses::resting(x) };
            self.aim = x;
            self.aim_at_target();
            self.aim_rate = PerDrive::zeros(self.aim.len());
        }
    }

    /// Sets the target of the end effector in the axes of the base, m.
    pub fn set_target(&mut self, at: Vector) {
        self.let_go();
        self.target.at = at;
        self.aim_at_target();
        self.aim_rate = PerDrive::zeros(self.aim.len());
        self.steer();
    }

    /// Sets the target of the relative angles, rad, within the limits. If a fold or a change point to be avoided lies
    /// on the straight line to it, the aim is the last point before it.
    pub fn set_angles(&mut self, a: &PerDrive) {
        self.let_go();
        self.aim = self.as_far_as_open(self.map.clamped(a));
        self.target = Target { at: self.aim_point(), reach: Reach::Inside };
        self.aim_rate = PerDrive::zeros(self.aim.len());
        self.steer();
    }

    /// Returns the relative angles that the reference moves to, rad.
    pub fn aim(&self) -> &PerDrive {
        &self.aim
    }

    /// Sets the target of the pose constant, rad.
    pub fn set_b(&mut self, b: f64) {
        self.let_go();
        self.b_aim = b;
        self.steer();
    }

    /// Returns the target of the end effector in the axes of the base.
    pub fn target(&self) -> Target {
        self.target
    }

    /// Returns b of the reference, rad.
    pub fn b(&self) -> f64 {
        self.b.x
    }

    /// Returns the b that the reference moves to, rad.
    pub fn b_aim(&self) -> f64 {
        self.b_aim
    }

    /// Returns the pose space.
    pub fn map(&self) -> &PoseSpace {
        &self.map
    }

    /// Returns the bounds on accelerations.
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// Returns whether the reference has arrived and stands still.
    pub fn is_at_rest(&self) -> bool {
        if let Some(held) = &self.held {
            return held.is_at_rest();
        }
        self.a.v.iter().chain(self.a.acc.iter()).all(|x| *x == 0.0) && self.b.v == 0.0 && self.b.acc == 0.0
    }

    /// Returns the reference dt seconds into the present step.
    pub fn reference(&self, dt: f64) -> Reference {
        if let Some(held) = &self.held {
            return held.reference(dt);
        }
        let (a, b) = (self.a.after(dt), self.b.after(dt));
        Reference {
            q: self.map.lift(&a.x, b.x),
            qd: self.map.lift_rates(&a.v, b.v),
            qdd: self.map.lift_rates(&a.acc, b.acc),
        }
    }

    /// Ends the present step and begins the next.
    pub fn advance(&mut self) {
        if let Some(held) = &mut self.held {
            held.advance();
            return;
        }
        let h = self.step;
        let turning = self.b.v != 0.0 || self.b.acc != 0.0;
        self.a = self.a.after(h);
        self.b = self.b.after(h);
        self.aim_rate = PerDrive::zeros(self.aim.len());
        if turning {
            let before = self.aim;
            self.turn_aim();
            // The nearest pose may jump as b changes: then the aim has no rate to follow.
            if self.target.reach == Reach::Inside {
                self.aim_rate = self.aim.minus(&before).scaled(1.0 / h);
            }
        }
        self.steer();
        let came_to_rest = turning && self.b.v == 0.0 && self.b.acc == 0.0;
        if came_to_rest && matches!(self.target.reach, Reach::Outside { .. }) {
            // At this b another pose may reach the target.
            self.aim_at_target();
            self.aim_rate = PerDrive::zeros(self.aim.len());
            self.steer();
        }
        self.hold();
    }

    /// Updates the aim after b has changed: the end effector stays if it can, else it turns with the workspace.
    fn turn_aim(&mut self) {
        match self.target.reach {
            Reach::Inside => match self.map.follow(self.target.at, self.b.x, &self.aim) {
                Some(a) => self.aim = a,
                None => {
                    self.target.reach = Reach::Carried;
                    self.target.at = self.aim_point();
                }
            },
            Reach::Carried | Reach::Stopped { .. } => self.target.at = self.aim_point(),
            // Starts from the aim, so that the result does not depend on the lag of the reference.
            Reach::Outside { .. } => {
                let (aim, reach) = self.map.target_pose_nearby(self.target.at, self.b.x, &self.aim, self.target.reach);
                (self.aim, self.target.reach) = (self.as_far_as_open(aim), reach);
            }
        }
    }

    /// Returns the pose `to`, or the last before a fold or a change point to be avoided on the straight line to it.
    fn as_far_as_open(&self, to: PerDrive) -> PerDrive {
        let from = self.a.x;
        if !self.map.has_barriers() || self.map.is_unblocked(&from, &to) {
            return to;
        }
        let at = |t: f64| from.plus(t, &to.minus(&from));
        at(greatest_feasible_fraction(|t| self.map.is_unblocked(&from, &at(t))))
    }

    fn aim_point(&self) -> Vector {
        self.map.forward(&self.aim, self.b.x)
    }

    /// Puts the reference at rest at b, rad: the end effector keeps its position if it can.
    pub fn pose_at(&mut self, b: f64) {
        self.let_go();
        self.b = Course { x: b, v: 0.0, acc: 0.0 };
        self.b_aim = b;
        self.turn_aim();
        self.aim_rate = PerDrive::zeros(self.aim.len());
        self.a = Courses::resting(self.aim);
    }

    /// Sets the aim to the pose of the target at the present b and on the present sheet, or to the nearest pose.
    fn aim_at_target(&mut self) {
        // Starts from the present pose, not from the aim, so that the aim can be reached on a straight line.
        (self.aim, self.target.reach) = self.map.target_pose(self.target.at, self.b.x, &self.a.x);
    }

    /// Returns the accelerations nearest to the wanted ones after which each angle can still stop before its limit.
    /// Each angle brakes with at most bound/√n, so that braking all at once keeps the bound.
    fn within_limits(&self, want: &PerDrive) -> PerDrive {
        let n = want.len();
        let (h, brake) = (self.step, self.bounds.joint / (n as f64).sqrt());
        let mut acc = PerDrive::from_fn(n, |i| {
            let (x, v) = (self.a.x[i], self.a.v[i]);
            // Maximum acceleration towards a limit at distance d, approached at speed v: after this step the angle can
            // brake step by step and stop at the limit. If the limit is too near for that, the angle turns back at the
            // limit.
            let max_towards = |d: f64, v: f64| {
                if d == f64::INFINITY {
                    return d;
                }
                let room = d - 0.5 * h * v;
                // If braking takes between n and n + 1 steps, the stopping distance is linear in the speed.
                let n = (0.5 * (1.0 + 8.0 * room.max(0.0) / (brake * h * h)).sqrt() - 0.5).floor();
                let s = room.max(0.0) / (h * (n + 1.0)) + 0.5 * brake * h * n;
                let most = if room < 0.0 && d > 0.0 { -0.5 * v * v / d } else { (s - v) / h };
                most.max(-brake)
            };
            let [low, high] = self.map.limits(i);
            let (up, down) = (max_towards(high - x, v), max_towards(x - low, -v));
            want[i].min(up).max(-down)
        });
        // If some angles must brake harder than wanted, the others are scaled down to keep the bound on |ä|.
        let brakes = PerDrive::from_fn(n, |i| f64::from(u8::from(acc[i].abs() > want[i].abs())));
        let size = |which: f64| (0..n).filter(|i| brakes[*i] == which).fold(0.0, |sum: f64, i| sum.hypot(acc[i]));
        let (braking, others) = (size(1.0), size(0.0));
        let available = (self.bounds.joint.powi(2) - braking * braking).max(0.0).sqrt();
        if braking > 0.0 && others > available {
            (0..n).filter(|i| brakes[*i] == 0.0).for_each(|i| acc[i] *= available / others);
        }
        acc
    }

    /// Returns accelerations between the wanted ones and full braking, as near as possible to the wanted ones. After
    /// them the reference can stop on a straight line without leaving its sheet.
    fn before_folds(&self, want: &PerDrive) -> PerDrive {
        let wanted = self.within_limits(want);
        if !self.map.has_barriers() || self.can_stop_after(&wanted) {
            return wanted;
        }
        let speed = norm(&self.a.v);
        let brake = self.bounds.joint.min(speed / self.step);
        let braking = self.a.v.scaled(if speed > 0.0 { -brake / speed } else { 0.0 });
        // Full braking does not move the stopping point, so it is always feasible.
        let at = |t: f64| self.within_limits(&braking.plus(t, &want.minus(&braking)));
        at(greatest_feasible_fraction(|t| self.can_stop_after(&at(t))))
    }

    /// Returns whether the coming step with these accelerations, and the straight line from there to the stop, meet no
    /// fold or change point to be avoided.
    fn can_stop_after(&self, acc: &PerDrive) -> bool {
        let next = Courses { acc: *acc, ..self.a }.after(self.step);
        let speed = norm(&next.v);
        // Full braking step by step, in the last step only as much as needed.
        let whole = (speed / (self.bounds.joint * self.step)).floor();
        let rest = speed - whole * self.bounds.joint * self.step;
        let far = self.step * (0.5 * whole * (speed + rest) + 0.5 * rest);
        let stop = next.x.plus(if speed > 0.0 { far / speed } else { 0.0 }, &next.v);
        self.map.is_unblocked(&self.a.x, &next.x) && self.map.is_unblocked(&next.x, &stop)
    }

    /// Sets the accelerations of the coming step.
    fn steer(&mut self) {
        let n = self.aim.len();
        let way = self.aim.minus(&self.a.x);
        let v = self.a.v.minus(&self.aim_rate);
        let distance = norm(&way);
        if self.aim_rate.iter().all(|rate| *rate == 0.0) && distance < ARRIVAL_TOLERANCE && norm(&v) < ARRIVAL_TOLERANCE
        {
            self.a = Courses::resting(self.aim);
        } else {
            let speed = approach(distance, self.bounds.joint);
            let gain = if distance > 0.0 { speed / distance } else { 0.0 };
            let want = PerDrive::from_fn(n, |i| (gain * way[i] - v[i]) / LAG_TIME);
            let scale = (self.bounds.joint / norm(&want)).min(1.0);
            self.a.acc = self.before_folds(&want.scaled(scale));
        }
        let b_error = self.b_aim - self.b.x;
        if b_error.abs() < ARRIVAL_TOLERANCE && self.b.v.abs() < ARRIVAL_TOLERANCE {
            self.b = Course { x: if self.b.v == 0.0 { self.b.x } else { self.b_aim }, v: 0.0, acc: 0.0 };
        } else {
            let want = (approach(b_error.abs(), self.bounds.pose).copysign(b_error) - self.b.v) / LAG_TIME;
            self.b.acc = want.clamp(-self.bounds.pose, self.bounds.pose);
        }
    }
}
