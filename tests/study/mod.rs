//! Many runs.

mod comparison;
mod spectrum;
mod tolerance;
