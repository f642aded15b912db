//! Stillbase.
#![warn(missing_docs)]

pub mod balance;
pub mod control;
pub mod dynamics;
pub mod files;
pub mod frame;
#[cfg(feature = "record")]
pub mod headless;
pub mod kinematics;
pub mod machine;
pub mod plan;
pub mod planar;
pub mod pose_constant;
pub mod reactionless;
pub mod scenario;
#[cfg(feature = "render")]
pub mod render;
pub mod scene;
pub mod session;
pub mod signals;
pub mod simulation;
#[cfg(feature = "ui")]
pub mod ui;
#[cfg(feature = "window")]
pub mod window;
