//! Change points as curves of the workspace, and the parts of the workspace on either side of them.

use std::ops::RangeInclusive;

use super::arrangement::SpanPart;
use super::line::BoundaryLine;
use super::region::{HalfPlane, Region, along};
use super::span::{BoundaryCurve, BoundarySpan, Surface};
use super::{Boundary, MIN_WIDTH_RAD};
use crate::reactionless::PlaneMap;
use crate::reactionless::change::{AngleDifference, CHANGE_POINT_MARGIN, DRIVE_PAIRS};

/// The change points of a pair of drives within the limits: a straight line in (a_1, a_2), a curve in the workspace.
#[derive(Clone, Debug)]
pub struct ChangeCurve {
    /// Index of the pair in [`DRIVE_PAIRS`].
    pub pair: usize,
    /// Number m of half turns: q_l − q_k = mπ.
    pub half_turns: i32,
    /// Ends (a_1, a_2), rad.
    pub ends: [[f64; 2]; 2],
    /// The curve in the workspace.
    pub line: BoundaryLine,
}

impl Boundary {
    /// Returns the part of the workspace whose poses are on given sides of change points: mπ ≤ q_l − q_k ≤ (m + 1)π for
    /// each pair of [`DRIVE_PAIRS`] with an m. `None` if there is no such pose, or only a line of them.
    ///
    /// The straight line in (a_1, a_2) between two such poses consists of such poses.
    pub fn on_sides(map: &PlaneMap, half_turns: [Option<i32>; 3]) -> Option<Self> {
        let on = Surface::of(map);
        let mut region = Region::limits(&on);
        for (pair, m) in half_turns.into_iter().enumerate() {
            let Some(m) = m else { continue };
            let difference = AngleDifference::of(map, pair);
            for sign in [1.0, -1.0] {
                let at = if sign > 0.0 { f64::from(m) } else { f64::from(m) + 1.0 };
                let half = HalfPlane {
                    n: difference.n.map(|n| sign * n),
                    level: sign * difference.level(at),
                    curve: BoundaryCurve::Change { pair },
                };
                region = region.within(&on, half);
            }
        }
        (!region.is_thin(MIN_WIDTH_RAD)).then(|| Self::over(on, &region))
    }

    /// Returns the sides of a pair's change points on which there are poses within the limits. Side m is mπ ≤ q_l − q_k
    /// ≤ (m + 1)π. Empty if there is no such pair.
    pub fn sides(&self, pair: usize) -> RangeInclusive<i32> {
        if pair >= DRIVE_PAIRS.len() {
            return RangeInclusive::new(1, 0);
        }
        let [least, most] = AngleDifference::of(&self.on.map, pair).range(self.on.map.limits());
        let half_turns = |angle: f64| (angle / std::f64::consts::PI).floor() as i32;
        let first = half_turns(least + CHANGE_POINT_MARGIN);
        first..=half_turns(most - CHANGE_POINT_MARGIN).max(first)
    }

    /// Returns all change points strictly within the limits: sin(q_k − q_l) = 0, and the linkage is flat. Limits that
    /// are such lines are not included.
    pub fn change_curves(&self) -> Vec<ChangeCurve> {
        let mut curves = Vec::new();
        for pair in 0..DRIVE_PAIRS.len() {
            let sides = self.sides(pair);
            for half_turns in sides.clone().skip(1) {
                let difference = AngleDifference::of(&self.on.map, pair);
                let Some(ends) = difference.segment(self.on.map.limits(), f64::from(half_turns)) else { continue };
                let spans: Vec<BoundarySpan> = along(&self.on, BoundaryCurve::Change { pair }, ends).collect();
                let chain: Vec<SpanPart> = (0..spans.len()).map(|span| SpanPart { span, from: 0.0, to: 1.0 }).collect();
                let line = BoundaryLine::of(&self.on, &spans, &chain);
                curves.push(ChangeCurve { pair, half_turns, ends, line });
            }
        }
        curves
    }
}
