//! Distance of a point from the boundary.

use super::arrangement::SpanPart;
use super::{Boundary, from_chord};
use stillbase_mechanics::planar::{Vector, unit};

/// Tolerance of distances, as a fraction of the unit of the map.
const DISTANCE_TOLERANCE: f64 = 2e-10;
/// Maximum number of bisections of a chord's portion; each reduces the chord's deviation to a quarter.
const MAX_DEPTH: usize = 14;

impl Boundary {
    /// Returns the distance, m, of p from the boundary of the workspace of b, rad: above 0 inside, below outside, 0
    /// on it. It refers to the exact curves, with an error below 1e-9 of the reach. Returns −∞ if p or b is not finite.
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
                self.refine(p, portion, ends, MAX_DEPTH, &mut least);
            }
        }
        if self.contains_unturned(p) { least } else { -least }
    }

    /// Returns for each chord its portion, its ends, its distance from p, and the maximum deviation of the curve from
    /// it, m.
    fn gaps(&self, p: Vector) -> impl Iterator<Item = (SpanPart, [Vector; 2], f64, f64)> {
        self.loops.iter().flat_map(move |l| {
            l.portions().iter().enumerate().map(move |(i, &portion)| {
                let ends = l.chord(i);
                (portion, ends, from_chord(ends, p).sqrt(), self.slack(&portion))
            })
        })
    }

    fn slack(&self, portion: &SpanPart) -> f64 {
        self.cycle.spans[portion.span].deviation * (portion.to - portion.from).powi(2) + 1e-15 * self.on.map.unit()
    }

    /// Branch and bound: only halves that may be nearer than the known distance are refined.
    fn refine(&self, p: Vector, portion: SpanPart, ends: [Vector; 2], depth: usize, least: &mut f64) {
        let (gap, slack) = (from_chord(ends, p).sqrt(), self.slack(&portion));
        if gap - slack >= *least {
            return;
        }
        if slack < DISTANCE_TOLERANCE * self.on.map.unit() || depth == 0 {
            *least = least.min(gap);
            return;
        }
        *least = least.min(gap + slack).min((ends[0] - p).norm()).min((ends[1] - p).norm());
        let half = 0.5 * (portion.from + portion.to);
        let middle = self.on.at(&self.cycle.spans[portion.span], half);
        let halves = [
            (SpanPart { to: half, ..portion }, [ends[0], middle]),
            (SpanPart { from: half, ..portion }, [middle, ends[1]]),
        ];
        let nearer = usize::from((ends[1] - p).norm_sqr() < (ends[0] - p).norm_sqr());
        for i in [nearer, 1 - nearer] {
            let (portion, ends) = halves[i];
            self.refine(p, portion, ends, depth - 1, least);
        }
    }
}
