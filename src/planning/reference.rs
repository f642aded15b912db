//! [`Reference`]: what control follows.

use crate::mechanics::planar::{DriveAngles, PerDrive};

/// Where the machine should be, and how it should move there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reference {
    /// rad.
    pub q: DriveAngles,
    /// rad/s.
    pub qd: PerDrive,
    /// rad/s².
    pub qdd: PerDrive,
}

impl Reference {
    /// The reference that rests at a pose.
    pub fn at_rest(q: DriveAngles) -> Self {
        let still = PerDrive::zeros(q.len());
        Self { q, qd: still, qdd: still }
    }
}
