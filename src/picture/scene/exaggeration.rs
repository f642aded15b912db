//! How much the motion of a base is exaggerated, so that it can be seen.

use crate::mechanics::planar::{Pose2, unit};
use crate::picture::numbers::round_up;
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

/// A frame as it would be, had the base moved so many times as far: drives, end effector and centre of mass go along.
pub fn exaggerated(frame: &Frame, times: f64) -> Frame {
    if times == 1.0 {
        return *frame;
    }
    let base = Pose2 { at: frame.base.at * times, angle: frame.base.angle * times };
    let more = base.angle - frame.base.angle;
    let moved = |p| base.at + frame.in_base(p) * unit(base.angle);
    let mut q = frame.q;
    q.0.iter_mut().for_each(|q| *q += more);
    Frame { base, q, end_effector: moved(frame.end_effector), com: moved(frame.com), ..*frame }
}
