//! Tests of `src/study`: runs side by side, samples, tolerances and spectra.

mod comparison;
mod counterweights;
mod design_space;
mod difference;
mod doubt;
mod equations;
mod fronts;
mod import;
mod joint_extremes;
mod layers;
mod lengths;
mod orbit;
mod plan_summary;
mod samples;
mod series;
mod spectrum;
mod summary;
mod tolerance;
mod trim;
mod workshop;
mod workspace;
