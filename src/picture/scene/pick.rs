//! What the pointer has taken hold of, and what pulling at it asks for.

use super::options::Handle;

/// How near to a handle the pointer takes hold of it, px.
pub const NEAR: f64 = 20.0;

/// What the pointer has taken hold of, and where.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pick {
    /// What is held.
    pub handle: Handle,
    /// In the scene.
    pub at: [f64; 3],
}

/// What pulling at it asks of the session.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Aim {
    /// The end effector at a point, m.
    Target([f64; 2]),
    /// The pose constant, rad.
    B(f64),
    /// A point of the path, counted from A, at a place, m.
    Waypoint(usize, [f64; 2]),
    /// A force at the end effector, N.
    Push([f64; 2]),
}
