//! On a plane: a curve followed on one sheet, or why not; the nearest motion to a given one; the pointer and the
//! slider.

mod braking;
pub mod closest;
pub mod follow;
pub mod held;
pub mod nearest;
pub mod trace;

pub use follow::Follower;
pub use held::Pull;
pub use trace::{Blocked, Rule, Stop};
