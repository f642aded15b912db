//! Rates by finite differences of neighbouring samples, and the noise of samples.
//!
//! # Source
//! Lagrange's interpolation polynomials through neighbouring samples, at times that need not be evenly spaced.

/// Number of samples in the stencil of a rate; the error of the rate falls with the fourth power of the spacing.
const STENCIL_POINTS: usize = 5;

/// Returns the stencil of the rate at sample i: its first sample, and the weights, 1/s.
pub(super) fn stencil(t: &[f64], i: usize) -> (usize, Vec<f64>) {
    let count = STENCIL_POINTS.min(t.len());
    let from = i.saturating_sub(count / 2).min(t.len() - count);
    let near = &t[from..from + count];
    (from, (0..count).map(|j| slope(near, j, t[i])).collect())
}

/// Returns the derivative of the Lagrange polynomial of node j at a time.
fn slope(t: &[f64], j: usize, at: f64) -> f64 {
    let others = |skip: usize| (0..t.len()).filter(move |m| *m != j && *m != skip);
    let scale: f64 = others(j).map(|m| t[j] - t[m]).product();
    let sum: f64 = others(j).map(|out| others(out).map(|m| at - t[m]).product::<f64>()).sum();
    sum / scale
}

/// Estimates the standard deviation of independent errors of samples, from the residual of each against the polynomial
/// through three neighbours on either side. `None` for fewer than seven samples.
pub(super) fn noise(t: &[f64], y: impl Fn(usize) -> f64) -> Option<f64> {
    let around = |i: usize| (i - 3..i).chain(i + 1..i + 4);
    let places = 3..t.len().checked_sub(3).filter(|end| *end > 3)?;
    let count = places.len() as f64;
    let squared_error = |i: usize| {
        let (mut value, mut gain) = (y(i), 1.0);
        for j in around(i) {
            let weight: f64 = around(i).filter(|m| *m != j).map(|m| (t[i] - t[m]) / (t[j] - t[m])).product();
            value -= weight * y(j);
            gain += weight * weight;
        }
        value * value / gain
    };
    Some((places.map(squared_error).sum::<f64>() / count).sqrt())
}

/// Number of samples through which values between them are interpolated.
const NEAR_POINTS: usize = 4;

/// Returns the value of samples at a time: the polynomial through the nearest two on either side.
pub(super) fn interpolated(t: &[f64], y: &[f64], at: f64) -> f64 {
    let count = NEAR_POINTS.min(t.len());
    let from = t.partition_point(|t| *t < at).saturating_sub(count / 2).min(t.len() - count);
    let near = from..from + count;
    let weight = |j: usize| near.clone().filter(|m| *m != j).map(|m| (at - t[m]) / (t[j] - t[m])).product::<f64>();
    near.clone().map(|j| weight(j) * y[j]).sum()
}
