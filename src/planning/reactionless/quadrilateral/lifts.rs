//! Angles that are equal modulo whole turns.

use std::f64::consts::TAU;

use crate::reactionless::plane::AngleLimit;

/// Returns the angles within bounds that equal `angle` modulo whole turns, ascending.
pub(super) fn lifts(angle: f64, bound: AngleLimit) -> impl Iterator<Item = f64> {
    let first = ((bound.min - angle) / TAU).ceil();
    let count = ((bound.max - angle) / TAU).floor() - first + 1.0;
    // The cast turns a negative count into 0.
    (0..count as usize).map(move |i| angle + TAU * (first + i as f64))
}
