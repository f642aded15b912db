//! Motion planning: the poses and paths that a machine can reach, and the timing of motions along them.
//!
//! Others reach this crate as `stillbase::planning`; `stillbase` alone follows semantic versioning.
//!
//! | what | modules |
//! |---|---|
//! | existence of a pose constant b = Σ λ_k q_k, described in words | [`pose_constant`] |
//! | coordinates (a, b), poses, workspace boundaries, feasible sets of b; any number of drives | [`pose_space`] |
//! | the same in closed form, for three drives with two bounded angles; used by [`pose_space`] | [`reactionless`] |
//! | geometry: curves of the end effector, paths of the drives | [`curves`] |
//! | the b that several points share, and if there is none, the point that has to move least | [`common`] |
//! | poses of several points at a b, and how the points are carried along when b changes | [`posed`] |
//! | time: time laws, limits, the fastest motion | [`timing`] |
//! | use of the redundant freedoms of four and more drives | [`posture`] |
//! | at constant b: following curves, or the reason why not; following pointer and slider | [`following`] |
//! | off the planes b = const: the cost of a change of b, the least reaction, zero momentum | [`off_plane`] |
//! | paths of the last platform of blocks that carry each other | [`platform`] |
//! | path and timing together, and a forecast of torques and reactions | [`motion`], [`forecast`] |
//!
//! Only [`pose_space`] chooses its methods by the number of drives. Callers query a pose space for a capability by
//! name, and it answers or gives the reason in words: [`planes`](pose_space::PoseSpace::planes),
//! [`follows_curves`](pose_space::PoseSpace::follows_curves),
//! [`leaves_freedoms`](pose_space::PoseSpace::leaves_freedoms).

pub mod common;
pub mod curves;
pub mod following;
pub mod forecast;
mod golden;
pub mod motion;
pub mod off_plane;
pub mod platform;
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
