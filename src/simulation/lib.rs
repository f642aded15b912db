//! Simulation of the plant under control, step by step, with all quantities at each instant.
//!
//! Others reach this crate as `stillbase::simulation`; `stillbase` alone follows semantic versioning.

pub mod audit;
pub mod control;
pub mod frame;
mod peaks;
pub mod plant;
pub mod signal_table;
pub mod signals;
mod simulator;
pub mod totals;

pub use simulator::{Guide, Setup, Simulation};
