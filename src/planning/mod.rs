//! Where a machine may go, and when: reactionless planes and workspaces, curves, timing, ways off the plane, following.

pub mod plan;
pub mod pose_constant;
pub mod reactionless;
