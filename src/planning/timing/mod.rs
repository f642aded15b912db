//! Timing: time laws, limits of the drives, the fastest motion along a path.

pub mod fastest;
mod jerk;
mod keep;
pub mod law;
pub mod limits;
mod outcome;
pub mod profile;
mod s_curve;
mod smooth;
mod topp;
pub mod usage;
mod within;

pub use fastest::fastest;
pub use law::{PathProgress, TimeLaw};
pub use limits::{ConstraintRow, DriveLimits, LimitsOnPath};
pub use outcome::{FastestMotion, TimeError};
pub use profile::Profile;
pub use s_curve::s_curve;
pub use usage::Usage;
pub use within::fastest_within;
