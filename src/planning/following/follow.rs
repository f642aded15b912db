//! Following the pointer and the slider: a smooth reference that stays on its plane.
//!
//! The reference moves in plane coordinates (a_1, a_2, b). Acceleration is constant over a step and bounded: the
//! vector (ä_1, ä_2) as a whole, never component by component, and b̈ on its own. While b is not slid it is not
//! touched at all, so the motion is reactionless to the last bit of b.

use std::sync::Arc;

use crate::mechanics::planar::{DriveAngles, PerDrive, Vector};
use crate::planning::Reference;
use crate::planning::pose_constant::{Planes, Reach};
use crate::planning::reactionless::PlanePoint;

/// Where the end effector is sent, and whether it can go there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    /// m.
    pub at: Vector,
    /// Whether it can be reached.
    pub reach: Reach,
}

/// Bounds on how fast the reference may change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// |(ä_1, ä_2)|, rad/s².
    pub joint: f64,
    /// |b̈|, rad/s²; the base feels at most D_1 times this.
    pub pose: f64,
}

/// Time constant of the reference behind its aim, s.
const LAG: f64 = 0.02;
/// The aim counts as reached when the reference is nearer than this, rad and rad/s.
const ARRIVED: f64 = 1e-11;

/// A reference that runs after a target on the plane of a pose constant.
#[derive(Clone, Debug)]
pub struct Follower {
    planes: Arc<Planes>,
    bounds: Bounds,
    step: f64,
    a: [Course; 2],
    b: Course,
    aim: [f64; 2],
    aim_rate: [f64; 2],
    b_aim: f64,
    target: Target,
}

/// A coordinate with its derivatives; the second holds over the present step.
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

impl Follower {
    /// Takes over from a reference: keeps its pose and rates, then slows to rest on the plane it is on. `step` is the
    /// time between calls of [`advance`](Self::advance), s.
    pub fn new(planes: Arc<Planes>, bounds: Bounds, step: f64, from: &Reference) -> Self {
        let map = planes.map();
        let at = map.project(&from.q);
        let (ad, bd) = map.project_rates(&from.qd);
        let mut follower = Self {
            bounds,
            step,
            a: [0, 1].map(|i| Course { x: at.a[i], v: ad[i], acc: 0.0 }),
            b: Course { x: at.b, v: bd, acc: 0.0 },
            aim: at.a,
            aim_rate: [0.0; 2],
            // The nearest b at which it can stop.
            b_aim: at.b + 0.5 * bd * bd.abs() / bounds.pose,
            target: Target { at: map.forward(at.a, at.b), reach: Reach::Inside },
            planes,
        };
        let stop = ad[0].hypot(ad[1]) / bounds.joint;
        follower.aim = follower.planes.map().clamp([0, 1].map(|i| at.a[i] + 0.5 * stop * ad[i]));
        follower.target.at = follower.aim_point();
        follower.steer();
        follower
    }

    /// Sends the end effector to a point, m.
    pub fn set_target(&mut self, at: Vector) {
        self.target.at = at;
        self.aim_at_target();
        self.aim_rate = [0.0; 2];
        self.steer();
    }

    /// Sends the relative angles to (a_1, a_2), rad, as far as their limits and folds on the straight way let them.
    pub fn set_angles(&mut self, a: [f64; 2]) {
        let from = self.a.map(|c| c.x);
        let to = self.planes.map().clamp(a);
        let at = |t: f64| [0, 1].map(|i| from[i] + t * (to[i] - from[i]));
        self.aim = to;
        if !self.planes.is_open_way(from, to) {
            // The last pose before what bars the way.
            let (mut open, mut barred) = (0.0, 1.0);
            for _ in 0..20 {
                let middle = 0.5 * (open + barred);
                if self.planes.is_open_way(from, at(middle)) { open = middle } else { barred = middle }
            }
            self.aim = at(open);
        }
        self.target = Target { at: self.aim_point(), reach: Reach::Inside };
        self.aim_rate = [0.0; 2];
        self.steer();
    }

    /// The relative angles that the reference goes to, rad.
    pub fn aim(&self) -> [f64; 2] {
        self.aim
    }

    /// Sends the pose constant to b, rad.
    pub fn set_b(&mut self, b: f64) {
        self.b_aim = b;
        self.steer();
    }

    /// Where the end effector is sent, and whether it can go there.
    pub fn target(&self) -> Target {
        self.target
    }

    /// b of the reference, rad.
    pub fn b(&self) -> f64 {
        self.b.x
    }

    /// b that the reference goes to, rad.
    pub fn b_aim(&self) -> f64 {
        self.b_aim
    }

    /// The planes it moves on.
    pub fn planes(&self) -> &Planes {
        &self.planes
    }

    /// The bounds it keeps.
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// Whether the reference has arrived and stands still.
    pub fn is_at_rest(&self) -> bool {
        self.a.iter().all(|c| c.v == 0.0 && c.acc == 0.0) && self.b.v == 0.0 && self.b.acc == 0.0
    }

    /// The reference dt seconds into the present step.
    pub fn reference(&self, dt: f64) -> Reference {
        let (a, b) = (self.a.map(|c| c.after(dt)), self.b.after(dt));
        let map = self.planes.map();
        Reference {
            q: DriveAngles::from(map.lift(PlanePoint { a: a.map(|c| c.x), b: b.x })),
            qd: PerDrive::from(map.lift_rates(a.map(|c| c.v), b.v)),
            qdd: PerDrive::from(map.lift_rates(a.map(|c| c.acc), b.acc)),
        }
    }

    /// Ends the present step and begins the next.
    pub fn advance(&mut self) {
        let h = self.step;
        let turning = self.b.v != 0.0 || self.b.acc != 0.0;
        self.a = self.a.map(|c| c.after(h));
        self.b = self.b.after(h);
        if turning {
            let before = self.aim;
            self.turn_aim();
            self.aim_rate = [0, 1].map(|i| (self.aim[i] - before[i]) / h);
        } else {
            self.aim_rate = [0.0; 2];
        }
        self.steer();
    }

    /// b has changed: the end effector keeps its place while it can; when it cannot, it turns with the workspace.
    fn turn_aim(&mut self) {
        match self.target.reach {
            Reach::Inside => match self.planes.follow(self.target.at, self.b.x, self.aim) {
                Some(a) => self.aim = a,
                None => {
                    self.target.reach = Reach::Carried;
                    self.target.at = self.aim_point();
                }
            },
            Reach::Carried => self.target.at = self.aim_point(),
            Reach::Outside { .. } => self.aim_at_target(),
        }
    }

    fn aim_point(&self) -> Vector {
        self.planes.map().forward(self.aim, self.b.x)
    }

    /// Puts the reference at rest on the plane b: the end effector keeps its place if it can.
    pub fn pose_at(&mut self, b: f64) {
        self.b = Course { x: b, v: 0.0, acc: 0.0 };
        self.b_aim = b;
        self.turn_aim();
        self.aim_rate = [0.0; 2];
        self.a = self.aim.map(|x| Course { x, v: 0.0, acc: 0.0 });
    }

    /// Finds the pose for the target on the present plane and sheet, or the nearest one.
    fn aim_at_target(&mut self) {
        // From where it is, not from where it was going: what it can go to straight.
        let (aim, reach) = self.planes.reach(self.target.at, self.b.x, self.a.map(|c| c.x));
        self.aim = aim;
        self.target.reach = reach;
    }

    /// The accelerations nearest to the wanted ones after which either angle can still stop before its limit, with
    /// half of the bound's square each, so that stopping both at once is within the bound.
    fn within_limits(&self, want: [f64; 2]) -> [f64; 2] {
        let (h, brake) = (self.step, self.bounds.joint * std::f64::consts::FRAC_1_SQRT_2);
        let limits = self.planes.map().limits();
        let mut acc = [0, 1].map(|i| {
            let Course { x, v, .. } = self.a[i];
            // The greatest acceleration towards a wall at distance d, nearing it at v. The speed s after this step has
            // h (v + s)/2 + s²/(2 brake) = d; nearer than that, the rest of the way just stops it.
            let most = |d: f64, v: f64| {
                let room = d - 0.5 * h * v;
                let s = 0.5 * (((brake * h).powi(2) + 8.0 * brake * room.max(0.0)).sqrt() - brake * h);
                let most = if room < 0.0 && d > 0.0 { -0.5 * v * v / d } else { (s - v) / h };
                most.max(-brake)
            };
            let (up, down) = (most(limits[i].max - x, v), most(x - limits[i].min, -v));
            want[i].min(up).max(-down)
        });
        // Where one angle must brake harder than wanted, the other one leaves it the share it needs.
        for (i, j) in [(0, 1), (1, 0)] {
            let left = (self.bounds.joint.powi(2) - acc[i] * acc[i]).max(0.0).sqrt();
            if acc[i].abs() > want[i].abs() && acc[j].abs() > left {
                acc[j] = left.copysign(acc[j]);
            }
        }
        acc
    }

    /// The wanted accelerations, or full braking where after them a fold could not be avoided any more. So there is
    /// always a straight way on which to stop that keeps to the sheet.
    fn before_folds(&self, want: [f64; 2]) -> [f64; 2] {
        if !self.planes.has_bars() {
            return want;
        }
        let [x, y] = [0, 1].map(|i| Course { acc: want[i], ..self.a[i] }.after(self.step));
        let speed = x.v.hypot(y.v);
        let stop = [x, y].map(|c| c.x + 0.5 * speed * c.v / self.bounds.joint);
        let (now, next) = (self.a.map(|c| c.x), [x.x, y.x]);
        if self.planes.is_open_way(now, next) && self.planes.is_open_way(next, stop) {
            return want;
        }
        let speed = self.a[0].v.hypot(self.a[1].v);
        let brake = self.bounds.joint.min(speed / self.step);
        self.a.map(|c| if speed > 0.0 { -brake * c.v / speed } else { 0.0 })
    }

    /// Chooses the accelerations of the coming step.
    fn steer(&mut self) {
        let [x, y] = [0, 1].map(|i| self.aim[i] - self.a[i].x);
        let v = [0, 1].map(|i| self.a[i].v - self.aim_rate[i]);
        let distance = x.hypot(y);
        if self.aim_rate == [0.0; 2] && distance < ARRIVED && v[0].hypot(v[1]) < ARRIVED {
            for i in 0..2 {
                self.a[i] = Course { x: self.aim[i], v: 0.0, acc: 0.0 };
            }
        } else {
            let speed = approach(distance, self.bounds.joint);
            let gain = if distance > 0.0 { speed / distance } else { 0.0 };
            let want = [(gain * x - v[0]) / LAG, (gain * y - v[1]) / LAG];
            let scale = (self.bounds.joint / want[0].hypot(want[1])).min(1.0);
            let acc = self.within_limits(self.before_folds(want.map(|w| w * scale)));
            self.a.iter_mut().zip(acc).for_each(|(a, acc)| a.acc = acc);
        }
        let left = self.b_aim - self.b.x;
        if left.abs() < ARRIVED && self.b.v.abs() < ARRIVED {
            self.b = Course { x: if self.b.v == 0.0 { self.b.x } else { self.b_aim }, v: 0.0, acc: 0.0 };
        } else {
            let want = (approach(left.abs(), self.bounds.pose).copysign(left) - self.b.v) / LAG;
            self.b.acc = want.clamp(-self.bounds.pose, self.bounds.pose);
        }
    }
}

/// Speed at which a distance is closed so that four fifths of the bound can still stop it.
fn approach(distance: f64, bound: f64) -> f64 {
    (distance / (4.0 * LAG)).min((1.6 * bound * distance).sqrt())
}
