//! What then happens: the plant under control, step by step, and everything that is true at each instant.

pub mod audit;
pub mod control;
pub mod frame;
mod peaks;
pub mod plant;
pub mod signals;
mod simulator;
pub mod totals;

pub use simulator::{Guide, Setup, Simulation};
