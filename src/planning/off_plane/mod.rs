//! Motions off the planes: the moment that a change of b costs, least reactions, drift at zero momentum, two drives.

pub mod b_course;
#[doc(hidden)]
pub mod b_integral;
mod b_program;
pub mod corridor;
pub mod drift;
#[doc(hidden)]
pub mod inverse;
pub mod least_reaction;
#[doc(hidden)]
pub mod momentum;
#[doc(hidden)]
pub mod null_space;
pub mod price;

pub use corridor::Corridor;
pub use least_reaction::LeastReaction;
pub use price::Price;
