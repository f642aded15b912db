//! Where a machine may go, and when.
//!
//! | what | modules |
//! |---|---|
//! | planes q₁ + λ₂ q₂ + λ₃ q₃ = b, poses, boundaries, which b reach a point | [`reactionless`], [`pose_constant`] |
//! | where: curves of the end effector, paths of the drives | [`curves`] |
//! | which b serve several points, and which point has to move least where none does | [`common`] |
//! | when: laws, limits, the fastest | [`timing`] |
//! | what becomes of the freedoms that four drives and more have left | [`posture`] |
//! | on a plane: curves followed, or why not | [`following`] |
//! | off the planes: what a change of b costs, the least reaction, zero momentum | [`off_plane`] |
//! | where and when together, and what they will cost | [`motion`], [`forecast`] |

pub mod common;
pub mod curves;
pub mod following;
pub mod forecast;
mod golden;
pub mod motion;
pub mod off_plane;
pub mod pose_constant;
pub mod pose_map;
pub mod pose_space;
pub mod posture;
pub mod reactionless;
mod reference;
pub mod timing;
mod unreachable;

pub use forecast::Forecast;
pub use motion::Motion;
pub use reference::Reference;
