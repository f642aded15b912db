//! A base that floats turns while b changes: which b brings the end effector to a point in spite of it.
//!
//! While nothing moves, the base of a balanced machine turns by Δθ = −D₁ Δb / (I_b + μ|ρ|² + Σ D_k), and the centre of
//! mass of everything stays where it is. So the pose of the base follows from b alone, and with it the place of the
//! point in the axes of the base, in which the machine is led.

use crate::interactive::Session;
use crate::verdict::inertia_of;
use stillbase_mechanics::planar::{Pose2, Vector, unit};
use stillbase_planning::off_plane::price::Price;
use stillbase_planning::pose_space::PoseSpace;
use stillbase_planning::reactionless::Decimal;
use stillbase_simulation::plant::PlantDifferences;

/// Largest drift of everything that moves at which the base counts as at rest, m/s and rad/s.
const MAX_DRIFT: f64 = 1e-7;
/// Maximum number of steps of the search for b, and the step at which it ends, rad.
const MAX_STEPS: usize = 400;
const LAST_STEP_RAD: f64 = 1e-10;
/// Numbers of decimals of b, rad, and of a place, m, in the order of the trials.
const DECIMALS: std::ops::RangeInclusive<usize> = 3..=12;
/// Fractions of an interval of b by which b is moved inside, in the order of the trials.
const INWARDS: [f64; 5] = [0.0, 1e-3, 1e-2, 5e-2, 0.5];

/// What the base does while b changes.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum BaseMotion {
    /// It stays, or comes back.
    Stays,
    /// It turns in proportion to b.
    Turns(FloatingBody),
    /// It floats, but only a run tells how it turns.
    Untold,
}

/// A floating base without momentum.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct FloatingBody {
    /// Angle, rad, at the present b.
    angle: f64,
    /// The present b, rad.
    b: f64,
    /// Δθ/Δb.
    rate: f64,
    /// Centre of mass of everything: at rest, m, and in the axes of the base, m.
    centre: [Vector; 2],
}

/// A place and a b that bring the end effector to a point.
pub(super) struct Led {
    /// The place in space, m, at which the target is put before b changes.
    pub to: [Decimal; 2],
    /// The pose constant, rad.
    pub b: Decimal,
}

impl BaseMotion {
    /// Returns what the base of a session does while b changes from the frame on display on.
    pub fn of(session: &Session) -> Self {
        let frame = session.frame();
        if !frame.floats {
            return Self::Stays;
        }
        FloatingBody::of(session).map_or(Self::Untold, Self::Turns)
    }
}

impl FloatingBody {
    /// Returns the base of the frame on display, if its motion follows from b alone.
    fn of(session: &Session) -> Option<Self> {
        let (scenario, frame, model) = (session.scenario(), session.frame(), inertia_of(session.run()));
        let base = &scenario.base;
        let floating = base.body();
        let rate = Price::of(&model, 1.0).and_then(|price| price.base_turn(&model, &floating)).ok()?;
        let mass = base.mass + model.mass();
        let drift =
            (frame.momentum.norm() / mass).max((frame.angular_momentum / (base.inertia + model.locked())).abs());
        let is_bare = scenario.plant == PlantDifferences::default() && scenario.machine.gravity().norm() == 0.0;
        if !(is_bare && drift <= MAX_DRIFT) {
            return None;
        }
        let inside = (base.mass * floating.com + model.mass() * frame.in_base(frame.com)) / mass;
        let Pose2 { at, angle } = frame.base;
        Some(Self { angle, b: frame.b, rate, centre: [at + inside * unit(angle), inside] })
    }

    /// Returns the angle of the base at a pose constant, rad.
    fn angle_at(&self, b: f64) -> f64 {
        self.angle + self.rate * (b - self.b)
    }

    /// Returns a point, m, in the axes that the base has at b, rad.
    fn seen(&self, at: Vector, b: f64) -> Vector {
        let [centre, inside] = self.centre;
        (at - centre) * unit(-self.angle_at(b)) + inside
    }

    /// Returns where the machine has to be led so that the end effector comes to a point in space, m, at a b near `b`,
    /// rad.
    pub fn led_to(&self, space: &PoseSpace, at: Vector, b: f64) -> Option<Led> {
        // The base turns more slowly than the workspace, so each step comes nearer.
        let mut near = b;
        for _ in 0..MAX_STEPS {
            let next = space.reach(self.seen(at, near)).ok()?.nearest(near)?;
            let step = (next - near).abs();
            near = next;
            if step < LAST_STEP_RAD {
                break;
            }
        }
        let set = space.reach(self.seen(at, near)).ok()?;
        let [centre, inside] = self.centre;
        let inner = INWARDS.map(|share| set.moved_inside(near, share));
        let trials = DECIMALS.flat_map(|decimals| inner.map(|b| Decimal::nearest(b, decimals)));
        let mut led = trials.map(|b| {
            // The target moves with the base, so it is put where it will be carried from.
            let place = self.seen(at, b.value());
            let now = centre + (place - inside) * unit(self.angle);
            let to = [now.re, now.im].map(|x| Decimal::nearest(x, b.decimals()));
            Led { to, b }
        });
        led.find(|Led { to: [x, y], b }| space.reaches(self.seen(Vector::new(x.value(), y.value()), self.b), b.value()))
    }
}
