//! Many runs: side by side, around a nominal machine, by frequency; one run over time, and what its joints carry; what a
//! plan costs, a workspace holds and counterweights come to; a machine, and its front, beside another; a motion from
//! elsewhere, and the nearest one without reactions; the equations of the paper with today's numbers in them; and a
//! machine that is built, from what its base felt.

pub mod advice;
pub mod balance_constants;
pub mod base_spectrum;
pub mod centres;
pub mod comparison;
pub mod counterweights;
pub mod equations;
pub mod front_point;
pub mod fronts;
pub mod import;
pub mod joint_extremes;
pub mod lengths;
pub mod measures;
pub mod plan_summary;
pub mod pose_measures;
pub mod samples;
pub mod series;
pub mod spectrum;
pub mod tolerance;
pub mod trim;
pub mod workspace;
