//! A straight line with bounded speed, acceleration and jerk, in closed form.

use super::profile::JerkPhase;

/// Returns the fastest motion of s from 0 to 1, from rest to rest, with |ṡ| ≤ v, |s̈| ≤ a, |s⃛| ≤ j. All bounds must be
/// above 0 and may be infinite. The phases are positive jerk, constant s̈, negative jerk, constant ṡ, and their mirror
/// image; unused phases have zero time. Returns `None` if both s̈ and s⃛ are unlimited.
pub fn s_curve(v: f64, a: f64, j: f64) -> Option<[JerkPhase; 7]> {
    if a.is_infinite() && j.is_infinite() {
        return None;
    }
    // The peak rate without the bound v, with or without constant s̈ between the phases of jerk.
    let with_constant = 2.0 * a * (a / j) * (a / j) <= 1.0;
    let free = if a.is_finite() && with_constant {
        let p = a * (a / j);
        2.0 * a / (p + (p * p + 4.0 * a).sqrt())
    } else {
        (0.25 * j).cbrt()
    };
    let peak = v.min(free);
    // Either s̈ reaches a, or it falls again before that.
    let up = if j.is_infinite() { 0.0 } else { (peak / j).sqrt().min(a / j) };
    let constant = if a.is_infinite() { 0.0 } else { (peak / a - up).max(0.0) };
    // There is a phase of constant ṡ only if v bounds the rate, regardless of rounding.
    let cruise = if peak < free { (1.0 / peak - 2.0 * up - constant).max(0.0) } else { 0.0 };
    let top = if j.is_infinite() { a } else { (j * up).min(a) };
    let jerk = if j.is_infinite() { 0.0 } else { j };
    let span = |time, acceleration, jerk| JerkPhase { time, acceleration, jerk };
    Some([
        span(up, 0.0, jerk),
        span(constant, top, 0.0),
        span(up, top, -jerk),
        span(cruise, 0.0, 0.0),
        span(up, 0.0, -jerk),
        span(constant, -top, 0.0),
        span(up, -top, jerk),
    ])
}
