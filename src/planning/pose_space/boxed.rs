//! The weighted least-squares step within a box, subject to two linear equations.
//!
//! # Symbols
//! | letter | meaning |
//! |---|---|
//! | x | the step: minimises ½ Σ w_i (x_i − y_i)² subject to Σ c_i x_i = r and low_i ≤ x_i ≤ high_i |
//! | ν | the multiplier of the two equations: x_i = y_i + c_i·ν / w_i, clamped |
//!
//! # Method
//! The dual is a concave, piecewise quadratic function of the two components of ν. Newton's iteration on it, with an
//! exact line search, ends after a few iterations. If no x in the box satisfies the equations, x nearly minimises their
//! residual.

use stillbase_mechanics::planar::{MAX_DRIVES, PerDrive, Vector, dot};

/// Maximum number of Newton iterations.
const MAX_ITERATIONS: usize = 30;
/// Regularisation that makes the dual strictly concave, as a fraction of Σ |c_i|² / w_i.
const DAMPING: f64 = 1e-14;
/// Relative tolerance of the residual of the equations.
const RELATIVE_TOLERANCE: f64 = 1e-13;

/// A box-constrained least-squares problem.
pub(super) struct BoxedStep<'a> {
    /// Columns c_i of the equations.
    pub columns: &'a [Vector; MAX_DRIVES],
    /// Weights w_i, above 0.
    pub weight: &'a PerDrive,
    /// Unconstrained optimum y_i.
    pub unconstrained: &'a PerDrive,
    /// Bounds low_i and high_i.
    pub range: [[f64; 2]; MAX_DRIVES],
}

impl BoxedStep<'_> {
    /// Returns the step x for the right-hand side r = `wanted`, and the multiplier ν.
    pub fn step(&self, wanted: Vector) -> (PerDrive, Vector) {
        let n = self.unconstrained.len();
        let scale: f64 = (0..n).map(|i| self.columns[i].norm_sqr() / self.weight[i]).sum();
        let damping = DAMPING * scale;
        let mut nu = Vector::default();
        let mut x = self.at(nu);
        if scale == 0.0 {
            return (x, nu);
        }
        let gradient = |x: &PerDrive, nu: Vector| wanted - self.sum(x) - damping * nu;
        let enough = RELATIVE_TOLERANCE * (wanted.norm() + self.sum(self.unconstrained).norm());
        for _ in 0..MAX_ITERATIONS {
            let missing = gradient(&x, nu);
            if missing.norm() <= enough {
                break;
            }
            let mut gram = [damping, 0.0, damping];
            for i in 0..n {
                let [low, high] = self.range[i];
                let own = self.unconstrained[i] + dot(self.columns[i], nu) / self.weight[i];
                if low < high && own >= low && own <= high {
                    let (c, w) = (self.columns[i], 1.0 / self.weight[i]);
                    gram = [gram[0] + w * c.re * c.re, gram[1] + w * c.re * c.im, gram[2] + w * c.im * c.im];
                }
            }
            let det = gram[0] * gram[2] - gram[1] * gram[1];
            let mut way =
                Vector::new(gram[2] * missing.re - gram[1] * missing.im, gram[0] * missing.im - gram[1] * missing.re)
                    / det;
            if !way.norm_sqr().is_finite() || dot(way, missing) <= 0.0 {
                way = missing / scale;
            }
            let Some(far) = self.along(nu, way, |x, nu| dot(way, gradient(x, nu))) else { break };
            nu += far * way;
            x = self.at(nu);
        }
        (x, nu)
    }

    fn at(&self, nu: Vector) -> PerDrive {
        PerDrive::from_fn(self.unconstrained.len(), |i| {
            let [low, high] = self.range[i];
            (self.unconstrained[i] + dot(self.columns[i], nu) / self.weight[i]).clamp(low, high)
        })
    }

    fn sum(&self, x: &PerDrive) -> Vector {
        x.iter().zip(self.columns).map(|(x, c)| *c * *x).sum()
    }

    /// Line search: returns the step factor at which the dual is greatest along a direction, or 1 if that is near
    /// enough. The slope of the dual decreases piecewise linearly. Returns `None` if no maximum is found.
    fn along(&self, nu: Vector, way: Vector, slope: impl Fn(&PerDrive, Vector) -> f64) -> Option<f64> {
        let at = |t: f64| slope(&self.at(nu + t * way), nu + t * way);
        let first = at(0.0);
        let whole = at(1.0);
        if whole.abs() <= 1e-3 * first {
            return Some(1.0);
        }
        let mut breakpoints = [f64::INFINITY; 2 * MAX_DRIVES];
        let mut count = 0;
        for i in 0..self.unconstrained.len() {
            let speed = dot(self.columns[i], way) / self.weight[i];
            let own = self.unconstrained[i] + dot(self.columns[i], nu) / self.weight[i];
            for end in self.range[i] {
                let t = (end - own) / speed;
                if t > 0.0 && t.is_finite() {
                    breakpoints[count] = t;
                    count += 1;
                }
            }
        }
        let breakpoints = &mut breakpoints[..count];
        breakpoints.sort_unstable_by(f64::total_cmp);
        let (mut from, mut before) = (0.0, first);
        for t in breakpoints.iter().copied() {
            let here = at(t);
            if here <= 0.0 {
                return Some(from + (t - from) * before / (before - here));
            }
            (from, before) = (t, here);
        }
        // Past the last breakpoint the slope comes only from the regularisation and from components without bounds in
        // this direction.
        let beyond = from.max(1.0) * 2.0;
        let here = at(beyond);
        let falls = before - here;
        let t = from + (beyond - from) * before / falls;
        let goes_on = falls > 1e-6 * first.max(before) && t.is_finite();
        if goes_on { Some(t) } else { (from > 0.0).then_some(from) }
    }
}
