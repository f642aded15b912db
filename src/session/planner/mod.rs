//! From a task to a motion: poses for its points, a path through them, and when to be where.

mod along;
mod any_drives;
mod choose;
mod given;
mod off_plane;
mod off_space;
mod plan;
mod pose;
mod posture;

pub use along::curves;
pub(super) use choose::plan;
pub use plan::Plan;
