//! Motions given by samples: the reactions of such a motion, and the nearest motion without reactions.
//!
//! A quintic spline interpolates all samples. The proposal has the same timing and a constant b. It keeps the motion of
//! the end effector if possible; otherwise the arm is turned as a whole. It counts as reactionless only if a simulation
//! confirms this. A machine without b moves its end effector without angular momentum, which leaves a force.
//!
//! | what | type |
//! |---|---|
//! | samples with angles within the joint limits, smoothed or not | [`GivenMotion`] |
//! | the request | [`Request`] |
//! | the query | [`ImportQuery`] |
//! | the result | [`ImportedMotion`], with [`MotionEffects`] and [`Proposal`]; [`Advice`](super::advice::Advice) in words |

mod drives;
mod freedoms;
mod given;
mod imported;
mod importing;
mod judge;
mod lines;
mod momentum;
mod plane;
mod request;
mod tip;
mod ways;

pub use given::GivenMotion;
pub use imported::ImportedMotion;
pub use importing::ImportQuery;
pub use judge::{MotionEffects, Proposal};
pub use lines::ComparedNumber;
pub use request::{MotionImportError, PreservedPath, Request};
