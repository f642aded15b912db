//! Many runs: side by side, around a nominal machine, by frequency; one run over time; and a machine beside another.

pub mod comparison;
pub mod front_point;
pub mod lengths;
pub mod measures;
pub mod samples;
pub mod series;
pub mod spectrum;
pub mod tolerance;
