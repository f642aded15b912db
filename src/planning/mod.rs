//! Where a machine may go, and when.
//!
//! | what | modules |
//! |---|---|
//! | whether a machine has a pose constant b = Σ λ_k q_k, in words | [`pose_constant`] |
//! | coordinates (a, b), poses, boundaries, which b reach a point, for any number of drives | [`pose_space`] |
//! | the same of three drives with two bounded angles in closed form: the kernel of such a pose space | [`reactionless`] |
//! | where: curves of the end effector, paths of the drives | [`curves`] |
//! | which b serve several points, and which point has to move least where none does | [`common`] |
//! | poses of several points at a b, and where the points go as b does | [`posed`] |
//! | when: laws, limits, the fastest | [`timing`] |
//! | what becomes of the freedoms that four drives and more have left | [`posture`] |
//! | with b held: curves followed, or why not; the pointer and the slider | [`following`] |
//! | off the planes: what a change of b costs, the least reaction, zero momentum | [`off_plane`] |
//! | where and when together, and what they will cost | [`motion`], [`forecast`] |
//!
//! Nothing outside of [`pose_space`] asks how many drives there are to choose its way. What a machine lacks is asked of its
//! pose space by name, and answered with the reason in words: [`planes`](pose_space::PoseSpace::planes),
//! [`follows_curves`](pose_space::PoseSpace::follows_curves),
//! [`leaves_freedoms`](pose_space::PoseSpace::leaves_freedoms).

pub mod common;
pub mod curves;
pub mod following;
pub mod forecast;
mod golden;
pub mod motion;
pub mod off_plane;
pub mod pose_constant;
pub mod pose_space;
pub mod posed;
pub mod posture;
pub mod reactionless;
mod reference;
pub mod timing;
mod unreachable;

pub use forecast::Forecast;
pub use motion::Motion;
pub use reference::Reference;
