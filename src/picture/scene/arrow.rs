//! Arrow heads.

use super::point;
use stillbase_mechanics::planar::{Vector, unit};

/// Returns the polyline of an arrow head with its tip at `at`. `along` is the unit vector of its direction, `size` the
/// length of its sides and `z` its height, m.
pub fn head(at: Vector, along: Vector, size: f64, z: f64) -> Vec<[f32; 3]> {
    let barb = |turn: f64| at - along * unit(turn) * size;
    vec![point(barb(0.5), z), point(at, z), point(barb(-0.5), z)]
}
