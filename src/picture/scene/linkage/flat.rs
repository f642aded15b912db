//! [`FlatLink`]: a link seen from straight above.

use stillbase_mechanics::planar::Vector;

/// A link seen from straight above.
pub struct FlatLink {
    /// Its name.
    pub name: String,
    /// Its drawn ends, m.
    pub ends: [Vector; 2],
    /// Half the width of its bar, m; 0 if it is made of plates alone.
    pub radius: f64,
    /// What it carries, and its plates.
    pub covers: Vec<FlatCover>,
    /// Index of the drive that it follows, from 0.
    pub drive: usize,
}

/// A counterweight, an arm, a plate or a lump seen from straight above.
pub struct FlatCover {
    /// Ends of a segment about which it lies, m; equal for a round one.
    pub ends: [Vector; 2],
    /// Distance from the segment within which it lies, m: the radius of a round one.
    pub radius: f64,
    /// Its area as convex polygons, m; empty if it is all that lies within the radius.
    pub areas: Vec<Vec<Vector>>,
}
