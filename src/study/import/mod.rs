//! Motions given by samples: what such a motion does to the base, and the nearest one that does nothing.
//!
//! A quintic spline goes through every sample. What is proposed keeps the timing and holds b: with the end effector where
//! it was if that is possible, else with the arm turned as a whole. It is simulated before it is called reactionless.
//!
//! | what | type |
//! |---|---|
//! | samples with angles within the joint limits, smoothed or not | [`GivenMotion`] |
//! | what is asked | [`Request`] |
//! | the query | [`Importing`] |
//! | what it comes to | [`Imported`], of [`Account`] and [`Proposal`]; [`Advice`](super::advice::Advice) in words |

mod drives;
mod freedoms;
mod given;
mod imported;
mod importing;
mod judge;
mod lines;
mod plane;
mod request;
mod tip;
mod ways;

pub use given::GivenMotion;
pub use imported::Imported;
pub use importing::Importing;
pub use judge::{Account, Proposal};
pub use lines::Line;
pub use request::{ImportError, Keep, Request};
