//! Many runs: side by side, around a nominal machine, by frequency; and one run over time.

pub mod comparison;
pub mod samples;
pub mod series;
pub mod spectrum;
pub mod tolerance;
