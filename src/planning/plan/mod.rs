//! Plans: a path and a timing make the reference that control follows.
//!
//! | what | modules |
//! |---|---|
//! | curves of the end effector, and paths of the drives | [`curve`], [`path`], [`table`] |
//! | given by samples: splined, smoothed | [`given`], [`spline`], [`low_pass`] |
//! | the nearest reactionless motion to a given one | [`nearest`] |
//! | on a plane: a curve followed on one sheet, or why not | [`trace`] |
//! | when: laws, limits of the drives, the fastest motion | [`law`], [`profile`], [`limits`], [`mod@fastest`], [`usage`] |
//! | off the plane: the price of b, the least reaction | [`price`], [`corridor`], [`inverse`], [`pose_course`], [`least_reaction`] |
//! | on any machine: zero momentum, its drift, and two drives | [`null_space`], [`drift`], [`pose_integral`] |
//! | what it will cost | [`forecast`] |
//! | following the pointer and the slider | [`follow`] |

mod convex;
pub mod corridor;
pub mod curve;
pub mod drift;
pub mod fastest;
pub mod follow;
pub mod forecast;
pub mod given;
pub mod inverse;
mod jerk;
mod keep;
pub mod law;
pub mod least_reaction;
pub mod limits;
pub mod low_pass;
pub mod nearest;
pub mod null_space;
pub mod path;
pub mod pose_course;
pub mod pose_integral;
mod pose_program;
pub mod price;
pub mod profile;
mod smooth;
pub mod spline;
pub mod table;
mod topp;
pub mod trace;
pub mod usage;

pub use corridor::Corridor;
pub use curve::{Curve, CurveError, CurvePoint};
pub use fastest::{Fastest, TimeError, fastest};
pub use follow::Follower;
pub use forecast::Forecast;
pub use given::Samples;
pub use law::{Progress, TimeLaw};
pub use least_reaction::LeastReaction;
pub use limits::Limits;
pub use path::{Path, PathError};
pub use price::Price;
pub use profile::Profile;
pub use table::Table;
pub use trace::{Blocked, Rule, Stop};
pub use usage::Usage;

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
    /// At rest.
    pub fn at_rest(q: DriveAngles) -> Self {
        let still = PerDrive::zeros(q.len());
        Self { q, qd: still, qdd: still }
    }
}

/// A path run through once, from rest to rest unless it is given otherwise.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    /// Where.
    pub path: Path,
    /// When.
    pub profile: Profile,
}

impl Motion {
    /// A path by a law in a time T, s.
    pub fn new(path: Path, law: TimeLaw, duration: f64) -> Self {
        Self { path, profile: Profile::of(law, duration) }
    }

    /// T, s.
    #[inline]
    pub fn duration(&self) -> f64 {
        self.profile.duration()
    }

    /// Times after the start at which q̈ jumps or bends, s, in order: no step of a simulation should pass one.
    pub fn kinks(&self) -> Vec<f64> {
        let mut all = self.profile.kinks();
        all.extend(self.path.kinks().into_iter().map(|s| self.profile.when(s)));
        all.sort_by(f64::total_cmp);
        all.dedup();
        all
    }

    /// The reference t seconds after the start; at rest before it and after T.
    #[inline]
    pub fn at(&self, t: f64) -> Reference {
        let p = self.profile.at(t);
        self.path.at(p.s).timed(&p)
    }
}
