//! [`Reference`]: the reference that control follows.

use stillbase_mechanics::planar::{DriveAngles, PerDrive};

/// Desired drive angles, rates and accelerations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reference {
    /// Drive angles, rad.
    pub q: DriveAngles,
    /// Drive rates, rad/s.
    pub qd: PerDrive,
    /// Drive accelerations, rad/s².
    pub qdd: PerDrive,
}

impl Reference {
    /// Returns the reference that rests at a pose.
    pub fn at_rest(q: DriveAngles) -> Self {
        let still = PerDrive::zeros(q.len());
        Self { q, qd: still, qdd: still }
    }
}
