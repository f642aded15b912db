//! s as a function of θ, with zero first and second derivatives at both ends.

/// Returns s and its first three derivatives with respect to θ.
pub fn eased(theta: f64) -> [f64; 4] {
    let (v, w) = (theta, 1.0 - theta);
    let s = v * v * v * (10.0 + v * (-15.0 + 6.0 * v));
    [s, 30.0 * v * v * w * w, 60.0 * v * w * (1.0 - 2.0 * v), 60.0 * (1.0 - 6.0 * v * w)]
}

/// Returns θ for a given s.
pub fn uneased(s: f64) -> f64 {
    if s > 0.5 {
        return 1.0 - uneased(1.0 - s);
    }
    // s rises and is convex below the middle, so that Newton's method converges.
    let mut theta = (s / 5.0).cbrt().min(0.5);
    for _ in 0..60 {
        let [at, slope, ..] = eased(theta);
        let step = (at - s) / slope;
        if step.is_nan() || step.abs() <= 1e-16 * theta {
            break;
        }
        theta -= step;
    }
    theta
}
