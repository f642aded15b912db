//! Vectors of the plane, and what is made of them.

use nalgebra::Complex;
use serde::{Deserialize, Serialize};

/// A vector of the plane, x + iy.
pub type Vector = Complex<f64>;

/// a × b, the component out of the plane.
pub fn cross(a: Vector, b: Vector) -> f64 {
    a.re * b.im - a.im * b.re
}

/// a · b.
pub fn dot(a: Vector, b: Vector) -> f64 {
    a.re * b.re + a.im * b.im
}

/// |v|, by squares: a third of the time of a length that no square can overflow.
#[inline]
pub fn length(v: Vector) -> f64 {
    v.norm_sqr().sqrt()
}

/// A force at B and a moment about B.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Wrench {
    /// N.
    pub force: Vector,
    /// N m, out of the plane.
    pub moment: f64,
}

/// Where a body is and how it is turned.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Pose2 {
    /// m.
    pub at: Vector,
    /// rad.
    pub angle: f64,
}
