//! How far a point is from the boundary.

use super::arrangement::Portion;
use super::{Boundary, from_chord};
use crate::mechanics::planar::{Vector, unit};

/// Distances are exact to this share of the unit of the map.
const EXACT: f64 = 2e-10;
/// Halvings of a chord's portion: each brings the chord four times nearer to the curve.
const DEPTH: usize = 14;

impl Boundary {
    /// The distance of p, m, from the boundary of the workspace of b, m: positive inside, negative outside, 0 on it.
    /// Along the true curves, exact to 1e-9 of the reach. Negative infinity if p is no point.
    pub fn distance(&self, p: Vector, b: f64) -> f64 {
        if !(p.re.is_finite() && p.im.is_finite() && b.is_finite()) {
            return f64::NEG_INFINITY;
        }
        let p = p * unit(-self.on.map.turn(b));
        let mut least = f64::INFINITY;
        for (gap, slack) in self.gaps(p).map(|(_, _, gap, slack)| (gap, slack)) {
            least = least.min(gap + slack);
        }
        for (portion, ends, gap, slack) in self.gaps(p) {
            if gap - slack < least {
                self.refine(p, portion, ends, DEPTH, &mut least);
            }
        }
        if self.contains_unturned(p) { least } else { -least }
    }

    /// For each chord: its portion, its ends, its distance from p, and how far the curve may be from it.
    fn gaps(&self, p: Vector) -> impl Iterator<Item = (Portion, [Vector; 2], f64, f64)> {
        self.loops.iter().flat_map(move |l| {
            l.portions().iter().enumerate().map(move |(i, &portion)| {
                let ends = l.chord(i);
                (portion, ends, from_chord(ends, p).sqrt(), self.slack(&portion))
            })
        })
    }

    fn slack(&self, portion: &Portion) -> f64 {
        self.cycle.spans[portion.span].deviation * (portion.to - portion.from).powi(2) + 1e-15 * self.on.map.unit()
    }

    /// Branch and bound: only halves that may come nearer than what is known are looked into.
    fn refine(&self, p: Vector, portion: Portion, ends: [Vector; 2], depth: usize, least: &mut f64) {
        let (gap, slack) = (from_chord(ends, p).sqrt(), self.slack(&portion));
        if gap - slack >= *least {
            return;
        }
        if slack < EXACT * self.on.map.unit() || depth == 0 {
            *least = least.min(gap);
            return;
        }
        *least = least.min(gap + slack).min((ends[0] - p).norm()).min((ends[1] - p).norm());
        let half = 0.5 * (portion.from + portion.to);
        let middle = self.on.at(&self.cycle.spans[portion.span], half);
        let halves = [
            (Portion { to: half, ..portion }, [ends[0], middle]),
            (Portion { from: half, ..portion }, [middle, ends[1]]),
        ];
        let nearer = usize::from((ends[1] - p).norm_sqr() < (ends[0] - p).norm_sqr());
        for i in [nearer, 1 - nearer] {
            let (portion, ends) = halves[i];
            self.refine(p, portion, ends, depth - 1, least);
        }
    }
}
