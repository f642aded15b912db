//! The quintic spline through samples: four continuous derivatives, each sample met exactly.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | t_i, y_i | time and value of sample i, 0 … N | s, any |
//! | h_i | t_{i+1} − t_i | s |
//! | m_i, M_i | ẏ and ÿ at sample i, which with y_i determine the quintics | |
//!
//! # Source
//! On each interval the spline is the quintic Hermite polynomial through (y, m, M) at both ends. Continuity of y⃛ and
//! y⁗ at every inner sample gives two linear equations for its m and M, a symmetric block-tridiagonal system. At both
//! ends m and M are those of the polynomial through the six samples next to the end. So nothing is assumed about how
//! the motion begins or stops. The error of y falls with h⁶, that of ẏ with h⁵, that of ÿ with h⁴.
//!
//! # Noise
//! The spline does not smooth. Independent errors of standard deviation σ in evenly spaced samples cause errors of ÿ.
//! Their root mean square is [`NOISE_GAIN`] σ/h² at inner samples, and about 27 σ/h² at both ends, where only six
//! samples contribute.

use nalgebra::{Matrix2, Vector2};

/// Minimum number of samples.
pub const MIN_SPLINE_SAMPLES: usize = 6;

/// Root mean square error of ÿ at inner samples, times h²/σ. The samples are evenly spaced and have independent errors
/// of standard deviation σ.
pub const NOISE_GAIN: f64 = 4.5;

/// Equations of the spline for given times, factorised once for any number of columns.
#[derive(Clone, Debug)]
pub struct Knots {
    t: Vec<f64>,
    /// Mean of h, s: the unit of time in the equations, so that all blocks are of order 1.
    unit: f64,
    /// For each inner sample: the sub-diagonal block, and the inverse of the pivot block.
    rows: Vec<[Matrix2<f64>; 2]>,
    /// For each inner sample: the inverse pivot times the super-diagonal block.
    upper: Vec<Matrix2<f64>>,
}

impl Knots {
    /// Factorises the equations for given times, s. Returns `None` if the times do not rise or are fewer than
    /// [`MIN_SPLINE_SAMPLES`].
    pub fn new(t: &[f64]) -> Option<Self> {
        let spaces = t.len().checked_sub(1).filter(|_| t.len() >= MIN_SPLINE_SAMPLES)?;
        let unit = (t[spaces] - t[0]) / spaces as f64;
        if !(unit.is_finite() && t.windows(2).all(|w| w[1] - w[0] > 0.0)) {
            return None;
        }
        let (mut rows, mut upper) = (Vec::with_capacity(spaces), Vec::with_capacity(spaces));
        let mut previous = Matrix2::zeros();
        for i in 1..spaces {
            let (l, r) = ((t[i] - t[i - 1]) / unit, (t[i + 1] - t[i]) / unit);
            let ([l1, l2, l3], [r1, r2, r3]) = ([l, l * l, l * l * l], [r, r * r, r * r * r]);
            let mixed = 36.0 / r2 - 36.0 / l2;
            let own = Matrix2::new(192.0 / l3 + 192.0 / r3, mixed, mixed, 9.0 / l1 + 9.0 / r1);
            let below = Matrix2::new(168.0 / l3, 24.0 / l2, -24.0 / l2, -3.0 / l1);
            let above = Matrix2::new(168.0 / r3, -24.0 / r2, 24.0 / r2, -3.0 / r1);
            let pivot = (own - below * previous).try_inverse()?;
            previous = pivot * above;
            rows.push([below, pivot]);
            upper.push(previous);
        }
        Some(Self { t: t.to_vec(), unit, rows, upper })
    }

    /// Returns (ẏ, ÿ) at every sample for values y at these times.
    pub fn rates(&self, y: impl Fn(usize) -> f64) -> Vec<[f64; 2]> {
        let (t, unit, last) = (&self.t, self.unit, self.t.len() - 1);
        let scaled = |[m, second]: [f64; 2]| Vector2::new(m * unit, second * unit * unit);
        let near = |i: usize| (t[i], y(i));
        let start = scaled(at_end(std::array::from_fn(near)));
        let end = scaled(at_end(std::array::from_fn(|k| near(last - k))));
        let mut x = Vec::with_capacity(t.len());
        x.push(start);
        for i in 1..last {
            let (l, r) = ((t[i] - t[i - 1]) / unit, (t[i + 1] - t[i]) / unit);
            let (before, next) = ((y(i) - y(i - 1)) / (l * l * l), (y(i + 1) - y(i)) / (r * r * r));
            let side = Vector2::new(360.0 * (before / l + next / r), 60.0 * (next - before));
            let [below, pivot] = &self.rows[i - 1];
            // m and M of the first and the last sample are known.
            x.push(pivot * (side - below * x[i - 1]));
        }
        x.push(end);
        for i in (1..last).rev() {
            let next = x[i + 1];
            x[i] -= self.upper[i - 1] * next;
        }
        x.iter().map(|x| [x[0] / unit, x[1] / (unit * unit)]).collect()
    }
}

/// Returns the first two derivatives of the polynomial through six points (t, y), at the first of them.
fn at_end(points: [(f64, f64); MIN_SPLINE_SAMPLES]) -> [f64; 2] {
    let (t, mut c) = (points.map(|p| p.0), points.map(|p| p.1));
    // Newton's divided differences, in place.
    for k in 1..MIN_SPLINE_SAMPLES {
        for i in (k..MIN_SPLINE_SAMPLES).rev() {
            c[i] = (c[i] - c[i - 1]) / (t[i] - t[i - k]);
        }
    }
    let (mut value, mut first, mut half) = (0.0, 0.0, 0.0);
    for i in (0..MIN_SPLINE_SAMPLES).rev() {
        let d = t[0] - t[i];
        (half, first, value) = (half * d + first, first * d + value, value * d + c[i]);
    }
    [first, 2.0 * half]
}
