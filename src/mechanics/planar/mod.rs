//! Plane algebra: complex vectors, small per-drive vectors, wrenches, poses.
//!
//! A vector (x, y) of the plane of motion is the complex number x + iy, in base axes, with B as origin.

mod circle;
mod drives;
mod sincos;
mod vector;

pub use circle::{circle, equal_area};
pub use drives::{DriveAngles, MAX_DRIVES, PerDrive, UnitVectors, with_ground};
pub use sincos::unit;
pub use vector::{Pose2, Vector, Wrench, cross, dot, length};
