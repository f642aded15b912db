//! Machines for other programs.

pub mod mjcf;
mod turn;
