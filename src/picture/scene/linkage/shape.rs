//! [`Shape`]: what is drawn of a link, in the axes of the link.

use super::cover::Cover;
use crate::scene::Mesh;

/// What is drawn of a link. Its mesh begins at the height of the lower face of its bar.
pub struct Shape {
    pub mesh: Mesh,
    /// Interval along the link in which it is drawn, m.
    pub span: [f64; 2],
    /// Half the width of its bar, m; 0 if it is made of plates alone.
    pub radius: f64,
    /// Height of its bar from the lower to the upper face, m.
    pub height: f64,
    /// Height of the middle of its bar above that of the link, m.
    pub rise: f64,
    /// What it carries, and its plates.
    pub covers: Vec<Cover>,
}
