//! Tests of `src/planning`: planes and workspaces, curves, timing, ways off the plane.

mod boundary;
pub mod change_points;
mod common;
mod curve;
mod floating;
mod given;
mod least_reaction;
mod led;
mod null_space;
mod off_space;
mod outline;
mod pose_ends;
mod pose_space;
mod posture;
mod posture_laws;
mod price;
mod proposals;
mod rays;
mod reach;
mod sizes;
mod tasks;
mod timing;
mod trace;
mod turning_loop;
mod windings;
