//! Long-run variance: the variance of sums of terms that are correlated over time.
//!
//! # Source
//! Newey and West (1987): Bartlett's window over the autocovariances, here computed equivalently by sums of L
//! neighbours. Andrews (1991), equation (6.2) with the first-order plug-in (6.4), for L. Kiefer and Vogelsang (2005),
//! table 1, for the critical value of two-sided 95 %.

use nalgebra::DMatrix;

/// Returns Σ over lags of Bartlett's weight times Σ_i s_i s_{i+lag}ᵀ, where s_i are the rows of `scores`, summed motion
/// by motion. For each motion, `fitted` parameters were fitted; the result is corrected for the variance that this
/// removed.
pub(super) fn long_run(scores: &DMatrix<f64>, motions: &[usize], lags: usize, fitted: i32) -> DMatrix<f64> {
    let p = scores.ncols();
    let mut sum = DMatrix::zeros(p, p);
    let mut from = 0;
    for &count in motions {
        let mut blocks = DMatrix::zeros(count + lags - 1, p);
        for (j, column) in scores.column_iter().enumerate() {
            let mut running = 0.0;
            for i in 0..count + lags - 1 {
                running += if i < count { column[from + i] } else { 0.0 };
                running -= if i >= lags { column[from + i - lags] } else { 0.0 };
                blocks[(i, j)] = running;
            }
        }
        // Fraction of the variance that remains after the fit, approximately the same factor for each parameter of a
        // trend line (offset and drift).
        let share = (lags as f64 / count as f64).min(1.0);
        let remaining = (1.0 - share + share * share / 3.0).powi(fitted);
        sum += blocks.tr_mul(&blocks) / (lags as f64 * remaining);
        from += count;
    }
    sum
}

/// Factor on the number of lags that minimises the mean square error of the variance: too narrow intervals are worse
/// than slightly too wide ones.
const LAG_FACTOR: f64 = 2.0;

/// Returns the ratio of the long-run variance of errors to the variance of one row, at least 1: their correlation length in
/// rows. Each column of `errors` is one measured quantity; other symbols as in [`long_run`].
pub(super) fn correlation_length(errors: &DMatrix<f64>, motions: &[usize], lags: usize, fitted: i32) -> f64 {
    let (long, own) = (long_run(errors, motions, lags, fitted).trace(), errors.norm_squared());
    if own > 0.0 { (long / own).max(1.0) } else { 1.0 }
}

/// Returns Σ y_i² and Σ y_i y_{i+1}, summed motion by motion.
pub(super) fn neighbour_products(y: &[f64], motions: &[usize]) -> [f64; 2] {
    let (mut own, mut next, mut from) = (0.0, 0.0, 0);
    for &n in motions {
        let y = &y[from..from + n];
        own += y.iter().map(|x| x * x).sum::<f64>();
        next += y.windows(2).map(|w| w[0] * w[1]).sum::<f64>();
        from += n;
    }
    [own, next]
}

/// Returns the number of lags of Bartlett's window for residuals: at least `least`, at most half the longest motion.
pub(super) fn bartlett_lags(residuals: &[&[f64]], motions: &[usize], least: usize) -> usize {
    let count: usize = motions.iter().sum();
    let first = |y: &[f64]| {
        let [own, next] = neighbour_products(y, motions);
        if own > 0.0 { (next / own).abs().min(0.97) } else { 0.0 }
    };
    let rho = residuals.iter().map(|y| first(y)).fold(0.0, f64::max);
    let alpha = 4.0 * rho * rho / ((1.0 - rho) * (1.0 + rho)).powi(2);
    let wanted = (LAG_FACTOR * 1.1447 * (alpha * count as f64).cbrt()).ceil() as usize;
    let longest = motions.iter().copied().max().unwrap_or(1);
    wanted.max(least).clamp(1, longest.div_ceil(2))
}

/// Returns the ratio of the half width of a 95 % interval to the standard deviation. The window covers the fraction
/// `share` of the data.
pub(super) fn t_quantile(share: f64) -> f64 {
    let b = share.clamp(0.0, 1.0);
    1.96 + b * (2.9694 + b * (0.4160 - 0.5324 * b))
}
