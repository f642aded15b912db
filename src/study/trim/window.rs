//! [`SmoothingWindow`]: weights for the average of a signal over a window and for the average of its derivative.
//!
//! # Symbols
//! | letter | meaning |
//! |---|---|
//! | u | (t − `centre`)/`half`, from −1 to 1 |
//! | φ | (1 − u²)⁴ |
//! | a_j | weights of the average: Σ a_j y_j ≈ ∫ φ y / ∫ φ |
//! | d_j | weights with Σ d_j y_j = −Σ a_j ẏ_j for cubics, ≈ ∫ φ̇ y / ∫ φ |

use std::ops::Range;

use nalgebra::{Matrix4, Vector4};

/// Minimum number of samples in a window.
pub(super) const MIN_WINDOW_SAMPLES: usize = 7;

/// Weights of the samples in a window.
pub(super) struct SmoothingWindow {
    /// Indices of the samples.
    pub samples: Range<usize>,
    /// Weights a_j.
    pub mean: Vec<f64>,
    /// Weights d_j, 1/s.
    pub rate: Vec<f64>,
}

impl SmoothingWindow {
    /// Returns the window of half width `half`, s, about the time `centre`, s; `None` if it contains too few samples.
    pub fn about(t: &[f64], centre: f64, half: f64) -> Option<Self> {
        let from = t.partition_point(|t| *t <= centre - half);
        let samples = from..t.partition_point(|t| *t < centre + half);
        if samples.len() < MIN_WINDOW_SAMPLES {
            return None;
        }
        let u: Vec<f64> = samples.clone().map(|j| (t[j] - centre) / half).collect();
        // Half the distance between the two neighbours; at the ends of the record, half the distance to the only
        // neighbour.
        let place = |j: usize| t[j.min(t.len() - 1)];
        let space = |j: usize| 0.5 * (place(j + 1) - place(j.saturating_sub(1))) / half;
        let phi: Vec<f64> = samples.clone().zip(&u).map(|(j, u)| space(j) * (1.0 - u * u).powi(4)).collect();
        let whole: f64 = phi.iter().sum();
        let mean: Vec<f64> = phi.iter().map(|phi| phi / whole).collect();
        let slope = |(j, u): (usize, &f64)| -8.0 * u * (1.0 - u * u).powi(3) * space(j) / whole;
        let mut rate: Vec<f64> = samples.clone().zip(&u).map(slope).collect();
        // Correct the quadrature error on unevenly spaced times, exactly for cubics.
        let moment = |weights: &[f64], power: i32| weights.iter().zip(&u).map(|(w, u)| w * u.powi(power)).sum::<f64>();
        let gram = Matrix4::from_fn(|i, j| moment(&mean, (i + j) as i32));
        let wanted = Vector4::from_fn(|i, _| if i == 0 { 0.0 } else { -(i as f64) * moment(&mean, i as i32 - 1) });
        let error = Vector4::from_fn(|i, _| wanted[i] - moment(&rate, i as i32));
        let by = gram.lu().solve(&error)?;
        for ((rate, mean), u) in rate.iter_mut().zip(&mean).zip(&u) {
            *rate += mean * (by[0] + u * (by[1] + u * (by[2] + u * by[3])));
            *rate /= half;
        }
        Some(Self { samples, mean, rate })
    }
}
