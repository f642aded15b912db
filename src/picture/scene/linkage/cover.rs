//! [`Cover`]: the area that a counterweight, an arm, a plate or a lump of a link covers.

use super::flat::FlatCover;
use stillbase_mechanics::planar::Vector;

/// The area that something on a link covers, in the axes of the link, and its heights.
#[derive(Clone, Debug)]
pub struct Cover {
    /// Position of its middle along the link, and to the left of its axis, m.
    pub at: Vector,
    /// Ends of a segment about which it lies, m; equal for a round one.
    pub ends: [Vector; 2],
    /// Distance from the segment within which it lies, m: the radius of a round one.
    pub radius: f64,
    /// Its area as convex polygons, m; empty if it is all that lies within the radius.
    pub areas: Vec<Vec<Vector>>,
    /// Height of its lower face above that of the link, m; negative if it reaches below.
    pub z: f64,
    /// Height from its lower to its upper face, m.
    pub height: f64,
}

impl Cover {
    /// Returns it seen from above, on a link with its root at a point, m, in a direction.
    pub fn flat(&self, root: Vector, along: Vector) -> FlatCover {
        let placed = |p: Vector| root + along * p;
        let area = |corners: &Vec<Vector>| corners.iter().map(|corner| placed(*corner)).collect();
        FlatCover { ends: self.ends.map(placed), radius: self.radius, areas: self.areas.iter().map(area).collect() }
    }
}
