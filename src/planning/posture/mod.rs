//! Use of the redundant freedoms of machines with four and more drives at a given point and b.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | q′ | dq/ds, s the fraction of the whole path length | rad |
//! | T | A⁻ᵀ H, A of [`Motors`](stillbase_mechanics::machine::Motors); T q̈ is the torque for q̇ = 0, g = 0 | kg m² |
//! | x_i | relative angle a_i scaled to −1 and 1 at its limits; 0 if it has none | 1 |
//!
//! # Method
//! The search optimises the whole path at once. It samples the set of poses of (p, b) at stations along the path
//! (`layers`). It finds the cheapest route through the samples (`route`), and refines it to a local optimum (`refine`).
//! The objective is ∫ |q′|² ds, ∫ |T q̈|² dt by the time law, or ∫ ½ Σ x_i² ds (`goal`). Each objective also starts
//! from the results of the others, and the path with the least objective is taken. It is a local optimum, the least one
//! found from these starts: a path far from all of them may need less. The layers find an existing path unless it has a
//! passage narrower than the spacing of the samples.

mod emit;
mod envelope;
mod goal;
mod guided_space;
mod layers;
mod refine;
mod route;
mod rows;
mod search;
mod stations;
mod weights;

pub use guided_space::GuidedSpace;
pub use search::{NoPosturePath, PosturePaths, PostureRequest};
pub use weights::PostureWeights;

use stillbase_settings::word::words;

words! {
    /// Use of the redundant freedoms at a given point and b.
    pub enum Posture {
        /// Least ∫ |q′|² ds.
        LeastRates = "least-rates", "Drives turn least", "The drives turn as little as they can";
        Orientation = "orientation", "Keep the hand's orientation", "The last link does not turn";
        /// Least ∫ |T q̈|² dt.
        LeastTorque = "least-torque", "Least motor torque", "The motors need least torque to accelerate the machine";
        /// Least ∫ ½ Σ x_i² ds.
        MidRange = "mid-range", "Far from limits", "Joints stay as near to the middle of their ranges as can be";
    }
}
