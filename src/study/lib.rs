//! Studies built on runs and machines: comparisons of runs, tolerances around a nominal machine, spectra, signals, and
//! joint loads. Plans: their cost, the contents of a workspace, and imported motions with the nearest reactionless
//! ones. Machines: counterweights, Pareto fronts, the equations of the paper with present values, and the trim of a
//! built machine from measured base forces.
//!
//! Others reach this crate as `stillbase::study`; `stillbase` alone follows semantic versioning.

pub mod advice;
pub mod assembly_check;
pub mod assembly_weights;
pub mod balance_constants;
pub mod base_spectrum;
pub mod centres;
#[doc(hidden)]
pub mod comparison;
pub mod counterweights;
pub mod design_space;
pub mod difference;
#[doc(hidden)]
pub mod equations;
pub mod front_point;
pub mod fronts;
pub mod import;
pub mod joint_extremes;
pub mod layers;
pub mod lengths;
pub mod measures;
pub mod parts;
pub mod plan_summary;
pub mod pose_curves;
pub mod pose_measures;
#[doc(hidden)]
pub mod samples;
#[doc(hidden)]
pub mod series;
pub mod spectrum;
pub mod tolerance;
pub mod trim;
pub mod turn_map;
pub mod workshop;
pub mod workspace;
