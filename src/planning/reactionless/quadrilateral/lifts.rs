//! Angles that differ by whole turns.

use std::f64::consts::TAU;

use crate::planning::reactionless::plane::AngleLimit;

/// The angles between two bounds that are `angle` give or take whole turns.
pub(super) fn lifts(angle: f64, bound: AngleLimit) -> impl Iterator<Item = f64> {
    let first = ((bound.min - angle) / TAU).ceil();
    let count = ((bound.max - angle) / TAU).floor() - first + 1.0;
    // As a cast: a negative count is none.
    (0..count as usize).map(move |i| angle + TAU * (first + i as f64))
}
