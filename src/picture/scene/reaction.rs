//! What reaches the base at an instant, with its words and colours: every view and every recording draws this.
//!
//! The arrow is the force of the motion; constant forces, of weight and pushes, are written beside it. The arc is the
//! moment that the base feels. Force and moment have a colour each.

use std::f64::consts::FRAC_PI_2;

use super::Rgba;
use super::palette::Palette;
use crate::mechanics::planar::Vector;
use crate::picture::numbers::{round_up, signed};
use crate::simulation::frame::{Frame, REACTIONLESS};

/// A full arrow, parts of the machine's reach.
pub const ARROW: f64 = 0.25;
/// Radius of the arc of a moment, parts of the machine's reach.
pub const RADIUS: f64 = 0.17;
/// The sweep of a full arc, rad.
pub const FULL: f64 = 1.5 * FRAC_PI_2;
/// The least arrow, parts of the reach, and the least sweep, rad, that can be seen.
const LEAST: (f64, f64) = (0.004, 0.02);

/// What a full arrow and a full arc stand for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// N of a full arrow.
    pub newtons: f64,
    /// N m of a full arc.
    pub newton_metres: f64,
}

impl Scale {
    /// Round numbers that hold the largest force and moment that are shown.
    pub fn of(force: f64, moment: f64) -> Self {
        Self { newtons: round_up(force.max(1e-3)), newton_metres: round_up(moment.max(1e-3)) }
    }
}

/// What reaches the base at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reaction {
    /// f_B of motion, N.
    pub force: Vector,
    /// What the base feels of n_B, N m.
    pub moment: f64,
    /// |f_B| of weight and pushes, N.
    pub rest: f64,
    /// Whether the force is more than rounding, by the measure of the run so far.
    pub pulls: bool,
    /// The same of the moment.
    pub turns: bool,
}

impl Reaction {
    /// Of a frame.
    pub fn of(frame: &Frame) -> Self {
        let (force, moment) = (frame.wrench.dynamic.force, frame.felt_moment());
        Self {
            force,
            moment,
            rest: frame.wrench.statical.force.norm(),
            pulls: force.norm() > REACTIONLESS * frame.peaks.inertial_pull.max(1e-9),
            turns: moment.abs() > REACTIONLESS * frame.peaks.torque_sum.max(1e-9),
        }
    }

    /// The arrow, parts of the reach, where a full one stands for so many newtons; none where nothing is to be seen.
    pub fn arrow(&self, newtons: f64) -> Option<Vector> {
        let arrow = self.force * (ARROW / newtons);
        (self.pulls && arrow.norm() > LEAST.0).then_some(arrow)
    }

    /// The sweep of the arc, rad, where a full one stands for so many newton metres; none where nothing is to be seen.
    pub fn sweep(&self, newton_metres: f64) -> Option<f64> {
        let sweep = self.moment / newton_metres * FULL;
        (self.turns && sweep.abs() > LEAST.1).then_some(sweep)
    }

    /// f_B and n_B in words, each in its own colour.
    pub fn readings(&self, palette: &Palette) -> [(String, Rgba); 2] {
        let tone = |real: bool| if real { palette.reaction } else { palette.zero };
        [
            (format!("f_B {} N", reading(self.force.norm(), self.pulls)), tone(self.pulls)),
            (format!("n_B {} N m", reading(self.moment, self.turns)), tone(self.turns)),
        ]
    }

    /// What else the base carries, by its name, if there is any.
    pub fn beside(&self, name: &str) -> Option<String> {
        (self.rest > 0.0).then(|| format!("and {name}, {:.1} N", self.rest))
    }
}

/// Three decimals, or the order of magnitude where they would hide it.
fn reading(x: f64, real: bool) -> String {
    if real && x.abs() < 5e-4 { format!("{x:.1e}").replace('-', "−") } else { signed(x, 3) }
}
