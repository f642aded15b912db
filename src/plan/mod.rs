//! Plans: a path and a time law make the reference that control follows.

mod convex;
pub mod corridor;
pub mod curve;
pub mod drift;
pub mod follow;
pub mod inverse;
pub mod law;
pub mod least_reaction;
pub mod null_space;
pub mod path;
pub mod pose_course;
pub mod pose_integral;
mod pose_program;
pub mod price;
pub mod table;

pub use corridor::Corridor;
pub use curve::CurvePoint;
pub use follow::Follower;
pub use law::TimeLaw;
pub use least_reaction::LeastReaction;
pub use path::{Path, PathError};
pub use price::Price;
pub use table::Table;

use crate::planar::{DriveAngles, PerDrive};

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
    /// At rest.
    pub fn at_rest(q: DriveAngles) -> Self {
        let still = PerDrive::zeros(q.len());
        Self { q, qd: still, qdd: still }
    }
}

/// A path run through once, from rest to rest.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    /// Where.
    pub path: Path,
    /// When.
    pub law: TimeLaw,
    /// T, s.
    pub duration: f64,
}

impl Motion {
    /// The reference t seconds after the start; at rest before it and after T.
    #[inline]
    pub fn at(&self, t: f64) -> Reference {
        let p = self.law.at(t, self.duration);
        let point = self.path.at(p.s);
        Reference {
            q: point.q,
            qd: point.first.scaled(p.rate),
            qdd: point.second.scaled(p.rate * p.rate).plus(p.acceleration, &point.first),
        }
    }
}
