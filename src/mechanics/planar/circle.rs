//! Circles as polygons with the area of the circle.

use std::f64::consts::TAU;

use super::sincos::unit;
use super::vector::Vector;

/// Returns the ratio of the radius of a polygon of so many sides, at least three, to that of the circle with its area.
pub fn equal_area(sides: usize) -> f64 {
    let step = TAU / sides as f64;
    (step / step.sin()).sqrt()
}

/// Returns a circle as a polygon of so many sides, at least three, counter-clockwise from its right, m. The area of the
/// polygon is that of the circle.
pub fn circle(centre: Vector, radius: f64, sides: usize) -> Vec<Vector> {
    let radius = radius * equal_area(sides);
    (0..sides).map(|i| centre + unit(TAU * i as f64 / sides as f64) * radius).collect()
}
