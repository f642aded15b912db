//! Initial timing of the interior-point method: a slow timing within all limits.

use super::program::{JerkProgram, dot};

impl JerkProgram {
    /// Returns an initial timing y(θ): below the maximum that each point by itself permits, with at most `share` of the
    /// curvature that jerk allows. Returns `None` if there is none.
    pub(super) fn start(&self, bound: &impl Fn(f64) -> f64, share: f64) -> Option<Vec<f64>> {
        let mut bend = f64::INFINITY;
        let mut alone = Vec::with_capacity(self.places.len());
        for (place, sides) in self.places.iter().zip(self.sides.chunks_exact(self.each)) {
            let theta = place.theta;
            let mut least = bound(theta).powf(1.5);
            for (i, side) in sides.iter().enumerate() {
                let v = side.v.iter().sum::<f64>().abs();
                if i < self.linear {
                    least = least.min(((1.0 - side.g.abs()) / v).powf(1.5));
                } else {
                    least = least.min(1.0 / v);
                    // For y = m + bend θ², θ⃛ = y″/3 − y′²/(9 y) is at most 2/3 bend.
                    bend = bend.min(if side.g == 0.0 { f64::INFINITY } else { 1.0 / (6.0 * side.g.abs()) });
                }
            }
            alone.push((theta, least));
        }
        if bend.is_nan() || bend <= 0.0 {
            return None;
        }
        // Lower envelope of upward parabolas, then upper envelope of downward ones: the result has at most the latter's
        // curvature (Lasry–Lions regularisation).
        let bend = share * bend;
        let low = |theta: f64| {
            alone.iter().map(|(at, max)| max + 0.5 * bend * (theta - at) * (theta - at)).fold(f64::INFINITY, f64::min)
        };
        let lows: Vec<(f64, f64)> = alone.iter().map(|(at, _)| (*at, low(*at))).collect();
        let high = |theta: f64| {
            lows.iter().map(|(at, low)| low - bend * (theta - at) * (theta - at)).fold(f64::NEG_INFINITY, f64::max)
        };
        let last = self.nodes.len() - 1;
        let place = |j: usize| 0.5 * (self.nodes[j.saturating_sub(1)] + self.nodes[j.min(last)]);
        let c: Vec<f64> = (0..self.multiplier.len()).map(|j| high(place(j))).collect();
        c.iter().all(|c| *c > 0.0 && c.is_finite()).then_some(c)
    }

    /// Scales a timing so that it is well within all limits; `None` if there is no such factor.
    pub(super) fn within(&self, mut c: Vec<f64>) -> Option<Vec<f64>> {
        let mut factor: f64 = f64::INFINITY;
        for (place, sides) in self.places.iter().zip(self.sides.chunks_exact(self.each)) {
            let c = &c[place.first..];
            let (y, slope) = (dot(&place.y, c), dot(&place.slope, c));
            for (i, side) in sides.iter().enumerate() {
                let value = dot(&side.v, c);
                factor = factor.min(if i < self.linear {
                    ((1.0 - side.g.abs()) * y.cbrt() / value.abs()).powf(1.5)
                } else {
                    1.0 / (value - side.g * slope * slope / y).abs()
                });
            }
        }
        c.iter_mut().for_each(|c| *c *= 0.7 * factor);
        (factor > 0.0 && factor.is_finite()).then_some(c)
    }

    /// Returns the duration T of a timing, s.
    pub(super) fn time(&self, c: &[f64]) -> f64 {
        self.places.iter().map(|p| p.weight / dot(&p.y, &c[p.first..]).cbrt()).sum()
    }
}
