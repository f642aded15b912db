//! How much the motion of a base is exaggerated, so that it can be seen.

use crate::mechanics::planar::{DriveAngles, Pose2, Vector, unit};
use crate::picture::numbers::round_up;
use crate::picture::scene::course::target_handle;
use crate::simulation::frame::Frame;

/// Height of a picture of the whole machine, as parts of its reach.
const PICTURE: f64 = 1.64;

/// The part of the picture's height that the greatest motion should at least have.
const SEEN: f64 = 0.025;

/// Motion below this part of the reach is rounding, and shown as it is.
const NOISE: f64 = 1e-10;

/// The most that motion is exaggerated.
const MOST: f64 = 1e6;

/// The least of 1, 2, 5, 10 … with which the greatest motion of a run, m and rad, is seen on a machine of a reach, m.
pub fn exaggeration([shift, angle]: [f64; 2], reach: f64) -> f64 {
    let motion = shift + angle * reach;
    if !(motion > NOISE * reach && motion.is_finite()) {
        return 1.0;
    }
    let wanted = SEEN * PICTURE * reach / motion;
    if wanted <= 1.0 { 1.0 } else { round_up(wanted).min(MOST) }
}

/// How the motion of a base is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Exaggeration {
    /// So many times as far as it moves.
    Times(f64),
    /// Turned against the moment on it, as if it stood on a soft mount, rad/(N m).
    Mount(f64),
}

impl Default for Exaggeration {
    fn default() -> Self {
        Self::Times(1.0)
    }
}

impl Exaggeration {
    /// How many times as far as it moves the base is drawn to move.
    pub fn times(self) -> f64 {
        match self {
            Self::Times(times) => times,
            Self::Mount(_) => 1.0,
        }
    }

    fn base(self, frame: &Frame) -> Pose2 {
        let Pose2 { at, angle } = frame.base;
        match self {
            Self::Times(times) => Pose2 { at: at * times, angle: angle * times },
            Self::Mount(softness) => Pose2 { at, angle: angle - softness * frame.base_moment() },
        }
    }
}

/// An instant as it is drawn: where things are in the picture, and the frame beside them. Only the frame is spoken of:
/// what makes words is given the frame and never this.
#[derive(Clone, Copy, Debug)]
pub struct Shown<'a> {
    /// What is true.
    pub frame: &'a Frame,
    /// Where the base is drawn.
    pub base: Pose2,
    /// The drive angles that are drawn, rad.
    pub q: DriveAngles,
    /// Where the end effector is drawn, m.
    pub end_effector: Vector,
    /// Where the centre of mass is drawn, m.
    pub com: Vector,
    /// Where the target's handle is drawn, m.
    pub target: Vector,
}

impl<'a> Shown<'a> {
    /// A frame, drawn so: drives, end effector and centre of mass go with the base.
    pub fn of(frame: &'a Frame, exaggeration: Exaggeration) -> Self {
        let base = exaggeration.base(frame);
        let more = base.angle - frame.base.angle;
        if base == frame.base {
            let (q, end_effector, com) = (frame.q, frame.end_effector, frame.com);
            return Self { frame, base, q, end_effector, com, target: target_handle(frame) };
        }
        let moved = |p| base.at + frame.in_base(p) * unit(base.angle);
        let mut q = frame.q;
        q.0.iter_mut().for_each(|q| *q += more);
        let target = match exaggeration {
            // It stays where it was set, however far the base moves.
            Exaggeration::Times(_) => target_handle(frame),
            // Here nothing moves but the picture, and all of it.
            Exaggeration::Mount(_) => target_handle(frame) * unit(more),
        };
        Self { frame, base, q, end_effector: moved(frame.end_effector), com: moved(frame.com), target }
    }

    /// A place of the picture as seen from the base, m: where it would be, had the base not moved.
    pub fn in_base(&self, place: Vector) -> Vector {
        (place - self.base.at) * unit(-self.base.angle)
    }
}

impl<'a> From<&'a Frame> for Shown<'a> {
    /// As it is.
    fn from(frame: &'a Frame) -> Self {
        Self::of(frame, Exaggeration::default())
    }
}
