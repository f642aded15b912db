//! [`Joint`]: one of the relative angles that join all drives.

/// A relative joint angle between the drive that is nearer to drive 1 and the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joint {
    /// The drive nearer to drive 1, and the other, counted from 0.
    pub(super) ends: [usize; 2],
    /// 1 where the other one's angle is added.
    pub(super) sense: f64,
    /// rad.
    pub(super) offset: f64,
    /// Least and greatest angle, rad; one turn where there are no limits.
    pub(super) limits: [f64; 2],
    /// Whether there are none.
    pub(super) free: bool,
    /// Its place among the machine's angles; none where the file names no angle that joins these drives.
    pub(super) angle: Option<usize>,
}

impl Joint {
    /// Least and greatest angle, rad.
    pub fn limits(&self) -> [f64; 2] {
        self.limits
    }

    /// The same, without end where there are no limits.
    pub fn bounds(&self) -> [f64; 2] {
        if self.free { [f64::NEG_INFINITY, f64::INFINITY] } else { self.limits }
    }

    /// Its place among the machine's angles; none where the file has no angle between these drives.
    pub fn angle(&self) -> Option<usize> {
        self.angle
    }

    /// The angle of a pose, rad.
    pub fn of(&self, q: &[f64]) -> f64 {
        self.sense * (q[self.ends[1]] - q[self.ends[0]]) + self.offset
    }
}
