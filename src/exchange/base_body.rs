//! [`BaseBody`]: the base of a machine as a rigid body.

use stillbase_mechanics::planar::Vector;

/// A base with all parts that are fixed to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BaseBody {
    /// Mass, kg.
    pub mass: f64,
    /// Moment of inertia about the axis through its centre of mass parallel to that of the drives, kg m².
    pub inertia: f64,
    /// Position of its centre of mass relative to the axis of the drives, m.
    pub com: Vector,
}

impl BaseBody {
    /// Returns the side of the square plate that has this mass and inertia, m: it is drawn for the base.
    pub fn drawn_side(&self) -> f64 {
        (6.0 * self.inertia / self.mass).sqrt()
    }
}
