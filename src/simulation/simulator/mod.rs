//! The plant under control, advanced by a fixed step with classical fourth-order Runge–Kutta; within a step by as many
//! substeps as it takes (`stepping`), cut where contacts stick or slip (`sticking`).
//!
//! The simulation reads no clock. Control is evaluated in every stage. The base wrench is taken from the plant's own
//! accelerations, never from the planned motion, so that a zero is found and not assumed.

mod control_loop;
mod guide;
mod simulation;
mod step_control;
mod stepping;
mod sticking;

pub use guide::{Guide, Setup};
pub use simulation::Simulation;
