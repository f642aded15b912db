//! Poses of machines with any number of drives by their pose constant: which b reach a point, with which poses, how far
//! the reactionless workspace goes, and where a hand leads the machine in it.
//!
//! The set of poses of a b has n − 1 freedoms: with two drives it is a curve of the end effector, with four and more every
//! point of the workspace leaves n − 3 freedoms. Three drives with limits of both relative angles have planes, and
//! everything about them in closed form in [`reactionless`](super::reactionless): a [`PoseSpace`] answers by these where
//! it has them. [`PoseSpace::general`] leaves them out, so that tests can compare both ways.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | c_k | the end effector is p = Σ_k c_k e^{i q_k} | m |
//! | λ_k | b = Σ_k λ_k q_k, (13) | 1 |
//! | a_i | relative joint angles q_to − q_from + offset, n − 1 of them, that join all drives | rad |
//! | L, Λ, δ | a *compound*: drives whose relative angles are at their limits turn as one, L = Σ c_k e^{iδ_k}, Λ = Σ λ_k | m, 1, rad |
//! | ν | where b is stationary at a fixed point: |L| sin α = ν Λ for every compound, α = its angle to the direction of that condition | m |
//!
//! # Method
//! b of a point can end only where it is stationary within what limits leave free, so each set of limits that are
//! active, and each sign of every cos α, gives one scalar equation in ν: (Σ ±√(L² − ν²Λ²))² + (ν ΣΛ)² = |p|². All
//! such values of b are found in closed form; beside each, first and second derivatives say whether b goes on from
//! there upwards, downwards, both or neither. Poses at a b are continued from the critical poses above and below it.

mod boxed;
mod continuation;
mod covered;
mod critical;
mod facing;
mod hand;
mod in_reach;
mod joint;
mod lacking;
mod looks;
mod loops;
mod nearest;
mod outline;
mod pattern;
mod planes;
mod poses;
mod reach;
mod rings;
mod space;
mod toward;

pub use in_reach::Reach;
pub use joint::Joint;
pub use lacking::{NoPoseSpace, OwnWay};
pub(crate) use lacking::{held, is_reactionless};
pub use outline::Outline;
pub use planes::{PlaneError, Planes, plane_area, plane_map};
pub use space::{Lead, PoseSpace};
