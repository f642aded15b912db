//! Many runs: side by side, around a nominal machine, by frequency.

pub mod comparison;
pub mod spectrum;
pub mod tolerance;
