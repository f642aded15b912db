//! The plant under control, advanced by a fixed step with the classical fourth-order rule; within a step by as many
//! parts as it takes (`stride`), cut where contacts stick or slip (`sticking`).
//!
//! The simulation reads no clock. Control is evaluated in every stage. The base wrench is taken from the plant's own
//! accelerations, never from the planned motion, so that a zero is found and not assumed.

mod guide;
mod pace;
mod pilot;
mod simulation;
mod sticking;
mod stride;

pub use guide::{Guide, Setup};
pub use simulation::Simulation;
