//! What becomes of the freedoms that a point leaves to four drives and more while b is held.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | q′ | dq/ds, s the share of the whole way | rad |
//! | T | motor torques are T q̈ from rest: A⁻ᵀ H | kg m² |
//! | x_i | relative angle a_i as a share of its range, −1 and 1 at its limits; 0 where it has none | 1 |
//!
//! # Method
//! The freedoms are found along the whole path at once. Poses are spread over the set of poses of (p, b) at stations along
//! the path (`layers`); the cheapest way from one to the next (`route`) is refined until it is the best beside it
//! (`refine`): least ∫ |q′|² ds, least ∫ |T q̈|² dt by the time law, or least ∫ ½ Σ x_i² ds (`goal`). Each of these begins at
//! the results of all others as well, and of all paths that were found the one with the least goal is taken. Where a way
//! exists, the layers find it but for passages narrower than their poses are apart.

mod emit;
mod envelope;
mod goal;
mod hand;
mod layers;
mod led;
mod refine;
mod route;
mod rows;
mod search;
mod stations;

pub use hand::Postures;
pub use led::Led;
pub use search::{Asked, Found, NoWay};

use crate::settings::word::words;

words! {
    /// How the freedoms that a point leaves are used.
    pub enum Posture {
        /// Searched for: least ∫ |q′|² ds.
        LeastRates = "least-rates", "Drives turn least", "The drives turn as little as they can";
        Orientation = "orientation", "Keep the hand's orientation", "The last link does not turn";
        /// Least ∫ τ² dt.
        LeastTorque = "least-torque", "Least motor torque", "What the motors need to set the motion up is least";
        /// Least ∫ ½ Σ x_i² ds.
        MidRange = "mid-range", "Far from limits", "Joints stay as near to the middle of their ranges as can be";
    }
}
