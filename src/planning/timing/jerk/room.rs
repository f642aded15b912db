//! What a step of the method is made of: the room that limits leave, what it is worth, and the matrix.

use super::band::Band;
use super::program::{JerkProgram, Side, dot};

impl JerkProgram {
    /// What all room is worth.
    pub(super) fn gap(&self, c: &[f64]) -> f64 {
        let own: f64 = self.worth.iter().zip(c).map(|(worth, c)| worth * c).sum();
        own + self.sides.iter().map(|s| s.worth[0] * s.room[0] + s.worth[1] * s.room[1]).sum::<f64>()
    }

    /// Takes new room on every side from coefficients; whether at least a share of all is left.
    pub(super) fn measure(&mut self, c: &[f64], share: f64) -> bool {
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
                if !(new[0] > share * side.room[0] && new[1] > share * side.room[1]) {
                    return false;
                }
                side.next = new;
            }
        }
        if share == 0.0 {
            self.sides.iter_mut().for_each(Side::settle);
        }
        true
    }

    /// The matrix of a step, and the slopes of all room.
    pub(super) fn assemble(&mut self, c: &[f64], band: &mut Band) {
        band.clear();
        for (i, (worth, c)) in self.worth.iter().zip(c).enumerate() {
            band.rows[i][0] = worth / c;
        }
        let linear = self.linear;
        for (place, sides) in self.places.iter().zip(self.sides.chunks_exact_mut(self.each)) {
            let c = &c[place.first..];
            let (y, rate) = (dot(&place.y, c), dot(&place.slope, c));
            let (root, r) = (y.cbrt(), rate / y);
            let steep = 1.0 / (3.0 * root * root);
            let mut sum = [0.0; 6];
            let (mut bow, mut curl) = (4.0 / 9.0 * place.weight / (y * y * root), 0.0);
            for (i, side) in sides.iter_mut().enumerate() {
                let v = side.v;
                if i < linear {
                    let by = [(1.0 - side.g) * steep, (1.0 + side.g) * steep];
                    side.slope =
                        [[0, 1, 2].map(|k| by[0] * place.y[k] - v[k]), [0, 1, 2].map(|k| by[1] * place.y[k] + v[k])];
                    bow += 2.0 / 3.0 / y * (side.worth[0] * by[0] + side.worth[1] * by[1]);
                } else {
                    let g = side.g;
                    let up = [0, 1, 2].map(|k| v[k] - g * r * (2.0 * place.slope[k] - r * place.y[k]));
                    side.slope = [up.map(|x| -x), up];
                    // Of the two sides one is convex.
                    curl += 2.0 / y * if g > 0.0 { g * side.worth[1] } else { -g * side.worth[0] };
                }
                add(&mut sum, side.worth[0] / side.room[0], &side.slope[0]);
                add(&mut sum, side.worth[1] / side.room[1], &side.slope[1]);
            }
            add(&mut sum, bow, &place.y);
            add(&mut sum, curl, &[0, 1, 2].map(|k| place.slope[k] - r * place.y[k]));
            band.add(place.first, &sum);
        }
    }

    /// Where the objective and the limits push the coefficients.
    pub(super) fn push(&self, c: &[f64], centre: f64, push: &mut [f64]) {
        for (push, (bent, c)) in push.iter_mut().zip(self.bent.iter().zip(c)) {
            *push = (centre - bent) / c;
        }
        for (place, sides) in self.places.iter().zip(self.sides.chunks_exact(self.each)) {
            let y = dot(&place.y, &c[place.first..]);
            let gain = place.weight / (3.0 * y * y.cbrt());
            let mut sum = place.y.map(|w| gain * w);
            for side in sides {
                for n in [0, 1] {
                    let by = (centre - side.bent[n]) / side.room[n];
                    (0..3).for_each(|k| sum[k] += by * side.slope[n][k]);
                }
            }
            (0..3).for_each(|k| push[place.first + k] += sum[k]);
        }
    }

    /// Calls with room, its change, worth and its change, for every limit.
    #[inline]
    fn each(&self, c: &[f64], step: &[f64], centre: f64, mut call: impl FnMut([f64; 4])) {
        for ((room, change), (worth, bent)) in c.iter().zip(step).zip(self.worth.iter().zip(&self.bent)) {
            call([*room, *change, *worth, (centre - bent - worth * change) / room - worth]);
        }
        for (place, sides) in self.places.iter().zip(self.sides.chunks_exact(self.each)) {
            let step = &step[place.first..];
            for side in sides {
                for n in [0, 1] {
                    let (room, worth, change) = (side.room[n], side.worth[n], dot(&side.slope[n], step));
                    call([room, change, worth, (centre - side.bent[n] - worth * change) / room - worth]);
                }
            }
        }
    }

    /// How far the step may be gone, and how far the worths', so that a share of all room is left.
    pub(super) fn reach(&self, c: &[f64], step: &[f64], centre: f64, short: f64) -> (f64, f64) {
        let (mut primal, mut dual) = (1.0_f64 / short, 1.0_f64 / short);
        self.each(c, step, centre, |[room, change, worth, other]| {
            if change < 0.0 {
                primal = primal.min(-room / change);
            }
            if other < 0.0 {
                dual = dual.min(-worth / other);
            }
        });
        ((short * primal).min(1.0), (short * dual).min(1.0))
    }

    /// What all room would be worth after it.
    pub(super) fn left(&self, c: &[f64], step: &[f64], primal: f64, dual: f64) -> f64 {
        let mut left = 0.0;
        self.each(c, step, 0.0, |[room, change, worth, other]| {
            left += (room + primal * change) * (worth + dual * other);
        });
        left
    }

    /// Keeps the products of the predicted changes.
    pub(super) fn bend(&mut self, c: &[f64], step: &[f64]) {
        let mut products = Vec::with_capacity(2 * self.sides.len() + c.len());
        self.each(c, step, 0.0, |[_, change, _, other]| products.push(change * other));
        let (own, sides) = products.split_at(c.len());
        self.bent.copy_from_slice(own);
        for (side, bent) in self.sides.iter_mut().zip(sides.chunks_exact(2)) {
            side.bent = [bent[0], bent[1]];
        }
    }

    /// Moves the worths by a share of their step.
    pub(super) fn revalue(&mut self, c: &[f64], step: &[f64], centre: f64, dual: f64) {
        let mut worths = Vec::with_capacity(2 * self.sides.len() + c.len());
        self.each(c, step, centre, |[_, _, worth, change]| worths.push(worth + dual * change));
        let (own, sides) = worths.split_at(c.len());
        self.worth.copy_from_slice(own);
        for (side, worth) in self.sides.iter_mut().zip(sides.chunks_exact(2)) {
            side.worth = [worth[0], worth[1]];
        }
    }
}

/// Adds weight · v vᵀ: above and on the diagonal.
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
