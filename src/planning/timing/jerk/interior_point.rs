//! Parts of an interior-point step: slacks, multipliers, and the matrix.

use super::band::Band;
use super::program::{JerkProgram, TwoSidedLimit, dot};

impl JerkProgram {
    /// Returns the complementarity gap, the sum of slacks times multipliers.
    pub(super) fn gap(&self, c: &[f64]) -> f64 {
        let own: f64 = self.multiplier.iter().zip(c).map(|(multiplier, c)| multiplier * c).sum();
        own + self.sides.iter().map(|s| s.multiplier[0] * s.slack[0] + s.multiplier[1] * s.slack[1]).sum::<f64>()
    }

    /// Computes the trial slacks of all limits. Returns whether each exceeds `share` times the present slack. If
    /// so, and if `share` is 0, the trial slacks become the present ones.
    pub(super) fn compute_slacks(&mut self, c: &[f64], share: f64) -> bool {
        for (place, sides) in self.places.iter().zip(self.sides.chunks_exact_mut(self.each)) {
            let c = &c[place.first..];
            let (y, slope) = (dot(&place.y, c), dot(&place.slope, c));
            if y.is_nan() || y <= 0.0 {
                return false;
            }
            let (root, squares) = (y.cbrt(), slope * slope / y);
            for (i, side) in sides.iter_mut().enumerate() {
                let value = dot(&side.v, c);
                let new = if i < self.linear {
                    [(1.0 - side.g) * root - value, (1.0 + side.g) * root + value]
                } else {
                    let value = value - side.g * squares;
                    [1.0 - value, 1.0 + value]
                };
                if !(new[0] > share * side.slack[0] && new[1] > share * side.slack[1]) {
                    return false;
                }
                side.next = new;
            }
        }
        if share == 0.0 {
            self.sides.iter_mut().for_each(TwoSidedLimit::accept);
        }
        true
    }

    /// Assembles the matrix of a step and the gradients of all slacks.
    pub(super) fn assemble(&mut self, c: &[f64], band: &mut Band) {
        band.clear();
        for (i, (multiplier, c)) in self.multiplier.iter().zip(c).enumerate() {
            band.rows[i][0] = multiplier / c;
        }
        let linear = self.linear;
        for (place, sides) in self.places.iter().zip(self.sides.chunks_exact_mut(self.each)) {
            let c = &c[place.first..];
            let (y, rate) = (dot(&place.y, c), dot(&place.slope, c));
            let (root, r) = (y.cbrt(), rate / y);
            let steep = 1.0 / (3.0 * root * root);
            let mut sum = [0.0; 6];
            let (mut y_curvature, mut slope_curvature) = (4.0 / 9.0 * place.weight / (y * y * root), 0.0);
            for (i, side) in sides.iter_mut().enumerate() {
                let v = side.v;
                if i < linear {
                    let by = [(1.0 - side.g) * steep, (1.0 + side.g) * steep];
                    side.slope =
                        [[0, 1, 2].map(|k| by[0] * place.y[k] - v[k]), [0, 1, 2].map(|k| by[1] * place.y[k] + v[k])];
                    y_curvature += 2.0 / 3.0 / y * (side.multiplier[0] * by[0] + side.multiplier[1] * by[1]);
                } else {
                    let g = side.g;
                    let up = [0, 1, 2].map(|k| v[k] - g * r * (2.0 * place.slope[k] - r * place.y[k]));
                    side.slope = [up.map(|x| -x), up];
                    // Of the two limits, only the convex one adds curvature; that of the other is omitted.
                    slope_curvature += 2.0 / y * if g > 0.0 { g * side.multiplier[1] } else { -g * side.multiplier[0] };
                }
                add(&mut sum, side.multiplier[0] / side.slack[0], &side.slope[0]);
                add(&mut sum, side.multiplier[1] / side.slack[1], &side.slope[1]);
            }
            add(&mut sum, y_curvature, &place.y);
            add(&mut sum, slope_curvature, &[0, 1, 2].map(|k| place.slope[k] - r * place.y[k]));
            band.add(place.first, &sum);
        }
    }

    /// Computes the right-hand side of a step for the barrier parameter `centre`.
    pub(super) fn right_side(&self, c: &[f64], centre: f64, out: &mut [f64]) {
        for (out, (correction, c)) in out.iter_mut().zip(self.correction.iter().zip(c)) {
            *out = (centre - correction) / c;
        }
        for (place, sides) in self.places.iter().zip(self.sides.chunks_exact(self.each)) {
            let y = dot(&place.y, &c[place.first..]);
            let gain = place.weight / (3.0 * y * y.cbrt());
            let mut sum = place.y.map(|w| gain * w);
            for side in sides {
                for n in [0, 1] {
                    let by = (centre - side.correction[n]) / side.slack[n];
                    (0..3).for_each(|k| sum[k] += by * side.slope[n][k]);
                }
            }
            (0..3).for_each(|k| out[place.first + k] += sum[k]);
        }
    }

    /// Calls a function for every limit with its slack, the slack's change, its multiplier and the multiplier's change.
    #[inline]
    fn each(&self, c: &[f64], step: &[f64], centre: f64, mut call: impl FnMut([f64; 4])) {
        for ((slack, change), (multiplier, correction)) in
            c.iter().zip(step).zip(self.multiplier.iter().zip(&self.correction))
        {
            call([*slack, *change, *multiplier, (centre - correction - multiplier * change) / slack - multiplier]);
        }
        for (place, sides) in self.places.iter().zip(self.sides.chunks_exact(self.each)) {
            let step = &step[place.first..];
            for side in sides {
                for n in [0, 1] {
                    let (slack, multiplier, change) = (side.slack[n], side.multiplier[n], dot(&side.slope[n], step));
                    call([
                        slack,
                        change,
                        multiplier,
                        (centre - side.correction[n] - multiplier * change) / slack - multiplier,
                    ]);
                }
            }
        }
    }

    /// Returns the step lengths of coefficients and of multipliers: at most 1, and at most `short` times the length to
    /// the nearest bound.
    pub(super) fn step_lengths(&self, c: &[f64], step: &[f64], centre: f64, short: f64) -> (f64, f64) {
        let (mut primal, mut dual) = (1.0_f64 / short, 1.0_f64 / short);
        self.each(c, step, centre, |[slack, change, multiplier, other]| {
            if change < 0.0 {
                primal = primal.min(-slack / change);
            }
            if other < 0.0 {
                dual = dual.min(-multiplier / other);
            }
        });
        ((short * primal).min(1.0), (short * dual).min(1.0))
    }

    /// Returns the complementarity gap after a step.
    pub(super) fn predicted_gap(&self, c: &[f64], step: &[f64], primal: f64, dual: f64) -> f64 {
        let mut gap = 0.0;
        self.each(c, step, 0.0, |[slack, change, multiplier, other]| {
            gap += (slack + primal * change) * (multiplier + dual * other);
        });
        gap
    }

    /// Stores the products of the predicted changes as second-order corrections.
    pub(super) fn set_corrections(&mut self, c: &[f64], step: &[f64]) {
        let mut products = Vec::with_capacity(2 * self.sides.len() + c.len());
        self.each(c, step, 0.0, |[_, change, _, other]| products.push(change * other));
        let (own, sides) = products.split_at(c.len());
        self.correction.copy_from_slice(own);
        for (side, correction) in self.sides.iter_mut().zip(sides.chunks_exact(2)) {
            side.correction = [correction[0], correction[1]];
        }
    }

    /// Moves the multipliers by `dual` times their step.
    pub(super) fn update_multipliers(&mut self, c: &[f64], step: &[f64], centre: f64, dual: f64) {
        let mut multipliers = Vec::with_capacity(2 * self.sides.len() + c.len());
        self.each(c, step, centre, |[_, _, multiplier, change]| multipliers.push(multiplier + dual * change));
        let (own, sides) = multipliers.split_at(c.len());
        self.multiplier.copy_from_slice(own);
        for (side, multiplier) in self.sides.iter_mut().zip(sides.chunks_exact(2)) {
            side.multiplier = [multiplier[0], multiplier[1]];
        }
    }
}

/// Adds weight · v vᵀ to an upper triangle.
#[inline]
fn add(sum: &mut [f64; 6], weight: f64, v: &[f64; 3]) {
    let w = v.map(|v| weight * v);
    sum[0] += w[0] * v[0];
    sum[1] += w[0] * v[1];
    sum[2] += w[0] * v[2];
    sum[3] += w[1] * v[1];
    sum[4] += w[1] * v[2];
    sum[5] += w[2] * v[2];
}
