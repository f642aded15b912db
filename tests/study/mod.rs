//! Tests of `src/study`: runs side by side, tolerances and spectra.

mod comparison;
mod spectrum;
mod tolerance;
