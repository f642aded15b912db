//! Exaggeration of the motion of a base, so that small motions are visible.

use crate::numbers::round_up;
use crate::scene::course::target_handle;
use stillbase_mechanics::planar::{DriveAngles, Pose2, Vector, unit};
use stillbase_simulation::frame::Frame;

/// Height of a picture of the whole machine, as a multiple of its reach.
const PICTURE_HEIGHT: f64 = 1.64;

/// Minimum size of the largest motion, as a fraction of the height of the picture.
const VISIBLE_MOTION: f64 = 0.025;

/// Maximum size of the largest motion of a run that has changed, as a fraction of the height of the picture.
const MAX_MOTION: f64 = 0.25;

/// Motion below this fraction of the reach is rounding error and is not exaggerated.
const NOISE_LEVEL: f64 = 1e-10;

/// Maximum factor of exaggeration.
const MAX_FACTOR: f64 = 1e6;

/// Returns the smallest of the factors 1, 2, 5, 10 … that makes the largest motion of a run visible. The arguments are
/// the largest displacement, m, the largest rotation, rad, and the reach of the machine, m.
pub fn exaggeration([shift, angle]: [f64; 2], reach: f64) -> f64 {
    let motion = shift + angle * reach;
    if !(motion > NOISE_LEVEL * reach && motion.is_finite()) {
        return 1.0;
    }
    let wanted = VISIBLE_MOTION * PICTURE_HEIGHT * reach / motion;
    if wanted <= 1.0 { 1.0 } else { round_up(wanted).min(MAX_FACTOR) }
}

/// Returns the factor for the motion of a base `before` a run was changed, unless it enlarges the `present` motion
/// beyond a quarter of the height of the picture.
pub fn exaggeration_kept(before: [f64; 2], present: [f64; 2], reach: f64) -> f64 {
    let kept = exaggeration(before, reach);
    let [shift, angle] = present;
    let fits = kept * (shift + angle * reach) <= MAX_MOTION * PICTURE_HEIGHT * reach;
    if fits { kept } else { exaggeration(present, reach) }
}

/// Rule by which the motion of a base is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Exaggeration {
    /// Displacement and rotation are multiplied by this factor.
    Times(f64),
    /// The base is rotated by minus this compliance, rad/(N m), times the moment n_B, as if on a soft mount.
    Mount(f64),
}

impl Default for Exaggeration {
    fn default() -> Self {
        Self::Times(1.0)
    }
}

impl Exaggeration {
    /// Factor by which the motion of the base is exaggerated.
    pub fn factor(self) -> f64 {
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

/// A frame with exaggerated motion: drawn positions, and the true values. Texts use only the true values, never
/// the drawn positions.
#[derive(Clone, Copy, Debug)]
pub struct DrawnFrame<'a> {
    /// True values.
    pub frame: &'a Frame,
    /// Drawn pose of the base.
    pub base: Pose2,
    /// Drawn drive angles, rad.
    pub q: DriveAngles,
    /// Drawn position of the end effector, m.
    pub end_effector: Vector,
    /// Drawn position of the centre of mass, m.
    pub com: Vector,
    /// Drawn position of the target's handle, m.
    pub target: Vector,
}

impl<'a> DrawnFrame<'a> {
    /// Applies an exaggeration to a frame; drives, end effector and centre of mass move with the base.
    pub fn of(frame: &'a Frame, exaggeration: Exaggeration) -> Self {
        let base = exaggeration.base(frame);
        let more = base.angle - frame.base.angle;
        if base == frame.base {
            let (q, end_effector, com) = (frame.q, frame.end_effector, frame.com);
            return Self { frame, base, q, end_effector, com, target: target_handle(frame) };
        }
        let moved = |p| base.place(frame.in_base(p));
        let mut q = frame.q;
        q.0.iter_mut().for_each(|q| *q += more);
        let target = match exaggeration {
            Exaggeration::Times(_) if is_led(frame) => moved(target_handle(frame)),
            // The target stays where it was set, however far the base moves.
            Exaggeration::Times(_) => target_handle(frame),
            // The base itself is at rest; the whole picture is rotated.
            Exaggeration::Mount(_) => target_handle(frame) * unit(more),
        };
        Self { frame, base, q, end_effector: moved(frame.end_effector), com: moved(frame.com), target }
    }

    /// Returns where a place near the end effector is drawn, m: beside the drawn one if this is led to it.
    pub fn near_target(&self, place: Vector) -> Vector {
        if is_led(self.frame) { self.base.place(self.frame.in_base(place)) } else { place }
    }

    /// Returns the target, m, that leads the drawn end effector to a drawn position, if the base is free.
    pub fn target_at(&self, drawn: Vector) -> Vector {
        if self.frame.floats || is_led(self.frame) { self.frame.base.place(self.in_base(drawn)) } else { drawn }
    }

    /// Converts a drawn position, m, to the axes of the drawn base.
    pub fn in_base(&self, place: Vector) -> Vector {
        self.base.seen(place)
    }
}

/// Whether the end effector goes to the target wherever the base is.
fn is_led(frame: &Frame) -> bool {
    frame.target_rides || frame.base_is_planned
}

impl<'a> From<&'a Frame> for DrawnFrame<'a> {
    /// Returns the frame without exaggeration.
    fn from(frame: &'a Frame) -> Self {
        Self::of(frame, Exaggeration::default())
    }
}
