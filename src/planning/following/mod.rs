//! Motions with b constant: following a curve on one sheet of a plane, and the motion nearest to a given one.
//! Following the pointer also keeps b; following the slider changes it.

mod braking;
mod closest;
mod deviation;
pub mod follow;
#[doc(hidden)]
pub mod held;
mod momentum_follower;
pub mod nearest;
mod on_plane;
pub mod trace;

pub use follow::Follower;
pub use held::Pull;
pub use momentum_follower::{Barrier, MomentumFollower};
pub use trace::{Blocked, Rule, SheetEnd};
