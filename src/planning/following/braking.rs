//! How fast a reference nears what it has to stop at.

/// Time constant of the reference behind its aim, s.
pub(super) const LAG: f64 = 0.02;

/// √Σ x².
pub(super) fn norm(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |sum: f64, x| sum.hypot(*x))
}

/// The greatest share that is open, of those between 0, which is, and 1, which is not.
pub(super) fn last_open(is_open: impl Fn(f64) -> bool) -> f64 {
    let (mut open, mut barred) = (0.0, 1.0);
    for _ in 0..20 {
        let middle = 0.5 * (open + barred);
        if is_open(middle) { open = middle } else { barred = middle }
    }
    open
}

/// Speed at which a distance is closed so that four fifths of the bound can still stop it.
pub(super) fn approach(distance: f64, bound: f64) -> f64 {
    (distance / (4.0 * LAG)).min((1.6 * bound * distance).sqrt())
}
