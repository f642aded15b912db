//! Arrow heads.

use super::point;
use crate::mechanics::planar::{Vector, unit};

/// The two barbs of an arrow head at a point, along a unit vector.
pub fn head(at: Vector, along: Vector, size: f64, z: f64) -> Vec<[f32; 3]> {
    let barb = |turn: f64| at - along * unit(turn) * size;
    vec![point(barb(0.5), z), point(at, z), point(barb(-0.5), z)]
}
