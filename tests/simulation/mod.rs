//! What then happens.

mod bases;
mod contacts;
mod convergence;
mod meaning;
mod plants;
mod signals;
