//! Where it may go, and when.

mod boundary;
pub mod change_points;
mod curve;
mod given;
mod least_reaction;
mod null_space;
mod price;
mod proposals;
mod reach;
mod sizes;
mod tasks;
mod timing;
mod trace;
mod windings;
