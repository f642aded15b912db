//! Approach speeds from which a reference can still stop.

/// Time constant with which the speed of the reference follows the wanted speed, s.
pub(super) const LAG_TIME: f64 = 0.02;

/// Returns the Euclidean norm, √Σ x².
pub(super) fn norm(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |sum: f64, x| sum.hypot(*x))
}

/// Finds by bisection the greatest fraction that is feasible; 0 is feasible, 1 is not.
pub(super) fn greatest_feasible_fraction(is_open: impl Fn(f64) -> bool) -> f64 {
    let (mut open, mut blocked) = (0.0, 1.0);
    for _ in 0..20 {
        let middle = 0.5 * (open + blocked);
        if is_open(middle) { open = middle } else { blocked = middle }
    }
    open
}

/// Returns the speed at which to close a distance, so that a deceleration of 0.8 `bound` still stops in time.
pub(super) fn approach(distance: f64, bound: f64) -> f64 {
    (distance / (4.0 * LAG_TIME)).min((1.6 * bound * distance).sqrt())
}
