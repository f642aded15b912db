//! [`Measurement`]: a distance between two points, or the angle between the lines to two points.

use serde::{Deserialize, Serialize};
use stillbase_mechanics::machine::Machine;
use stillbase_mechanics::planar::Vector;
use stillbase_session::scenario::SnapPoint;

/// A distance or an angle that the user measures in the scene.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Measurement {
    /// Its points: two for a distance; three for the angle at the second one.
    pub points: Vec<SnapPoint>,
    /// Whether it is under the pointer.
    #[serde(skip)]
    pub highlighted: bool,
}

/// Number of points of an angle.
pub const ANGLE_POINTS: usize = 3;

impl Measurement {
    /// Returns the measurement with these points.
    pub fn of(points: Vec<SnapPoint>) -> Self {
        Self { points, highlighted: false }
    }

    /// Whether it has two or three points, and a machine has all of them.
    pub fn is_of(&self, machine: &Machine) -> bool {
        (2..=ANGLE_POINTS).contains(&self.points.len()) && self.points.iter().all(|point| point.check(machine).is_ok())
    }

    /// Returns whether it has enough points for a distance.
    pub fn is_whole(&self) -> bool {
        self.points.len() >= 2
    }
}

/// Returns the angle at `corner` from the line to `from` to the line to `to`, rad, between −π and π. `None` if one of
/// the lines has no length.
pub fn angle([from, corner, to]: [Vector; ANGLE_POINTS]) -> Option<f64> {
    let (u, v) = (from - corner, to - corner);
    // A line shorter than this has no direction, m.
    let shortest = 1e-9;
    (u.norm() > shortest && v.norm() > shortest).then(|| (u.re * v.im - u.im * v.re).atan2(u.re * v.re + u.im * v.im))
}
