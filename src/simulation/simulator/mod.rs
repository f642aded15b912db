//! The plant under control, advanced by a fixed step with the classical fourth-order Runge–Kutta method. A step has as
//! many substeps as its error requires (`stepping`), and substeps end where contacts stick or slip (`sticking`).
//!
//! The simulation reads no clock. Continuous control is evaluated in every stage, sampled control at its sampling
//! instants. The base wrench is computed from the plant's own accelerations, not from the planned motion. So a zero
//! reaction is a result, not an assumption.

mod control_loop;
mod guide;
mod simulation;
mod step_control;
mod stepping;
mod sticking;

pub use guide::{Guide, Setup};
pub use simulation::Simulation;
