//! [`SketchRefusal`]: why a step of a drawing is refused, where, and what would do.

use thiserror::Error;

use super::drawing::Place;
use super::step::SketchStep;

/// What the machines of this program are, for refusals of loops.
pub(super) const FAMILY: &str = "every bar parallel to the arm of one drive, so that loops are parallelograms";

/// Reason why a step of a drawing is refused; the drawing is then as before.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{what}: want {want}")]
pub struct SketchRefusal {
    /// What is wrong.
    pub what: String,
    /// The part of the drawing where it is.
    pub place: Place,
    /// What would be right.
    pub want: String,
    /// Steps that would do instead.
    pub proposals: Vec<SketchStep>,
}

impl SketchRefusal {
    pub(super) fn new(place: Place, what: impl Into<String>, want: impl Into<String>) -> Self {
        Self { what: what.into(), place, want: want.into(), proposals: Vec::new() }
    }

    pub(super) fn or(self, proposals: impl IntoIterator<Item = SketchStep>) -> Self {
        Self { proposals: proposals.into_iter().collect(), ..self }
    }
}
