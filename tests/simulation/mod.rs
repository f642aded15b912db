//! What then happens.

mod bases;
mod contacts;
mod convergence;
mod plants;
mod signals;
