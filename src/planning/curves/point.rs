//! [`PathPoint`]: a pose on a path with its derivatives.

use crate::reference::Reference;
use crate::timing::law::PathProgress;
use stillbase_mechanics::planar::{DriveAngles, PerDrive};

/// A pose on a path with its first two derivatives with respect to s.
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
    /// Returns the reference at this point for given rates of s: q̇ = q′ ṡ, q̈ = q″ ṡ² + q′ s̈.
    #[inline]
    pub fn timed(&self, p: &PathProgress) -> Reference {
        Reference {
            q: self.q,
            qd: self.first.scaled(p.rate),
            qdd: self.second.scaled(p.rate * p.rate).plus(p.acceleration, &self.first),
        }
    }
}
