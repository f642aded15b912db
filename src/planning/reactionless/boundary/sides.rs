//! Change points as curves of the workspace, and the parts of the workspace on either side of them.

use std::ops::RangeInclusive;

use super::arrangement::Portion;
use super::line::BoundaryLine;
use super::region::{HalfPlane, Region, along};
use super::span::{BoundaryCurve, Span, Surface};
use super::{Boundary, THIN};
use crate::planning::reactionless::PlaneMap;
use crate::planning::reactionless::change::{Difference, PAIRS, TOUCH};

/// Change points of a pair of drives within the limits: a straight line in (a_1, a_2), a curve in the workspace.
#[derive(Clone, Debug)]
pub struct ChangeCurve {
    /// Which of [`PAIRS`].
    pub pair: usize,
    /// m, where q_l − q_k = mπ.
    pub half_turns: i32,
    /// (a_1, a_2) at its ends, rad.
    pub ends: [[f64; 2]; 2],
    /// The curve.
    pub line: BoundaryLine,
}

impl Boundary {
    /// The part of the workspace that poses on given sides of change points reach: those with
    /// mπ ≤ q_l − q_k ≤ (m + 1)π for each pair of [`PAIRS`] that has an m. `None` if no pose, or only a line of them,
    /// is there.
    ///
    /// A straight line in (a_1, a_2) between two such poses stays there.
    pub fn on_sides(map: &PlaneMap, half_turns: [Option<i32>; 3]) -> Option<Self> {
        let on = Surface::of(map);
        let mut region = Region::limits(&on);
        for (pair, m) in half_turns.into_iter().enumerate() {
            let Some(m) = m else { continue };
            let difference = Difference::of(map, pair);
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
        (!region.is_thin(THIN)).then(|| Self::over(on, &region))
    }

    /// The sides of the change points of a pair that poses within the limits are on: m for mπ ≤ q_l − q_k ≤ (m + 1)π.
    /// Empty if there is no such pair.
    pub fn sides(&self, pair: usize) -> RangeInclusive<i32> {
        if pair >= PAIRS.len() {
            return RangeInclusive::new(1, 0);
        }
        let [least, most] = Difference::of(&self.on.map, pair).range(self.on.map.limits());
        let half_turns = |angle: f64| (angle / std::f64::consts::PI).floor() as i32;
        let first = half_turns(least + TOUCH);
        first..=half_turns(most - TOUCH).max(first)
    }

    /// All change points between the limits: where sin(q_k − q_l) = 0 the linkage goes flat. Edges of the limits that
    /// are such lines are not listed.
    pub fn change_curves(&self) -> Vec<ChangeCurve> {
        let mut curves = Vec::new();
        for pair in 0..PAIRS.len() {
            let sides = self.sides(pair);
            for half_turns in sides.clone().skip(1) {
                let difference = Difference::of(&self.on.map, pair);
                let Some(ends) = difference.segment(self.on.map.limits(), f64::from(half_turns)) else { continue };
                let spans: Vec<Span> = along(&self.on, BoundaryCurve::Change { pair }, ends).collect();
                let chain: Vec<Portion> = (0..spans.len()).map(|span| Portion { span, from: 0.0, to: 1.0 }).collect();
                let line = BoundaryLine::of(&self.on, &spans, &chain);
                curves.push(ChangeCurve { pair, half_turns, ends, line });
            }
        }
        curves
    }
}
