//! Stillbase.
#![warn(missing_docs)]

pub mod dynamics;
pub mod kinematics;
pub mod machine;
pub mod planar;
pub mod reactionless;
pub mod scene;
