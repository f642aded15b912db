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
    /// How a link is held.
    pub grip: Option<Grip>,
}

/// How a link is held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grip {
    /// From the link's direction to the pointer about its root, rad.
    pub angle: f64,
    /// (a_1, a_2) when it was taken hold of, rad.
    pub from: [f64; 2],
}

impl Pick {
    /// Anything but a link.
    pub fn of(handle: Handle, at: [f64; 3]) -> Self {
        Self { handle, at, grip: None }
    }
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
    /// The relative joint angles (a_1, a_2), rad.
    Angles([f64; 2]),
    /// A force at the end effector, N.
    Push([f64; 2]),
}
