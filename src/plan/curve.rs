//! Curves of the end effector in the plane: p(s) for s from 0 to 1, with exact derivatives.

use crate::planar::Vector;

/// A place on a curve and how it changes with s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvePoint {
    /// p, m.
    pub p: Vector,
    /// dp/ds, m.
    pub first: Vector,
    /// d²p/ds², m.
    pub second: Vector,
}
