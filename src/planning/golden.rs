//! Golden-section search.

/// The smaller part of the golden section, (3 − √5)/2.
const SMALLER_SECTION: f64 = 0.381_966_011_250_105_2;

/// Finds a minimum of `f` in [low, high] by golden-section search: returns the best sample and its value. It is the
/// global minimum if `f` is unimodal in the interval. Takes `sections` + 1 evaluations; infinite values are allowed.
pub(super) fn golden([mut low, mut high]: [f64; 2], sections: usize, mut f: impl FnMut(f64) -> f64) -> (f64, f64) {
    let mut at = |x: f64| (x, f(x));
    let (mut left, mut right) = (at(low + SMALLER_SECTION * (high - low)), at(high - SMALLER_SECTION * (high - low)));
    let mut best = if right.1 < left.1 { right } else { left };
    for _ in 1..sections {
        // The new sample divides the interval from the kept sample to the farther bound, so that rounding does not
        // accumulate.
        let new = if left.1 < right.1 {
            (high, right) = (right.0, left);
            left = at(right.0 - SMALLER_SECTION * (right.0 - low));
            left
        } else {
            (low, left) = (left.0, right);
            right = at(left.0 + SMALLER_SECTION * (high - left.0));
            right
        };
        best = if new.1 < best.1 { new } else { best };
    }
    best
}
