//! Paths of the last platform of blocks that carry each other, while each block holds its b.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | p | place of the platform in axes of the base | m |
//! | a | relative angles of all blocks of the chain, the block on the base first | rad |
//! | J | ∂p/∂a | m |
//! | W | metric of the rates: Σ q̇_k² = ȧᵀ W ȧ over all drives | 1 |
//! | m, h | middles and half widths of the ranges of a | rad |
//!
//! Each block adds the place of its end effector in its plane: p = Σ_i (o_i + x_i Re r_i + y_i Im r_i). So J and the second
//! derivatives are those of the planes, and every solution holds every b exactly.

mod chain;
mod choice;
mod course;
mod pose;

pub use chain::{ChainBlock, PlatformChain};
pub use choice::FreedomChoice;
pub use course::{StopReason, Stopped, follow};
pub use pose::{NearestPlace, pose_at};
