//! The reaction on the base at an instant, with its texts and colours, for all views and recordings.
//!
//! The arrow is the force due to the motion; constant forces (weight and pushes) are written beside it. The arc is the
//! moment that reaches the base. Force and moment have separate colours.

use std::f64::consts::FRAC_PI_2;

use super::Rgba;
use super::palette::Palette;
use crate::numbers::{round_up, signed};
use stillbase_mechanics::planar::Vector;
use stillbase_simulation::frame::Frame;

/// Length of the arrow of a full-scale force, as a fraction of the reach of the machine.
pub const FULL_ARROW: f64 = 0.25;
/// Radius of the arc of a moment, as a fraction of the reach of the machine.
pub const ARC_RADIUS: f64 = 0.17;
/// Angle of the arc of a full-scale moment, rad.
pub const FULL_ARC: f64 = 1.5 * FRAC_PI_2;
/// Minimum length of a visible arrow, as a fraction of the reach.
const MIN_ARROW: f64 = 0.004;
/// Minimum angle of a visible arc, rad.
const MIN_SWEEP_RAD: f64 = 0.02;

/// Full-scale force and moment: those of an arrow of length [`FULL_ARROW`] and an arc of angle [`FULL_ARC`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// Full-scale force, N.
    pub newtons: f64,
    /// Full-scale moment, N m.
    pub newton_metres: f64,
}

impl Scale {
    /// Returns round numbers that are at least the largest force, N, and moment, N m.
    pub fn of(force: f64, moment: f64) -> Self {
        Self { newtons: round_up(force.max(1e-3)), newton_metres: round_up(moment.max(1e-3)) }
    }
}

/// Reaction on the base at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReactionGlyph {
    /// Force f_B due to the motion, N.
    pub force: Vector,
    /// Part of the moment n_B that reaches the base, N m.
    pub moment: f64,
    /// |f_B| due to weight and pushes, N.
    pub static_force: f64,
    /// Whether the force exceeds rounding errors, relative to the inertial forces of the run so far.
    pub has_force: bool,
    /// Whether the moment exceeds rounding errors, relative to the torques of the run so far.
    pub has_moment: bool,
    /// Whether the run so far has had a force on the base, from motion.
    pub had_force: bool,
    /// Whether a moment, after subtraction of a wheel's, has reached the base in the run so far.
    pub had_moment: bool,
    /// Whether the machine has moved so far.
    pub has_moved: bool,
}

/// Inertial forces of a machine that has moved exceed this, N.
const MIN_INERTIAL_PULL_N: f64 = 1e-9;

impl ReactionGlyph {
    /// Returns the reaction of a frame.
    pub fn of(frame: &Frame) -> Self {
        let (force, moment) = (frame.wrench.dynamic.force, frame.felt_moment);
        Self {
            force,
            moment,
            static_force: frame.wrench.static_part.force.norm(),
            has_force: frame.peaks.counts_as_force(force.norm()),
            had_force: frame.peaks.transmits_force(),
            had_moment: frame.peaks.counts_as_moment(frame.peaks.moment),
            has_moved: frame.peaks.inertial_pull > MIN_INERTIAL_PULL_N,
            has_moment: frame.peaks.counts_as_moment(moment.abs()),
        }
    }

    /// Returns the arrow as a fraction of the reach; `newtons` is the full-scale force. `None` if the arrow is too
    /// small.
    pub fn arrow(&self, newtons: f64) -> Option<Vector> {
        let arrow = self.force * (FULL_ARROW / newtons);
        (self.has_force && arrow.norm() > MIN_ARROW).then_some(arrow)
    }

    /// Returns the angle of the arc, rad; `newton_metres` is the full-scale moment. `None` if the arc is too small.
    pub fn sweep(&self, newton_metres: f64) -> Option<f64> {
        let sweep = self.moment / newton_metres * FULL_ARC;
        (self.has_moment && sweep.abs() > MIN_SWEEP_RAD).then_some(sweep)
    }

    /// Returns the texts of f_B and n_B with their colours. A reaction is red; zero is green if the machine has moved
    /// without any reaction so far. Before the first motion, and after an earlier reaction, zero is dim. `feels_more`
    /// says whether the moment that turns the base may differ from n_B.
    pub fn readings(&self, palette: &Palette, feels_more: bool) -> [(String, Rgba); 2] {
        let tone = |real: bool, stays_zero: bool| match (real, stays_zero && self.has_moved) {
            (true, _) => palette.reaction,
            (false, true) => palette.zero,
            (false, false) => palette.dim,
        };
        let [force, moment] = [tone(self.has_force, !self.had_force), tone(self.has_moment, !self.had_moment)];
        [
            (format!("f_B {} N", reading(self.force.norm(), self.has_force)), force),
            (format!("{} {} N m", moment_symbol(feels_more), reading(self.moment, self.has_moment)), moment),
        ]
    }

    /// Returns the text of the constant force under the given name, if there is one.
    pub fn static_force_text(&self, name: &str) -> Option<String> {
        (self.static_force > 0.0).then(|| format!("and {name}, {:.1} N", self.static_force))
    }
}

/// Returns the symbol of the moment that turns the base; `feels_more` says whether it may differ from n_B.
pub fn moment_symbol(feels_more: bool) -> &'static str {
    if feels_more { "n felt" } else { "n_B" }
}

/// Formats with three decimals, or with a power of ten if a nonzero value would be rounded to zero.
fn reading(x: f64, real: bool) -> String {
    if real && x.abs() < 5e-4 { format!("{x:.1e}").replace('-', "−") } else { signed(x, 3) }
}
