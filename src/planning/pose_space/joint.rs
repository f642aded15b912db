//! [`RelativeJoint`]: one of the relative angles that connect all drives.

/// A relative angle between two drives, one of them nearer to drive 1 in the tree of joints.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RelativeJoint {
    /// Indices, counted from 0, of the drive nearer to drive 1 and of the other drive.
    pub(super) ends: [usize; 2],
    /// Sign of the farther drive's angle in the relative angle: 1 or −1.
    pub(super) sense: f64,
    /// Constant offset of the angle, rad.
    pub(super) offset: f64,
    /// Bounds, rad; [−π, π] if the joint is free.
    pub(super) limits: [f64; 2],
    /// Whether the joint has no limits.
    pub(super) free: bool,
    /// Index among the machine's angles; `None` if the file names no angle between these drives.
    pub(super) angle: Option<usize>,
}

impl RelativeJoint {
    /// Returns the bounds, rad; [−π, π] if the joint is free.
    pub fn limits(&self) -> [f64; 2] {
        self.limits
    }

    /// Returns the bounds, rad; infinite if the joint is free.
    pub fn bounds(&self) -> [f64; 2] {
        if self.free { [f64::NEG_INFINITY, f64::INFINITY] } else { self.limits }
    }

    /// Returns the index among the machine's angles; `None` if the file has no angle between these drives.
    pub fn angle(&self) -> Option<usize> {
        self.angle
    }

    /// Returns the relative angle of a pose, rad.
    pub fn of(&self, q: &[f64]) -> f64 {
        self.sense * (q[self.ends[1]] - q[self.ends[0]]) + self.offset
    }
}
