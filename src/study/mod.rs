//! Many runs: side by side, around a nominal machine, by frequency; one run over time; a machine beside another; a
//! motion from elsewhere, and the nearest one without reactions; the equations of the paper with today's numbers in them;
//! and a machine that is built, from what its base felt.

pub mod comparison;
pub mod equations;
pub mod front_point;
pub mod import;
pub mod lengths;
pub mod measures;
pub mod plan_summary;
pub mod samples;
pub mod series;
pub mod spectrum;
pub mod tolerance;
pub mod trim;
