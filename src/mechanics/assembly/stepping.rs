//! One step of a motion that turns in space.

use nalgebra::SVector;

/// Returns a state after a step of h seconds. `slope` returns the slope at a fraction of the step and a state, and `moved`
/// a state moved by a slope times a time.
///
/// # Source
/// The commutator-free method of fourth order of E. Celledoni, A. Marthinsen and B. Owren, *Commutator-free Lie group
/// methods*, 2003: what turns stays a rotation. For what does not turn it is the classical method of Runge and Kutta.
pub(super) fn after<S, const N: usize>(
    start: &S,
    h: f64,
    mut slope: impl FnMut(f64, &S) -> SVector<f64, N>,
    moved: impl Fn(&S, &SVector<f64, N>) -> S,
) -> S {
    let first = h * slope(0.0, start);
    let half = moved(start, &(0.5 * first));
    let second = h * slope(0.5, &half);
    let third = h * slope(0.5, &moved(start, &(0.5 * second)));
    let fourth = h * slope(1.0, &moved(&half, &(third - 0.5 * first)));
    let both = 2.0 * (second + third);
    moved(&moved(start, &((3.0 * first + both - fourth) / 12.0)), &((3.0 * fourth + both - first) / 12.0))
}
