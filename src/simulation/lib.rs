//! Simulation of the plant under control, step by step, with all quantities at each instant.

pub mod audit;
pub mod control;
pub mod frame;
mod peaks;
pub mod plant;
pub mod signals;
mod simulator;
pub mod totals;

pub use simulator::{Guide, Setup, Simulation};
