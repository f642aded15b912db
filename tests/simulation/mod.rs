//! Tests of `src/simulation`: plants, control, the step, friction, signals and audits.

mod attitude;
mod bases;
mod contacts;
mod convergence;
mod family;
mod meaning;
mod plants;
mod signals;
