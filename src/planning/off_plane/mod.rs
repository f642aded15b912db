//! Motions off the planes: the moment that a change of b costs, least reactions, drift at zero momentum, two drives.

pub mod b_course;
#[doc(hidden)]
pub mod b_integral;
mod b_program;
pub mod base_forecast;
pub mod corridor;
pub mod drift;
mod flow;
#[doc(hidden)]
pub mod inverse;
#[doc(hidden)]
pub mod least_momentum;
pub mod least_reaction;
mod loop_spline;
#[doc(hidden)]
pub mod momentum;
#[doc(hidden)]
pub mod null_space;
pub mod price;
#[doc(hidden)]
pub mod rays;
#[doc(hidden)]
pub mod turning_loop;

pub use corridor::Corridor;
pub use least_reaction::LeastReaction;
pub use price::Price;
