//! With b held: a curve followed on one sheet of a plane, or why not; the nearest motion to a given one; the pointer and
//! the slider.

mod braking;
mod closest;
mod deviation;
pub mod follow;
pub mod held;
pub mod nearest;
mod on_plane;
pub mod trace;

pub use follow::Follower;
pub use held::Pull;
pub use trace::{Blocked, Rule, Stop};
