//! Studies built on runs and machines. Runs side by side, around a nominal machine, and by frequency; signals and joint
//! loads of one run. Cost of a plan, contents of a workspace, counterweights, and Pareto fronts of several machines.
//! Imported motions and the nearest ones without reactions; the equations of the paper with present values; and the
//! trim of a built machine from measured base forces.
//!
//! Others reach this crate as `stillbase::study`; `stillbase` alone follows semantic versioning.

pub mod advice;
pub mod balance_constants;
pub mod base_spectrum;
pub mod centres;
#[doc(hidden)]
pub mod comparison;
pub mod counterweights;
#[doc(hidden)]
pub mod equations;
pub mod front_point;
pub mod fronts;
pub mod import;
pub mod joint_extremes;
pub mod lengths;
pub mod measures;
pub mod plan_summary;
pub mod pose_measures;
#[doc(hidden)]
pub mod samples;
#[doc(hidden)]
pub mod series;
pub mod spectrum;
pub mod tolerance;
pub mod trim;
pub mod workspace;
