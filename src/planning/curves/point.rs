//! [`PathPoint`]: where a path is after a share of it, and how it goes on.

use crate::mechanics::planar::{DriveAngles, PerDrive};
use crate::planning::reference::Reference;
use crate::planning::timing::law::Progress;

/// A pose on a path and how it changes with s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathPoint {
    /// q, rad.
    pub q: DriveAngles,
    /// dq/ds, rad.
    pub first: PerDrive,
    /// d²q/ds², rad.
    pub second: PerDrive,
}

impl PathPoint {
    /// The reference where the path is passed with given rates of s: q̇ = q′ ṡ, q̈ = q″ ṡ² + q′ s̈.
    #[inline]
    pub fn timed(&self, p: &Progress) -> Reference {
        Reference {
            q: self.q,
            qd: self.first.scaled(p.rate),
            qdd: self.second.scaled(p.rate * p.rate).plus(p.acceleration, &self.first),
        }
    }
}
